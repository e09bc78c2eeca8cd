//! Sensitivities along the dense output of a run, compared with published digits, closed forms, the
//! variational equations and the same motion in other coordinates.

use pendulum_runtime::analysis::{Variational, variational_size};
use pendulum_runtime::integrate::{Event, Solution, State};
use pendulum_runtime::motion::{Curve, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::Driven;

use crate::exponents::blocks::Damped;
use crate::variational::blocks::{Forced, Hung};

lagrangian! {
    pub struct Swing { L, g }
    coordinate θ;
    kinetic = L^2*θ̇^2/2;
    potential = -g*L*cos(θ);
}

lagrangian! {
    /// The bob of a swing, held by its rod.
    pub struct Bob { L, g }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*y;
    constraint rod: x^2 + y^2 = L^2;
}

lagrangian! {
    pub struct Arm { b, g }
    coordinate θ;
    input τ;
    kinetic = θ̇^2/2;
    potential = -g*cos(θ);
    dissipation = b*θ̇^2/2;
    force θ = τ;
}

lagrangian! {
    /// A mass on a spring that is stiffer on one side.
    pub struct Sided { k, F }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k*x^2/2;
    force x = -F*min(x, 0);
}

lagrangian! {
    pub struct Reversed { F, w }
    coordinate x;
    kinetic = ẋ^2/2;
    force x = F*sign(cos(w*t));
}

lagrangian! {
    pub struct Rough { k, F }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k*x^2/2;
    force x = -F*sign(ẋ);
}

lagrangian! {
    pub struct Wells { k, c }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k*min((x - 1)^2, (x + 1)^2)/2 + c*x;
}

lagrangian! {
    /// A push that ends where the mass passes a moving place.
    pub struct Step { c, F }
    coordinate x;
    driven u;
    kinetic = ẋ^2/2;
    potential = x^2/8;
    force x = F*sign(c + u - x);
}

lagrangian! {
    #[derive(Clone)]
    pub struct Belt { F }
    coordinate x;
    driven u;
    kinetic = ẋ^2/2;
    potential = x^2/2;
    force x = -F*sign(ẋ - u̇);
}

lagrangian! {
    pub struct Twice { F, d }
    coordinate x;
    kinetic = ẋ^2/2;
    force x = F*(sign(x - 1) + sign(x - 1 - d));
}

fn close(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "{found} instead of {expected}");
}

/// Compares the last columns by `p`, `x` and `ẋ` with the digits of `tests/data/variational.py`.
fn published(run: &Solution<f64, 1>, within: f64) {
    let columns = run.sensitivities(&Forced::new(0.4), ["p", "x", "x_dot"]).unwrap();
    let expected = [
        [-0.25807427091440042944, 0.86792700365180577626],
        [-0.42547799684275369339, -0.19171818343890700153],
        [0.41983648992585684417, -0.51871994406285746946],
    ];
    for (column, [q, v]) in columns.iter().zip(expected) {
        close(column[0].q[0], q, within);
        close(column[0].v[0], v, within);
    }
}

#[test]
fn the_forced_pendulum_has_the_published_sensitivities_by_every_kind_of_dense_output() {
    let forced = Forced::new(0.4);
    let solved = || solve(&forced, (0.0, 3.0), [0.2], [0.3]).rtol(1e-13).dense();
    published(&solved().run().unwrap(), 1e-12);
    published(&solved().method(Picard).run().unwrap(), 1e-12);
    published(&solved().method(Dop853).run().unwrap(), 1e-12);
    published(&solved().method(Taylor::new()).run().unwrap(), 1e-12);
    published(&solved().rtol(1e-9).method(Rodas4).run().unwrap(), 1e-7);
}

