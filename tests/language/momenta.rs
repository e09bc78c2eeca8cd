//! Velocities from momenta where the Lagrangian is not quadratic in them: relativistic particles up
//! to the speed of light.

use pendulum_runtime::error::Error;
use pendulum_runtime::motion::Curve;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Dual, Float, Lanes, Octet, Real};
use pendulum_runtime::system::System;

lagrangian! {
    /// A relativistic particle in a uniform field; lengths in light seconds.
    pub struct Relativistic { a: 1/s }
    coordinate x: s;
    lagrangian = -sqrt(1 - ẋ^2) + a*x;
}

lagrangian! {
    /// The same in space, with a potential that knows a direction.
    pub struct Space { m: kg, c: m/s, b: kg/s }
    coordinate x: m;
    coordinate y: m;
    coordinate z: m;
    lagrangian = -m*c^2*sqrt(1 - (ẋ^2 + ẏ^2 + ż^2)/c^2) + b*(x*ẏ - y*ẋ);
}

lagrangian! {
    /// A light and a heavy particle in the plane, on coordinates that mix them.
    pub struct Pair { m: [kg; 2], c: m/s }
    coordinate x[2]: m;
    coordinate y[2]: m;
    let a = [x[0], y[0]];
    let b = [x[0] + x[1], y[1] - y[0]];
    lagrangian = -m[0]*c^2*sqrt(1 - |ȧ|^2/c^2) - m[1]*c^2*sqrt(1 - |ḃ|^2/c^2);
}

lagrangian! {
    /// A momentum that no velocity makes greater than that of the pivot by one.
    pub struct Bounded { k: 1 }
    coordinate x: s;
    driven u: [s; 2];
    lagrangian = sqrt(1 + ẋ^2) + k*ẋ*u̇.x;
}

/// Returns the velocities for the momenta of `v`.
fn back<S: System<N, Inputs = ()>, const N: usize>(
    system: &S,
    q: [S::Scalar; N],
    v: [S::Scalar; N],
) -> [S::Scalar; N] {
    let t = S::Scalar::from_f64(0.0);
    system.velocities(t, &q, &system.momenta(At::of(t, &q, &v)), &())
}

/// The differences between the speed of light and the tested speeds, relative to the speed of
/// light.
const GAPS: [f64; 14] =
    [1.0, 0.999, 0.5, 0.3, 0.21, 0.19, 0.1, 0.01, 1e-3, 1e-4, 1e-5, 3e-6, 1e-6, 1e-7];

#[test]
fn a_particle_comes_back_from_its_momentum() {
    for gap in GAPS {
        for v in [1.0 - gap, gap - 1.0] {
            let [found] = back(&Relativistic::new(1.0), [0.3], [v]);
            assert!((found - v).abs() <= 2.0 * f64::EPSILON, "{v}: {found}, {:e}", found - v);
        }
    }
    for gap in &GAPS[..10] {
        let v = 1.0 - *gap as f32;
        let [found] = back(&Relativistic::<f32>::new(1.0), [0.3], [v]);
        assert!((found - v).abs() <= 2.0 * f32::EPSILON, "{v}: {found}");
    }
}

#[test]
fn two_words_go_further() {
    for exponent in 0..24 {
        let gap = DoubleDouble::from_f64(10.0_f64.powi(-exponent));
        let v = DoubleDouble::from_f64(1.0) - gap;
        let [found] =
            back(&Relativistic::<DoubleDouble>::new(DoubleDouble::from_f64(1.0)), [gap], [v]);
        let error = (found - v).abs().to_f64();
        assert!(error < 1e-30, "1e-{exponent}: {error:e}");
    }
}

#[test]
fn particles_in_space_come_back_in_any_units() {
    for (m, c) in [(1.0, 1.0), (9.1e-31, 299_792_458.0), (1e30, 1e-3)] {
        let system = Space::new(m, c, 0.3 * m * c);
        for gap in GAPS {
            let v = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0].map(|part| part * c * (1.0 - gap));
            let found = back(&system, [0.1, 0.2, 0.3], v);
            for i in 0..3 {
                assert!(
                    (found[i] - v[i]).abs() <= 16.0 * f64::EPSILON * c,
                    "{gap:e} of {c}: {found:?} for {v:?}"
                );
            }
        }
    }
}

