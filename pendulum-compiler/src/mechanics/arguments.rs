//! Arguments of functions that change within a short range of them.
//!
//! A method samples accelerations at a few times in a step. tanh(v/ε) with a small ε, exp(−(x/w)²)
//! or max(0, θ − θmax) may change and change back between two of these times, and the error
//! estimate does not contain what no sample contains. The integrators therefore follow the
//! arguments along each step. A switch is the argument of `sign`, `abs`, `min` or `max`: a step
//! ends where it changes its sign, and where the argument of a table passes a knot. A layer is the
//! argument z of a function that changes where |z| is of the order of one and is flat elsewhere.
//!
//! Functions of time whose width `clock` determines bound the steps in advance and are no layers.

use crate::algebra::diff::derivative;
use crate::algebra::expr::{Dependencies, Graph, Id, Node, Symbol};
use crate::algebra::functions::{Function, Kinks, Scale};
use crate::algebra::number::Rational;
use crate::algebra::order;
use std::collections::{BTreeMap, BTreeSet};

/// The arguments in some expressions, in a separate graph.
pub(crate) struct Arguments {
    pub(crate) graph: Graph,
    pub(crate) switches: Vec<Id>,
    pub(crate) layers: Vec<Id>,
}

/// Returns the arguments in `roots`, where the intervals of each table have some `digits`.
pub(crate) fn arguments(graph: &Graph, roots: &[Id], digits: &BTreeMap<u8, u8>) -> Arguments {
    let mut roots = roots.to_vec();
    let graph = order::canonicalize(graph, &mut roots.iter_mut().collect::<Vec<_>>());
    let (switches, layers) = (BTreeSet::new(), BTreeSet::new());
    let mut search = Search { graph, digits, switches, layers };
    let nodes = search.graph.reachable(&roots);
    // The slope of ln(1 + exp u) is a logistic function, too, but the force of a contact that is
    // softened in this way grows on one side, so that steps do not miss it.
    let softened: BTreeSet<Id> = nodes
        .iter()
        .filter_map(|&id| match search.graph.node(id) {
            Node::Call(Function::Ln, argument) => Some(search.open(*argument)),
            _ => None,
        })
        .collect();
    for id in nodes {
        if search.varies(id) {
            search.visit(id, &softened);
        }
    }
    let Search { graph, switches, layers, .. } = search;
    let [switches, layers] = [switches, layers].map(|ids| ids.into_iter().collect());
    Arguments { graph, switches, layers }
}

/// Returns `true` for the exponent of a power of a sine that is flat between its peaks: one of sin⁸
/// u is half as wide as one of sin² u.
pub(super) fn is_sharp(exponent: Rational) -> bool {
    exponent.integer().is_some_and(|whole| 8 <= whole)
}

/// Returns `true` for an exponent of a power that does not change its sign.
fn is_even(exponent: Rational) -> bool {
    exponent.integer().is_none_or(|whole| whole % 2 == 0)
}

/// Terms with their coefficients, or factors with their exponents.
type Factors = Vec<(Id, Rational)>;

struct Search<'d> {
    graph: Graph,
    digits: &'d BTreeMap<u8, u8>,
    switches: BTreeSet<Id>,
    layers: BTreeSet<Id>,
}

