//! Systems written by hand, with the names and numbers of the literature.

use nalgebra::SMatrix;
use pendulum_runtime::motion::{Derivatives, Motion, Sample, Side};
use pendulum_runtime::scalar::Real;
use pendulum_runtime::system::{At, Driven, Facts, Input, System, VelocityFree};
use pendulum_runtime::time::Time;

/// Implements `System` from accelerations, energy, momenta and velocities; integrators and tests
/// call no other methods.
macro_rules! system {
    ($(#[$doc:meta])* $name:ident<$t:ident, $n:literal> { $($parameter:ident),* } $inputs:ty; $facts:expr;
     |$self:ident, $q:ident, $v:ident, $x:ident|
     accelerations $accelerations:expr;
     energy $energy:expr;
     momenta $momenta:expr;
     velocities |$p:ident| $velocities:expr;) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct $name<$t> { $(pub(crate) $parameter: $t),* }

        impl<$t: Real> System<$n> for $name<$t> {
            type Scalar = $t;
            type Inputs = $inputs;
            type With<U: Real> = $name<U>;
            type Prepared = ();
            const FACTS: Facts = $facts;

            #[allow(unused_mut, unused_variables)]
            fn map<U: Real>(&self, mut map: impl FnMut($t) -> U) -> $name<U> {
                $name { $($parameter: map(self.$parameter)),* }
            }

            fn prepare(&self) {}

            #[allow(unused_variables)]
            #[inline]
            fn accelerations(&self, At { q: $q, v: $v, inputs: $x, .. }: At<'_, $t, $inputs, $n>) -> [$t; $n] {
                let $self = self;
                $accelerations
            }

            #[allow(unused_variables)]
            fn energy(&self, At { q: $q, v: $v, inputs: $x, .. }: At<'_, $t, $inputs, $n>) -> $t {
                let $self = self;
                $energy
            }

            #[allow(unused_variables)]
            fn momenta(&self, At { q: $q, v: $v, inputs: $x, .. }: At<'_, $t, $inputs, $n>) -> [$t; $n] {
                let $self = self;
                $momenta
            }

            #[allow(unused_variables)]
            fn velocities(&self, _: $t, $q: &[$t; $n], $p: &[$t; $n], $x: &$inputs) -> [$t; $n] {
                let $self = self;
                $velocities
            }

            fn power(&self, _: At<'_, $t, $inputs, $n>) -> $t {
                unreachable!("no integrator asks for the power")
            }

            fn mass_matrix(&self, _: At<'_, $t, $inputs, $n>) -> SMatrix<$t, $n, $n> {
                unreachable!("no integrator asks for the mass matrix")
            }

            fn forces(&self, _: At<'_, $t, $inputs, $n>) -> [$t; $n] {
                unreachable!("no integrator asks for the forces")
            }

            fn momentum_rates(&self, _: At<'_, $t, $inputs, $n>) -> [$t; $n] {
                unreachable!("no integrator asks for the momentum rates")
            }
        }
    };
}

/// Returns the facts about a system with these names.
const fn facts(
    name: &'static str,
    coordinates: &'static [&'static str],
    parameters: &'static [&'static str],
) -> Facts {
    let mut facts = Facts::new(name, coordinates);
    facts.parameters = parameters;
    facts
}

fn two<T: Real>() -> T {
    T::from_f64(2.0)
}

system! {
    /// θ̈ = −(g/L) sin θ.
    Pendulum<T, 1> { length, g } ();
    facts("Pendulum", &["θ"], &["L", "g"]);
    |s, q, v, x|
    accelerations [-(s.g / s.length) * q[0].sin()];
    energy s.length * s.length * v[0] * v[0] / two() - s.g * s.length * q[0].cos();
    momenta [s.length * s.length * v[0]];
    velocities |p| [p[0] / (s.length * s.length)];
}

impl<T: Real> VelocityFree<1> for Pendulum<T> {}

/// Returns the pendulum with L = g = 1.
pub(crate) fn pendulum() -> Pendulum<f64> {
    Pendulum { length: 1.0, g: 1.0 }
}

