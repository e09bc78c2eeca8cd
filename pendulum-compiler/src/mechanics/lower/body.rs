//! Integrals over bodies: a polynomial of degree two in the point becomes mass, centre and second
//! moments.

use super::context::{Local, Lower};
use super::value::Value;
use crate::algebra::expr::{Dependencies, Graph, Id, Moment, Symbol};
use crate::algebra::number::Rational;
use crate::algebra::velocity_polynomial;
use crate::messages::message;
use crate::model::Meaning;
use crate::syntax::ast::{Expr, ExprKind};
use crate::syntax::name::{self, Name};
use crate::syntax::text::text;

impl Lower<'_, '_, '_, '_> {
    /// Returns the body that an expression names.
    pub(super) fn body(&self, expr: &Expr) -> Option<usize> {
        let ExprKind::Name(ident) = &expr.kind else { return None };
        let Name { base, dots: 0 } = name::read(&ident.to_string()) else { return None };
        if self.local(&base).is_some() {
            return None;
        }
        match self.model.names.get(&base) {
            Some(&Meaning::Parameter(index)) if self.model.parameters[index].is_body() => {
                Some(index)
            }
            _ => None,
        }
    }

    /// Returns `B.mass`, `B.center` or `B.inertia`.
    pub(super) fn property(&mut self, body: usize, name: &str) -> Value {
        match name {
            "mass" => Value::Scalar(self.mass(body)),
            "center" => Value::Plane { parts: self.center(body), complex: false },
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

    fn center(&mut self, body: usize) -> [Id; 2] {
        let first = self.model.parameters[body].first;
        [1, 2].map(|offset| self.graph.symbol(Symbol::Parameter(first + offset)))
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
        let parts = [0, 1].map(|component| self.graph.symbol(Symbol::Point(level, component)));
        self.scope
            .push((name::read(point).base, Local::Value(Value::Plane { parts, complex: false })));
        self.integrals += 1;
        let value = self.expr(integrand);
        self.integrals -= 1;
        self.scope.pop();
        let mut wrong = None;
        let result = match self.components(value) {
            Value::Bad | Value::Family(_) | Value::Turned(_) | Value::Rotation(_) => Value::Bad,
            Value::Scalar(id) => Value::Scalar(self.moment(index, parts, id, &mut wrong)),
            Value::Plane { parts: components, complex } => Value::Plane {
                parts: components.map(|id| self.moment(index, parts, id, &mut wrong)),
                complex,
            },
            Value::Space(components) => {
                Value::Space(components.map(|id| self.moment(index, parts, id, &mut wrong)))
            }
        };
        match wrong {
            None => result,
            Some(what) => {
                let found = text(integrand);
                let message = message!(
                    "`{found}` is {what} in `{point}`, and a body knows its moments up to the \
                     second; write a polynomial of degree two or less"
                );
                self.wrong(integrand, message)
            }
        }
    }

    /// Returns the integral of a scalar, and in `wrong` what the scalar is if it has none.
    fn moment(&mut self, body: usize, point: [Id; 2], id: Id, wrong: &mut Option<&str>) -> Id {
        let Some(polynomial) = velocity_polynomial::polynomial(self.graph, id, Dependencies::POINT)
        else {
            *wrong = Some("no polynomial");
            return Graph::ZERO;
        };
        let mass = self.mass(body);
        let center = self.center(body);
        let first = self.model.parameters[body].first;
        let [inertia, difference, product] = [Moment::Inertia, Moment::Difference, Moment::Product]
            .map(|moment| self.graph.symbol(Symbol::Moment(first, moment)));
        let mut terms = Vec::new();
        for (monomial, coefficients) in polynomial {
            // Points of enclosing integrals are constants here.
            let power = |component: usize| {
                monomial
                    .iter()
                    .find(|(base, _)| *base == point[component])
                    .map_or(0, |&(_, power)| power)
            };
            let outside: Vec<(Id, Rational)> = monomial
                .iter()
                .filter(|(base, _)| !point.contains(base))
                .map(|&(base, power)| (base, Rational::whole(power)))
                .collect();
            let moment = match (power(0), power(1)) {
                (0, 0) => mass,
                (1, 0) => self.graph.mul(mass, center[0]),
                (0, 1) => self.graph.mul(mass, center[1]),
                (2, 0) => {
                    self.graph.sum(&[(inertia, Rational::HALF), (difference, Rational::HALF)])
                }
                (0, 2) => self
                    .graph
                    .sum(&[(inertia, Rational::HALF), (difference, Rational::HALF.negative())]),
                (1, 1) => product,
                _ => {
                    *wrong = Some("of higher degree than two");
                    return Graph::ZERO;
                }
            };
            let coefficient = velocity_polynomial::simplest(self.graph, &coefficients);
            let outside = self.graph.product(Rational::ONE, &outside);
            let term = self.graph.mul(coefficient, moment);
            terms.push((self.graph.mul(term, outside), Rational::ONE));
        }
        self.graph.sum(&terms)
    }
}
