//! Small oscillations of hanging chains: ω² = (g/l) times the zeros of the Laguerre polynomial L_N,
//! for every N.

use pendulum_runtime::analysis::linearize;
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::Jacobians;

macro_rules! chain {
    ($name:ident, $n:literal) => {
        lagrangian! {
            #[derive(Clone, Debug)]
            pub struct $name { m: [kg; $n], l: [m; $n], g: m/s^2 = 9.81 }
            coordinate θ[$n]: rad;
            let y[k in 0..$n] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
            kinetic = sum(k in 0..$n, m[k]/2*|ẏ[k]|^2);
            potential = sum(k in 0..$n, m[k]*g*height(y[k]));
        }
    };
}

chain!(Chain2, 2);
chain!(Chain3, 3);
chain!(Chain5, 5);
chain!(Chain10, 10);

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Damped { m, k, c }
    coordinate x;
    kinetic = m/2*ẋ^2;
    potential = k/2*x^2;
    dissipation = c/2*ẋ^2;
}

/// Compares the modes of a chain with the zeros of L_N, given with 18 digits.
fn check<S: Jacobians<N, Scalar = f64, Inputs = ()>, const N: usize>(chain: &S, zeros: [f64; N]) {
    let modes = linearize(chain, 0.0, &[0.0; N], &[0.0; N]).normal_modes().unwrap();
    for (found, zero) in modes.squared_frequencies.iter().zip(zeros) {
        let expected = 9.81 / 0.7 * zero;
        assert!((found - expected).abs() < 1e-12 * expected, "{found} for {expected}");
    }
}

#[test]
fn chains_vibrate_at_the_zeros_of_laguerre_polynomials() {
    check(&Chain2::new([1.3; 2], [0.7; 2]), [0.585786437626904951, 3.41421356237309505]);
    check(
        &Chain3::new([1.3; 3], [0.7; 3]),
        [0.415774556783479083, 2.29428036027904172, 6.2899450829374792],
    );
    check(
        &Chain5::new([1.3; 5], [0.7; 5]),
        [
            0.26356031971814091,
            1.41340305910651679,
            3.59642577104072208,
            7.08581000585883756,
            12.6408008442757827,
        ],
    );
    check(
        &Chain10::new([1.3; 10], [0.7; 10]),
        [
            0.137793470540492431,
            0.729454549503170498,
            1.80834290174031605,
            3.40143369785489951,
            5.55249614006380363,
            8.3301527467644967,
            11.8437858379000656,
            16.2792578313781021,
            21.996585811980762,
            29.9206970122738916,
        ],
    );
}

#[test]
fn shapes_are_normal_to_the_mass() {
    let linear =
        linearize(&Chain3::new([1.0, 2.0, 0.5], [1.0, 0.4, 0.8]), 0.0, &[0.0; 3], &[0.0; 3]);
    let modes = linear.normal_modes().unwrap();
    let product = modes.shapes.transpose() * linear.mass * &modes.shapes;
    for row in 0..3 {
        for column in 0..3 {
            assert!((product[(row, column)] - f64::from(u8::from(row == column))).abs() < 1e-13);
        }
    }
}

#[test]
fn an_upright_chain_is_unstable_and_damping_is_found() {
    let upright =
        linearize(&Chain2::new([1.0; 2], [1.0; 2]), 0.0, &[core::f64::consts::PI; 2], &[0.0; 2]);
    assert!(upright.normal_modes().unwrap().squared_frequencies.iter().all(|&square| square < 0.0));
    let damped = linearize(&Damped::new(2.0, 3.0, 0.5), 0.0, &[0.0], &[0.0]);
    assert_eq!((damped.mass[0], damped.damping[0], damped.stiffness[0]), (2.0, 0.5, 3.0));
    let massless = linearize(&Damped::new(0.0, 3.0, 0.5), 0.0, &[0.0], &[0.0]);
    assert!(massless.normal_modes().is_err());
}
