//! Time scales of the equations: width and centre of each function of time in them.
//!
//! A method samples accelerations, and the search for impacts samples gaps of limits, at a few
//! times in a step. For small w, exp(−((t − t₀)/w)²) could fall between two of these times and be
//! missed, so that steps are limited by w. A function f(u) of a polynomial u = a tᵈ + … has the
//! width |a|^(−1/d).

mod polynomial;

use crate::algebra::diff::{derivative, substitute};
use crate::algebra::expr::{Dependencies, Graph, Id, Node, Symbol};
use crate::algebra::functions::{Function, Scale};
use crate::algebra::number::Rational;
use crate::algebra::order;
use crate::mechanics::arguments::is_sharp;
use polynomial::Polynomial;
use std::collections::{BTreeMap, BTreeSet};

/// A function of time in the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Feature {
    /// The reciprocal of its width.
    pub(crate) rate: Id,
    /// The time since its centre, or zero if it has no centre.
    pub(crate) since: Id,
}

/// Returns the features of accelerations and of the gaps of limits, in a separate graph.
///
/// Gaps have more of them: an error estimate corrects what samples show of a force, but nothing
/// corrects an impact that is missed.
pub(crate) fn features(graph: &Graph, accelerations: &[Id], gaps: &[Id]) -> (Graph, Vec<Feature>) {
    let mut roots = [accelerations, gaps].concat();
    if !roots.iter().any(|&root| graph.dependencies(root).any(Dependencies::TIME)) {
        return (Graph::new(), Vec::new());
    }
    let graph = order::canonicalize(graph, &mut roots.iter_mut().collect::<Vec<_>>());
    let mut search = Search {
        graph,
        found: BTreeSet::new(),
        corners: BTreeSet::new(),
        degrees: BTreeMap::new(),
        polynomials: BTreeMap::new(),
        gap: false,
        sharpness: Graph::ONE,
    };
    for (gap, roots) in [(false, &roots[..]), (true, &roots[accelerations.len()..])] {
        search.gap = gap;
        for id in search.graph.reachable(roots) {
            if search.moves(id) {
                search.visit(id);
            }
        }
    }
    search.pairs();
    (search.graph, search.found.into_iter().collect())
}

/// The highest degree of polynomials in time that are examined.
const HIGHEST: i64 = 8;

/// The largest number of corners for which all pairs are examined. If there are more, only pairs of
/// neighbours are.
///
/// The number of features is at most `CORNERS` times the number of functions and powers in the
/// equations, plus the number of pairs.
const CORNERS: usize = 8;

/// Everything that may vary apart from time.
const BESIDE_TIME: Dependencies = Dependencies::COORDINATE
    .or(Dependencies::VELOCITY)
    .or(Dependencies::INPUT)
    .or(Dependencies::MOMENTUM)
    .or(Dependencies::POINT)
    .or(Dependencies::MULTIPLIER)
    .or(Dependencies::TARGET)
    .or(Dependencies::AUXILIARY);

struct Search {
    graph: Graph,
    found: BTreeSet<Feature>,
    /// The times at which `abs`, `sign` or `max` has a corner.
    corners: BTreeSet<Id>,
    /// The degrees of polynomials in time computed so far.
    degrees: BTreeMap<Id, Option<i64>>,
    /// The polynomials computed so far.
    polynomials: BTreeMap<Id, Option<Polynomial>>,
    /// `true` if the expressions are gaps of limits.
    gap: bool,
    /// The factor of rates inside of a power.
    sharpness: Id,
}

/// A term k sinⁿ ωt.
struct Swing {
    /// k.
    factor: Id,
    /// n.
    power: i64,
    /// |ω|.
    speed: Id,
}

impl Search {
    fn moves(&self, id: Id) -> bool {
        self.graph.dependencies(id).any(Dependencies::TIME)
    }

    fn has_state(&self, id: Id) -> bool {
        self.graph.dependencies(id).any(BESIDE_TIME)
    }

    fn visit(&mut self, id: Id) {
        match self.graph.node(id).clone() {
            // The knots are switches, also those of a table of the time.
            Node::Call(Function::Table(..), _) => {}
            Node::Call(function, argument) => match function.row().scale {
                Scale::Oscillation => self.oscillation(argument),
                Scale::Bell => self.bell(argument),
                Scale::Bump => self.bump(argument),
                Scale::Kink => self.corner(argument),
            },
            Node::Max(a, b) => {
                let difference = self.graph.sub(a, b);
                self.corner(difference);
            }
            Node::Atan2(y, x) => {
                let squares = [x, y].map(|part| self.graph.power(part, Rational::whole(2)));
                let square = self.graph.add(squares[0], squares[1]);
                self.bump(square);
            }
            Node::Product(_, factors) => {
                for (base, exponent) in factors {
                    if !exponent.is_integer() || exponent.is_negative() {
                        self.bump(base);
                    } else if (self.gap && exponent != Rational::ONE || is_sharp(exponent))
                        && self.moves(base)
                    {
                        // f(u)ⁿ is √n times as narrow as f(u).
                        let power = self.graph.number(exponent);
                        self.sharpness = self.graph.power(power, Rational::HALF);
                        match self.graph.node(base) {
                            Node::Call(..) => self.visit(base),
                            Node::Sum(_) => self.peaks(base),
                            _ => {}
                        }
                        self.sharpness = Graph::ONE;
                    }
                }
            }
            _ => {}
        }
    }

