//! Derivatives of motions and Lyapunov exponents of rotations and of constrained motions, against
//! Euler angles, differences of neighbouring motions and closed forms.

use nalgebra::SMatrix;
use pendulum_runtime::analysis::{LyapunovSpectrum, Variational, lyapunov, variational_size};
use pendulum_runtime::motion::{Sinusoid, Turning};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Dual;

pub(crate) mod blocks {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        /// A damped body between two leaning rests, pushed by a torque.
        #[derive(Clone)]
        pub struct Turned { J: [1; 3], g, k, s, c, A, Ω }
        coordinate R: rotation;
        let ω = transpose(R)*angular_velocity(R);
        let up = R*[0, 0, 1];
        kinetic = (J.x*ω.x^2 + J.y*ω.y^2 + J.z*ω.z^2)/2;
        potential = g*up.z + k*(up.x^2 - s^2)^2 + k*(up.y^2 + height(R*[1, 0, 0])^2)/2;
        dissipation = c/2*|ω|^2;
        torque R = [0, A*sin(Ω*t), 0];
    }

    lagrangian! {
        /// The same body, by heading, climb and bank.
        #[derive(Clone)]
        pub struct Angled { J: [1; 3], g, k, s, c, A, Ω }
        coordinate φ[3];
        let R = rotation([0, 0, 1], φ[0])*rotation([0, 1, 0], φ[1])*rotation([1, 0, 0], φ[2]);
        let ω = transpose(R)*angular_velocity(R);
        let up = R*[0, 0, 1];
        kinetic = (J.x*ω.x^2 + J.y*ω.y^2 + J.z*ω.z^2)/2;
        potential = g*up.z + k*(up.x^2 - s^2)^2 + k*(up.y^2 + height(R*[1, 0, 0])^2)/2;
        dissipation = c/2*|ω|^2;
        torque R = [0, A*sin(Ω*t), 0];
    }

    lagrangian! {
        /// A body on a ball joint that turns with a parent, and a bone that hangs from it.
        #[derive(Clone)]
        pub struct Bones { J: [1; 3], m, l, k, g }
        driven P: rotation;
        coordinate R: rotation;
        coordinate S: rotation;
        let ω = transpose(R)*angular_velocity(R);
        let bob = R*[0, 0, -1] + l*(S*[0, 0, -1]);
        kinetic = (J.x*ω.x^2 + J.y*ω.y^2 + J.z*ω.z^2)/2 + m/2*|dot(bob)|^2 + m*l^2*|angular_velocity(S)|^2/9;
        potential = g*m*height(bob) - k*inner(R*[1, 0, 0], P*[1, 0, 0]) - k*inner(R*[1, 0, 0], S*[1, 0, 0]);
    }

    lagrangian! {
        #[derive(Clone)]
        pub struct Bob { L, g }
        coordinate p: [1; 2];
        kinetic = |ṗ|^2/2;
        potential = g*p.y;
        constraint rod: |p| = L;
    }

    lagrangian! {
        #[derive(Clone)]
        pub struct Angle { L, g }
        coordinate θ;
        kinetic = L^2*θ̇^2/2;
        potential = -g*L*cos(θ);
    }

    lagrangian! {
        /// Chaplygin's sleigh: a knife edge at `p`, a mass ahead of it.
        #[derive(Clone)]
        pub struct Sleigh { m, I, a }
        coordinate p: [1; 2];
        coordinate φ;
        kinetic = m/2*|dot(p + a*[cos(φ), sin(φ)])|^2 + I*φ̇^2/2;
        constraint edge: ṗ.y*cos(φ) = ṗ.x*sin(φ);
    }
}

use blocks::*;

const TURNED: usize = variational_size(4, 7);
const ANGLED: usize = variational_size(3, 7);

fn turned() -> Turned {
    Turned::new([1.0, 1.2, 0.7], 0.3, 6.0, 0.5, 0.1, 1.0, 3.0)
}