#[test]
fn a_driven_system_across_kinks_has_the_columns_of_its_variational_equations() {
    const M: usize = variational_size(2, 4);
    let knots = Curve::linear(&[0.0, 0.5, 2.0], &[[0.0, 0.0], [0.1, 0.2], [-0.1, 0.0]]).unwrap();
    let hung = Hung::new(9.81, 0.7, 0.5, 0.2);
    let varied = Variational::<_, 2, M>::new(hung.clone());
    let (q, v) = varied.start([0.9, 0.3], [0.0, 1.0]);
    let driven = Driven::new(varied.clone(), (knots.clone(),));
    let end = solve(&driven, (0.0, 1.5), q, v).method(Dop853).rtol(1e-13).run().unwrap().end;
    let driven = hung.driven_by(knots);
    let run = solve(&driven, (0.0, 1.5), [0.9, 0.3], [0.0, 1.0]).rtol(1e-13).dense();
    let run = run.run().unwrap();
    let [by_c, by_g, by_angle, by_rate] =
        run.sensitivities(&driven, ["c", "g", "θ[1]", "θ̇[0]"]).unwrap();
    for (found, (q, v)) in [
        (by_c, varied.by_parameter(&end, 3)),
        (by_g, varied.by_parameter(&end, 0)),
        (by_angle, varied.by_position(&end, 1)),
        (by_rate, varied.by_velocity(&end, 0)),
    ] {
        for i in 0..2 {
            close(found[0].q[i], q[i], 1e-11);
            close(found[0].v[i], v[i], 1e-10);
        }
    }
}

#[test]
fn a_column_has_a_state_at_each_output_time_and_on_both_sides_of_a_kink() {
    let knots = Curve::linear(&[0.0, 0.5, 2.0], &[[0.0, 0.0], [0.1, 0.2], [-0.1, 0.0]]).unwrap();
    let hung = Hung::new(9.81, 0.7, 0.5, 0.2).driven_by(knots);
    let solved = || solve(&hung, (0.0, 1.0), [0.9, 0.3], [0.0, 1.0]).rtol(1e-12).dense();
    let steps = solved().every_step().run().unwrap();
    let [by_c] = steps.sensitivities(&hung, ["c"]).unwrap();
    assert_eq!(by_c.iter().map(|state| state.t).collect::<Vec<_>>(), steps.t);
    let kink = steps.t.windows(2).position(|pair| pair == [0.5, 0.5]).unwrap();
    assert_eq!(by_c[kink].q, by_c[kink + 1].q);
    assert_ne!(by_c[kink].v, by_c[kink + 1].v);
    // The only output time there has the value after the kink.
    let [single] =
        solved().t_eval(&[0.0, 0.5, 0.8]).run().unwrap().sensitivities(&hung, ["c"]).unwrap();
    assert_eq!((single.len(), single[0].q), (3, [0.0; 2]));
    assert_eq!(single[1], by_c[kink + 1]);
}

/// Derivatives of cos(√k t) by k and of the damped motion by c at c = 0.
#[test]
fn columns_of_a_spring_are_those_of_its_closed_form() {
    let spring = Damped::new(4.0, 0.0);
    for (end, sign) in [(5.0, 1.0), (-5.0, -1.0)] {
        let run = solve(&spring, (0.0, end), [1.0], [0.0]).rtol(1e-13).every(0.5).dense();
        let run = run.run().unwrap();
        let [by_k, by_c] = run.sensitivities(&spring, ["k", "c"]).unwrap();
        for (k, (by_k, by_c)) in by_k.iter().zip(&by_c).enumerate() {
            let t = sign * 0.5 * k as f64;
            close(by_k.q[0], -t * (2.0 * t).sin() / 4.0, 1e-11);
            // x = e^(−ct/2)(cos ωt + c/(2ω) sin ωt)
            close(by_c.q[0], -t / 2.0 * (2.0 * t).cos() + (2.0 * t).sin() / 4.0, 1e-11);
        }
    }
}

