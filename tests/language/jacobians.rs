//! Jacobians of generated systems, symbolic and by forward mode, compared with dual numbers.

use pendulum_runtime::body::Body;
use pendulum_runtime::motion::Sample;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Dual;
use pendulum_runtime::system::Jacobians;
use pendulum_runtime::system::System;

use systems::random::Random;

lagrangian! {
    pub struct Body1 { B: body, c: N*m*s, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let r(p) = x + cis(θ)*p;
    kinetic   = integral(p in B, |dot(r(p))|^2 / 2);
    potential = integral(p in B, g*height(r(p)));
    dissipation = c*θ̇^2/2;
}

lagrangian! {
    pub struct Chain2 { m: [kg; 2], l: [m; 2], g: m/s^2 = 9.81 }
    coordinate θ[2]: rad;
    let y[k in 0..2] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..2, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..2, m[k]*g*height(y[k]));
}

lagrangian! {
    pub struct Chain5 { m: [kg; 5], l: [m; 5], g: m/s^2 = 9.81 }
    coordinate θ[5]: rad;
    driven x: [m; 2];
    let y[k in 0..5] = x + sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..5, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..5, m[k]*g*height(y[k]));
}

lagrangian! {
    pub struct Sphere { m: kg, l: m, k: N/m, g: m/s^2 = 9.81 }
    coordinate r: m;
    coordinate θ: rad;
    coordinate φ: rad;
    let y = r*[sin(θ)*cos(φ), sin(θ)*sin(φ), -cos(θ)];
    kinetic = m/2*|ẏ|^2;
    potential = m*g*height(y) + k/2*(r - l)^2 + k*l^2*exp(-|y|/l)*atan2(r, l)/20;
}

/// Compares all three Jacobians with dual numbers at random states.
macro_rules! compare {
    ($n:literal, $system:expr, $inputs:expr) => {{
        let mut random = Random::new(3);
        for _ in 0..100 {
            let system = $system(&mut random);
            let inputs = $inputs;
            let q: [f64; $n] = core::array::from_fn(|_| random.uniform(0.3, 1.4));
            let v: [f64; $n] = core::array::from_fn(|_| random.uniform(-1.0, 1.0));
            let lifted = system.map(Dual::constant);
            let (t, lifted_inputs) = (Dual::constant(0.3), lift(&inputs));
            let column = |q: [Dual; $n], v: [Dual; $n]| {
                lifted
                    .accelerations(At { t, q: &q, v: &v, inputs: &lifted_inputs })
                    .map(|a| a.derivative)
            };
            let at = At { t: 0.3, q: &q, v: &v, inputs: &inputs };
            let positions = system.position_jacobian(at);
            let velocities = system.velocity_jacobian(at);
            for k in 0..$n {
                let mut seeded = q.map(Dual::constant);
                seeded[k].derivative = 1.0;
                near(positions.column(k).as_slice(), &column(seeded, v.map(Dual::constant)));
                let mut seeded = v.map(Dual::constant);
                seeded[k].derivative = 1.0;
                near(velocities.column(k).as_slice(), &column(q.map(Dual::constant), seeded));
            }
            let count = facts(&system).parameters.len();
            let mut columns = vec![[0.0; $n]; count];
            system.parameter_jacobian(at, &mut columns);
            for (k, found) in columns.iter().enumerate() {
                let mut index = 0;
                let seeded = system.map(|value| {
                    index += 1;
                    Dual { value, derivative: if index == k + 1 { 1.0 } else { 0.0 } }
                });
                let (q, v) = (q.map(Dual::constant), v.map(Dual::constant));
                near(
                    found,
                    &seeded
                        .accelerations(At { t, q: &q, v: &v, inputs: &lifted_inputs })
                        .map(|a| a.derivative),
                );
            }
        }
    }};
}

fn facts<const N: usize, S: System<N>>(_: &S) -> pendulum_runtime::system::Facts {
    S::FACTS
}

fn near(found: &[f64], expected: &[f64]) {
    let scale = expected.iter().fold(1.0f64, |scale, value| scale.max(value.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 2e-12 * scale, "{found} for {expected}");
    }
}

trait Lift {
    type Lifted;
    fn lifted(&self) -> Self::Lifted;
}

impl Lift for () {
    type Lifted = ();
    fn lifted(&self) {}
}

impl Lift for (Sample<f64, 2>,) {
    type Lifted = (Sample<Dual, 2>,);
    fn lifted(&self) -> Self::Lifted {
        (self.0.map(Dual::constant),)
    }
}

fn lift<L: Lift>(inputs: &L) -> L::Lifted {
    inputs.lifted()
}

fn shaken(random: &mut Random) -> (Sample<f64, 2>,) {
    let mut pair = || [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)];
    (Sample { position: pair(), velocity: pair(), acceleration: pair() },)
}

#[test]
fn a_driven_body() {
    let mut other = Random::new(5);
    compare!(
        1,
        |random: &mut Random| Body1::new(
            Body {
                mass: random.uniform(0.5, 2.0),
                center: [random.uniform(-1.0, 1.0), 0.4],
                central: [0.2, 0.05, random.uniform(0.1, 0.3)]
            },
            0.3
        ),
        shaken(&mut other)
    );
}

#[test]
fn a_double_pendulum() {
    compare!(
        2,
        |random: &mut Random| Chain2::new(
            [random.uniform(0.5, 2.0), 1.0],
            [1.0, random.uniform(0.5, 2.0)]
        ),
        ()
    );
}

#[test]
fn a_driven_chain_by_dual_numbers() {
    let mut other = Random::new(5);
    compare!(
        5,
        |random: &mut Random| Chain5::new([random.uniform(0.5, 2.0); 5], [1.0; 5]),
        shaken(&mut other)
    );
}

#[test]
fn a_spring_in_space() {
    compare!(
        3,
        |random: &mut Random| Sphere::new(random.uniform(0.5, 2.0), 1.1, random.uniform(0.5, 2.0)),
        ()
    );
}