fn angled() -> Angled {
    Angled::new([1.0, 1.2, 0.7], 0.3, 6.0, 0.5, 0.1, 1.0, 3.0)
}

/// Returns the quaternion of angles, followed by its rates.
fn chart<T: Real>(x: [T; 6]) -> [T; 8] {
    let angle = |i: usize| Dual { value: x[i], derivative: x[i + 3] };
    let turn = Attitude::from_euler("zyx", [angle(0), angle(1), angle(2)]).unwrap();
    let all = turn.to_quaternion();
    core::array::from_fn(|i| if i < 4 { all[i].value } else { all[i - 4].derivative })
}

/// Returns the derivatives of [`chart`].
fn tangent(x: [f64; 6]) -> SMatrix<f64, 8, 6> {
    SMatrix::from_fn(|row, column| {
        let seeds = core::array::from_fn(|i| {
            if i == column { Dual::variable(x[i]) } else { Dual::constant(x[i]) }
        });
        chart(seeds)[row].derivative
    })
}

fn joined<const N: usize, const M: usize>(q: &[f64; N], v: &[f64; N]) -> [f64; M] {
    core::array::from_fn(|i| if i < N { q[i] } else { v[i - N] })
}

fn halves<const N: usize, const M: usize>(all: [f64; M]) -> ([f64; N], [f64; N]) {
    (core::array::from_fn(|i| all[i]), core::array::from_fn(|i| all[N + i]))
}

#[test]
fn columns_of_a_rotation_are_those_of_its_euler_angles() {
    let start = [0.3, 0.5, -0.2, 0.4, -0.7, 0.9];
    let by_angles = Variational::<_, 3, ANGLED>::new(angled());
    let by_turn = Variational::<_, 4, TURNED>::new(turned());
    let ((a, w), (q, v)) = (halves(start), halves(chart(start)));
    let (a, w) = by_angles.start(a, w);
    let (first_q, first_v) = by_turn.start(q, v);
    let a = solve(&by_angles, (0.0, 4.0), a, w).method(Picard).rtol(1e-13).run().unwrap().end;
    let end =
        solve(&by_turn, (0.0, 4.0), first_q, first_v).method(Picard).rtol(1e-13).run().unwrap().end;

    let last = by_angles.state(&a);
    let own = by_turn.state(&end);
    let expected = chart(joined(&last.q, &last.v));
    let sign = own.q[0].signum() * expected[0].signum();
    for (found, expected) in joined::<4, 8>(&own.q, &own.v).iter().zip(expected) {
        assert!((found - sign * expected).abs() < 1e-11, "{found} instead of {expected}");
    }
    let outer = sign * tangent(joined(&last.q, &last.v));
    let expected = outer * by_angles.transition(&a);
    let found = by_turn.transition(&end) * tangent(start);
    assert!((&found - &expected).amax() < 1e-10 * expected.amax(), "{found} {expected}");
    assert!(1.0 < expected.amax());
    for index in 0..7 {
        let (x, y) = by_angles.by_parameter(&a, index);
        let expected = outer * SMatrix::<f64, 6, 1>::from(joined::<3, 6>(&x, &y));
        let (q, v) = by_turn.by_parameter(&end, index);
        for (found, expected) in joined::<4, 8>(&q, &v).iter().zip(expected.iter()) {
            assert!((found - expected).abs() < 1e-10, "{found} instead of {expected}");
        }
    }
    // Every column is tangent to |q| = 1 and to q·q̇ = 0, at the start to rounding.
    let off = |q: &[f64; TURNED], v: &[f64; TURNED], within: f64| {
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        for index in 1..TURNED / 4 {
            let [a, b] = [q, v].map(|all| &all[4 * index..][..4]);
            let across = product(&q[..4], a);
            let rate = product(&q[..4], b) + product(&v[..4], a);
            assert!(across.abs() < within && rate.abs() < within, "{index}: {across:e} {rate:e}");
        }
    };
    off(&first_q, &first_v, 1e-15);
    off(&end.q, &end.v, 1e-11);

    // Along dense output, by name.
    let run = solve(&turned(), (0.0, 4.0), q, v).rtol(1e-13).dense().run().unwrap();
    let names = ["J.y", "c", "R.x", "Ṙ.z"];
    let columns = run.sensitivities(&turned(), names).unwrap();
    let known = [
        by_turn.by_parameter(&end, 1),
        by_turn.by_parameter(&end, 6),
        by_turn.by_position(&end, 1),
        by_turn.by_velocity(&end, 3),
    ];
    for ((column, (q, v)), name) in columns.iter().zip(known).zip(names) {
        let last = column.last().unwrap();
        for (found, expected) in joined::<4, 8>(&last.q, &last.v).iter().zip(joined::<4, 8>(&q, &v))
        {
            assert!((found - expected).abs() < 1e-10, "{name}: {found} instead of {expected}");
        }
    }
}

