//! Leaves: numbers, parameters, coordinates, velocities and driven inputs as pure numbers.

use super::{Generator, May, measure};
use crate::tree::{Expr, Index, Kind, Operation, Property, Type, power, product, quotient};

/// The fractions among the leaves.
const NUMBERS: [[i64; 2]; 10] =
    [[1, 1], [2, 1], [3, 1], [1, 2], [1, 4], [3, 4], [2, 3], [-1, 3], [7, 5], [-2, 1]];

impl Generator {
    pub(crate) fn leaf(&mut self, may: May) -> Expr {
        if let Some(index) =
            (!may.arguments.is_empty()).then(|| self.random.below(may.arguments.len()))
            && self.random.once_in(2)
        {
            return match may.arguments[index] {
                Type::Scalar => Expr::Argument(index),
                _ => Expr::Component(Box::new(Expr::Argument(index)), self.random.below(2)),
            };
        }
        match self.random.below(12) {
            0 => {
                let [top, bottom] = self.random.of(&NUMBERS);
                Expr::Number(top, bottom)
            }
            1..=3 => self.parameter(may),
            4 if may.velocities => self.velocity(may),
            5 if !self.system.inputs.is_empty() => self.input(may),
            6 if self.random.once_in(2) => product(Expr::Time, self.frequency()),
            7 if may.bound.is_some() && self.random.once_in(2) => Expr::Bound(0),
            8 if !self.system.units && self.random.once_in(2) => Expr::Time,
            _ => self.coordinate(may),
        }
    }

    /// Returns an index below `count`.
    pub(crate) fn index(&mut self, count: usize, may: May) -> Index {
        match may.bound {
            Some(bound) if bound <= count && self.random.below(4) != 0 => {
                if self.random.once_in(4) { Index::Reversed(0, count) } else { Index::Bound(0) }
            }
            _ => Index::Number(self.random.below(count)),
        }
    }

    pub(crate) fn coordinate(&mut self, may: May) -> Expr {
        let coordinate = self.random.below(self.system.coordinates.len());
        let member =
            self.system.coordinates[coordinate].length.map(|length| self.index(length, may));
        Expr::Coordinate(coordinate, member)
    }

    pub(crate) fn velocity(&mut self, may: May) -> Expr {
        let coordinate = self.random.below(self.system.coordinates.len());
        let member =
            self.system.coordinates[coordinate].length.map(|length| self.index(length, may));
        self.velocity_of(coordinate, member)
    }

    pub(crate) fn velocity_of(&mut self, coordinate: usize, member: Option<Index>) -> Expr {
        let velocity = Expr::Velocity(coordinate, member, self.random.below(3));
        self.rate(velocity)
    }

    fn parameter(&mut self, may: May) -> Expr {
        let index = self.random.below(self.system.parameters.len());
        match self.system.parameters[index].kind {
            Kind::Scalar => Expr::Parameter(index),
            Kind::Rate if self.system.units => product(self.frequency(), Expr::Time),
            Kind::Rate => Expr::Parameter(index),
            Kind::Vector(count) => match self.random.below(3) {
                0 => Expr::Member(index, self.index(count, may)),
                1 => Operation::Height.of([Expr::Parameter(index)]),
                _ => Expr::Component(Box::new(Expr::Parameter(index)), self.random.below(count)),
            },
            Kind::Family(count) => Expr::Member(index, self.index(count, may)),
            Kind::Body => {
                let property = self.random.of(&[Property::Mass, Property::Inertia]);
                self.property(index, property)
            }
            Kind::Mass | Kind::Length => self.coordinate(may),
        }
    }

    pub(crate) fn positive_parameter(&mut self) -> Expr {
        let scalars: Vec<usize> = (0..self.system.parameters.len())
            .filter(|&index| self.system.parameters[index].kind == Kind::Scalar)
            .collect();
        Expr::Parameter(self.random.of(&scalars))
    }

    /// Returns a component of a driven input or of its derivatives, as a pure number.
    fn input(&mut self, may: May) -> Expr {
        let index = self.random.below(self.system.inputs.len());
        let order = self.random.below(may.orders + 1);
        let components = self.system.inputs[index].components;
        let own = Expr::Input(index, order);
        let part = if components == 1 {
            own
        } else {
            Expr::Component(Box::new(own), self.random.below(components))
        };
        match order {
            0 => part,
            1 => self.rate(part),
            _ if self.system.units => quotient(part, power(self.frequency(), 2)),
            _ => part,
        }
    }

    /// Returns a property of a body as a pure number.
    pub(crate) fn property(&self, body: usize, property: Property) -> Expr {
        let own = Expr::Property(body, property);
        match property {
            Property::Mass => quotient(own, self.measure(Kind::Mass)),
            Property::Center => quotient(own, self.measure(Kind::Length)),
            Property::Inertia => quotient(
                own,
                product(self.measure(Kind::Mass), power(self.measure(Kind::Length), 2)),
            ),
        }
    }

    pub(crate) fn frequency(&self) -> Expr {
        self.measure(Kind::Rate)
    }

    pub(crate) fn measure(&self, kind: Kind) -> Expr {
        measure(&self.system, kind)
    }

    /// Returns a rate as a pure number if units are checked.
    pub(crate) fn rate(&mut self, rate: Expr) -> Expr {
        if self.system.units || self.random.once_in(4) {
            quotient(rate, self.frequency())
        } else {
            rate
        }
    }
}