system! {
    /// A pendulum whose pivot x is driven: θ̈ = −((g + ẍ₂) sin θ + ẍ₁ cos θ)/L.
    MovingPendulum<T, 1> { length, g } (Sample<T, 2>,);
    {
        let mut facts = facts("MovingPendulum", &["θ"], &["L", "g"]);
        facts.inputs = &[X];
        facts
    };
    |s, q, v, x|
    accelerations {
        let (sin, cos) = q[0].sin_cos();
        [-((s.g + x.0.acceleration[1]) * sin + x.0.acceleration[0] * cos) / s.length]
    };
    energy s.length * s.length * v[0] * v[0] / two() - s.g * s.length * q[0].cos();
    momenta {
        let (sin, cos) = q[0].sin_cos();
        [s.length * (s.length * v[0] + x.0.velocity[0] * cos + x.0.velocity[1] * sin)]
    };
    velocities |p| {
        let (sin, cos) = q[0].sin_cos();
        [(p[0] / s.length - x.0.velocity[0] * cos - x.0.velocity[1] * sin) / s.length]
    };
}

const X: Input = Input {
    name: "x",
    components: 2,
    control: false,
    accelerations: Derivatives::ACCELERATION,
    momenta: Derivatives::VELOCITY,
    energy: Derivatives::ALL,
    power: Derivatives::ALL,
    outputs: Derivatives::NONE,
};

impl<T: Real> VelocityFree<1> for MovingPendulum<T> {}

system! {
    /// The double pendulum with unit masses and lengths, in absolute angles.
    DoublePendulum<T, 2> { g } ();
    facts("DoublePendulum", &["θ₁", "θ₂"], &["g"]);
    |s, q, v, x|
    accelerations {
        let (sin, cos) = (q[0] - q[1]).sin_cos();
        let f0 = -(sin * v[1] * v[1]) - two::<T>() * s.g * q[0].sin();
        let f1 = sin * v[0] * v[0] - s.g * q[1].sin();
        let reciprocal = T::from_f64(1.0) / (T::from_f64(1.0) + sin * sin);
        [(f0 - cos * f1) * reciprocal, (two::<T>() * f1 - cos * f0) * reciprocal]
    };
    energy {
        let kinetic = v[0] * v[0] + v[1] * v[1] / two() + v[0] * v[1] * (q[0] - q[1]).cos();
        kinetic - s.g * (two::<T>() * q[0].cos() + q[1].cos())
    };
    momenta {
        let cos = (q[0] - q[1]).cos();
        [two::<T>() * v[0] + cos * v[1], v[1] + cos * v[0]]
    };
    velocities |p| {
        let (sin, cos) = (q[0] - q[1]).sin_cos();
        let reciprocal = T::from_f64(1.0) / (T::from_f64(1.0) + sin * sin);
        [(p[0] - cos * p[1]) * reciprocal, (two::<T>() * p[1] - cos * p[0]) * reciprocal]
    };
}

/// Returns the double pendulum with g = 1.
pub(crate) fn double_pendulum() -> DoublePendulum<f64> {
    DoublePendulum { g: 1.0 }
}

system! {
    /// A planet around a unit mass.
    Kepler<T, 2> { mu } ();
    facts("Kepler", &["x", "y"], &["μ"]);
    |s, q, v, x|
    accelerations {
        let square = q[0] * q[0] + q[1] * q[1];
        let factor = -s.mu / (square * square.sqrt());
        [factor * q[0], factor * q[1]]
    };
    energy (v[0] * v[0] + v[1] * v[1]) / two() - s.mu / (q[0] * q[0] + q[1] * q[1]).sqrt();
    momenta *v;
    velocities |p| *p;
}

impl<T: Real> VelocityFree<2> for Kepler<T> {}

system! {
    /// Hénon and Heiles (1964), with λ = 1 in their potential.
    HenonHeiles<T, 2> { lambda } ();
    facts("HenonHeiles", &["x", "y"], &["λ"]);
    |s, q, v, x|
    accelerations [-q[0] - two::<T>() * s.lambda * q[0] * q[1], -q[1] - s.lambda * (q[0] * q[0] - q[1] * q[1])];
    energy {
        let cubic = q[0] * q[0] * q[1] - q[1] * q[1] * q[1] / T::from_f64(3.0);
        (v[0] * v[0] + v[1] * v[1] + q[0] * q[0] + q[1] * q[1]) / two() + s.lambda * cubic
    };
    momenta *v;
    velocities |p| *p;
}