#[test]
fn columns_of_a_rotation_are_differences_of_motions() {
    let start = [0.3, 0.5, -0.2, 0.4, -0.7, 0.9];
    let end = |start: [f64; 6]| {
        let (q, v) = halves::<4, 8>(chart(start));
        let end = solve(&turned(), (0.0, 4.0), q, v).rtol(1e-12).run().unwrap().end;
        SMatrix::<f64, 8, 1>::from(joined(&end.q, &end.v))
    };
    let by_turn = Variational::<_, 4, TURNED>::new(turned());
    let (q, v) = halves(chart(start));
    let (q, v) = by_turn.start(q, v);
    let last = solve(&by_turn, (0.0, 4.0), q, v).method(Dop853).rtol(1e-12).run().unwrap().end;
    let found = by_turn.transition(&last) * tangent(start);
    for index in 0..6 {
        let h = 1e-4;
        let moved = |by: f64| {
            let mut start = start;
            start[index] += by;
            end(start)
        };
        // Of fourth order.
        let near = (moved(h) - moved(-h)) / (2.0 * h);
        let far = (moved(2.0 * h) - moved(-2.0 * h)) / (4.0 * h);
        let expected = (4.0 * near - far) / 3.0;
        let off = (found.column(index) - expected).amax();
        assert!(off < 2e-8, "{index}: {off:e}");
    }
}

#[test]
fn two_ways_to_columns_agree_under_a_parent_that_turns() {
    // A step with 184 coordinates, unoptimized, needs more stack than threads of tests have.
    let thread = std::thread::Builder::new().stack_size(1 << 24).spawn(two_ways_to_columns);
    thread.unwrap().join().unwrap();
}

fn two_ways_to_columns() {
    const M: usize = variational_size(8, 6);
    let bones = Bones::new([0.5, 0.7, 0.4], 0.8, 0.6, 2.0, 3.0);
    let parent = Turning::new([1.0, 0.5, 2.0], Sinusoid::new([0.8], 3.0, [0.2]));
    let tilted = Attitude::from_axis_angle([1.0, -0.4, 0.2], 0.7);
    let start = Bones::start().R(tilted, Rates::body([0.3, 1.0, -0.5]));
    let by_start = Variational::<_, 8, M>::new(bones.clone());
    let (q, v) = by_start.start(start.q, start.v);
    let varied = Driven::new(by_start, (parent.clone(),));
    let end = solve(&varied, (0.0, 2.0), q, v).method(Dop853).rtol(1e-12).run().unwrap().end;
    let bones = bones.driven_by(parent);
    let run = solve(&bones, (0.0, 2.0), start.q, start.v).method(Dop853).rtol(1e-12).dense();
    let names = ["J.y", "l", "R.y", "S.z"];
    let columns = run.run().unwrap().sensitivities(&bones, names).unwrap();
    let by_start = &varied.system;
    let known = [
        by_start.by_parameter(&end, 1),
        by_start.by_parameter(&end, 4),
        by_start.by_position(&end, 2),
        by_start.by_position(&end, 7),
    ];
    for ((column, (q, v)), name) in columns.iter().zip(known).zip(names) {
        let last = column.last().unwrap();
        let size = joined::<8, 16>(&q, &v).iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        assert!(0.05 < size, "{name}");
        for (found, expected) in
            joined::<8, 16>(&last.q, &last.v).iter().zip(joined::<8, 16>(&q, &v))
        {
            assert!((found - expected).abs() < 1e-9 * size, "{name}: {found} and {expected}");
        }
    }
}