#[test]
fn columns_of_a_stiff_damper_need_no_short_steps() {
    // The slow rate is −k/c (1 + k/c² + …).
    let (k, c) = (1.0e4, 1.0e4);
    let damped = Damped::new(k, c);
    let rate = |k: f64| -2.0 * k / (c + (c * c - 4.0 * k).sqrt());
    let run = solve(&damped, (0.0, 1.0), [1.0], [rate(k)]).rtol(1e-9).dense();
    let run = run.method(Rodas4).run().unwrap();
    assert!(run.stats.accepted < 1000, "{}", run.stats);
    let [by_k, by_start, by_rate] = run.sensitivities(&damped, ["k", "x", "ẋ"]).unwrap();
    // Along the slow motion x(0) = 1, ẋ(0) = rate(k), which depends on k as well.
    let h = 1.0;
    let slope = (rate(k + h) - rate(k - h)) / (2.0 * h);
    close(by_k[0].q[0] + slope * by_rate[0].q[0], slope * rate(k).exp(), 1e-9);
    close(by_start[0].q[0] + rate(k) * by_rate[0].q[0], rate(k).exp(), 1e-9);
    // What is fast has decayed: x = (e^(λt) − e^(μt))/(λ − μ) for the start with the speed 1.
    let fast = -c - rate(k);
    close(by_rate[0].q[0] * (rate(k) - fast), rate(k).exp(), 1e-6);
}

#[test]
fn a_bob_on_a_rod_has_the_columns_of_its_angle() {
    let (swing, bob) = (Swing::new(0.8, 9.81), Bob::new(0.8, 9.81));
    let (angle, rate) = (1.1_f64, 0.7);
    let place = [0.8 * angle.sin(), -0.8 * angle.cos()];
    let speed = [0.8 * rate * angle.cos(), 0.8 * rate * angle.sin()];
    let run = solve(&swing, (0.0, 2.0), [angle], [rate]).rtol(1e-13).dense().run().unwrap();
    let held = solve(&bob, (0.0, 2.0), place, speed).rtol(1e-13).dense().run().unwrap();
    let [by_g, by_length, by_rate] = run.sensitivities(&swing, ["g", "L", "θ̇"]).unwrap();
    let [bob_by_g, bob_by_length] = held.sensitivities(&bob, ["g", "L"]).unwrap();
    let end = run.end.q[0];
    close(bob_by_g[0].q[0], 0.8 * end.cos() * by_g[0].q[0], 1e-10);
    close(bob_by_g[0].q[1], 0.8 * end.sin() * by_g[0].q[0], 1e-10);
    // A longer rod moves the start outwards; the speed there stays, so that the rate is less.
    let by_length = by_length[0].q[0] - rate / 0.8 * by_rate[0].q[0];
    close(bob_by_length[0].q[0], end.sin() + 0.8 * end.cos() * by_length, 1e-10);
    close(bob_by_length[0].q[1], -end.cos() + 0.8 * end.sin() * by_length, 1e-10);
}

#[test]
fn a_feedback_law_is_varied_with_the_state() {
    // With the law of a spring and a damper, τ = −3 θ − 2 θ̇.
    let law = |_: f64, q: &[f64; 1], v: &[f64; 1]| -3.0 * q[0] - 2.0 * v[0];
    let arm = Arm::new(0.5, 0.0).controlled_by(law);
    let written = Damped::new(3.0, 2.5);
    let run = solve(&arm, (0.0, 2.0), [1.0], [0.2]).rtol(1e-12).dense().run().unwrap();
    let same = solve(&written, (0.0, 2.0), [1.0], [0.2]).rtol(1e-12).dense().run().unwrap();
    let [by_b, by_start] = run.sensitivities(&arm, ["b", "θ"]).unwrap();
    let [by_c, by_x] = same.sensitivities(&written, ["c", "x"]).unwrap();
    close(by_b[0].q[0], by_c[0].q[0], 1e-9);
    close(by_start[0].q[0], by_x[0].q[0], 1e-9);
}

