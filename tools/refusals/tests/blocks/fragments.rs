//! Blocks written by a macro of the user, from expressions, numbers, names and units.

use pendulum_runtime::prelude::*;
use pendulum_runtime::system::SplitEnergy;

macro_rules! system {
    ($name:ident, $coordinate:ident, $unit:ty, $mass:literal, $count:literal, $energy:expr, $members:expr) => {
        lagrangian! {
            struct $name { k, m: kg = $mass, l: [$unit; $count] }
            coordinate $coordinate: $unit;
            kinetic = m/2*dot($coordinate)^2;
            potential = k*2*$energy - k*$energy^2*sum(j in $members, l[j]);
        }
    };
}

system!(Wrapped, q, rad, -2, 3, 1 + q, 0..3);

fn main() {
    let system = Wrapped::new(1.0, [1.0, 0.5, 0.5]);
    assert_eq!(system.m, -2.0);
    let energy = system.potential_energy(At::of(0.0, &[10.0], &[0.0]));
    assert_eq!(energy, 22.0 - 2.0 * 121.0);
}
