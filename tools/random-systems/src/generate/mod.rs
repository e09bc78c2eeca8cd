//! Random systems: always well formed, and tame if their values are to be compared.

mod declare;
mod definition;
mod energy;
mod leaf;
mod scalar;
mod vector;

use super::tree::{Expr, Kind, System, Type, number, power, product, quotient, sum};
use systems::random::Random;

/// The kind of system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// Every function has an argument for which it is real and smooth, kinetic energies are
    /// positive, and no value is large.
    Tame,
    /// Any well-formed system.
    Wild,
}

/// The quantities allowed in an expression.
#[derive(Clone, Copy, Debug)]
struct May {
    /// `true` if velocities of coordinates are allowed.
    velocities: bool,
    /// The highest derivative of driven inputs: 0 in expressions that are differentiated, 1 in
    /// energies, 2 in forces.
    orders: usize,
    /// The definitions with an index below this number are allowed.
    lets: usize,
    /// The length of the range of the bound index, if there is one.
    bound: Option<usize>,
    /// The types of the arguments of the enclosing function.
    arguments: &'static [Type],
}

/// Returns the system of a seed.
pub fn system(seed: u64, manner: Manner) -> System {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5eed);
    random.bits();
    let mut generator = Generator { random, system: System { seed, ..System::default() }, manner };
    generator.declare();
    generator.define();
    generator.energies();
    generator.system
}

/// Returns a random function of coordinates and time.
pub fn gauge(system: &System, random: &mut Random) -> Expr {
    let mut generator =
        Generator { random: random.clone(), system: system.clone(), manner: Manner::Tame };
    let may = May { velocities: false, orders: 0, lets: 0, bound: None, arguments: &[] };
    let coordinate = generator.coordinate(may);
    // Only the last term contains a separate second power, so that the sum depends on the
    // coordinate.
    let rest = sum(product(coordinate.clone(), generator.scalar(1, may)), generator.scalar(2, may));
    sum(rest, quotient(power(coordinate, 2), number(7)))
}

/// Returns the parameter that is the unit of a kind of quantity.
///
/// # Panics
///
/// Panics if the system has no parameter of this kind.
pub fn measure(system: &System, kind: Kind) -> Expr {
    let found = system.parameters.iter().position(|parameter| parameter.kind == kind);
    Expr::Parameter(found.expect("a system has a measure for what it has"))
}

struct Generator {
    random: Random,
    system: System,
    manner: Manner,
}

impl Generator {
    fn typed(&mut self, kind: Type, depth: usize, may: May) -> Expr {
        match kind {
            Type::Scalar => self.scalar(depth, may),
            Type::Plane => self.plane(depth, may),
            Type::Complex => self.complex(depth, may),
            Type::Space => self.space(depth, may),
        }
    }
}