#[test]
fn columns_go_on_over_a_kink_of_the_accelerations() {
    let (k, f, end) = (4.0_f64, 5.0, 1.4);
    let [fast, slow] = [(k + f).sqrt(), k.sqrt()];
    let sided = Sided::new(k, f);
    // x = −(slow/fast) sin(fast (t − π/(2 slow))) on the stiff side.
    let time = end - core::f64::consts::FRAC_PI_2 / slow;
    let (sine, cosine) = (fast * time).sin_cos();
    let by_fast = slow / fast * (sine / fast - time * cosine);
    let solved = || solve(&sided, (0.0, end), [1.0], [0.0]).rtol(1e-12).dense();
    for (run, within) in [
        (solved().run(), 1e-9),
        (solved().method(Dop853).run(), 1e-9),
        // Its steps do not end at the kink.
        (solved().method(Rk4).step(1e-3).run(), 1e-5),
    ] {
        let [by_force] = run.unwrap().sensitivities(&sided, ["F"]).unwrap();
        close(by_force[0].q[0], by_fast / (2.0 * fast), within);
    }
}

#[test]
fn columns_jump_where_dry_friction_turns() {
    const M: usize = variational_size(1, 2);
    // x = −F/k − (3 F/k − x₀) cos ωt in the second half swing.
    let (k, f, x0, t) = (4.0_f64, 0.3, 1.2, 2.5);
    let at = |k: f64, f: f64, x0: f64| {
        let omega = k.sqrt();
        let (sine, cosine) = (omega * t).sin_cos();
        let size = 3.0 * f / k - x0;
        [-f / k - size * cosine, size * omega * sine]
    };
    let by = |plus: [f64; 2], minus: [f64; 2], d: f64| [0, 1].map(|i| (plus[i] - minus[i]) / d);
    let d = 1e-5;
    let expected = [
        by(at(k, f + d, x0), at(k, f - d, x0), 2.0 * d),
        by(at(k, f, x0 + d), at(k, f, x0 - d), 2.0 * d),
        by(at(k + d, f, x0), at(k - d, f, x0), 2.0 * d),
    ];
    let rough = Rough::new(k, f);
    let solved = || solve(&rough, (0.0, t), [x0], [0.0]).rtol(1e-12).atol(1e-12).dense();
    for run in [solved().run(), solved().method(Dop853).run()] {
        let columns = run.unwrap().sensitivities(&rough, ["F", "x", "k"]).unwrap();
        for (column, expected) in columns.iter().zip(&expected) {
            let end = column.last().unwrap();
            close(end.q[0], expected[0], 2e-9);
            close(end.v[0], expected[1], 2e-9);
        }
    }
    let varied = Variational::<_, 1, M>::new(rough);
    let (q, v) = varied.start([x0], [0.0]);
    let solved = || solve(&varied, (0.0, t), q, v).rtol(1e-12).atol(1e-12);
    for run in [solved().method(Picard).run(), solved().method(Dop853).run()] {
        let end = run.unwrap().end;
        let found = [
            varied.by_parameter(&end, 1),
            varied.by_position(&end, 0),
            varied.by_parameter(&end, 0),
        ];
        for ((q, v), expected) in found.iter().zip(&expected) {
            close(q[0], expected[0], 2e-9);
            close(v[0], expected[1], 2e-9);
        }
    }
}

