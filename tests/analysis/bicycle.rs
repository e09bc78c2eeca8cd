//! The bicycle of the benchmark: J. P. Meijaard, J. M. Papadopoulos, A. Ruina and A. L. Schwab,
//! Linearized dynamics equations for the balance and steer of a bicycle: a benchmark and review,
//! Proceedings of the Royal Society A 463 (2007) 1955, table 1.

use nalgebra::{Matrix2, SMatrix};
use pendulum_runtime::analysis::state_space;
use pendulum_runtime::prelude::*;
use std::f64::consts::PI;

lagrangian! {
    /// Two wheels, a frame with a rider, and a fork; x is forward, y to the right, z downward. The
    /// wheels roll without slipping.
    #[derive(Clone, Debug)]
    pub struct Bicycle {
        m: [kg; 4], J: [kg*m^2; 3, 3], K: [kg*m^2; 3, 3], A: [kg*m^2; 2], B: [kg*m^2; 2],
        rider: [m; 3], fork: [m; 3], r: [m; 2], w: m, c: m, λ: rad, g: m/s^2 = 9.81,
    }
    coordinate x: [m; 3];
    coordinate F: rotation;
    coordinate δ: rad;
    coordinate ρ[2]: rad;
    let H = F*rotation([sin(λ), 0, cos(λ)], δ);
    let head = x + F*[w + c, 0, r[0]];
    let front = head + H*[-c, 0, -r[1]];
    let Ω = transpose(F)*angular_velocity(F);
    let Φ = transpose(H)*angular_velocity(H);
    let wheel(W, s, a, b) = a/2*(W.x^2 + W.z^2) + b/2*(W.y + s)^2;
    kinetic = m[0]/2*|ẋ|^2 + wheel(Ω, ρ̇[0], A[0], B[0]) + m[3]/2*|dot(front)|^2 + wheel(Φ, ρ̇[1], A[1], B[1])
        + m[1]/2*|dot(x + F*rider)|^2 + inner(Ω, J*Ω)/2 + m[2]/2*|dot(head + H*fork)|^2 + inner(Φ, K*Φ)/2;
    potential = -g*(m[0]*x.z + m[1]*height(x + F*rider) + m[2]*height(head + H*fork) + m[3]*height(front));
    let down(n) = ([0, 0, 1] - n.z*n)/sqrt(1 - n.z^2);
    let arm = r[0]*down(F*[0, 1, 0]);
    let reach = r[1]*down(H*[0, 1, 0]);
    constraint rear: x.z + arm.z = 0;
    constraint ahead: front.z + reach.z = 0;
    let slip = ẋ + cross(angular_velocity(F) + F*[0, ρ̇[0], 0], arm);
    let skid = dot(front) + cross(angular_velocity(H) + H*[0, ρ̇[1], 0], reach);
    constraint roll: [slip.x, slip.y] = [0, 0];
    constraint follow: [skid.x, skid.y] = [0, 0];
}

/// The eigenvalues of M q̈ + v C q̇ + (g K₀ + v² K₂) q = 0 with the matrices of the benchmark, whose
/// equations were derived by hand and by two other programs.
#[test]
fn a_bicycle_balances_as_in_the_benchmark() {
    let bicycle = Bicycle {
        m: [2.0, 85.0, 4.0, 3.0],
        J: [9.2, 11.0, 2.8, 0.0, 2.4, 0.0],
        K: [0.05892, 0.06, 0.00708, 0.0, -0.00756, 0.0],
        A: [0.0603, 0.1405],
        B: [0.12, 0.28],
        rider: [0.3, 0.0, -0.6],
        fork: [0.9 - 1.1, 0.0, -0.7],
        r: [0.3, 0.35],
        w: 1.02,
        c: 0.08,
        λ: PI / 10.0,
        g: 9.81,
    };
    let mass = Matrix2::new(80.81722, 2.31941332208709, 2.31941332208709, 0.29784188199686);
    let rest = Matrix2::new(-80.95, -2.59951685249872, -2.59951685249872, -0.80329488458618);
    let fast = Matrix2::new(0.0, 76.59734589573222, 0.0, 2.65431523794604);
    let turn = Matrix2::new(0.0, 33.86641391492494, -0.85035641456978, 1.68540397397560);
    let inverse = mass.try_inverse().unwrap();
    for v in [0.0, 5.0, 10.0] {
        let mut q = [0.0; 10];
        (q[2], q[3]) = (-0.3, 1.0);
        let mut speeds = [0.0; 10];
        (speeds[0], speeds[8], speeds[9]) = (v, -v / 0.3, -v / 0.35);
        let model = state_space(&bicycle, 0.0, &q, &speeds);
        let found = model.a.complex_eigenvalues();
        let mut companion = SMatrix::<f64, 4, 4>::zeros();
        companion.fixed_view_mut::<2, 2>(0, 2).fill_with_identity();
        let stiffness = -inverse * (9.81 * rest + v * v * fast);
        companion.fixed_view_mut::<2, 2>(2, 0).copy_from(&stiffness);
        companion.fixed_view_mut::<2, 2>(2, 2).copy_from(&(-inverse * turn * v));
        for known in companion.complex_eigenvalues().iter() {
            let off = found.iter().map(|own| (own - known).norm()).fold(f64::INFINITY, f64::min);
            assert!(off < 1e-10, "{known} at {v} m/s: {off:e}");
        }
        // What the table lists: weave, capsize and castering.
        if v == 5.0 {
            for known in [-14.07838969279822, -0.32286642900409] {
                assert!(found.iter().any(|own| (own.re - known).hypot(own.im) < 1e-10), "{known}");
            }
        }
    }
}
