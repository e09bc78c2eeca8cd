//! The systems of the benchmark, as a user would write them, with their parameters.

use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::system::Driven;
use shared::{Double, Elastic, Five, HenonHeiles, Kepler};

#[path = "../../../tests/common/systems.rs"]
mod shared;

mod blocks {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        /// A pendulum.
        pub struct Simple { m: kg, L: m, g: m/s^2 }
        coordinate θ: rad;
        let y = L * [sin(θ), -cos(θ)];
        kinetic = m/2 * |ẏ|^2;
        potential = m*g*height(y);
    }

    lagrangian! {
        /// A pendulum on a driven pivot.
        pub struct Moving { m: kg, L: m, g: m/s^2 }
        coordinate θ: rad;
        driven x: [m; 2];
        let y = L * [sin(θ), -cos(θ)];
        kinetic = m/2 * |ẋ + ẏ|^2;
        potential = m*g*height(x + y);
    }

    lagrangian! {
        /// A rigid body on a driven pivot: mass, centre and moment of inertia about the pivot are exact.
        pub struct MovingCompound { m: kg, c: [m; 2], I: kg*m^2, g: m/s^2 }
        coordinate θ: rad;
        driven x: [m; 2];
        let r = cis(θ)*c;
        kinetic = m/2*|ẋ|^2 + m*inner(ẋ, ṙ) + I/2*θ̇^2;
        potential = m*g*height(x + r);
    }
}

/// g/L = 9.8.
pub fn simple() -> blocks::Simple<f64> {
    blocks::Simple::new(1.0, 1.0, 9.8)
}

/// The pivot at x = ¼ sin 2t.
pub fn moving() -> Driven<blocks::Moving<f64>, (Sinusoid<2>,)> {
    blocks::Moving::new(1.0, 1.0, 1.0).driven_by(Sinusoid::new([0.25, 0.0], 2.0, [0.0, 0.0]))
}

/// The pivot at (¼ sin 2t, ⅛ sin(2t + 1)).
pub fn moving_compound() -> Driven<blocks::MovingCompound<f64>, (Sinusoid<2>,)> {
    let pivot = Sinusoid::new([0.25, 0.125], 2.0, [0.0, 1.0]);
    blocks::MovingCompound::new(1.5, [0.25, -0.75], 1.25, 9.8).driven_by(pivot)
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
