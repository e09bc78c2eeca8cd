//! Integrals over bodies: a polynomial of degree two in the point becomes mass, centre and second
//! moments.

use super::context::{Local, Lower};
use super::value::Value;
use crate::algebra::expr::{Dependencies, Graph, Id, Moment, Symbol};
use crate::algebra::number::Rational;
use crate::algebra::velocity_polynomial;
use crate::messages::message;
use crate::model::{Element, Meaning};
use crate::syntax::ast::Expr;
use crate::syntax::name;
use crate::syntax::text::text;
use std::collections::BTreeMap;

/// Expressions, each with its factor in a sum or its power in a product.
type Weighted = Vec<(Id, Rational)>;

impl Lower<'_, '_, '_, '_> {
    /// Returns the body that an expression names.
    pub(super) fn body(&self, expr: &Expr) -> Option<usize> {
        self.model.body(expr, |name| self.local(name).is_some())
    }

    /// Returns `B.mass`, `B.center` or `B.inertia`.
    pub(super) fn property(&mut self, body: usize, name: &str) -> Value {
        let solid = self.model.parameters[body].element == Element::Solid;
        match name {
            "mass" => Value::Scalar(self.mass(body)),
            "center" if solid => Value::Space(self.center(body)),
            "center" => Value::Plane { parts: self.center(body), complex: false },
            "inertia" if solid => {
                let first = self.model.parameters[body].first;
                let mut entry = |moment| self.graph.symbol(Symbol::Moment(first, moment));
                let about = [0, 1, 2].map(|axis| entry(Moment::About(axis)));
                let mixed = [0, 1, 2].map(|pair| entry(Moment::Mixed(pair)));
                let [xx, yy, zz] = about;
                let [xy, xz, yz] = mixed.map(|product| self.graph.negative(product));
                Value::Matrix([xx, yy, zz, xy, xz, yz])
            }
            "inertia" => {
                let first = self.model.parameters[body].first;
                Value::Scalar(self.graph.symbol(Symbol::Moment(first, Moment::Inertia)))
            }
            _ => Value::Bad,
        }
    }

    fn mass(&mut self, body: usize) -> Id {
        self.graph.symbol(Symbol::Parameter(self.model.parameters[body].first))
    }

    /// Returns the centre of a body with `D` dimensions.
    fn center<const D: usize>(&mut self, body: usize) -> [Id; D] {
        let first = self.model.parameters[body].first;
        std::array::from_fn(|k| self.graph.symbol(Symbol::Parameter(first + 1 + k)))
    }

    /// Returns ∫ ρ expr dp over a body.
    pub(super) fn integral(&mut self, point: &str, body: &str, integrand: &Expr) -> Value {
        let Some(&Meaning::Parameter(index)) = self.model.names.get(&name::read(body).base) else {
            return Value::Bad;
        };
        if !self.model.parameters[index].is_body() {
            return Value::Bad;
        }
        let level = self.integrals;
        let component = |k: usize| self.graph.symbol(Symbol::Point(level, k));
        let solid = self.model.parameters[index].element == Element::Solid;
        let parts: Vec<Id> = (0..if solid { 3 } else { 2 }).map(component).collect();
        let at = Value::vector(&parts);
        self.scope.push((name::read(point).base, Local::Value(at)));
        self.integrals += 1;
        let value = self.expr(integrand);
        self.integrals -= 1;
        self.scope.pop();
        let mut wrong = None;
        let result = match self.components(value) {
            Value::Bad | Value::Family(_) | Value::Turned(_) | Value::Rotation(_) => Value::Bad,
            other @ Value::Matrix(_) => {
                self.unfit(integrand, &other, ", which has no integral; write a scalar or a vector")
            }
            Value::Scalar(id) => Value::Scalar(self.moment(index, &parts, id, &mut wrong)),
            Value::Plane { parts: components, complex } => Value::Plane {
                parts: components.map(|id| self.moment(index, &parts, id, &mut wrong)),
                complex,
            },
            Value::Space(components) => {
                Value::Space(components.map(|id| self.moment(index, &parts, id, &mut wrong)))
            }
        };
        match wrong {
            None => result,
            Some(what) => {
                let found = text(integrand);
                let body = self.model.parameters[index].body_kind();
                let message = message!(
                    "`{found}` is {what} in `{point}`, and {body} knows its moments up to the \
                     second; write a polynomial of degree two or less"
                );
                self.wrong(integrand, message)
            }
        }
    }

