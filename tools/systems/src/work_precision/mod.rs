//! The benchmark `work_precision` as its own methods and the peers see it: the systems, as a user
//! would write them, with their parameters; the problems and how they are timed.

pub mod measure;
pub mod problem;

use crate::pendulums::{Hanging, MovingCompound, Simple};
use crate::problems::{Double, Elastic, Five, HenonHeiles, Kepler};
use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::system::Driven;

/// g/L = 9.8.
pub fn simple() -> Simple<f64> {
    Simple { m: 1.0, L: 1.0, g: 9.8 }
}

/// The pivot at x = ¼ sin 2t.
pub fn moving() -> Driven<Hanging<f64>, (Sinusoid<2>,)> {
    Hanging { m: 1.0, L: 1.0, g: 1.0 }.driven_by(Sinusoid::new([0.25, 0.0], 2.0, [0.0, 0.0]))
}

/// The pivot at (¼ sin 2t, ⅛ sin(2t + 1)).
pub fn moving_compound() -> Driven<MovingCompound<f64>, (Sinusoid<2>,)> {
    let pivot = Sinusoid::new([0.25, 0.125], 2.0, [0.0, 1.0]);
    MovingCompound { m: 1.5, c: [0.25, -0.75], I: 1.25, g: 9.8 }.driven_by(pivot)
}

/// A spring with k = 8.
pub fn elastic() -> Elastic<f64> {
    Elastic::new(8.0, 1.0, 1.0)
}

/// Unit links and masses, g = 1.
pub fn double() -> Double<f64> {
    Double::new([1.0; 2], [1.0; 2], 1.0)
}

/// Unit links and masses, g = 1.
pub fn chain5() -> Five<f64> {
    Five::new([1.0; 5], [1.0; 5], 1.0)
}

/// μ = 1.
pub fn kepler() -> Kepler<f64> {
    Kepler::new(1.0)
}

/// λ = 1.
pub fn henon_heiles() -> HenonHeiles<f64> {
    HenonHeiles::new(1.0)
}