#[test]
fn columns_jump_at_steps_that_parameters_and_inputs_move() {
    let motion = |u: [f64; 3]| {
        let [c, f, x] = u;
        let hill = Step::new(c, f).driven_by(Sinusoid::new([0.2], 0.4, [0.3]));
        let run = solve(&hill, (0.0, 3.0), [x], [1.0]).rtol(1e-13).atol(1e-13).dense().run();
        (hill, run.unwrap())
    };
    let u = [0.5, 0.7, -0.4];
    let (hill, run) = motion(u);
    let columns = run.sensitivities(&hill, ["c", "F", "x"]).unwrap();
    for (k, column) in columns.iter().enumerate() {
        let d = 1e-5;
        let [plus, minus] = [d, -d].map(|d| {
            let mut u = u;
            u[k] += d;
            motion(u).1.end
        });
        let end = column.last().unwrap();
        close(end.q[0], (plus.q[0] - minus.q[0]) / (2.0 * d), 1e-8);
        close(end.v[0], (plus.v[0] - minus.v[0]) / (2.0 * d), 1e-8);
    }
}

#[test]
fn a_kink_of_an_input_moves_a_switch_but_no_column() {
    // The velocity of the belt jumps past that of the mass.
    let keys = [[0.0], [0.7], [-0.4], [0.5], [0.0]];
    let moved = Curve::linear(&[0.0, 1.0, 2.3, 4.0, 9.0], &keys).unwrap();
    let run = |push: f64, end: f64| {
        let belt = Belt::new(push).driven_by(moved.clone());
        let run = solve(&belt, (0.0, end), [1.3], [0.2]).rtol(1e-13).atol(1e-13).dense().run();
        (belt, run.unwrap())
    };
    for end in [2.0, 4.5, 6.0] {
        let (belt, own) = run(0.3, end);
        let [column] = own.sensitivities(&belt, ["F"]).unwrap();
        let d = 1e-5;
        let [plus, minus] = [d, -d].map(|d| run(0.3 + d, end).1.end);
        let found = column.last().unwrap();
        close(found.q[0], (plus.q[0] - minus.q[0]) / (2.0 * d), 1e-8);
        close(found.v[0], (plus.v[0] - minus.v[0]) / (2.0 * d), 1e-8);
        let varied = Variational::<_, 1, { variational_size(1, 1) }>::new(Belt::new(0.3));
        let (q, v) = varied.start([1.3], [0.2]);
        let driven = Driven::new(varied.clone(), (moved.clone(),));
        let run = solve(&driven, (0.0, end), q, v).method(Dop853).rtol(1e-13).atol(1e-13).run();
        let (q, v) = varied.by_parameter(&run.unwrap().end, 0);
        close(q[0], found.q[0], 1e-9);
        close(v[0], found.v[0], 1e-9);
    }
}

#[test]
fn a_jump_between_two_kinks_has_the_rate_of_its_time() {
    let push = |c: f64, u: Curve<1>| {
        let step = Step::new(c, 0.7).driven_by(u);
        let run = solve(&step, (0.0, 3.0), [-0.4], [1.0]).rtol(1e-13).atol(1e-13).dense().run();
        (step, run.unwrap())
    };
    let still = Curve::linear(&[0.0, 5.0], &[[0.0], [0.0]]).unwrap();
    let (_, run) = push(0.5, still);
    let (mut low, mut high) = (0.0, 3.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if run.at(middle).unwrap().q[0] < 0.5 { low = middle } else { high = middle }
    }
    // The place moves for a ten thousandth of a second while the mass passes it.
    let (times, keys) = ([0.0, low - 5e-5, low + 5e-5, 5.0], [[0.0], [-1e-5], [1e-5], [1e-5]]);
    let moved = Curve::linear(&times, &keys).unwrap();
    let (step, run) = push(0.5, moved.clone());
    let [by_c] = run.sensitivities(&step, ["c"]).unwrap();
    let d = 1e-6;
    let [plus, minus] = [d, -d].map(|d| push(0.5 + d, moved.clone()).1.end);
    let found = by_c.last().unwrap();
    close(found.q[0], (plus.q[0] - minus.q[0]) / (2.0 * d), 1e-7);
    close(found.v[0], (plus.v[0] - minus.v[0]) / (2.0 * d), 1e-7);
}

