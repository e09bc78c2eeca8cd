//! Lowering of frictions to scalars.

use super::context::Lower;
use super::row::Row;
use super::value::Value;
use crate::algebra::diff::{derivative, substitute};
use crate::algebra::expr::{Dependencies, Graph, Id, Node, Symbol};
use crate::mechanics::constraint::MOST_LIMITS;
use crate::messages::message;
use crate::messages::shared::derivative_of_control;
use crate::model;
use crate::syntax::ast::{Expr, Slip};
use crate::syntax::text::text;

/// A scalar rate with dry friction, or a component of a rate.
#[derive(Debug)]
pub(crate) struct Friction {
    /// The index of its statement among the frictions.
    pub(crate) statement: usize,
    /// The name with component and index: `grip.x`, `joint[2]`.
    pub(crate) name: String,
    pub(crate) rate: Id,
    /// The number of components of the rate of which this is one.
    pub(crate) components: usize,
    /// The magnitude of the force, and the bound `static`, zero if there is none, without their
    /// `shares`.
    pub(crate) grips: [Id; 2],
    /// The coefficients of both for the reaction of each limit, and for the size of each load.
    pub(crate) shares: [Vec<Id>; 2],
}

impl Friction {
    /// Returns the magnitudes with their shares.
    pub(crate) fn magnitudes(&self) -> impl Iterator<Item = Id> {
        self.grips.into_iter().chain(self.shares.iter().flatten().copied())
    }

    pub(super) fn roots(&mut self) -> impl Iterator<Item = &mut Id> {
        let shares = self.shares.iter_mut().flatten();
        [&mut self.rate].into_iter().chain(&mut self.grips).chain(shares)
    }
}

impl Lower<'_, '_, '_, '_> {
    /// Returns the scalars of all frictions.
    pub(super) fn frictions(&mut self, limits: &[Row]) -> Vec<Friction> {
        let mut rows = Vec::new();
        for (statement, friction) in self.model.frictions.iter().enumerate() {
            let shape =
                self.members(&mut rows, friction.name, friction.index, |lower, rows, name| {
                    lower.friction(rows, statement, name, friction, limits)
                });
            self.frictions.push(shape);
        }
        for share in rows.iter_mut().flat_map(|row| &mut row.shares) {
            share.resize(limits.len() + self.loads.len(), Graph::ZERO);
        }
        rows
    }

    /// Returns the symbol of the size of a constraint's reaction in the magnitude of a friction.
    pub(super) fn load(&mut self, reaction: &Value) -> Option<Id> {
        let parts = reaction.scalars();
        let &[first, ..] = &parts[..] else { return None };
        let Node::Symbol(Symbol::Multiplier(first)) = *self.graph.node(first) else { return None };
        // Outputs contain the reaction itself.
        if self.accelerations {
            return None;
        }
        let own = [first, parts.len()];
        let known = self.loads.iter().position(|load| *load == own);
        let place = known.unwrap_or_else(|| {
            self.loads.push(own);
            self.loads.len() - 1
        });
        Some(self.graph.symbol(Symbol::Contact(MOST_LIMITS + place)))
    }

    /// Adds the scalars of one member. Returns the number of components, or 0 for a scalar.
    fn friction(
        &mut self,
        rows: &mut Vec<Friction>,
        statement: usize,
        name: &str,
        friction: &model::Friction,
        limits: &[Row],
    ) -> usize {
        let Slip { rate, force, bound } = friction.slip;
        self.constrained = true;
        let value = self.expr(rate);
        self.constrained = false;
        let value = self.components(value);
        match &value {
            Value::Bad => return 0,
            Value::Family(members) => {
                self.whole_family(rate, rate, &friction.name.to_string(), members.len());
                return 0;
            }
            Value::Matrix(_) | Value::Rotation(_) => {
                self.unfit(rate, &value, ", and a friction acts on a scalar or a vector of rates");
                return 0;
            }
            _ => {}
        }
        let scalars = value.scalars();
        if !scalars.iter().all(|&scalar| self.within_bounds(rate, scalar))
            || !self.is_rate(rate, &scalars)
        {
            return 0;
        }
        let reaction = if friction.limit.is_some() {
            let Some(limit) = limits.iter().position(|row| row.name == name) else { return 0 };
            self.graph.symbol(Symbol::Contact(limit))
        } else {
            Graph::ONE
        };
        let force = self.grip(force, reaction, limits.len());
        let bound = match bound {
            Some(bound) => self.bound(bound, reaction, limits.len()),
            None => Some((Graph::ZERO, vec![Graph::ZERO; limits.len()])),
        };
        let (Some((force, force_shares)), Some((bound, bound_shares))) = (force, bound) else {
            return 0;
        };
        let vector = !matches!(value, Value::Scalar(_));
        for (&rate, component) in scalars.iter().zip(["x", "y", "z"]) {
            let name = if vector { format!("{name}.{component}") } else { name.to_owned() };
            let (components, grips) = (scalars.len(), [force, bound]);
            let shares = [force_shares.clone(), bound_shares.clone()];
            rows.push(Friction { statement, name, rate, components, grips, shares });
        }
        if vector { scalars.len() } else { 0 }
    }

