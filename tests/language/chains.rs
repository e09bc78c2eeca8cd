//! Driven chains of N links, from Cartesian positions, compared with an independent form of their
//! equations.
//!
//! The accelerations of the bobs and the tensions of the rods give a tridiagonal system with one
//! equation for each rod: the rod keeps its length, and l θ̇² is the centripetal acceleration. This
//! form uses no Lagrangian.

use pendulum_runtime::motion::Sample;
use pendulum_runtime::prelude::*;

use systems::random::Random;

macro_rules! chain {
    ($name:ident, $n:literal) => {
        lagrangian! {
            #[derive(Clone, Debug)]
            pub struct $name { m: [kg; $n], l: [m; $n], g: m/s^2 = 9.81 }
            coordinate θ[$n]: rad;
            driven x: [m; 2];
            let y[k in 0..$n] = x + sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
            kinetic = sum(k in 0..$n, m[k]/2*|ẏ[k]|^2);
            potential = sum(k in 0..$n, m[k]*g*height(y[k]));
        }
    };
}

chain!(Chain1, 1);
chain!(Chain2, 2);
chain!(Chain3, 3);
chain!(Chain4, 4);
chain!(Chain5, 5);
chain!(Chain6, 6);
chain!(Chain7, 7);
chain!(Chain8, 8);
chain!(Chain9, 9);
chain!(Chain10, 10);
chain!(Chain16, 16);
chain!(Chain32, 32);

/// Returns θ̈ from the tensions: with e_i = (sin θ_i, −cos θ_i) along rod i and the pivot's
/// acceleration (a_x, a_y), T_1/m_1 − cos(θ_2 − θ_1) T_2/m_1 = l_1 θ̇_1² + (g + a_y) cos θ_1 − a_x
/// sin θ_1, and below (1/m_i + 1/m_{i−1}) T_i − cos(θ_i − θ_{i−1}) T_{i−1}/m_{i−1} − cos(θ_{i+1} −
/// θ_i) T_{i+1}/m_i = l_i θ̇_i².
fn by_tensions(m: &[f64], l: &[f64], g: f64, θ: &[f64], ω: &[f64], a: [f64; 2]) -> Vec<f64> {
    let n = m.len();
    let mut diagonal = vec![0.0; n];
    let mut above = vec![0.0; n];
    let mut below = vec![0.0; n];
    let mut tension = vec![0.0; n];
    for i in 0..n {
        diagonal[i] = 1.0 / m[i] + if 0 < i { 1.0 / m[i - 1] } else { 0.0 };
        tension[i] = l[i] * ω[i] * ω[i];
        if i == 0 {
            tension[0] += (g + a[1]) * θ[0].cos() - a[0] * θ[0].sin();
        } else {
            below[i] = -(θ[i] - θ[i - 1]).cos() / m[i - 1];
        }
        if i + 1 < n {
            above[i] = -(θ[i + 1] - θ[i]).cos() / m[i];
        }
    }
    for i in 1..n {
        let factor = below[i] / diagonal[i - 1];
        diagonal[i] -= factor * above[i - 1];
        tension[i] -= factor * tension[i - 1];
    }
    for i in (0..n).rev() {
        if i + 1 < n {
            tension[i] -= above[i] * tension[i + 1];
        }
        tension[i] /= diagonal[i];
    }
    (0..n)
        .map(|i| {
            let mut along =
                if i + 1 < n { tension[i + 1] * (θ[i + 1] - θ[i]).sin() / m[i] } else { 0.0 };
            along += if i == 0 {
                -(g + a[1]) * θ[0].sin() - a[0] * θ[0].cos()
            } else {
                tension[i - 1] * (θ[i - 1] - θ[i]).sin() / m[i - 1]
            };
            along / l[i]
        })
        .collect()
}

macro_rules! compare {
    ($($name:ident $n:literal),+) => {$({
        let mut random = Random::new($n);
        let mut worst = 0.0f64;
        for _ in 0..300 {
            let mut draw = |low: f64, high: f64| -> [f64; $n] { core::array::from_fn(|_| random.uniform(low, high)) };
            let (m, l, θ, ω) = (draw(0.5, 2.0), draw(0.5, 2.0), draw(-3.0, 3.0), draw(-2.0, 2.0));
            let a = [random.uniform(-10.0, 10.0), random.uniform(-10.0, 10.0)];
            let inputs = (Sample { position: [0.1, 0.2], velocity: [-1.0, 2.0], acceleration: a },);
            let found = $name::new(m, l).accelerations(At { t: 0.0, q: &θ, v: &ω, inputs: &inputs });
            let expected = by_tensions(&m, &l, 9.81, &θ, &ω, a);
            let scale = expected.iter().fold(1.0f64, |scale, value| scale.max(value.abs()));
            for (found, expected) in found.iter().zip(&expected) {
                worst = worst.max((found - expected).abs() / scale);
            }
        }
        println!("{} links: {worst:.1e}", $n);
        assert!(worst < 1e-12, "{} links: {worst}", $n);
    })+};
}

#[test]
fn chains_agree_with_the_tensions_of_their_rods() {
    compare!(Chain1 1, Chain2 2, Chain3 3, Chain4 4, Chain5 5, Chain6 6, Chain7 7, Chain8 8, Chain9 9, Chain10 10, Chain16 16, Chain32 32);
}
