//! A planet with units, for tests.

#![allow(missing_docs)]

use pendulum_runtime::lagrangian;

lagrangian! {
    /// A planet about a star at rest.
    #[derive(Clone, Debug)]
    pub struct Kepler { μ: m^3/s^2 }
    coordinate x: m;
    coordinate y: m;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = -μ/|[x, y]|;
}
