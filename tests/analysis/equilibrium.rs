//! Equilibria in closed form, and searches that cannot succeed.

use pendulum_runtime::analysis::{EquilibriumFailure, equilibrium, linearize};
use pendulum_runtime::motion::Function;

mod blocks {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        pub struct Double { m: [kg; 2], l: [m; 2], g: m/s^2 = 9.81 }
        coordinate θ[2]: rad;
        let y[k in 0..2] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
        kinetic = sum(k in 0..2, m[k]/2*|ẏ[k]|^2);
        potential = sum(k in 0..2, m[k]*g*height(y[k]));
    }

    lagrangian! {
        /// A pole on a cart that may stand anywhere.
        pub struct CartPole { M: kg, m: kg, L: m, g: m/s^2 = 9.81 }
        coordinate s: m;
        coordinate θ: rad;
        let tip = [s, 0] + L*[sin(θ), cos(θ)];
        kinetic = M/2*ṡ^2 + m/2*|dot(tip)|^2;
        potential = m*g*height(tip);
    }

    lagrangian! {
        /// A weight on a spring, and one that falls.
        pub struct Weights { k: N/m, m: kg, g: m/s^2 = 9.81 }
        coordinate x: m;
        coordinate z: m;
        kinetic = m/2*(ẋ^2 + ż^2);
        potential = k/2*x^2 + m*g*(x + z);
    }

    lagrangian! {
        /// x⁴ has no stiffness where it rests.
        pub struct Quartic { k }
        coordinate x;
        kinetic = ẋ^2/2;
        potential = k*x^4/4;
    }

    lagrangian! {
        /// A force that falls and never vanishes.
        pub struct Runaway { k }
        coordinate x;
        kinetic = ẋ^2/2;
        force x = k/(1 + x^2);
    }

    lagrangian! {
        pub struct Root { k }
        coordinate x;
        kinetic = ẋ^2/2;
        potential = k*(x - ln(x));
    }

    lagrangian! {
        /// A pendulum on a pivot that is accelerated.
        pub struct Bob { L: m, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        driven x: [m; 2];
        let y = x + L*[sin(θ), -cos(θ)];
        kinetic = |ẏ|^2/2;
        potential = g*height(y);
    }

    lagrangian! {
        /// An arm with a motor in its joint.
        #[derive(Clone)]
        pub struct Arm { m: kg, L: m, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        input τ: N*m;
        let y = L*[sin(θ), -cos(θ)];
        kinetic = m/2*|ẏ|^2;
        potential = m*g*height(y);
        force θ = τ;
    }

    lagrangian! {
        /// Masses in a line, on springs that pull against a weight each.
        pub struct Line { k: N/m, m: kg, g: m/s^2 = 9.81 }
        coordinate x[4]: m;
        kinetic = sum(i in 0..4, m/2*ẋ[i]^2);
        potential = k/2*x[0]^2 + sum(i in 1..4, k/2*(x[i] - x[i-1])^2) - sum(i in 0..4, m*g*x[i]);
    }
}

use blocks::*;

#[test]
fn every_equilibrium_of_a_double_pendulum_is_found_from_nearby() {
    let double = Double::new([1.0, 0.7], [0.6, 0.4]);
    let pi = std::f64::consts::PI;
    for exact in [[0.0, 0.0], [0.0, pi], [pi, 0.0], [pi, pi], [-pi, 2.0 * pi]] {
        let q = equilibrium(&double, 0.0, [exact[0] + 0.2, exact[1] - 0.3]).unwrap();
        for i in 0..2 {
            assert!((q[i] - exact[i]).abs() < 1e-14, "{q:?} for {exact:?}");
        }
    }
}

#[test]
fn hanging_weights_stretch_springs_as_statics_says() {
    let line = Line::new(50.0, 0.3);
    let q = equilibrium(&line, 0.0, [0.0; 4]).unwrap();
    // The spring above mass i carries all masses below.
    let mut x = 0.0;
    for i in 0..4 {
        x += (4 - i) as f64 * 0.3 * 9.81 / 50.0;
        assert!((q[i] - x).abs() < 1e-14, "{q:?}");
    }
}

#[test]
fn a_cart_stays_where_it_is() {
    let pole = CartPole::new(2.0, 0.3, 0.5);
    let q = equilibrium(&pole, 0.0, [0.7, 0.4]).unwrap();
    // The shortest path to rest also moves the cart, so that M q̈ vanishes; every position of the
    // cart is an equilibrium.
    assert!(q[1].abs() < 1e-14 && (q[0] - 0.7).abs() < 1.0, "{q:?}");
    let q = equilibrium(&pole, 0.0, [0.7, 3.0]).unwrap();
    assert!((q[1] - std::f64::consts::PI).abs() < 1e-14, "{q:?}");
}

#[test]
fn a_pendulum_leans_on_an_accelerated_pivot() {
    // The horizontal position is 2 t² to the left: the bob hangs along g − ẍ.
    let pivot = Function::new(|t: f64| [-2.0 * t * t, 0.0])
        .velocity(|t: f64| [-4.0 * t, 0.0])
        .acceleration(|_: f64| [-4.0, 0.0]);
    let bob = Bob::new(0.4).driven_by(pivot);
    let q = equilibrium(&bob, 3.0, [0.1]).unwrap();
    assert!((q[0] - (4.0_f64 / 9.81).atan()).abs() < 1e-15, "{q:?}");
}

#[test]
fn a_motor_holds_an_arm_where_its_torque_balances_the_weight() {
    let arm = Arm::new(2.0, 0.5);
    let weight = 2.0 * 9.81 * 0.5;
    let held = arm.clone().controlled_by(|_, _, _| 3.0);
    let q = equilibrium(&held, 0.0, [0.1]).unwrap();
    assert!((q[0].sin() - 3.0 / weight).abs() < 1e-15, "{q:?}");
    // A spring by feedback: m g L sin θ = 8 (1 − θ), whose derivative is part of Newton's step.
    let sprung = arm.controlled_by(|_, q: &[f64; 1], v: &[f64; 1]| 8.0 * (1.0 - q[0]) - v[0]);
    let q = equilibrium(&sprung, 0.0, [0.1]).unwrap();
    assert!((weight * q[0].sin() - 8.0 * (1.0 - q[0])).abs() < 1e-14, "{q:?}");
}

#[test]
fn a_flat_bottom_is_approached_in_many_steps() {
    let q = equilibrium(&Quartic::new(3.0), 0.0, [1.0]).unwrap();
    assert!(q[0].abs() < 1e-4, "{q:?}");
}

#[test]
fn steps_that_leave_the_domain_are_halved() {
    // 1/x − 1: Newton's step from 5 leads to −15, where the equations have no finite acceleration.
    let q = equilibrium(&Root::new(2.0), 0.0, [5.0]).unwrap();
    assert!((q[0] - 1.0).abs() < 1e-14, "{q:?}");
}

#[test]
fn a_weight_that_nothing_holds_is_named() {
    let error = equilibrium(&Weights::new(40.0, 0.5), 2.0, [0.0, 1.0]).unwrap_err();
    assert_eq!(error.reason, EquilibriumFailure::NoRestoringForce);
    assert_eq!((error.coordinate.name, error.guess, error.t), ("z", [0.0, 1.0], 2.0));
    assert!((error.acceleration + 9.81).abs() < 1e-12);
    // The other weight is at rest.
    assert!((error.q[0] + 0.5 * 9.81 / 40.0).abs() < 1e-12, "{error}");
    let message = error.to_string();
    assert!(
        message.starts_with("at t = 2 nothing balances the acceleration -9.81e0 of `z` near ["),
        "{message}"
    );
}

#[test]
fn a_search_without_an_end_says_so() {
    let error = equilibrium(&Runaway::new(1.0), 0.0, [0.5]).unwrap_err();
    assert_eq!(error.reason, EquilibriumFailure::Slow);
    assert!(1e30 < error.q[0], "{error}");
    let message = error.to_string();
    assert!(message.starts_with("at t = 0 the search from [0.5] came to ["), "{message}");
    assert!(message.ends_with("guess nearer to the equilibrium"), "{message}");
    assert_eq!(error.guess, [0.5]);

    for guess in [f64::NAN, f64::INFINITY, 0.0] {
        let error = equilibrium(&Root::new(1.0), 0.0, [guess]).unwrap_err();
        assert_eq!(error.reason, EquilibriumFailure::NotFinite);
        assert!(error.to_string().contains("`x`"), "{error}");
    }
}

#[test]
fn a_stiffness_that_vanishes_at_the_guess_is_no_obstacle() {
    // At a right angle the stiffness of a pendulum is zero.
    let bob = Bob::new(0.4).driven_by(pendulum_runtime::motion::Still::new([0.0, 0.0]));
    let q = equilibrium(&bob, 0.0, [std::f64::consts::FRAC_PI_2]).unwrap();
    assert!(q[0].sin().abs() < 1e-14, "{q:?}");
    assert!(linearize(&bob, 0.0, &q, &[0.0]).stiffness[(0, 0)].abs() > 1.0);
}