impl Search<'_> {
    fn varies(&self, id: Id) -> bool {
        self.graph.dependencies(id).any(Dependencies::STATE)
    }

    fn visit(&mut self, id: Id, softened: &BTreeSet<Id>) {
        match self.graph.node(id).clone() {
            Node::Call(Function::Table(index, _), argument) => {
                for digit in 0..self.digits[&index] {
                    let knots = self.graph.call(Function::Knots(index, digit), argument);
                    self.switches.insert(knots);
                }
            }
            Node::Call(function, argument) => {
                let row = function.row();
                if row.kinks != Kinks::Smooth {
                    let (_, argument) = self.graph.split(argument);
                    self.switches.insert(argument);
                } else if row.scale == Scale::Bell {
                    // exp u and sinh u change everywhere; exp(−u²) does so near its middle only, as
                    // do exp(−u² v) and exp(−exp u).
                    let grows = matches!(function, Function::Exp | Function::Sinh);
                    if !grows || self.turns(argument) || self.logarithm(argument).is_some() {
                        self.bell(argument);
                    }
                } else if function == Function::Ln {
                    self.bump(argument);
                }
            }
            Node::Max(a, b) => {
                let difference = self.graph.sub(a, b);
                let (_, difference) = self.graph.split(difference);
                self.switches.insert(difference);
            }
            Node::Atan2(y, x) if !self.varies(x) || !self.varies(y) => {
                let (moving, fixed) = if self.varies(x) { (x, y) } else { (y, x) };
                let ratio = self.graph.div(moving, fixed);
                self.bell(ratio);
            }
            Node::Product(_, factors) => {
                for (base, exponent) in factors {
                    if !exponent.is_integer() || exponent.is_negative() {
                        self.bump(base);
                    } else if is_sharp(exponent) {
                        self.peak(base, exponent);
                    }
                    if exponent.is_negative() && !softened.contains(&self.open(base)) {
                        self.logistic(base);
                    }
                }
            }
            _ => {}
        }
    }

    /// Adds the layer of a function f(u) that changes where |u| is of the order of one: ln |u| if u
    /// is an exponential, b if u is ±bᵖ, |u|^½ if u is a sum of squares, otherwise u.
    fn bell(&mut self, argument: Id) {
        let argument = self.open(argument);
        let layer = if let Some((_, layer)) = self.logarithm(argument) {
            layer
        } else if let Some((base, exponent)) = self.power_of(argument) {
            // The width of a known function of time bounds the steps.
            if exponent.is_integer() && self.is_line(base) {
                return;
            }
            base
        } else if self.is_square(argument) || self.touches(argument) {
            self.root_of(argument)
        } else {
            argument
        };
        self.layers.insert(layer);
    }

    /// Adds the layer of a power of c + u², with a constant c: the power changes where u² is of
    /// the order of c. So does a power of c + u² v.
    ///
    /// Without a constant, the width of a power is its distance from the pole, and steps follow it.
    fn bump(&mut self, base: Id) {
        let base = self.open(base);
        let Node::Sum(terms) = self.graph.node(base).clone() else { return };
        let (moving, fixed) = self.parted(terms);
        if moving.is_empty() || fixed.is_empty() {
            return;
        }
        let (moving, fixed) = (self.graph.sum(&moving), self.graph.sum(&fixed));
        let square = self.is_square(moving) && self.is_polynomial(moving);
        if fixed == Graph::ZERO || !square && !self.is_bent(moving) {
            return;
        }
        let ratio = self.graph.div(moving, fixed);
        let layer = match self.power_of(ratio) {
            Some((base, _)) if square && self.is_line(base) => return,
            Some((base, _)) if square => base,
            _ if square || self.touches(ratio) => self.root_of(ratio),
            _ => ratio,
        };
        self.layers.insert(layer);
    }

    /// Adds the layer of a high power of sines, which is flat except where its base is near ±1.
    fn peak(&mut self, base: Id, exponent: Rational) {
        let swings =
            |id: &Id| matches!(self.graph.node(*id), Node::Call(Function::Sin | Function::Cos, _));
        if self.goes_with_time(base) || !self.graph.reachable(&[base]).iter().any(swings) {
            return;
        }
        let size = self.graph.call(Function::Abs, base);
        let logarithm = self.graph.call(Function::Ln, size);
        let scaled = self.graph.scale(exponent, logarithm);
        let layer = self.root_of(scaled);
        self.layers.insert(layer);
    }

    /// Adds the layer of 1/(c + a exp u), with constants a and c, which changes where a exp u is of
    /// the order of c.
    fn logistic(&mut self, base: Id) {
        let base = self.open(base);
        let Node::Sum(terms) = self.graph.node(base).clone() else { return };
        let (moving, fixed) = self.parted(terms);
        let fixed = self.graph.sum(&fixed);
        if fixed == Graph::ZERO {
            return;
        }
        let moving = self.graph.sum(&moving);
        let ratio = self.graph.div(moving, fixed);
        if let Some((u, layer)) = self.logarithm(ratio)
            && !self.is_line(u)
        {
            self.layers.insert(layer);
        }
    }

    /// Returns u and u + ln |a| for an argument a exp u with a constant a.
    fn logarithm(&mut self, argument: Id) -> Option<(Id, Id)> {
        let argument = self.open(argument);
        let (factor, power) = self.only_factor(argument)?;
        let &Node::Call(Function::Exp, u) = self.graph.node(self.open(factor)) else { return None };
        let size = self.constant(argument);
        let shift = self.graph.call(Function::Ln, size);
        let scaled = self.graph.scale(power, u);
        Some((u, self.graph.add(scaled, shift)))
    }

    /// Returns `true` if exp u may rise and fall as u goes on: u is an even or fractional power, or
    /// depends on more than time and has a term that is one, or a product or a sine.
    fn turns(&mut self, argument: Id) -> bool {
        let argument = self.open(argument);
        self.is_square(argument)
            || self.power_of(argument).is_some_and(|(_, power)| is_even(power))
            || !self.goes_with_time(argument) && self.has_turning_term(argument)
    }

    fn has_turning_term(&self, argument: Id) -> bool {
        let terms = self.terms(argument).into_iter();
        terms.map(|term| self.parted(self.graph.factors(term)).0).any(|varying| {
            1 < varying.len()
                || varying.iter().any(|&(base, exponent)| match self.graph.node(self.open(base)) {
                    _ if is_even(exponent) => true,
                    Node::Sum(_) => self.has_turning_term(base),
                    Node::Call(function, _) => matches!(function, Function::Sin | Function::Cos),
                    _ => false,
                })
        })
    }

    /// Returns `true` for a product with an even or fractional power: it comes to zero without
    /// changing its sign.
    fn touches(&self, id: Id) -> bool {
        let varying = self.parted(self.graph.factors(id)).0;
        varying.iter().any(|&(_, exponent)| is_even(exponent) && !exponent.is_negative())
    }

    /// Returns `true` if a term has an even power of a polynomial.
    fn is_bent(&self, id: Id) -> bool {
        let mut terms = self.terms(id).into_iter();
        terms.any(|term| {
            let even = |&(base, exponent): &(Id, Rational)| {
                !exponent.is_negative() && is_even(exponent) && self.is_polynomial(base)
            };
            self.parted(self.graph.factors(term)).0.iter().any(even)
        })
    }

    fn terms(&self, id: Id) -> Vec<Id> {
        match self.graph.node(self.open(id)) {
            Node::Sum(terms) => terms.iter().map(|&(term, _)| term).collect(),
            _ => vec![self.open(id)],
        }
    }

    fn open(&self, mut id: Id) -> Id {
        while let Node::Atom(inner) = self.graph.node(id) {
            id = *inner;
        }
        id
    }

    /// Returns b and p with u = ±bᵖ, if a single factor of u varies.
    fn power_of(&mut self, u: Id) -> Option<(Id, Rational)> {
        let (base, exponent) = self.only_factor(u)?;
        let inverse = exponent.reciprocal().filter(|inverse| !inverse.is_negative())?;
        if exponent == Rational::ONE && self.is_square(base) {
            return None;
        }
        if exponent == Rational::ONE {
            return Some((u, exponent));
        }
        let size = self.constant(u);
        let scale = self.graph.power(size, inverse);
        Some((self.graph.mul(scale, base), exponent))
    }

    /// Returns the only factor of a product that varies, with its exponent.
    fn only_factor(&self, u: Id) -> Option<(Id, Rational)> {
        match self.parted(self.graph.factors(u)).0[..] {
            [only] => Some(only),
            _ => None,
        }
    }

    /// Returns the magnitude of the factors that do not vary.
    fn constant(&mut self, u: Id) -> Id {
        let own = match self.graph.node(u) {
            Node::Product(own, _) => *own,
            _ => Rational::ONE,
        };
        let (_, fixed) = self.parted(self.graph.factors(u));
        let product = self.graph.product(own, &fixed);
        self.graph.call(Function::Abs, product)
    }

    /// Parts terms or factors into those that vary and the others.
    fn parted(&self, all: Factors) -> (Factors, Factors) {
        all.into_iter().partition(|&(id, _)| self.varies(id))
    }

    fn root_of(&mut self, u: Id) -> Id {
        let size = self.graph.call(Function::Abs, u);
        self.graph.sqrt(size)
    }

    /// Returns `true` for a linear function of time.
    fn is_line(&mut self, id: Id) -> bool {
        let beside = Dependencies::STATE;
        let slope = derivative(&mut self.graph, id, Symbol::Time);
        self.goes_with_time(id) && !self.graph.dependencies(slope).any(beside)
    }

    /// Returns `true` if an expression varies with the time only.
    fn goes_with_time(&self, id: Id) -> bool {
        self.graph.symbols(&[id]).into_iter().all(|symbol| {
            matches!(symbol, Symbol::Time | Symbol::Parameter(_) | Symbol::Moment(..))
        })
    }

    /// Returns `true` if all varying factors of all varying terms have even exponents.
    fn is_square(&self, id: Id) -> bool {
        let id = self.open(id);
        self.terms(id).into_iter().filter(|&term| self.varies(term)).all(|term| {
            match self.graph.node(term) {
                Node::Product(_, factors) => factors.iter().all(|&(factor, exponent)| {
                    !self.varies(factor)
                        || exponent.integer().is_some_and(|exponent| exponent % 2 == 0)
                        || exponent == Rational::ONE && self.is_square_sum(factor)
                }),
                _ => false,
            }
        })
    }

    fn is_square_sum(&self, id: Id) -> bool {
        let id = self.open(id);
        matches!(self.graph.node(id), Node::Sum(_)) && self.is_square(id)
    }

    /// Returns `true` for a polynomial in the state, the time and the inputs. Sines and cosines in
    /// mass matrices have no narrow range.
    fn is_polynomial(&self, id: Id) -> bool {
        self.graph.reachable(&[id]).into_iter().filter(|&node| self.varies(node)).all(|node| {
            match self.graph.node(node) {
                Node::Call(..) | Node::Atan2(..) | Node::Max(..) => false,
                Node::Product(_, factors) => factors.iter().all(|&(factor, exponent)| {
                    !self.varies(factor) || exponent.is_integer() && !exponent.is_negative()
                }),
                _ => true,
            }
        })
    }
}