/// Asserts that all exponents vanish, and that their sum does to rounding.
fn regular(spectrum: &LyapunovSpectrum, within: f64) {
    assert_eq!(spectrum.exponents.len(), 6);
    assert!(spectrum.exponents.iter().all(|exponent| exponent.abs() < within), "{spectrum}");
    assert!(spectrum.sum().abs() < 1e-9, "{:e}", spectrum.sum());
}

const FREE: usize = variational_size(4, 0);

#[test]
fn a_free_body_and_a_fast_top_have_no_exponent() {
    // Neighbours part in proportion to the time, so that exponents fall as ln T/T.
    let turn = Attitude::from_euler("zxz", [0.2, 0.5, 1.0]).unwrap();
    let start = |rates| (turn.to_quaternion(), Rates::body(rates).derivative(turn));
    let free =
        Variational::<_, 4, FREE>::new(Turned::new([1.0, 1.7, 2.2], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0));
    let (q, v) = start([0.9, 0.5, -0.6]);
    regular(&lyapunov(&free, 0.0, q, v).transient(60.0).interval(2.0).run(140.0).unwrap(), 0.03);
    let top =
        Variational::<_, 4, FREE>::new(Turned::new([1.0, 1.0, 0.4], 2.0, 0.0, 0.0, 0.0, 0.0, 0.0));
    let (q, v) = start([0.1, 0.2, 9.0]);
    regular(&lyapunov(&top, 0.0, q, v).transient(60.0).run(120.0).unwrap(), 0.03);
}

#[test]
fn a_driven_body_has_the_exponents_of_its_euler_angles() {
    let by_turn = Variational::<_, 4, FREE>::new(turned());
    let by_angles = Variational::<_, 3, { variational_size(3, 0) }>::new(angled());
    let start = [0.0, 0.2, 0.1, 0.0, 0.3, 0.1];
    let (q, v) = halves(chart(start));
    let turned = lyapunov(&by_turn, 0.0, q, v).transient(50.0).rtol(1e-9).run(300.0).unwrap();
    let (q, v) = halves(start);
    let angled = lyapunov(&by_angles, 0.0, q, v).transient(50.0).rtol(1e-9).run(300.0).unwrap();
    // The damping c contracts all volumes by exp(−c tr J⁻¹ t).
    let sum = -0.1 * (1.0 + 1.0 / 1.2 + 1.0 / 0.7);
    assert!((turned.sum() - sum).abs() < 1e-7 && (angled.sum() - sum).abs() < 1e-7);
    for index in 0..6 {
        let off = turned.exponents[index] - angled.exponents[index];
        let error = turned.standard_errors[index].hypot(angled.standard_errors[index]);
        assert!(off.abs() < 4.0 * error, "{turned}\n{angled}");
    }
    assert!(5.0 * turned.standard_errors[0] < turned.exponents[0], "{turned}");
}