#[test]
fn columns_jump_on_the_ridge_between_two_wells() {
    let motion = |k: f64, c: f64| {
        let wells = Wells::new(k, c);
        let run = solve(&wells, (0.0, 4.0), [1.2], [0.0]).rtol(1e-13).atol(1e-13).dense().run();
        (wells, run.unwrap())
    };
    let (wells, run) = motion(4.0, 2.5);
    let [by_k, by_c] = run.sensitivities(&wells, ["k", "c"]).unwrap();
    let d = 1e-5;
    let by = |plus: Solution<f64, 1>, minus: Solution<f64, 1>| {
        (plus.end.q[0] - minus.end.q[0]) / (2.0 * d)
    };
    let ends = [
        (by_k, by(motion(4.0 + d, 2.5).1, motion(4.0 - d, 2.5).1)),
        (by_c, by(motion(4.0, 2.5 + d).1, motion(4.0, 2.5 - d).1)),
    ];
    for (column, expected) in ends {
        close(column.last().unwrap().q[0], expected, 1e-8 * expected.abs().max(1.0));
    }
}

#[test]
fn the_way_back_over_a_jump_undoes_the_way_there() {
    const M: usize = variational_size(1, 0);
    let varied = Variational::<_, 1, M>::new(Wells::new(4.0, 2.5));
    let transition = |span, q, v| {
        let (q, v) = varied.start([q], [v]);
        let run = solve(&varied, span, q, v).method(Dop853).rtol(1e-13).atol(1e-13).run();
        let end = run.unwrap().end;
        (varied.transition(&end), varied.state(&end))
    };
    let (there, end) = transition((0.0, 2.0), 1.2, 0.1);
    let (back, start) = transition((2.0, 0.0), end.q[0], end.v[0]);
    close(start.q[0], 1.2, 1e-10);
    let product = back * there;
    for i in 0..2 {
        for j in 0..2 {
            close(product[(i, j)], f64::from(u8::from(i == j)), 1e-9);
        }
    }
}

#[test]
fn a_step_of_fixed_length_over_two_jumps_is_told() {
    let both = Twice::new(0.1, 1e-5);
    let run = solve(&both, (0.0, 1.0), [0.3], [1.0]).method(Rk4).step(1e-2).dense().run().unwrap();
    let message = run.sensitivities(&both, ["F"]).unwrap_err().to_string();
    assert!(message.contains("`F` is lost where `"), "{message}");
}

#[test]
fn a_jump_at_a_time_that_no_column_moves_is_none() {
    // The times of the jumps do not depend on the force.
    let reversed = Reversed::new(2.0, 3.0);
    let run = solve(&reversed, (0.0, 4.0), [1.2], [0.0]).rtol(1e-12).dense().run().unwrap();
    let [by_force] = run.sensitivities(&reversed, ["F"]).unwrap();
    close(by_force[0].q[0], (run.end.q[0] - 1.2) / 2.0, 1e-10);
}

#[test]
fn what_has_no_columns_says_why() {
    let spring = Damped::new(4.0, 0.1);
    let plain = solve(&spring, (0.0, 1.0), [1.0], [0.0]).run().unwrap();
    let message = plain.sensitivities(&spring, ["k"]).unwrap_err().to_string();
    assert!(message.contains("`k`") && message.contains("`.dense()`"), "{message}");
    let run = solve(&spring, (0.0, 1.0), [1.0], [0.0]).dense().run().unwrap();
    let message = run.sensitivities(&spring, ["kk"]).unwrap_err().to_string();
    assert!(message.contains("did you mean `k`"), "{message}");
    let kick = Event::at([0.5]).then(|spring: &mut State<f64, 1>| spring.v[0] = -spring.v[0]);
    let kicked = solve(&spring, (0.0, 1.0), [1.0], [0.0]).events([kick]).dense().run().unwrap();
    let message = kicked.sensitivities(&spring, ["k"]).unwrap_err().to_string();
    assert!(message.contains("action"), "{message}");
}
