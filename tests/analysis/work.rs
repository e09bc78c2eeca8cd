//! The work along a run, compared with the change of the energy and with closed forms.

use pendulum_runtime::integrate::{Event, Solution, State, Work};
use pendulum_runtime::motion::{Curve, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::Dynamics;

use crate::exponents::blocks::Damped;

lagrangian! {
    /// A pendulum on a moving pivot, with a motor.
    #[derive(Clone)]
    pub struct Carried { L, b, g }
    coordinate θ;
    driven x: [1; 2];
    input τ;
    let y = x + L*[sin(θ), -cos(θ)];
    kinetic = |ẏ|^2/2;
    potential = g*height(y) - τ*θ/10;
    dissipation = b*θ̇^2/2;
    force θ = τ;
}

lagrangian! {
    pub struct Ball { c, g }
    coordinate y;
    kinetic = ẏ^2/2;
    potential = g*y;
    dissipation = c*ẏ^2/2;
    limit floor: y >= 0, restitution = 0.7;
}

lagrangian! {
    /// A mass on a spring that sticks and slips on a belt.
    pub struct Belt { k, F, S, u }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k*x^2/2;
    friction belt: ẋ - u, force = F, static = S;
}

/// Checks the balance of the energy to `within`, and returns the work.
fn balanced<D: Dynamics<N, Scalar = f64>, const N: usize>(
    dynamics: &D,
    run: &Solution<f64, N>,
    within: f64,
) -> Work<f64> {
    let (work, energy) = (run.work(dynamics).unwrap(), run.energy(dynamics));
    let gain = energy.last().unwrap() - energy[0];
    let rest = work.power + work.jumps - gain;
    assert!(rest.abs() < within, "{work:?}, gain {gain}, off by {rest:e}");
    work
}

#[test]
fn damping_takes_the_energy_by_every_kind_of_dense_output() {
    let fading = Damped::new(4.0, 0.3);
    let run = |end: f64| solve(&fading, (0.0, end), [1.0], [0.5]).rtol(1e-12).every(end).dense();
    let work = balanced(&fading, &run(9.0).run().unwrap(), 1e-11);
    assert!(work.jumps == 0.0 && work.power < -1.0);
    balanced(&fading, &run(9.0).method(Picard).run().unwrap(), 1e-11);
    balanced(&fading, &run(9.0).method(Dop853).run().unwrap(), 1e-10);
    balanced(&fading, &run(9.0).method(Taylor::new()).run().unwrap(), 1e-11);
    // Back in time, the motion gains what damping takes.
    let back = solve(&fading, (0.0, -2.0), [1.0], [0.5]).rtol(1e-12).dense().run().unwrap();
    let (work, end) = (back.work(&fading).unwrap(), back.energy(&fading)[0]);
    assert!((2.125 + work.power - end).abs() < 1e-10 && 0.5 < work.power, "{work:?}");
}

#[test]
fn a_moving_pivot_and_a_motor_do_work() {
    let law = |t: f64, q: &[f64; 1], v: &[f64; 1]| t.sin() - q[0] - 0.2 * v[0];
    let pivot = Sinusoid::new([0.1, 0.2], 3.0, [0.0, 0.4]);
    let smooth = Carried::new(0.8, 0.1, 9.81).driven_by(pivot).controlled_by(law);
    let run = solve(&smooth, (0.0, 6.0), [0.7], [0.0]).rtol(1e-11).every(6.0).dense();
    let work = balanced(&smooth, &run.run().unwrap(), 1e-9);
    assert!(work.jumps == 0.0 && 0.1 < work.power.abs(), "{work:?}");
}

#[test]
fn samples_and_kinks_change_the_energy_in_an_instant() {
    let hand = Curve::linear(&[0.0, 1.0, 3.0], &[[0.0, 0.0], [0.2, 0.1], [-0.1, 0.0]]).unwrap();
    let held =
        Carried::new(0.8, 0.1, 9.81).driven_by(hand).sampled(0.25, |_, q, v| -2.0 * q[0] - v[0]);
    let run = solve(&held, (0.0, 3.0), [0.7], [0.0]).rtol(1e-11).every(3.0).dense();
    let work = balanced(&held, &run.run().unwrap(), 1e-9);
    assert!(1e-3 < work.jumps.abs());
}

#[test]
fn impacts_are_told_apart_from_drag() {
    let ball = Ball::new(0.0, 9.81);
    let run = solve(&ball, (0.0, 2.0), [1.0], [0.0]).rtol(1e-11).every(2.0).dense().run().unwrap();
    let work = balanced(&ball, &run, 1e-9);
    assert!(1 < run.impacts.len() && work.power.abs() < 1e-12, "{work:?}");
    let left = 0.49_f64.powi(run.impacts.len() as i32);
    assert!((work.jumps - 9.81 * (left - 1.0)).abs() < 1e-8);
    // At the end it lies on the floor.
    let rough = Ball::new(0.4, 9.81);
    let run = solve(&rough, (0.0, 9.0), [1.0], [0.0]).rtol(1e-11).every(9.0).dense().run().unwrap();
    let work = balanced(&rough, &run, 1e-8);
    assert!(work.power < -0.5 && work.jumps < -5.0, "{work:?}");
}

#[test]
fn a_belt_drives_what_sticks_to_it() {
    let belt = Belt::new(2.0, 0.5, 0.9, 0.3);
    let run = solve(&belt, (0.0, 12.0), [0.0], [0.3]).rtol(1e-10).every(12.0).dense();
    let run = run.run().unwrap();
    assert!(run.frictions.iter().any(|slip| slip.direction != 0), "it never slips");
    assert!(run.frictions.iter().any(|slip| slip.direction == 0), "it never sticks");
    let work = balanced(&belt, &run, 1e-8);
    assert!(work.jumps == 0.0, "{work:?}");
}

#[test]
fn an_action_is_an_instant_and_a_run_that_is_not_dense_an_error() {
    let fading = Damped::new(4.0, 0.0);
    let kick = Event::at([0.5]).then(|mass: &mut State<f64, 1>| mass.v[0] += 1.0);
    let run = solve(&fading, (0.0, 1.0), [1.0], [0.0]).events([kick]).rtol(1e-11);
    let run = run.every(1.0).dense().run().unwrap();
    let work = balanced(&fading, &run, 1e-9);
    // (v + 1)²/2 − v²/2 with v = −2 sin 1.
    assert!((work.jumps - (0.5 - 2.0 * 1.0_f64.sin())).abs() < 1e-9, "{work:?}");
    let plain = solve(&fading, (0.0, 1.0), [1.0], [0.0]).run().unwrap();
    let message = plain.work(&fading).unwrap_err().to_string();
    assert!(message.contains("`work` needs the motion within the steps"), "{message}");
}
