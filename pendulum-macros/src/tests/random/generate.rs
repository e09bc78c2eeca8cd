//! Random systems: well formed always, and tame if they are to be compared in numbers.

use super::nilpotent::Function;
use super::split_mix::Random;
use super::tree::{
    Coordinate, Expr, Force, Index, Input, Kind, Let, Parameter, Property, Shape, System, Type, number, power, product, quotient,
    sum,
};

/// What a system is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Manner {
    /// Every function has an argument for which it is real and smooth, kinetic energies are positive, nothing is large.
    Tame,
    /// Anything that is well formed.
    Wild,
}

/// What may stand in an expression.
#[derive(Clone, Copy, Debug)]
struct May {
    /// Velocities of coordinates.
    velocities: bool,
    /// The highest derivative of driven inputs: none where the derivative of all is taken, the first in kinetic energies.
    orders: usize,
    /// Definitions with a smaller number than this.
    lets: usize,
    /// Indices that are bound: their number, and the least of the ranges.
    bound: Option<usize>,
    /// The arguments of a function.
    arguments: &'static [Type],
}

const PARAMETERS: [&str; 12] = ["m", "c", "l", "g", "κ", "b", "μ", "s", "R", "a", "ε", "d"];
const COORDINATES: [&str; 8] = ["θ", "φ", "x", "y", "ψ", "r", "q", "h"];
const INPUTS: [&str; 3] = ["u", "z", "f"];
const LETS: [&str; 6] = ["P", "ζ", "G", "H", "W", "Z"];
const FUNCTIONS: [&[Type]; 4] = [&[Type::Scalar], &[Type::Plane], &[Type::Scalar, Type::Plane], &[Type::Scalar, Type::Scalar]];

/// The system of a seed.
pub(crate) fn system(seed: u64, manner: Manner) -> System {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5eed);
    random.next();
    let mut generator = Generator { random, system: System { seed, ..System::default() }, manner };
    generator.declare();
    generator.define();
    generator.energies();
    generator.system
}

/// A function of coordinates and time.
pub(crate) fn gauge(system: &System, random: &mut Random) -> Expr {
    let mut generator = Generator { random: random.clone(), system: system.clone(), manner: Manner::Tame };
    let may = May { velocities: false, orders: 0, lets: 0, bound: None, arguments: &[] };
    let coordinate = generator.coordinate(may);
    // The last term is the only one with a second power of its own, so that the whole moves.
    let rest = sum(product(coordinate.clone(), generator.scalar(1, may)), generator.scalar(2, may));
    sum(rest, quotient(power(coordinate, 2), number(7)))
}

/// The parameter that a kind of quantity is measured in.
pub(crate) fn measure(system: &System, kind: Kind) -> Expr {
    let found = system.parameters.iter().position(|parameter| parameter.kind == kind);
    Expr::Parameter(found.expect("a system has a measure for what it has"))
}

struct Generator {
    random: Random,
    system: System,
    manner: Manner,
}

impl Generator {
    fn declare(&mut self) {
        self.system.units = self.random.below(5) < 2;
        let units = self.system.units;
        let mut names = PARAMETERS.to_vec();
        let mut take = |random: &mut Random| names.remove(random.below(names.len())).to_owned();
        for _ in 0..=self.random.below(3) {
            let name = take(&mut self.random);
            self.system.parameters.push(Parameter { name, kind: Kind::Scalar });
        }
        self.system.parameters.push(Parameter { name: "ω".to_owned(), kind: Kind::Rate });
        // An array or a body has a unit, and then everything is checked.
        if units {
            for kind in [Kind::Vector(2), Kind::Vector(3), Kind::Family(4), Kind::Body] {
                if self.random.below(3) != 0 {
                    let name = take(&mut self.random);
                    self.system.parameters.push(Parameter { name, kind });
                    if kind == Kind::Body {
                        let measures = [("M", Kind::Mass), ("Λ", Kind::Length)];
                        let measures = measures.map(|(name, kind)| Parameter { name: name.to_owned(), kind });
                        self.system.parameters.extend(measures);
                    }
                }
            }
        }
        let mut left = 1 + self.random.below(4);
        let mut names = COORDINATES.to_vec();
        while 0 < left {
            let name = names.remove(self.random.below(names.len())).to_owned();
            let length = if self.random.once_in(2) { Some(1 + self.random.below(left)) } else { None };
            left -= length.unwrap_or(1);
            self.system.coordinates.push(Coordinate { name, length });
        }
        for name in INPUTS.iter().take([0, 0, 1, 1, 2][self.random.below(5)]) {
            let components = if units { 1 + self.random.below(3) } else { 1 };
            self.system.inputs.push(Input { name: (*name).to_owned(), components });
        }
    }