    /// Returns `true` if rates are affine in the velocities, and reports why not otherwise.
    fn is_rate(&mut self, expr: &Expr, rates: &[Id]) -> bool {
        let (mut moves, mut affine) = (false, true);
        let refusal = self.graph.symbols(rates).into_iter().find_map(|symbol| match symbol {
            Symbol::Control { input, .. } => {
                Some(derivative_of_control(self.model.inputs[input].name))
            }
            Symbol::Input { input, order: 2, .. } => {
                let input = self.model.inputs[input].name;
                Some(message!(
                    "the derivative of this rate contains the third one of `{input}`, and driven \
                     inputs have two; leave its second derivative out"
                ))
            }
            Symbol::Velocity(_) => {
                for &rate in rates {
                    let slope = derivative(self.graph, rate, symbol);
                    moves |= slope != Graph::ZERO;
                    affine &= !self.graph.dependencies(slope).any(Dependencies::VELOCITY);
                }
                None
            }
            _ => None,
        });
        let refusal = refusal.or_else(|| {
            if !self.graph.smooth(rates) {
                return Some(message!(
                    "the rate of a friction needs a derivative, and `abs`, `sign`, `min` and \
                     `max` of what moves have a corner; write it without them, because a friction \
                     acts against either sign"
                ));
            }
            if !affine {
                return Some(message!(
                    "velocities enter the rate of a friction to the first power only; write a \
                     rate that is zero together with this one, as `dot(x)` for its square"
                ));
            }
            (!moves).then(|| {
                message!(
                    "no velocity of a coordinate stands in `{}`, and a friction acts against a \
                     rate; write one, as in `dot(x)`",
                    text(expr)
                )
            })
        });
        let Some(message) = refusal else { return true };
        self.wrong(expr, message);
        false
    }

    /// Returns the magnitude of a force, an expression times a reaction, and its coefficients for
    /// the reactions of the limits. A negative constant is refused.
    fn grip(&mut self, expr: &Expr, reaction: Id, limits: usize) -> Option<(Id, Vec<Id>)> {
        let value = self.scalar(expr)?;
        if self.graph.dependencies(value) == Dependencies::default() && self.constant(value) < 0.0 {
            let message = message!(
                "`{}` is negative, and a friction always acts against its rate; write the \
                 magnitude of its force, from 0",
                text(expr)
            );
            self.wrong(expr, message);
            return None;
        }
        let value = self.graph.mul(value, reaction);
        if !self.within_bounds(expr, value) {
            return None;
        }
        let signed = |symbol: &Symbol| matches!(symbol, Symbol::Multiplier(_));
        if self.graph.symbols(&[value]).iter().any(signed) {
            let message = message!(
                "the reaction of a constraint has either sign; write its size, as in \
                 `μ*abs(reaction(rod))`, or `μ*|reaction(rod)|` for a vector"
            );
            self.wrong(expr, message);
            return None;
        }
        let contact = |symbol| matches!(symbol, Symbol::Contact(_)).then_some(Graph::ZERO);
        let own = substitute(self.graph, value, contact);
        let loads = (0..self.loads.len()).map(|load| MOST_LIMITS + load);
        let shares: Vec<Id> = (0..limits)
            .chain(loads)
            .map(|place| derivative(self.graph, value, Symbol::Contact(place)))
            .collect();
        if MOST_LIMITS < shares.len() {
            let message = message!(
                "frictions contain at most {MOST_LIMITS} reactions of limits and constraints; \
                 leave some out"
            );
            self.wrong(expr, message);
            return None;
        }
        let unfit = Dependencies::MULTIPLIER.or(Dependencies::VELOCITY);
        let nonlinear = shares.iter().any(|&share| self.graph.dependencies(share).any(unfit));
        if nonlinear || self.graph.jumps(value, Dependencies::MULTIPLIER) {
            let message = message!(
                "a reaction enters a friction to the first power only, times what contains no \
                 velocity; write a sum of terms such as `μ*reaction(floor)`"
            );
            self.wrong(expr, message);
            return None;
        }
        Some((own, shares))
    }

    /// Returns the bound on the magnitude at rest in the same form. It is refused if it contains a
    /// velocity.
    fn bound(&mut self, expr: &Expr, reaction: Id, limits: usize) -> Option<(Id, Vec<Id>)> {
        let value = self.scalar(expr)?;
        if self.graph.dependencies(value).any(Dependencies::VELOCITY) {
            let message = message!(
                "`{}` contains a velocity, and `static` is a bound at rest; write in `force` what \
                 depends on velocities",
                text(expr)
            );
            self.wrong(expr, message);
            return None;
        }
        self.grip(expr, reaction, limits)
    }
}