#[test]
fn constrained_motions_have_two_exponents_for_each_degree_of_freedom() {
    // At the top of its circle, a bob leaves as exp(√(g/L) t).
    let bob = Variational::<_, 2, { variational_size(2, 0) }>::new(Bob::new(2.0, 8.0));
    let spectrum = lyapunov(&bob, 0.0, [0.0, 2.0], [0.0; 2]).transient(8.0).run(4.0).unwrap();
    assert_eq!(spectrum.exponents.len(), 2);
    assert!((spectrum.exponents[0] - 2.0).abs() < 1e-9, "{spectrum}");
    assert!((spectrum.exponents[1] + 2.0).abs() < 1e-9, "{spectrum}");
    // A sleigh that glides straight on: turns die out as exp(−m a u t/(I + m a²)), four directions
    // are indifferent.
    let sleigh = Variational::<_, 3, { variational_size(3, 0) }>::new(Sleigh::new(2.0, 1.5, 0.5));
    let v = [1.2, 1.6, 0.0];
    let run = lyapunov(&sleigh, 0.0, [0.0, 0.0, (1.6_f64).atan2(1.2)], v).transient(200.0);
    let spectrum = run.run(200.0).unwrap();
    assert_eq!(spectrum.exponents.len(), 5);
    assert!((spectrum.exponents[4] + 1.0).abs() < 1e-6, "{spectrum}");
    assert!(spectrum.exponents[..4].iter().all(|exponent| exponent.abs() < 0.01), "{spectrum}");
}

#[test]
fn columns_of_a_bob_on_a_rod_are_those_of_its_angle() {
    const M: usize = variational_size(2, 2);
    let bob = Variational::<_, 2, M>::new(Bob::new(2.0, 9.0));
    let by_angle = Variational::<_, 1, { variational_size(1, 2) }>::new(Angle::new(2.0, 9.0));
    let (θ, ω) = (0.8_f64, -0.6);
    let place = |[θ, ω, l]: [f64; 3]| [l * θ.sin(), -l * θ.cos(), l * ω * θ.cos(), l * ω * θ.sin()];
    // The derivatives of a place by the angle, its rate and the length.
    let slopes = |[θ, ω, l]: [f64; 3]| {
        let (s, c) = θ.sin_cos();
        let rows = [
            [l * c, 0.0, s],
            [l * s, 0.0, -c],
            [-l * ω * s, l * c, ω * c],
            [l * ω * c, l * s, ω * s],
        ];
        SMatrix::<f64, 4, 3>::from_fn(|row, column| rows[row][column])
    };
    let (q, v) = halves(place([θ, ω, 2.0]));
    let (q, v) = bob.start(q, v);
    let end = solve(&bob, (0.0, 3.0), q, v).method(Picard).rtol(1e-13).run().unwrap().end;
    let (a, w) = by_angle.start([θ], [ω]);
    let last = solve(&by_angle, (0.0, 3.0), a, w).method(Picard).rtol(1e-13).run().unwrap().end;
    let outer = slopes([last.q[0], last.v[0], 2.0]);
    let inner = slopes([θ, ω, 2.0]).fixed_columns::<2>(0).into_owned();
    let expected = outer.fixed_columns::<2>(0) * by_angle.transition(&last);
    let found = bob.transition(&end) * inner;
    assert!((&found - &expected).amax() < 1e-10, "{found} {expected}");
    // By the length: the start moves along the rod, and keeps the angle and the speed across it.
    let (q, v) = bob.by_parameter(&end, 0);
    let by_length = by_angle.by_parameter(&last, 0);
    let by_rate = by_angle.by_velocity(&last, 0);
    // The speed L ω stays, so that ω falls by ω/L.
    let change =
        [by_length.0[0] - by_rate.0[0] * ω / 2.0, by_length.1[0] - by_rate.1[0] * ω / 2.0, 1.0];
    let expected = outer * SMatrix::<f64, 3, 1>::from(change);
    for (found, expected) in joined::<2, 4>(&q, &v).iter().zip(expected.iter()) {
        assert!((found - expected).abs() < 1e-10, "{found} instead of {expected}");
    }
}
