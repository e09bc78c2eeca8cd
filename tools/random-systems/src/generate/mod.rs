//! Random systems: well formed always, and tame if they are to be compared in numbers.

mod declare;
mod definition;
mod energy;
mod leaf;
mod scalar;
mod vector;

use super::tree::{Expr, Kind, System, Type, number, power, product, quotient, sum};
use split_mix::Random;

/// The purpose of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// Every function has an argument for which it is real and smooth, kinetic energies are
    /// positive, nothing is large.
    Tame,
    /// Anything that is well formed.
    Wild,
}

/// The quantities that may stand in an expression.
#[derive(Clone, Copy, Debug)]
struct May {
    /// Velocities of coordinates.
    velocities: bool,
    /// The highest derivative of driven inputs: none where the derivative of all is taken, the
    /// first in energies.
    orders: usize,
    /// Definitions with a smaller number than this.
    lets: usize,
    /// Indices that are bound: their number, and the least of the ranges.
    bound: Option<usize>,
    /// The arguments of a function.
    arguments: &'static [Type],
}

/// The system of a seed.
pub fn system(seed: u64, manner: Manner) -> System {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5eed);
    random.bits();
    let mut generator = Generator { random, system: System { seed, ..System::default() }, manner };
    generator.declare();
    generator.define();
    generator.energies();
    generator.system
}

/// A function of coordinates and time.
pub fn gauge(system: &System, random: &mut Random) -> Expr {
    let mut generator =
        Generator { random: random.clone(), system: system.clone(), manner: Manner::Tame };
    let may = May { velocities: false, orders: 0, lets: 0, bound: None, arguments: &[] };
    let coordinate = generator.coordinate(may);
    // The last term is the only one with a second power of its own, so that the whole moves.
    let rest = sum(product(coordinate.clone(), generator.scalar(1, may)), generator.scalar(2, may));
    sum(rest, quotient(power(coordinate, 2), number(7)))
}

/// The parameter that a kind of quantity is measured in.
///
/// # Panics
///
/// If the system has no parameter of this kind.
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
