//! The benchmark `work_precision` of this project's methods and of the peers: the systems in the
//! form a user would write them, with their parameters; the problems and their timing.

pub mod measure;
pub mod problem;

use crate::pendulums::{Hanging, MovingCompound, Simple};
use crate::problems::{Double, Elastic, Five, HenonHeiles, Kepler, ThreeBodies};
use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::system::Driven;

/// Returns the pendulum with g/L = 9.8.
pub fn simple() -> Simple<f64> {
    Simple { m: 1.0, L: 1.0, g: 9.8 }
}

/// Returns the pendulum whose pivot is at x = ¼ sin 2t.
pub fn moving() -> Driven<Hanging<f64>, (Sinusoid<2>,)> {
    Hanging { m: 1.0, L: 1.0, g: 1.0 }.driven_by(Sinusoid::new([0.25, 0.0], 2.0, [0.0, 0.0]))
}

/// Returns the compound pendulum whose pivot is at (¼ sin 2t, ⅛ sin(2t + 1)).
pub fn moving_compound() -> Driven<MovingCompound<f64>, (Sinusoid<2>,)> {
    let pivot = Sinusoid::new([0.25, 0.125], 2.0, [0.0, 1.0]);
    MovingCompound { m: 1.5, c: [0.25, -0.75], I: 1.25, g: 9.8 }.driven_by(pivot)
}

/// Returns the elastic pendulum with k = 8.
pub fn elastic() -> Elastic<f64> {
    Elastic::new(8.0, 1.0, 1.0)
}

/// Returns the double pendulum with unit links and masses and g = 1.
pub fn double() -> Double<f64> {
    Double::new([1.0; 2], [1.0; 2], 1.0)
}

/// Returns the chain with unit links and masses and g = 1.
pub fn chain5() -> Five<f64> {
    Five::new([1.0; 5], [1.0; 5], 1.0)
}

/// Returns the planet with μ = 1.
pub fn kepler() -> Kepler<f64> {
    Kepler::new(1.0)
}

/// Returns the star with λ = 1.
pub fn henon_heiles() -> HenonHeiles<f64> {
    HenonHeiles::new(1.0)
}

/// Returns the Pythagorean bodies, with masses 3, 4 and 5 and G = 1.
pub fn pythagorean() -> ThreeBodies<f64> {
    ThreeBodies::new([3.0, 4.0, 5.0], 1.0)
}