    fn define(&mut self) {
        for index in 0..self.random.below(4) {
            let kind = self.random.of(&[Type::Scalar, Type::Plane, Type::Plane, Type::Complex, Type::Space]);
            let mut may = May { velocities: false, orders: 0, lets: index, bound: None, arguments: &[] };
            let shape = match self.random.below(5) {
                0 | 1 => Shape::Plain,
                2 | 3 => {
                    let count = 1 + self.random.below(4);
                    may.bound = Some(count);
                    Shape::Indexed(count)
                }
                _ => {
                    may.arguments = FUNCTIONS[self.random.below(FUNCTIONS.len())];
                    Shape::Function(may.arguments.to_vec())
                }
            };
            let expr = self.typed(kind, 3, may);
            self.system.lets.push(Let { name: LETS[index].to_owned(), shape, kind, expr });
        }
    }

    fn energies(&mut self) {
        let lets = self.system.lets.len();
        let still = May { velocities: false, orders: 1, lets, bound: None, arguments: &[] };
        let moving = May { velocities: true, ..still };
        self.squares(still);
        for _ in 0..self.random.below(3) {
            let term = self.kinetic_term(still, moving);
            self.system.kinetic.push(term);
        }
        for _ in 0..self.random.below(3) {
            let term = self.scalar(3, May { orders: 2, ..still });
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

    /// A positive square of each velocity.
    fn squares(&mut self, may: May) {
        for coordinate in 0..self.system.coordinates.len() {
            let length = self.system.coordinates[coordinate].length;
            let mass = |generator: &mut Self, may: May| match generator.random.below(4) {
                0 => number(1),
                1 => generator.positive_parameter(),
                2 => sum(number(1), power(generator.bounded(1, may), 2)),
                _ => sum(generator.positive_parameter(), product(number(2), power(generator.bounded(2, may), 2))),
            };
            if let Some(count) = length
                && self.random.once_in(2)
            {
                let mass = mass(self, May { bound: Some(count), ..may });
                let velocity = self.rate(Expr::Velocity(coordinate, Some(Index::Bound(0)), coordinate % 3));
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

    /// Something that leaves the mass matrix positive.
    fn kinetic_term(&mut self, still: May, moving: May) -> Expr {
        if self.manner == Manner::Wild && self.random.once_in(2) {
            return self.scalar(3, moving);
        }
        match self.random.below(6) {
            // The square of the velocity of a point.
            0..=2 => {
                let position = self.typed(Type::Plane, 3, May { orders: 0, ..still });
                let moved = self.moved(position);
                let velocity = self.rate(Expr::Dot(Box::new(moved)));
                let mass = self.positive_parameter();
                product(quotient(mass, number(2)), power(Expr::Magnitude(Box::new(velocity)), 2))
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
                    _ => Expr::Call(Function::Cosh, Box::new(quotient(velocity, number(3)))),
                }
            }
            // A mixed term that is small beside the squares.
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
            2 => product(factor, power(Expr::Magnitude(Box::new(velocity)), 3)),
            _ => self.scalar(2, moving),
        };
        // Energy per second.
        if self.system.units { product(pure, self.frequency()) } else { pure }
    }

    fn frequency(&self) -> Expr {
        self.measure(Kind::Rate)
    }

    fn measure(&self, kind: Kind) -> Expr {
        measure(&self.system, kind)
    }

    /// A property of a body as a pure number.
    fn property(&self, body: usize, property: Property) -> Expr {
        let own = Expr::Property(body, property);
        match property {
            Property::Mass => quotient(own, self.measure(Kind::Mass)),
            Property::Center => quotient(own, self.measure(Kind::Length)),
            Property::Inertia => quotient(own, product(self.measure(Kind::Mass), power(self.measure(Kind::Length), 2))),
        }
    }

    /// A rate as a pure number, where units are checked.
    fn rate(&mut self, rate: Expr) -> Expr {
        if self.system.units || self.random.once_in(4) { quotient(rate, self.frequency()) } else { rate }
    }

    /// A vector that moves, so that its derivative may be taken.
    fn moved(&mut self, vector: Expr) -> Expr {
        let may = May { velocities: false, orders: 0, lets: 0, bound: None, arguments: &[] };
        let shift = Expr::Vector(vec![self.coordinate(may), product(number(2), self.coordinate(may))]);
        sum(vector, shift)
    }

    fn typed(&mut self, kind: Type, depth: usize, may: May) -> Expr {
        match kind {
            Type::Scalar => self.scalar(depth, may),
            Type::Plane => self.plane(depth, may),
            Type::Complex => self.complex(depth, may),
            Type::Space => self.space(depth, may),
        }
    }

    fn scalar(&mut self, depth: usize, may: May) -> Expr {
        if depth == 0 {
            return self.leaf(may);
        }
        if self.manner == Manner::Wild && self.random.once_in(3) {
            return self.wild(depth, may);
        }
        let inner = depth - 1;
        match self.random.below(22) {
            0..=2 => {
                let items = (0..2 + self.random.below(2)).map(|_| (self.random.once_in(3), self.scalar(inner, may)));
                Expr::Sum(items.collect())
            }
            3..=5 => product(self.scalar(inner, may), self.scalar(inner, may)),
            6 => {
                let divisor = self.positive(inner, may);
                let divided = quotient(self.scalar(inner, may), divisor);
                if self.random.once_in(3) { product(divided, self.scalar(0, may)) } else { divided }
            }
            7 => Expr::Negative(Box::new(self.scalar(inner, may))),
            8 => {
                let exponent = self.random.of(&[2, 2, 3]);
                power(self.scalar(inner, may), exponent)
            }
            9 => {
                let (top, bottom) = self.random.of(&[(1, 2), (-1, 2), (3, 2), (2, 3), (-1, 1), (-2, 1), (5, 4)]);
                Expr::Power(Box::new(self.positive(inner, may)), top, bottom)
            }
            10 => Expr::GeneralPower(Box::new(self.positive(inner, may)), Box::new(self.bounded(inner, may))),
            11..=14 => self.bounded(depth, may),
            15 => self.of_vector(inner, may),
            16 => self.of_vector(inner, may),
            17 => self.sum_over(inner, may),
            18 => {
                let (a, b) = (Box::new(self.scalar(inner, may)), Box::new(self.scalar(inner, may)));
                if self.random.once_in(2) { Expr::Max(a, b) } else { Expr::Min(a, b) }
            }
            19 => self.use_let(Type::Scalar, inner, may).unwrap_or_else(|| self.leaf(may)),
            20 => self.integral(may).unwrap_or_else(|| self.leaf(may)),
            _ => self.leaf(may),
        }
    }

    /// Anything of no more than moderate size.
    fn bounded(&mut self, depth: usize, may: May) -> Expr {
        let inner = depth.saturating_sub(1);
        let call = |function, argument| Expr::Call(function, Box::new(argument));
        let angle = |generator: &mut Self| generator.angle(inner, may);
        let ring = |generator: &mut Self, function| {
            let angle = generator.angle(inner, may);
            Expr::Call(function, Box::new(angle))
        };
        match self.random.below(17) {
            0..=3 => ring(self, Function::Sin),
            4..=7 => ring(self, Function::Cos),
            8 => call(Function::Tanh, angle(self)),
            9 => call(Function::Atan, angle(self)),
            10 => {
                let half = quotient(ring(self, Function::Sin), number(2));
                let function = self.random.of(&[Function::Asin, Function::Acos, Function::Tan, Function::Sinh, Function::Cosh]);
                call(function, half)
            }
            11 => call(Function::Exp, Expr::Negative(Box::new(power(angle(self), 2)))),
            12 => call(Function::Exp, ring(self, Function::Cos)),
            13 => {
                let (y, x) = (angle(self), self.positive(inner, may));
                Expr::Atan2(Box::new(y), Box::new(x))
            }
            14 => {
                let positive = self.positive(inner, may);
                call(Function::Ln, positive)
            }
            15 => {
                let function = self.random.of(&[Function::Abs, Function::Sign]);
                let argument = ring(self, Function::Sin);
                call(function, argument)
            }
            _ => {
                let x = angle(self);
                quotient(x.clone(), sum(number(1), power(x, 2)))
            }
        }
    }

    /// A sum that a trigonometric function may take apart.
    fn angle(&mut self, depth: usize, may: May) -> Expr {
        if 0 < depth && self.random.once_in(3) {
            return self.scalar(depth - 1, may);
        }
        let (a, b) = (self.leaf(may), self.leaf(may));
        match self.random.below(7) {
            0 => sum(a, b),
            1 => Expr::Sum(vec![(false, a), (true, b)]),
            2 => product(number(2), a),
            3 => quotient(a, number(2)),
            4 => Expr::Sum(vec![(false, a), (true, quotient(Expr::Pi, number(2)))]),
            _ => a,
        }
    }

    /// At least one half.
    fn positive(&mut self, depth: usize, may: May) -> Expr {
        match self.random.below(5) {
            0 => sum(number(1), power(self.scalar(depth, may), 2)),
            1 => sum(number(2), Expr::Call(Function::Sin, Box::new(self.angle(depth, may)))),
            2 => self.positive_parameter(),
            3 => Expr::Call(Function::Cosh, Box::new(self.bounded(depth, may))),
            _ => {
                let vector = self.plane(depth.min(1), may);
                sum(number(1), power(Expr::Magnitude(Box::new(vector)), 2))
            }
        }
    }

    /// Functions of whatever comes.
    fn wild(&mut self, depth: usize, may: May) -> Expr {
        let inner = depth - 1;
        let a = Box::new(self.scalar(inner, may));
        let functions = [
            Function::Sqrt,
            Function::Exp,
            Function::Ln,
            Function::Tan,
            Function::Asin,
            Function::Acos,
            Function::Sinh,
            Function::Cosh,
            Function::Abs,
            Function::Sign,
        ];
        match self.random.below(8) {
            0..=2 => Expr::Call(self.random.of(&functions), a),
            3 => quotient(*a, self.scalar(inner, may)),
            4 => {
                let (top, bottom) = self.random.of(&[(1, 3), (-3, 2), (7, 1), (-5, 1), (1, 4), (11, 7), (0, 1)]);
                Expr::Power(a, top, bottom)
            }
            5 => Expr::GeneralPower(a, Box::new(self.scalar(inner, may))),
            6 => {
                let magnitude = Expr::Magnitude(Box::new(self.plane(inner, may)));
                Expr::Atan2(a, Box::new(magnitude))
            }
            _ => Expr::Sum(vec![(false, (*a).clone()), (true, *a)]),
        }
    }

    fn leaf(&mut self, may: May) -> Expr {
        if let Some(index) = (!may.arguments.is_empty()).then(|| self.random.below(may.arguments.len()))
            && self.random.once_in(2)
        {
            return match may.arguments[index] {
                Type::Scalar => Expr::Argument(index),
                _ => Expr::Component(Box::new(Expr::Argument(index)), self.random.below(2)),
            };
        }
        match self.random.below(12) {
            0 => {
                let (top, bottom) =
                    self.random.of(&[(1, 1), (2, 1), (3, 1), (1, 2), (1, 4), (3, 4), (2, 3), (-1, 3), (7, 5), (-2, 1)]);
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

    /// An index below `count`.
    fn index(&mut self, count: usize, may: May) -> Index {
        match may.bound {
            Some(bound) if bound <= count && self.random.below(4) != 0 => {
                if self.random.once_in(4) {
                    Index::Reversed(0, count)
                } else {
                    Index::Bound(0)
                }
            }
            _ => Index::Number(self.random.below(count)),
        }
    }

    fn coordinate(&mut self, may: May) -> Expr {
        let coordinate = self.random.below(self.system.coordinates.len());
        let member = self.system.coordinates[coordinate].length.map(|length| self.index(length, may));
        Expr::Coordinate(coordinate, member)
    }

    fn velocity(&mut self, may: May) -> Expr {
        let coordinate = self.random.below(self.system.coordinates.len());
        let member = self.system.coordinates[coordinate].length.map(|length| self.index(length, may));
        self.velocity_of(coordinate, member)
    }

    fn velocity_of(&mut self, coordinate: usize, member: Option<Index>) -> Expr {
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
                1 => Expr::Height(Box::new(Expr::Parameter(index))),
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

    fn positive_parameter(&mut self) -> Expr {
        let scalars: Vec<usize> =
            (0..self.system.parameters.len()).filter(|&index| self.system.parameters[index].kind == Kind::Scalar).collect();
        Expr::Parameter(self.random.of(&scalars))
    }

    /// A component of a driven input, or of its derivatives as pure numbers.
    fn input(&mut self, may: May) -> Expr {
        let index = self.random.below(self.system.inputs.len());
        let order = self.random.below(may.orders + 1);
        let components = self.system.inputs[index].components;
        let own = Expr::Input(index, order);
        let part = if components == 1 { own } else { Expr::Component(Box::new(own), self.random.below(components)) };
        match order {
            0 => part,
            1 => self.rate(part),
            _ if self.system.units => quotient(part, power(self.frequency(), 2)),
            _ => part,
        }
    }

    fn use_let(&mut self, kind: Type, depth: usize, may: May) -> Option<Expr> {
        if may.lets == 0 {
            return None;
        }
        let index = self.random.below(may.lets);
        let definition = self.system.lets[index].clone();
        if definition.kind != kind && !(kind == Type::Plane && definition.kind == Type::Complex) {
            return None;
        }
        let derived = may.velocities && self.random.once_in(2);
        let value = match definition.shape {
            Shape::Plain if derived && self.random.once_in(2) && moves(&definition.expr) => {
                return Some(self.rate(Expr::LetDot(index)));
            }
            Shape::Plain => Expr::Let(index),
            Shape::Indexed(count) => Expr::LetMember(index, self.index(count, may)),
            Shape::Function(types) => {
                let still = May { velocities: false, orders: 0, ..may };
                let arguments = types.iter().map(|&kind| self.typed(kind, depth.min(1), still)).collect();
                Expr::Apply(index, arguments)
            }
        };
        if derived && kind == Type::Plane {
            let value = self.moved(value);
            return Some(self.rate(Expr::Dot(Box::new(value))));
        }
        Some(value)
    }

    fn sum_over(&mut self, depth: usize, may: May) -> Expr {
        // An index is bound once; within a range the index outside keeps its name.
        if may.bound.is_some() {
            return self.leaf(may);
        }
        let count = 1 + self.random.below(4);
        let term = self.scalar(depth, May { bound: Some(count), ..may });
        Expr::Over(0, count, self.random.once_in(3), Box::new(term))
    }

    fn of_vector(&mut self, depth: usize, may: May) -> Expr {
        let boxed = |generator: &mut Self, kind| Box::new(generator.typed(kind, depth, may));
        match self.random.below(9) {
            0 => Expr::Inner(boxed(self, Type::Plane), boxed(self, Type::Plane)),
            1 => Expr::Inner(boxed(self, Type::Space), boxed(self, Type::Space)),
            2 => Expr::Cross(boxed(self, Type::Plane), boxed(self, Type::Plane)),
            3 => Expr::Height(boxed(self, Type::Plane)),
            4 => Expr::Height(boxed(self, Type::Space)),
            5 => Expr::Component(boxed(self, Type::Plane), self.random.below(2)),
            6 => Expr::Component(boxed(self, Type::Space), self.random.below(3)),
            7 => power(Expr::Magnitude(boxed(self, Type::Space)), 2),
            _ => {
                // The length of what is never short.
                let parts = [self.positive(depth, may), self.scalar(depth, may)];
                Expr::Magnitude(Box::new(Expr::Vector(parts.to_vec())))
            }
        }
    }

    fn plane(&mut self, depth: usize, may: May) -> Expr {
        let whole = self.whole(2, may);
        if depth == 0 {
            return whole.unwrap_or_else(|| Expr::Vector(vec![self.leaf(may), self.leaf(may)]));
        }
        let inner = depth - 1;
        match self.random.below(12) {
            0 => whole.unwrap_or_else(|| Expr::Vector(vec![self.leaf(may), self.leaf(may)])),
            1 | 2 => sum(self.plane(inner, may), self.plane(inner, may)),
            3 => product(self.scalar(inner, may), self.plane(inner, may)),
            4 => Expr::Perp(Box::new(self.plane(inner, may))),
            5 | 6 => product(Expr::Cis(Box::new(self.angle(inner, may)), false), self.plane(inner, may)),
            7 => self.complex(depth, may),
            8 | 9 => self.use_let(Type::Plane, inner, may).unwrap_or_else(|| Expr::Vector(vec![self.leaf(may), self.leaf(may)])),
            10 => {
                let angle = self.angle(0, may);
                let call = |function| Expr::Call(function, Box::new(angle.clone()));
                let turn = Expr::Vector(vec![call(Function::Sin), Expr::Negative(Box::new(call(Function::Cos)))]);
                product(self.leaf(may), turn)
            }
            _ => Expr::Vector(vec![self.scalar(inner, may), self.scalar(inner, may)]),
        }
    }

    /// What is a vector as declared.
    fn whole(&mut self, components: usize, may: May) -> Option<Expr> {
        let argument = may.arguments.iter().position(|&kind| kind == Type::Plane);
        if let Some(index) = argument
            && components == 2
            && self.random.once_in(2)
        {
            return Some(Expr::Argument(index));
        }
        let mut found = Vec::new();
        for (index, parameter) in self.system.parameters.iter().enumerate() {
            match parameter.kind {
                Kind::Vector(count) if count == components => found.push(Expr::Parameter(index)),
                Kind::Body if components == 2 => found.push(self.property(index, Property::Center)),
                _ => {}
            }
        }
        for (index, input) in self.system.inputs.iter().enumerate() {
            if input.components == components {
                found.push(Expr::Input(index, 0));
            }
        }
        if found.is_empty() { None } else { Some(found.swap_remove(self.random.below(found.len()))) }
    }

    /// Something that is written as a complex number.
    fn complex(&mut self, depth: usize, may: May) -> Expr {
        let inner = depth.saturating_sub(1);
        let cis = |generator: &mut Self| {
            let angle = Box::new(generator.angle(inner, may));
            Expr::Cis(angle, generator.random.once_in(2))
        };
        match self.random.below(9) {
            0 if 0 < depth => product(self.complex(inner, may), self.complex(inner, may)),
            1 if 0 < depth => sum(self.complex(inner, may), self.scalar(inner, may)),
            2 if 0 < depth => power(self.complex(inner, may), 2 + (depth % 2) as i64),
            3 => quotient(cis(self), cis(self)),
            4 => product(self.leaf(may), cis(self)),
            5 => sum(self.leaf(may), product(Expr::Imaginary, self.leaf(may))),
            6 if 0 < depth => self.use_let(Type::Complex, inner, may).unwrap_or_else(|| cis(self)),
            7 => quotient(cis(self), self.positive_parameter()),
            _ => cis(self),
        }
    }

    fn space(&mut self, depth: usize, may: May) -> Expr {
        let plain = |generator: &mut Self, depth| Expr::Vector((0..3).map(|_| generator.scalar(depth, may)).collect());
        if depth == 0 {
            return self.whole(3, may).unwrap_or_else(|| plain(self, 0));
        }
        let inner = depth - 1;
        match self.random.below(6) {
            0 => self.whole(3, may).unwrap_or_else(|| plain(self, 0)),
            1 => sum(self.space(inner, may), self.space(inner, may)),
            2 => product(self.scalar(inner, may), self.space(inner, may)),
            3 => Expr::Cross(Box::new(self.space(inner, may)), Box::new(self.space(inner, may))),
            4 => self.use_let(Type::Space, inner, may).unwrap_or_else(|| plain(self, 0)),
            _ => plain(self, inner.min(1)),
        }
    }

    /// The integral of the square of a velocity, of a height, or of a function of the point.
    fn integral(&mut self, may: May) -> Option<Expr> {
        let body = self.system.parameters.iter().position(|parameter| parameter.kind == Kind::Body)?;
        let still = May { velocities: false, orders: 0, arguments: &[], ..may };
        let point = quotient(Expr::Point, self.measure(Kind::Length));
        let turned = product(Expr::Cis(Box::new(self.angle(1, still)), false), point.clone());
        let place = sum(self.plane(1, still), turned);
        let integrand = match self.random.below(3) {
            0 if may.velocities => {
                let moved = self.moved(place);
                let velocity = self.rate(Expr::Dot(Box::new(moved)));
                quotient(power(Expr::Magnitude(Box::new(velocity)), 2), number(2))
            }
            1 => product(Expr::Height(Box::new(place)), Expr::Component(Box::new(point), 0)),
            _ => Expr::Height(Box::new(place)),
        };
        Some(quotient(Expr::Integral(body, Box::new(integrand)), self.measure(Kind::Mass)))
    }
}

/// Whether a coordinate stands openly in an expression that is never simplified away.
fn moves(expr: &Expr) -> bool {
    match expr {
        Expr::Coordinate(..) => true,
        Expr::Vector(items) => items.iter().any(moves),
        Expr::Call(Function::Sin | Function::Cos | Function::Exp, inner) => moves(inner),
        Expr::Cis(inner, _) => moves(inner),
        _ => false,
    }
}
