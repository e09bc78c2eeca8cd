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

fn bicycle() -> Bicycle {
    Bicycle {
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
    }
}

/// The eigenvalues of M q̈ + v C q̇ + (g K₀ + v² K₂) q = 0 with the matrices of the benchmark,
/// whose equations were derived by hand and by two other programs.
#[test]
fn a_bicycle_balances_as_in_the_benchmark() {
    let bicycle = bicycle();
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

/// A push of 0.5 rad/s to the side at 4.6 m/s, where weave and capsize die out. The states are
/// printed by `tests/data/bicycle.py`: Newton's and Euler's equations of four bodies, whose two
/// tolerances agree to 3e-13.
#[test]
fn a_pushed_bicycle_moves_as_by_newton_and_euler() {
    let (bicycle, mut q, mut v) = (bicycle(), [0.0; 10], [0.0; 10]);
    (q[2], q[3]) = (-0.3, 1.0);
    (v[0], v[1], v[4], v[8], v[9]) = (4.6, 0.15, 0.25, -4.6 / 0.3, -4.6 / 0.35);
    // The rear hub, the quaternion of the frame, and the steering angle with its rate.
    let known = [
        [
            4.5459952880769,
            0.77597434836395,
            -0.29974425879214,
            0.98894581706621,
            -0.020411255929071,
            -0.0031017644322315,
            0.14683300240766,
            -0.039988487002542,
            -0.3224040101815,
        ],
        [
            9.0856383846349,
            1.6499436811242,
            -0.29952668202357,
            0.9949714108526,
            0.027971260959443,
            0.0025486106444744,
            0.09614054675378,
            0.0630973190837,
            0.046373883594289,
        ],
        [
            13.574530261967,
            2.7612632026121,
            -0.29993113443525,
            0.9945970995958,
            -0.010652460900669,
            -0.0011411606330361,
            0.10325614899265,
            -0.035103896987934,
            0.087359657674639,
        ],
    ];
    let run = solve(&bicycle, (0.0, 3.0), q, v)
        .method(Dop853)
        .rtol(1e-12)
        .t_eval(&[1.0, 2.0, 3.0])
        .run()
        .unwrap();
    for (state, known) in run.iter().zip(known) {
        for index in 0..9 {
            let found = if index < 8 { state.q[index] } else { state.v[7] };
            let off = found - known[index];
            assert!(off.abs() < 1e-9, "{index} at {} s: off by {off:e}", state.t);
        }
    }
}