#[test]
fn particles_of_different_masses_come_back() {
    for masses in [[1.0, 1.0], [1.0, 1836.0], [1e6, 1.0]] {
        let system = Pair::new(masses, 1.0);
        for first in GAPS {
            for second in GAPS {
                let [a, b] = [1.0 - first, 1.0 - second];
                // The velocities a·(0.6, −0.8) and b·(−0.8, 0.6).
                let v = [0.6 * a, -0.8 * b - 0.6 * a, -0.8 * a, 0.6 * b - 0.8 * a];
                let found = back(&system, [0.0; 4], v);
                // If both particles contribute to a momentum, its rounding error is that of the
                // larger contribution.
                let p = system.momenta(At::of(0.0, &[0.0; 4], &v));
                let share =
                    p.iter().fold(0.0, |most: f64, p| most.max(p.abs())) / masses[0].min(masses[1]);
                for i in 0..4 {
                    assert!(
                        (found[i] - v[i]).abs() <= 4.0 * f64::EPSILON * (1.0 + share),
                        "{first:e}, {second:e}: {found:?} for {v:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn lanes_have_the_bits_of_single_particles() {
    let alone = |p: f64| Relativistic::new(1.0).velocities(0.0, &[0.0], &[p], &())[0].to_bits();
    // Momenta of slow and fast particles, of a particle at rest, and an infinite momentum.
    let momenta = [0.0, 1e-9, 0.3, -1.7, 12.0, 707.0, f64::INFINITY, -3e5];
    let eight = Octet(momenta);
    let number = Octet::from_f64;
    let [found] = Relativistic::<Octet<f64>>::new(number(1.0)).velocities(
        number(0.0),
        &[number(0.0)],
        &[eight],
        &(),
    );
    for (lane, p) in found.0.iter().zip(momenta) {
        assert_eq!(lane.to_bits(), alone(p), "{p}: {lane}");
    }
    let four = Lanes([1.0, 2.0, -500.0, 0.25]);
    let number = Lanes::from_f64;
    let [found] = Relativistic::<Lanes<f64, 4>>::new(number(1.0)).velocities(
        number(0.0),
        &[number(0.0)],
        &[four],
        &(),
    );
    for (lane, p) in found.0.iter().zip(four.0) {
        assert_eq!(lane.to_bits(), alone(p), "{p}: {lane}");
    }
}

/// dv/dp = (1 + p²)^(−3/2), and its derivative −3p (1 + p²)^(−5/2).
#[test]
fn derivatives_come_with_the_velocities() {
    for p in [0.0, 0.1, 1.0, -3.0, 30.0, 700.0_f64] {
        let constant = |value| Dual::constant(Dual::constant(value));
        let system = Relativistic::<Dual<Dual<f64>>>::new(constant(1.0));
        let momentum = Dual { value: Dual::variable(p), derivative: Dual::constant(1.0) };
        let [v] = system.velocities(constant(0.0), &[constant(0.0)], &[momentum], &());
        let whole = 1.0 + p * p;
        let (first, second) = (whole.powf(-1.5), -3.0 * p * whole.powf(-2.5));
        let near =
            |found: f64, exact: f64| (found - exact).abs() <= 1e-14 * whole * exact.abs() + 1e-16;
        assert!((v.value.value - p / whole.sqrt()).abs() < 4e-16, "{p}: {v:?}");
        assert!(
            near(v.value.derivative, first) && near(v.derivative.value, first),
            "{p}: {v:?} and {first}"
        );
        assert!(near(v.derivative.derivative, second), "{p}: {v:?} and {second}");
    }
}

/// From rest, x = (√(1 + (a t)²) − 1)/a.
#[test]
fn a_long_fall_approaches_the_speed_of_light() {
    let fall = solve(&Relativistic::new(1.0), (0.0, 700.0), [0.0], [0.0])
        .method(Gauss::<4>::new())
        .steps(1400)
        .run()
        .unwrap();
    let whole = (1.0 + 700.0_f64.powi(2)).sqrt();
    let (x, v) = (fall.end.q[0], fall.end.v[0]);
    assert!((x - whole + 1.0).abs() < 1e-8 && (v - 700.0 / whole).abs() < 1e-15, "{x} and {v}");
}

#[test]
fn a_momentum_without_a_velocity_is_named() {
    // The pivot's velocity jumps by two at t = 1: the momentum of the particle would have to exceed
    // one.
    let keys = Curve::linear(&[0.0, 1.0, 2.0], &[[0.0, 0.0], [0.0, 0.0], [-2.0, 0.0]]).unwrap();
    let driven = Bounded::new(1.0).driven_by(keys);
    let failure = solve(&driven, (0.0, 2.0), [0.0], [0.5]).method(Dop853).run().unwrap_err();
    let Error::NoVelocity { t, coordinate } = failure.error else { panic!("{failure}") };
    assert_eq!((t, coordinate.name), (1.0, "x"));
    assert!(
        failure.to_string().contains("no velocity was found for the momentum of `x`"),
        "{failure}"
    );
    // A jump for which a velocity exists.
    let keys = Curve::linear(&[0.0, 1.0, 2.0], &[[0.0, 0.0], [0.0, 0.0], [-0.4, 0.0]]).unwrap();
    let end = solve(&Bounded::new(1.0).driven_by(keys), (0.0, 1.5), [0.0], [0.5])
        .method(Dop853)
        .run()
        .unwrap()
        .end;
    let p = 0.5 / 1.25_f64.sqrt() + 0.4;
    assert!((end.v[0] - p / (1.0 - p * p).sqrt()).abs() < 1e-12, "{end:?}");
}

lagrangian! {
    /// Momenta below `m` and below `n`, in coordinates that mix them.
    pub struct Ranges { m: 1, n: 1 }
    coordinate x: s;
    coordinate y: s;
    lagrangian = m*sqrt(1 + ẋ^2) + n*sqrt(1 + (ẋ + ẏ)^2);
}

/// Asserts that velocities exist only for momenta below one, up to their rounding.
fn momenta_end_at_their_limit<T: Float>(shares: &[f64]) {
    let (system, zero) = (Pushed::<T>::new(T::from_f64(0.0)), T::from_f64(0.0));
    for &share in shares {
        for sign in [1.0, -1.0] {
            let velocity = |p: f64| system.velocities(zero, &[zero], &[T::from_f64(p)], &())[0];
            let (beyond, within) =
                (velocity(sign * (1.0 + share)), velocity(sign * (1.0 - share)).to_f64());
            assert!(!beyond.is_finite(), "1 + {share:e}: {beyond:?}");
            let exact = sign * (1.0 - share) / (share * (2.0 - share)).sqrt();
            assert!((within / exact - 1.0).abs() < 0.01, "1 - {share:e}: {within} for {exact}");
        }
    }
}

#[test]
fn momenta_just_beyond_their_limit_have_no_velocities() {
    momenta_end_at_their_limit::<f32>(&[1e-4, 5e-4, 1e-3, 2e-3, 0.01, 0.1]);
    momenta_end_at_their_limit::<f64>(&[1e-12, 1e-9, 1e-4, 5e-4, 1e-3, 2e-3, 0.01, 0.1]);
    momenta_end_at_their_limit::<DoubleDouble>(&[1e-12, 1e-9, 1e-4, 1e-3, 0.01]);
    let number = Octet::from_f64;
    let momenta = [0.5, 1.0001, -1.002, 0.999, -0.25, 1.000_000_1, 1.01, 0.0];
    let p = [Octet(momenta), number(0.0)];
    let system = Ranges::<Octet<f64>>::new(number(1.0), number(1.0));
    let found = system.velocities(number(0.0), &[number(0.0); 2], &p, &())[0];
    for (v, p) in found.0.iter().zip(momenta) {
        assert_eq!(v.is_finite(), p.abs() < 1.0, "{p}: {v}");
    }
}

/// Tests momenta whose large terms cancel to a small value or to rounding errors.
#[test]
fn momenta_that_cancel_have_velocities() {
    for v in [1e-6_f64, 0.1, 1.0, 30.0, 1e3, 1e4] {
        for other in [0.0, -v, -2.0 * v, -2.0 * v * (1.0 + 1e-9), 1.0, 1e-12] {
            let found = back(&Ranges::new(1.0, 1.0), [0.0; 2], [v, other]);
            // The effect of a rounding error ε of the momentum: dv/dp = (1 + v²)^(3/2).
            let error = 1e-14 * (1.0 + v.max((v + other).abs())).powi(3);
            assert!(
                (found[0] - v).abs() < error && (found[1] - other).abs() < 2.0 * error,
                "{v}, {other}: {found:?}"
            );
        }
    }
}

/// Tests a force that increases the momentum beyond the range of velocities within an implicit
/// step.
#[test]
fn a_momentum_that_leaves_its_range_is_named() {
    let failure = solve(&Pushed::new(1.0), (0.0, 2.0), [0.0], [0.0])
        .method(Gauss::<2>::new())
        .step(0.01)
        .run()
        .unwrap_err();
    let Error::NoVelocity { t, coordinate } = failure.error else { panic!("{failure}") };
    assert!((t - 1.0).abs() < 0.02 && coordinate.name == "x", "{failure}");
}

lagrangian! {
    /// A momentum below one, and a force that makes it grow without end.
    pub struct Pushed { f: 1/s }
    coordinate x: s;
    lagrangian = sqrt(1 + ẋ^2) + f*x;
}