impl<T: Real> VelocityFree<2> for HenonHeiles<T> {}

system! {
    /// ẍ = −k x.
    Oscillator<T, 1> { k } ();
    facts("Oscillator", &["x"], &["k"]);
    |s, q, v, x|
    accelerations [-s.k * q[0]];
    energy (v[0] * v[0] + s.k * q[0] * q[0]) / two();
    momenta *v;
    velocities |p| *p;
}

impl<T: Real> VelocityFree<1> for Oscillator<T> {}

system! {
    /// ẍ = −k √x, which has no value for negative x.
    Root<T, 1> { k } ();
    facts("Root", &["x"], &["k"]);
    |s, q, v, x|
    accelerations [-s.k * q[0].sqrt()];
    energy v[0] * v[0] / two();
    momenta *v;
    velocities |p| *p;
}

/// A motion given by a function of time for each derivative, with kinks at multiples of `period`,
/// if any.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Formula<F> {
    pub(crate) formula: F,
    pub(crate) period: f64,
}

impl<T: Real, const D: usize, F: Fn(f64) -> [[f64; D]; 3]> Motion<T, D> for Formula<F> {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, _: Side, _: Derivatives) -> Sample<T, D> {
        let [position, velocity, acceleration] =
            (self.formula)(t.to_f64()).map(|values| values.map(T::from_f64));
        Sample { position, velocity, acceleration }
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        (self.period < f64::INFINITY).then(|| (t / self.period).floor() * self.period + self.period)
    }
}

/// Straight lines in one dimension, along x, between keys at equal time intervals.
#[derive(Clone, Debug)]
pub(crate) struct LinearKeys {
    pub(crate) rate: f64,
    pub(crate) keys: Vec<f64>,
}

impl<T: Real> Motion<T, 2> for LinearKeys {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, side: Side, _: Derivatives) -> Sample<T, 2> {
        let position = t.to_f64() * self.rate;
        let mut segment = position.floor();
        if side == Side::Before && segment / self.rate == t.to_f64() {
            segment -= 1.0;
        }
        let index = (segment.max(0.0) as usize).min(self.keys.len() - 2);
        let rise = self.keys[index + 1] - self.keys[index];
        let zero = T::from_f64(0.0);
        Sample {
            position: [T::from_f64(self.keys[index] + rise * (position - index as f64)), zero],
            velocity: [T::from_f64(rise * self.rate), zero],
            acceleration: [zero; 2],
        }
    }

    fn next_kink(&self, t: f64) -> Option<f64> {
        let mut index = (t * self.rate).floor();
        while index / self.rate <= t {
            index += 1.0;
        }
        (index < (self.keys.len() - 1) as f64).then_some(index / self.rate)
    }
}

/// Returns the system of Hénon and Heiles.
pub(crate) fn henon_heiles() -> HenonHeiles<f64> {
    HenonHeiles { lambda: 1.0 }
}

/// A pendulum whose pivot moves by a formula.
pub(crate) type OnFormula<F> = Driven<MovingPendulum<f64>, (Formula<F>,)>;

/// Returns the pendulum with L = g = 1 whose pivot moves by a formula with kinks at multiples of
/// `period`.
pub(crate) fn moving<F: Fn(f64) -> [[f64; 2]; 3]>(formula: F, period: f64) -> OnFormula<F> {
    Driven::new(MovingPendulum { length: 1.0, g: 1.0 }, (Formula { formula, period },))
}

/// ẍ = −k x.
pub(crate) fn oscillator(k: f64) -> Oscillator<f64> {
    Oscillator { k }
}

/// Returns the pendulum with L = g = 1 whose pivot is at x = ¼ sin 2t.
pub(crate) fn shaken() -> OnFormula<impl Fn(f64) -> [[f64; 2]; 3]> {
    let formula = |t: f64| {
        let (sin, cos) = Real::sin_cos(2.0 * t);
        [[0.25 * sin, 0.0], [0.5 * cos, 0.0], [-sin, 0.0]]
    };
    moving(formula, f64::INFINITY)
}

/// The state of `shaken` at t = 10, from 0.5 at rest.
pub(crate) const SHAKEN: [f64; 2] = [0.0342105591464723414299261437288, -1.02072871213303888830643];