    /// Adds a feature for sine and cosine. Its width is that of a bell with the curvature of a
    /// crest, 1 − ω²t²/2.
    fn oscillation(&mut self, angle: Id) {
        if self.gap {
            self.swings(angle);
        }
        let Some(polynomial) = self.polynomial(angle) else { return };
        if self.gap && 1 < polynomial.degree {
            // The frequency is that at the start of a step, and that within a step from its zero.
            let frequency = derivative(&mut self.graph, polynomial.smooth, Symbol::Time);
            let half = self.graph.product(Rational::HALF, &[(frequency, Rational::whole(2))]);
            let own = self.root(half, 2);
            self.find(own, None);
            let near = self.root(polynomial.leading, polynomial.degree);
            let near = self.graph.scale(Rational::whole(polynomial.degree), near);
            return self.find(near, None);
        }
        let rate = if polynomial.degree == 1 {
            let half =
                self.graph.product(Rational::HALF, &[(polynomial.leading, Rational::whole(2))]);
            self.root(half, 2)
        } else {
            self.root(polynomial.leading, polynomial.degree)
        };
        self.find(rate, None);
    }

    /// Adds features for functions that change when their argument is of the order of one.
    fn bell(&mut self, argument: Id) {
        self.swings(argument);
        let Some(polynomial) = self.polynomial(argument) else { return };
        let rate = self.root(polynomial.leading, polynomial.degree);
        if !polynomial.whole || polynomial.middles.is_empty() {
            return self.find(rate, None);
        }
        for middle in polynomial.middles {
            self.find(rate, Some(middle));
        }
    }

    /// Adds features for terms k sinⁿ ωt in the argument of such a function. Near a zero of the
    /// sine, a term is approximately k (ωt)ⁿ.
    fn swings(&mut self, argument: Id) {
        let argument = if self.gap { self.spread(argument) } else { argument };
        for (term, coefficient) in self.terms(argument) {
            let Some(Swing { factor, power, speed }) = self.swing(term, coefficient) else {
                continue;
            };
            let steepness = self.root(factor, power);
            let rate = self.graph.mul(steepness, speed);
            self.find(rate, None);
        }
    }

    /// Returns a term as k sinⁿ ωt, if it is one.
    fn swing(&mut self, term: Id, coefficient: Rational) -> Option<Swing> {
        let mut factors = self.graph.factors(term);
        let own = match self.graph.node(term) {
            Node::Product(own, _) => *own,
            _ => Rational::ONE,
        };
        let place = factors.iter().position(|&(base, _)| self.moves(base))?;
        let (swing, exponent) = factors.remove(place);
        let Node::Call(Function::Sin | Function::Cos, angle) = *self.graph.node(swing) else {
            return None;
        };
        if factors.iter().any(|&(base, _)| self.moves(base) || self.has_state(base)) {
            return None;
        }
        let power = exponent.integer().filter(|power| (1..=HIGHEST).contains(power))?;
        let polynomial = self.polynomial(angle).filter(|polynomial| polynomial.degree == 1)?;
        let numbers = [own, coefficient].map(|number| self.graph.number(number));
        factors.extend(numbers.map(|number| (number, Rational::ONE)));
        let factor = self.graph.product(Rational::ONE, &factors);
        let speed = self.root(polynomial.leading, 1);
        Some(Swing { factor, power, speed })
    }

    /// Adds features for the peaks of a power of u = c + k sinⁿ ωt, where u is c or c ± k.
    fn peaks(&mut self, argument: Id) {
        let argument = self.spread(argument);
        let terms = self.terms(argument);
        for (index, &(term, coefficient)) in terms.iter().enumerate() {
            let Some(Swing { factor, power, speed }) = self.swing(term, coefficient) else {
                continue;
            };
            let mut others = terms.clone();
            others.remove(index);
            let rest = self.graph.sum(&others);
            if self.moves(rest) || self.has_state(rest) {
                continue;
            }
            let [above, below] = [self.graph.add(rest, factor), self.graph.sub(rest, factor)];
            let bend = Rational::new(power.into(), 2).unwrap_or(Rational::ONE);
            let bend = self.graph.scale(bend, factor);
            let crest = (above, bend, 2);
            let other = if power % 2 == 0 { (rest, factor, power) } else { (below, bend, 2) };
            for (value, leading, degree) in [crest, other] {
                if value != Graph::ZERO {
                    let ratio = self.graph.div(leading, value);
                    let steepness = self.root(ratio, degree);
                    let rate = self.graph.mul(steepness, speed);
                    self.find(rate, None);
                }
            }
        }
    }

