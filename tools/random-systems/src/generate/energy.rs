//! Kinetic and potential energies, friction and forces.

use super::{Generator, Manner, May};
use crate::nilpotent::Function;
use crate::tree::{
    Expr, Force, Index, Operation, Type, call, number, power, product, quotient, sum,
};

impl Generator {
    pub(crate) fn energies(&mut self) {
        let lets = self.system.lets.len();
        let still = May { velocities: false, orders: 1, lets, bound: None, arguments: &[] };
        let moving = May { velocities: true, ..still };
        self.squares(still);
        for _ in 0..self.random.below(3) {
            let term = self.kinetic_term(still, moving);
            self.system.kinetic.push(term);
        }
        for _ in 0..self.random.below(3) {
            let term = self.scalar(3, still);
            self.system.potential.push(term);
        }
        self.system.joined = self.random.once_in(4);
        if self.random.once_in(3) {
            let friction = self.friction(moving);
            self.system.dissipation.push(friction);
        }
        for coordinate in 0..self.system.coordinates.len() {
            if !self.random.once_in(4) {
                continue;
            }
            let length = self.system.coordinates[coordinate].length;
            let each = length.is_some() && self.random.once_in(2);
            let member = if each { None } else { length.map(|length| self.random.below(length)) };
            let bound = if each { length } else { None };
            let expr = self.scalar(3, May { bound, orders: 2, ..moving });
            self.system.forces.push(Force { coordinate, member, expr });
        }
    }

    /// Adds a positive square of each velocity.
    fn squares(&mut self, may: May) {
        for coordinate in 0..self.system.coordinates.len() {
            let length = self.system.coordinates[coordinate].length;
            let mass = |generator: &mut Self, may: May| match generator.random.below(4) {
                0 => number(1),
                1 => generator.positive_parameter(),
                2 => sum(number(1), power(generator.bounded(1, may), 2)),
                _ => sum(
                    generator.positive_parameter(),
                    product(number(2), power(generator.bounded(2, may), 2)),
                ),
            };
            if let Some(count) = length
                && self.random.once_in(2)
            {
                let mass = mass(self, May { bound: Some(count), ..may });
                let velocity =
                    self.rate(Expr::Velocity(coordinate, Some(Index::Bound(0)), coordinate % 3));
                let term = product(quotient(mass, number(2)), power(velocity, 2));
                let inclusive = self.random.once_in(3);
                self.system.kinetic.push(Expr::Over(0, count, inclusive, Box::new(term)));
                continue;
            }
            for member in 0..length.unwrap_or(1) {
                let mass = mass(self, may);
                let velocity = self.velocity_of(coordinate, length.map(|_| Index::Number(member)));
                self.system.kinetic.push(product(quotient(mass, number(2)), power(velocity, 2)));
            }
        }
    }

    /// Returns a term for which the mass matrix stays positive.
    fn kinetic_term(&mut self, still: May, moving: May) -> Expr {
        if self.manner == Manner::Wild && self.random.once_in(2) {
            return self.scalar(3, moving);
        }
        match self.random.below(6) {
            // The square of the velocity of a point.
            0..=2 => {
                let position = self.typed(Type::Plane, 3, May { orders: 0, ..still });
                let moved = self.moved(position);
                let velocity = self.rate(Operation::Dot.of([moved]));
                let mass = self.positive_parameter();
                product(quotient(mass, number(2)), power(Operation::Magnitude.of([velocity]), 2))
            }
            // Linear in a velocity.
            3 => {
                let (factor, velocity) = (self.scalar(2, still), self.velocity(still));
                product(factor, velocity)
            }
            // Convex in a velocity.
            4 => {
                let velocity = self.velocity(still);
                match self.random.below(3) {
                    0 => Expr::Power(Box::new(sum(number(2), power(velocity, 2))), 1, 2),
                    1 => quotient(power(velocity, 4), number(20)),
                    _ => call(Function::Cosh, quotient(velocity, number(3))),
                }
            }
            // A mixed term that is small compared with the squares.
            _ => {
                let (a, b) = (self.velocity(still), self.velocity(still));
                let factor = self.bounded(2, still);
                quotient(product(product(factor, a), b), number(9))
            }
        }
    }

    fn friction(&mut self, moving: May) -> Expr {
        let velocity = self.velocity(moving);
        let factor = self.positive_parameter();
        let pure = match self.random.below(4) {
            0 | 1 => product(quotient(factor, number(2)), power(velocity, 2)),
            2 => product(factor, power(Operation::Magnitude.of([velocity]), 3)),
            _ => self.scalar(2, moving),
        };
        // The unit is energy per second.
        if self.system.units { product(pure, self.frequency()) } else { pure }
    }
}