    /// Returns the integral of a scalar, and in `wrong` what the scalar is if it has none.
    fn moment(&mut self, body: usize, point: &[Id], id: Id, wrong: &mut Option<&str>) -> Id {
        let Some(polynomial) = velocity_polynomial::polynomial(self.graph, id, Dependencies::POINT)
        else {
            *wrong = Some("no polynomial");
            return Graph::ZERO;
        };
        let mut terms = Vec::with_capacity(polynomial.len());
        for (monomial, coefficients) in polynomial {
            let mut powers = [0; 3];
            for (own, at) in powers.iter_mut().zip(point) {
                let found = monomial.iter().find(|(base, _)| base == at);
                *own = found.map_or(0, |&(_, power)| power);
            }
            if 2 < powers.iter().sum::<i64>() {
                *wrong = Some("of higher degree than two");
                return Graph::ZERO;
            }
            // Points of enclosing integrals are constants here.
            let outside: Weighted = monomial
                .iter()
                .filter(|(base, _)| !point.contains(base))
                .map(|&(base, power)| (base, Rational::whole(power)))
                .collect();
            terms.push(Term { powers, outside, coefficients });
        }
        if self.model.parameters[body].element == Element::Solid {
            self.of_solid(body, terms)
        } else {
            self.of_body(body, terms)
        }
    }

    /// Returns the integral of a polynomial over a body in the plane.
    fn of_body(&mut self, body: usize, terms: Vec<Term>) -> Id {
        let (mass, center) = (self.mass(body), self.center::<2>(body));
        let first = self.model.parameters[body].first;
        let [inertia, difference, product] = [Moment::Inertia, Moment::Difference, Moment::Product]
            .map(|moment| self.graph.symbol(Symbol::Moment(first, moment)));
        let mut sum = Vec::new();
        for Term { powers, outside, coefficients } in terms {
            let moment = match powers {
                [0, 0, _] => mass,
                [1, 0, _] => self.graph.mul(mass, center[0]),
                [0, 1, _] => self.graph.mul(mass, center[1]),
                [2, 0, _] => {
                    self.graph.sum(&[(inertia, Rational::HALF), (difference, Rational::HALF)])
                }
                [0, 2, _] => self
                    .graph
                    .sum(&[(inertia, Rational::HALF), (difference, Rational::HALF.negative())]),
                _ => product,
            };
            let coefficient = velocity_polynomial::simplest(self.graph, &coefficients);
            let outside = self.graph.product(Rational::ONE, &outside);
            let term = self.graph.mul(coefficient, moment);
            sum.push((self.graph.mul(term, outside), Rational::ONE));
        }
        self.graph.sum(&sum)
    }

    /// Returns the integral of a polynomial over a solid.
    ///
    /// The squares are collected by moments of inertia, with which energies of rotations are short:
    /// S_xx is half of I_yy + I_zz − I_xx.
    fn of_solid(&mut self, body: usize, terms: Vec<Term>) -> Id {
        let (mass, center) = (self.mass(body), self.center::<3>(body));
        let first = self.model.parameters[body].first;
        let mut moment = |moment: Moment| self.graph.symbol(Symbol::Moment(first, moment));
        let about = [0, 1, 2].map(|axis| moment(Moment::About(axis)));
        let mixed = [0, 1, 2].map(|pair| moment(Moment::Mixed(pair)));
        let firsts = center.map(|part| self.graph.mul(mass, part));
        // The coefficients of each moment, apart for the points of each enclosing integral.
        let mut sums: BTreeMap<(Weighted, Id), Weighted> = BTreeMap::new();
        for Term { powers, outside, coefficients } in terms {
            let mut add = |moment: Id, factor: Rational| {
                let sum = sums.entry((outside.clone(), moment)).or_default();
                for &(id, own) in &coefficients {
                    sum.push(match own.mul(factor) {
                        Some(own) => (id, own),
                        None => (self.graph.scale(factor, id), own),
                    });
                }
            };
            let square = powers.iter().position(|&power| power == 2);
            let linear: Vec<usize> = (0..3).filter(|&k| powers[k] == 1).collect();
            match (square, &linear[..]) {
                (Some(own), _) => {
                    for axis in 0..3 {
                        let half = Rational::HALF;
                        add(about[axis], if axis == own { half.negative() } else { half });
                    }
                }
                (None, &[axis]) => add(firsts[axis], Rational::ONE),
                (None, &[i, k]) => {
                    let pair = Moment::PAIRS.iter().position(|&pair| pair == [i, k]);
                    add(mixed[pair.unwrap_or(0)], Rational::ONE);
                }
                (None, _) => add(mass, Rational::ONE),
            }
        }
        let mut sum = Vec::with_capacity(sums.len());
        for ((outside, moment), coefficients) in sums {
            let coefficient = velocity_polynomial::simplest(self.graph, &coefficients);
            let outside = self.graph.product(Rational::ONE, &outside);
            let term = self.graph.mul(coefficient, moment);
            sum.push((self.graph.mul(term, outside), Rational::ONE));
        }
        self.graph.sum(&sum)
    }
}

/// A term of a polynomial in the components of a point.
struct Term {
    /// The powers of the components.
    powers: [i64; 3],
    /// The points of enclosing integrals.
    outside: Weighted,
    coefficients: Weighted,
}