    /// Returns c·(a + b) with constant c as c·a + c·b.
    fn spread(&mut self, id: Id) -> Id {
        let Node::Product(own, factors) = self.graph.node(id).clone() else { return id };
        let (moving, fixed): (Vec<_>, Vec<_>) =
            factors.into_iter().partition(|&(base, _)| self.moves(base));
        let &[(base, Rational::ONE)] = moving.as_slice() else { return id };
        let terms: Vec<(Id, Rational)> = self
            .terms(base)
            .into_iter()
            .map(|(term, coefficient)| {
                let factors = [&fixed[..], &[(term, Rational::ONE)]].concat();
                (self.graph.product(own, &factors), coefficient)
            })
            .collect();
        self.graph.sum(&terms)
    }

    /// Adds features for functions without a width, such as the reciprocal. Their width is that of
    /// u if u is not zero at its centre.
    fn bump(&mut self, argument: Id) {
        if self.gap {
            self.peaks(argument);
        }
        let Some(polynomial) = self.polynomial(argument) else { return };
        if !polynomial.whole || polynomial.degree == 1 && !polynomial.cornered {
            return;
        }
        for middle in polynomial.middles {
            let value = self.at(polynomial.smooth, middle);
            if value == Graph::ZERO || self.has_state(value) || self.moves(value) {
                continue;
            }
            let ratio = self.graph.div(polynomial.leading, value);
            let rate = self.root(ratio, polynomial.degree);
            self.find(rate, Some(middle));
        }
    }

    /// Adds a corner at u = 0, or a feature for the pulse between two zeros.
    fn corner(&mut self, argument: Id) {
        self.bump(argument);
        if let Some(polynomial) = self.polynomial(argument)
            && polynomial.degree == 1
            && polynomial.whole
            && !polynomial.cornered
        {
            let zeros = polynomial
                .middles
                .into_iter()
                .filter(|&zero| !self.graph.dependencies(zero).any(BESIDE_TIME));
            self.corners.extend(zeros);
        }
    }

    /// Adds a feature for each pair of corners, because two corners may be the ends of a pulse.
    fn pairs(&mut self) {
        let mut corners: Vec<Id> = self.corners.iter().copied().collect();
        let pairs: Vec<(Id, Id)> = if corners.len() <= CORNERS {
            let others = |(index, &first): (usize, &Id)| {
                corners[index + 1..].iter().map(move |&second| (first, second))
            };
            corners.iter().enumerate().flat_map(others).collect()
        } else {
            // Only corners at numeric times can be sorted.
            let time = |id: Id| match *self.graph.node(id) {
                Node::Number(time) => time.numerator() as f64 / time.denominator() as f64,
                _ => f64::NAN,
            };
            corners.retain(|&corner| !time(corner).is_nan());
            corners.sort_by(|&a, &b| time(a).total_cmp(&time(b)));
            corners.windows(2).map(|pair| (pair[0], pair[1])).collect()
        };
        for (first, second) in pairs {
            let (length, sum) = (self.graph.sub(second, first), self.graph.add(first, second));
            let rate = self.graph.product(Rational::whole(2), &[(length, Rational::MINUS_ONE)]);
            let (rate, middle) = (self.root(rate, 1), self.graph.scale(Rational::HALF, sum));
            self.find(rate, Some(middle));
        }
    }

    fn find(&mut self, rate: Id, middle: Option<Id>) {
        let since = match middle.filter(|&middle| !self.has_state(middle) && !self.moves(middle)) {
            Some(middle) => {
                let time = self.graph.symbol(Symbol::Time);
                self.graph.sub(time, middle)
            }
            None => Graph::ZERO,
        };
        let rate = self.graph.mul(rate, self.sharpness);
        if rate != Graph::ZERO {
            self.found.insert(Feature { rate, since });
        }
    }

    /// Returns |x|^(1/d).
    fn root(&mut self, x: Id, degree: i64) -> Id {
        let magnitude = self.graph.call(Function::Abs, x);
        match Rational::new(1, degree.into()) {
            Some(exponent) => self.graph.power(magnitude, exponent),
            None => magnitude,
        }
    }

    /// Returns the terms of a sum with their coefficients.
    fn terms(&self, id: Id) -> Vec<(Id, Rational)> {
        match self.graph.node(id) {
            Node::Sum(terms) => terms.clone(),
            Node::Atom(inner) => self.terms(*inner),
            _ => vec![(id, Rational::ONE)],
        }
    }

    /// Evaluates an expression at a time.
    fn at(&mut self, id: Id, time: Id) -> Id {
        substitute(&mut self.graph, id, |symbol| (symbol == Symbol::Time).then_some(time))
    }
}
