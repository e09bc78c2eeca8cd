//! What the final states of methods do not reach: limits, controllers, motions back in time, saved
//! runs, ensembles, scenes, outputs, analysis and bodies, as hashes of all their numbers.

use super::{hash, numbers_of};
use crate::constrained::{Bob, four_bar};
use crate::problems::{Double, Forced, Hung, Lifted, Simple};
use pendulum_runtime::analysis::{
    Variational, equilibrium, linearize, lyapunov, poincare, state_space, variational_size,
};
use pendulum_runtime::body::{Body, Ellipse, FillRule, Outline, Polygon, Region};
use pendulum_runtime::integrate::Event;
use pendulum_runtime::motion::{Attenuated, Curve, Function, Sinusoid, Still};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Float;
use pendulum_runtime::scene::{Handle, Preserve, Resume, Scene, Stop};
use pendulum_runtime::system::System;

lagrangian! {
    /// A rod that falls on its ends, with two limits and two contacts.
    pub struct Rod { e, g }
    coordinate y;
    coordinate θ;
    kinetic = ẏ^2/2 + θ̇^2/24;
    potential = g*y;
    limit left: y - sin(θ)/2 >= 0, restitution = e;
    limit right: y + sin(θ)/2 >= 0, restitution = e;
    output high: 1 = y + sin(θ)/2;
}

lagrangian! {
    /// A bead on a circle over a floor.
    pub struct Bead { r, h, e, g }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*y;
    constraint circle: x^2 + y^2 = r^2;
    limit floor: y + h >= 0, restitution = e;
}

lagrangian! {
    /// A pendulum on a cart that is pushed, on a floor that is moved.
    pub struct Crane { m, l, b, g }
    coordinate s;
    coordinate θ;
    driven floor;
    input u;
    let r = [s + l*sin(θ), floor - l*cos(θ)];
    kinetic = (ṡ^2 + m*|ṙ|^2)/2;
    potential = m*g*height(r);
    dissipation = b*ṡ^2/2;
    force s = u;
    output load: [1; 2] = r;
    output effort: 1/s^3 = u*ṡ;
}

lagrangian! {
    /// A feather on a rod between two joints.
    pub struct Feather { l, c, g }
    coordinate θ;
    driven a: [1; 2];
    driven b: [1; 2];
    let y = (a + 2*b)/3 + l*[sin(θ), -cos(θ)];
    kinetic = |ẏ|^2/2;
    potential = g*height(y);
    dissipation = c*θ̇^2/2;
}

const TIMES: [f64; 6] = [0.0, 0.7, 1.9, 2.4, 4.0, 5.5];
const PLACES: [[f64; 2]; 6] =
    [[0.0, 0.0], [0.3, 0.1], [-0.2, 0.05], [0.1, -0.1], [0.4, 0.0], [0.0, 0.2]];
const HEIGHTS: [[f64; 1]; 6] = [[0.0], [0.3], [-0.2], [0.1], [0.4], [0.0]];

/// The coordinates of a variational system with one coordinate and one parameter.
const VARIED: usize = variational_size(1, 1);

/// Adds a line: names and the hash of the numbers.
fn add(lines: &mut Vec<String>, name: &str, numbers: impl IntoIterator<Item = f64>) {
    lines.push(format!("{name} {:016x}", hash(numbers)));
}

/// Returns all numbers of a solution: its rows, its end, events and impacts.
fn all_of<T: Float, const N: usize>(solution: &Solution<T, N>) -> Vec<f64> {
    let mut numbers: Vec<f64> =
        solution.iter().chain([solution.end]).flat_map(|state| numbers_of(&state)).collect();
    for found in &solution.events {
        numbers.extend([found.event as f64, found.time.to_f64(), found.time.low()]);
        numbers.extend(numbers_of(&found.state).into_iter().chain(numbers_of(&found.after)));
    }
    for impact in &solution.impacts {
        let limit = [impact.limit as f64, impact.time.to_f64(), impact.time.low()];
        numbers.extend(limit.into_iter().chain([impact.impulse.to_f64()]));
        numbers.extend(numbers_of(&impact.state).into_iter().chain(numbers_of(&impact.after)));
    }
    numbers
}

/// Runs a problem with every method and its settings.
macro_rules! runs {
    ($lines:ident, $name:literal, $problem:expr; $($method:literal $(.$setting:ident($($value:expr)?))+;)+) => {$(
        let solution = $problem$(.$setting($($value)?))+.run().expect($name);
        add($lines, concat!($name, " ", $method), all_of(&solution));
    )+};
}

/// Adds the lines of all features.
#[inline]
pub(super) fn all(lines: &mut Vec<String>) {
    limits(lines);
    controllers(lines);
    back(lines);
    events(lines);
    saved(lines);
    ensembles(lines);
    scenes(lines);
    analysis(lines);
    bodies(lines);
}

#[inline]
fn limits(lines: &mut Vec<String>) {
    let rod = Rod::new(0.3, 9.81);
    let falling = || solve(&rod, (0.0, 2.0), [0.5, 0.3], [0.0, 1.0]).every(0.1);
    runs! { lines, "rod", falling();
        "Auto" .rtol(1e-9).dense();
        "Dop853" .method(Dop853).rtol(1e-8);
        "Rk4" .method(Rk4).step(0.01);
    }
    let rests = falling().run().expect("rod");
    let columns = [rests.output(&rod, "high").expect("high"), rests.power(&rod).expect("power")];
    let forces = rests.contact_forces(&rod).expect("forces").concat();
    let accelerations = rests.accelerations(&rod).expect("accelerations").concat();
    add(
        lines,
        "rod contacts",
        columns.concat().into_iter().chain(forces).chain(accelerations).chain(rests.energy(&rod)),
    );
    let lively = Rod::new(1.0, 9.81);
    runs! { lines, "lively", solve(&lively, (0.0, 0.6), [0.5, 0.3], [0.0, 1.0]);
        "Picard" .method(Picard).rtol(1e-10);
        "Taylor" .method(Taylor::new()).rtol(1e-13);
        "Gauss2" .method(Gauss::<2>::new()).step(0.01);
        "Leapfrog" .method(Leapfrog).step(0.01);
    }
    let lifted = Lifted::new(0.4, 9.81).driven_by(Curve::linear(&TIMES, &HEIGHTS).expect("keys"));
    runs! { lines, "lifted", solve(&lifted, (0.0, 5.0), [1.0], [0.0]).every(0.25);
        "Auto" .rtol(1e-9);
        "Rk4" .method(Rk4).step(0.02);
    }
    let bead = Bead::new(1.0, 0.6, 0.5, 9.81);
    runs! { lines, "bead", solve(&bead, (0.0, 3.0), [0.96, 0.28], [-0.28, 0.96]).every(0.25);
        "Auto" .rtol(1e-9);
        "Dop853" .method(Dop853).rtol(1e-9);
    }
}

#[inline]
fn controllers(lines: &mut Vec<String>) {
    let floor = || Curve::spline(&TIMES, &HEIGHTS).expect("keys");
    let crane = || Crane::new(0.7, 1.1, 0.2, 9.81).driven_by(floor());
    let steered = crane().controlled_by(|t, q, v| 3.0 * (t / 5.0 - q[0]) - 2.0 * v[0] + q[1]);
    let start = ([0.1, 0.3], [0.0; 2]);
    runs! { lines, "crane", solve(&steered, (0.0, 5.0), start.0, start.1).every(0.5);
        "Auto" .rtol(1e-9).t_stops(&[2.2]);
        "Picard" .method(Picard).rtol(1e-9);
        "Dop853" .method(Dop853).rtol(1e-9);
        "Rodas4" .method(Rodas4).rtol(1e-5);
        "Rk4" .method(Rk4).step(0.02);
        "Gauss2" .method(Gauss::<2>::new()).step(0.02);
    }
    let mut sum = 0.0;
    let sampled = crane().sampled(0.04, move |t, q, v| {
        sum += 0.04 * (t / 5.0 - q[0]);
        3.0 * (t / 5.0 - q[0]) - 2.0 * v[0] + q[1] + sum
    });
    runs! { lines, "sampled", solve(&sampled, (0.0, 5.0), start.0, start.1).every(0.5);
        "Auto" .rtol(1e-9);
        "Rk4" .method(Rk4).step(0.03);
    }
    let run = solve(&sampled, (0.0, 3.0), start.0, start.1).every(0.1).run().expect("sampled");
    let columns =
        ["load.x", "load.y", "effort"].map(|name| run.output(&sampled, name).expect(name));
    add(
        lines,
        "sampled outputs",
        columns.concat().into_iter().chain(run.power(&sampled).expect("power")),
    );
    let model = state_space(&steered, 1.3, &[0.2, 0.1], &[0.3, -0.1]);
    let matrices = [&model.a, &model.b, &model.c, &model.d];
    add(lines, "crane state_space", matrices.into_iter().flat_map(|m| m.iter().copied()));
}

#[inline]
fn back(lines: &mut Vec<String>) {
    let smooth = Hung::new(0.5, 9.81).driven_by(Curve::spline(&TIMES, &PLACES).expect("keys"));
    let kinked = Hung::new(0.5, 9.81).driven_by(Curve::linear(&TIMES, &PLACES).expect("keys"));
    let zero = Event::new(|_, q: &[f64; 1], _: &[f64; 1]| q[0]).rising();
    runs! { lines, "back_spline",
        solve(&smooth, (5.0, 0.0), [0.3], [0.0]).events([zero.clone()]).every(0.7);
        "Auto" .rtol(1e-9).dense();
        "Rk4" .method(Rk4).step(0.03);
        "Dop853" .method(Dop853).rtol(1e-9);
        "Taylor" .method(Taylor::new()).rtol(1e-14);
        "Picard" .method(Picard).rtol(1e-9);
        "Gauss2" .method(Gauss::<2>::new()).step(0.02);
    }
    runs! { lines, "back_lines",
        solve(&kinked, (5.0, 0.0), [0.3], [0.0]).events([zero.clone()]).every(0.7);
        "Dop853" .method(Dop853).rtol(1e-9).dense();
        "Picard" .method(Picard).rtol(1e-9);
        "Leapfrog" .method(Leapfrog).step(0.01);
        "Srkn6b" .method(Srkn6b).step(0.03);
        "Dprkn12" .method(Dprkn12).rtol(1e-9);
    }
    let function = Function::new(|t: f64| [Real::sin(3.0 * t), 0.0])
        .velocity(|t: f64| [3.0 * Real::cos(3.0 * t), 0.0])
        .acceleration(|t: f64| [-9.0 * Real::sin(3.0 * t), 0.0]);
    let shaken = Hung::new(0.5, 9.81).driven_by(Attenuated::new(function, 0.2, 0.5).expect("gain"));
    runs! { lines, "attenuated", solve(&shaken, (0.0, 3.0), [0.3], [0.0]); "Auto" .rtol(1e-9); }
    let curved = Hung::new(0.5, 9.81).driven_by(Curve::catmull_rom(&TIMES, &PLACES).expect("keys"));
    runs! { lines, "catmull_rom", solve(&curved, (0.0, 5.0), [0.3], [0.0]); "Auto" .rtol(1e-9); }
}

#[inline]
fn events(lines: &mut Vec<String>) {
    let double = Double::new([1.0, 0.7], [0.9, 1.1], 9.81);
    let run = || {
        let through = Event::new(|_, q: &[f64; 2], _: &[f64; 2]| q[0]);
        let dips = Event::new(|_, _: &[f64; 2], v: &[f64; 2]| v[1] * v[1]).touching(1e-8);
        let stop = Event::new(|_, q: &[f64; 2], _: &[f64; 2]| q[0] - q[1] + 0.3).falling();
        let stop = stop.then(|state| state.bounce(&double, &[1.0, -1.0], 0.9));
        let known = Event::at([0.7, 2.1]).then(|state| state.v[0] += 0.1);
        let end = Event::new(|t, _: &[f64; 2], v: &[f64; 2]| v[0] + t - 4.0).terminal_after(2);
        let all = [through, dips, stop, known, end];
        solve(&double, (0.0, 5.0), [0.5, -0.25], [0.0; 2]).events(all).t_eval(&TIMES[..5])
    };
    let narrow = Double::new([1.0f32, 0.7], [0.9, 1.1], 9.81);
    runs! { lines, "double_f32", solve(&narrow, (0.0, 2.0), [0.5, -0.25], [0.0; 2]).every(0.3);
        "Dop853" .method(Dop853).rtol(1e-4);
    }
    runs! { lines, "double_events", run();
        "Auto" .rtol(1e-9).dense();
        "Rk4" .method(Rk4).step(0.03);
        "Dop853" .method(Dop853).rtol(1e-9);
        "Taylor" .method(Taylor::new()).rtol(1e-14);
        "Picard" .method(Picard).rtol(1e-9).every_step();
        "Gauss2" .method(Gauss::<2>::new()).step(0.02);
    }
    // Times within steps, and both sides of a kink.
    let kinked = Hung::new(0.5, 9.81).driven_by(Curve::linear(&TIMES, &PLACES).expect("keys"));
    let dense = |solution: Solution<f64, 1>| {
        let at = [0.05, 0.7, 1.3, 2.4, 4.99].map(|t| solution.at(t).expect("within"));
        at.into_iter().flat_map(|state| numbers_of(&state))
    };
    let run = || solve(&kinked, (0.0, 5.0), [0.3], [0.0]).dense();
    add(lines, "dense Picard", dense(run().method(Picard).rtol(1e-9).run().expect("dense")));
    add(lines, "dense Dop853", dense(run().method(Dop853).rtol(1e-9).run().expect("dense")));
    add(lines, "dense Srkn6b", dense(run().method(Srkn6b).step(0.03).run().expect("dense")));
    let bob = Bob::new(0.7, 1.3);
    let run = solve(&bob, (0.0, 3.0), [1.3 * 0.96, -1.3 * 0.28], [0.28, 0.96]).every(0.1);
    let run = run.rtol(1e-9).run().expect("bob");
    let columns = [
        run.output(&bob, "pull").expect("pull"),
        run.energy(&bob),
        run.power(&bob).expect("power"),
    ];
    let accelerations = run.accelerations(&bob).expect("accelerations").concat();
    let reactions = run.reactions(&bob).expect("reactions").concat();
    let vectors = accelerations.into_iter().chain(reactions);
    add(lines, "bob outputs", columns.concat().into_iter().chain(vectors));
}

/// Interrupts a run, continues it in another integrator, and adds its last state.
macro_rules! interrupted {
    ($lines:ident, $name:literal, $problem:expr) => {
        let mut first = $problem.start().expect($name);
        first.steps().take(7).for_each(|state| assert!(state.is_ok(), $name));
        let saved = first.save();
        let mut second = $problem.start().expect($name);
        second.restore(&saved).expect($name);
        let end = second.steps().last().expect($name).expect($name);
        let counts = [second.stats().accepted as f64, second.stats().evaluations as f64];
        add($lines, $name, numbers_of(&end).into_iter().chain(counts));
    };
}

#[inline]
fn saved(lines: &mut Vec<String>) {
    let kinked = Hung::new(0.5, 9.81).driven_by(Curve::linear(&TIMES, &PLACES).expect("keys"));
    let run = || {
        let wall = Event::new(|_, q: &[f64; 1], _: &[f64; 1]| q[0] + 0.4).falling();
        let wall = wall.then(|state| state.v[0] *= -0.9);
        solve(&kinked, (0.0, 5.0), [0.3], [0.0]).events([wall, Event::at([0.5, 1.25])])
    };
    interrupted!(lines, "saved Auto", run().rtol(1e-9));
    interrupted!(lines, "saved Picard", run().method(Picard).rtol(1e-9));
    interrupted!(lines, "saved Dop853", run().method(Dop853).rtol(1e-9));
    interrupted!(lines, "saved Leapfrog", run().method(Leapfrog).step(0.01));
    let smooth = Hung::new(0.5, 9.81).driven_by(Curve::spline(&TIMES, &PLACES).expect("keys"));
    let run = || solve(&smooth, (0.0, 5.0), [0.3], [0.0]);
    interrupted!(lines, "saved Taylor", run().method(Taylor::new()).rtol(1e-15));
    interrupted!(lines, "saved Gauss2", run().method(Gauss::<2>::new()).step(0.02));
    let rod = Rod::new(0.3, 9.81);
    interrupted!(lines, "saved rod", solve(&rod, (0.0, 2.0), [0.5, 0.3], [0.0, 1.0]).rtol(1e-9));
}

#[inline]
fn double_number(k: usize) -> Problem<Double, 2> {
    Problem {
        system: Double::new([1.0, 0.5 + 0.05 * (k % 10) as f64], [1.0, 0.7], 9.8),
        time: if k % 7 == 3 { (1.0, -0.5) } else { (0.0, 1.0 + 0.1 * (k % 7) as f64) },
        q: [0.3 * (k % 10) as f64, -0.2 * (k / 10) as f64],
        v: [0.1, if k == 11 { f64::NAN } else { 0.0 }],
    }
}

#[inline]
fn ensembles(lines: &mut Vec<String>) {
    let zero = Event::new(|_, q: &[f64; 2], _: &[f64; 2]| q[1]);
    let all = || {
        let all = Ensemble::new(0..40, double_number).rtol(1e-9).shard(3).every(0.3);
        all.events([zero.clone()])
    };
    let lists = all().map(|_, solution| all_of(solution)).collect().expect("ensemble");
    let failed = lists.tally.failures.iter().map(|failure| failure.index as f64);
    let lists = lists.value.iter().flatten().flatten().copied();
    add(lines, "ensemble lanes", lists.chain(failed));
    let sums = || all().map(|_, solution| solution.end.v[0]);
    let sum = sums().reduce(|| 0.0, |a, b| a + b).expect("ensemble");
    add(lines, "ensemble reduced", [sum.value, sum.tally.accepted as f64]);
    let folder = std::env::temp_dir().join(format!("pendulum-fingerprints-{}", std::process::id()));
    let part = || sums().checkpoint(&folder).tag("fingerprints");
    let first = part().part(1, 3).reduce(|| 0.0, |a, b| a + b).expect("ensemble");
    let whole = part().fold(|| 1.0, |a, b| a + b / 2.0, |a, b| a * b).expect("ensemble");
    std::fs::remove_dir_all(&folder).expect("folder");
    let counts = [first.missing, whole.resumed, whole.missing].map(|count| count as f64);
    add(lines, "ensemble checkpoint", [first.value, whole.value].into_iter().chain(counts));
    let alone = Ensemble::new(0..5, double_number).method(Dop853).rtol(1e-6);
    let alone = alone.map(|_, solution| all_of(solution)).collect().expect("ensemble");
    add(lines, "ensemble Dop853", alone.value.into_iter().flatten().flatten());
    let kinked = Curve::linear(&TIMES, &PLACES).expect("keys");
    let driven = Ensemble::new(0..20, |k| Problem {
        system: Hung::new(0.4 + 0.02 * k as f64, 9.81).driven_by(kinked.clone()),
        time: if k % 5 == 3 { (4.5, 0.3) } else { (0.1, 1.0 + 0.2 * k as f64) },
        q: [0.1 * k as f64],
        v: [0.0],
    });
    let driven = driven.dense().map(|_, solution| {
        let middle = solution.at(0.5).into_iter().flat_map(|state| numbers_of(&state));
        all_of(solution).into_iter().chain(middle).collect::<Vec<_>>()
    });
    let driven = driven.collect().expect("ensemble").value;
    add(lines, "ensemble driven", driven.into_iter().flatten().flatten());
    let problems: Vec<_> = (0..10).map(double_number).collect();
    let batch = Batch::new().rtol(1e-12).run(&problems).expect("batch");
    let batch = batch.iter().flat_map(|outcome| all_of(outcome.as_ref().expect("batch")));
    add(lines, "batch", batch);
}

/// Returns the states of pendulums of a scene, and their poses within a tick.
fn states<S, const N: usize>(scene: &Scene<f64>, hung: &[Handle<S, N>]) -> Vec<f64>
where
    S: pendulum_runtime::scene::SceneSystem<f64, N>,
{
    let of = |&hung: &Handle<S, N>| {
        let (q, v) = scene.state(hung);
        q.into_iter().chain(v).chain(scene.pose(hung, 0.3))
    };
    hung.iter().flat_map(of).chain([scene.time(), scene.alpha()]).collect()
}

#[inline]
fn scenes(lines: &mut Vec<String>) {
    let mut scene = Scene::<f64>::new(240.0).expect("rate");
    let wing = scene.joint(Sinusoid::new([0.05, 0.02], 9.0, [0.0, 1.0]));
    let hand = scene.joint(Curve::linear(&TIMES, &PLACES).expect("keys"));
    let rest = scene.joint(Still::new([1.0, 0.0]));
    let joints = [wing, hand, rest];
    let mut hung = Vec::new();
    for k in 0..40 {
        scene.set_tolerance(if k % 2 == 0 { 1e-3 } else { 1e-7 }).expect("tolerance");
        let system = Hung::new(0.1 + 0.02 * k as f64, 9.81);
        hung.push(scene.hang(joints[k % 3], system, [0.05 * k as f64], [0.1]).expect("hung"));
    }
    scene.set_tolerance(1e-4).expect("tolerance");
    let feathers: Vec<_> = (0..9)
        .map(|k| {
            let feather = Feather::new(0.2 + 0.05 * k as f64, 0.3, 9.81);
            scene.hang((wing, joints[k % 3]), feather, [0.2], [0.0]).expect("feather")
        })
        .collect();
    let double = [scene
        .hang((), Double::new([1.0, 0.7], [0.9, 1.1], 9.81), [0.5, -0.25], [0.0; 2])
        .expect("double")];
    let bob =
        [scene.hang((), Bob::new(0.7, 1.3), [1.3 * 0.96, -1.3 * 0.28], [0.28, 0.96]).expect("bob")];
    let whole = |scene: &Scene<f64>| {
        let groups = [states(scene, &hung), states(scene, &feathers)];
        [groups.concat(), states(scene, &double), states(scene, &bob)].concat()
    };
    // Frames of all lengths, kinks within ticks.
    for frame in [1.0 / 60.0, 0.3, 0.0137, 0.9] {
        scene.advance(frame).expect("frame");
    }
    add(lines, "scene advance", whole(&scene));
    let snapshot = scene.snapshot();
    scene.set_damping(hung[0], 4.0).expect("damping");
    scene.set_limits(hung[1], [-0.1], [0.1], Stop::Hard { restitution: 0.3 }).expect("limits");
    scene.set_limits(hung[3], [-0.1], [0.1], Stop::Soft { stiffness: 900.0 }).expect("limits");
    scene.set_parameter(hung[4], "l", 0.33).expect("parameter");
    scene.set_parameter_everywhere("g", 8.0).expect("parameter");
    scene.mirror(hung[6], [-1.0]).expect("mirror");
    scene.set_state(hung[7], [0.4], [0.2]).expect("state");
    scene.hide(hung[9]).expect("hidden");
    scene.hide(hung[10]).expect("hidden");
    scene.reset_to_rest(hung[12]).expect("rest");
    scene.advance(0.41).expect("frame");
    scene.show(hung[9], Resume::CatchUp { longest: 1.0 }).expect("shown");
    scene.show(hung[10], Resume::Unchanged).expect("shown");
    scene
        .set_motion(rest, Curve::linear(&TIMES, &PLACES).expect("keys"), Preserve::Momentum)
        .expect("motion");
    scene.set_motion(hand, Still::new([3.0, 0.0]), Preserve::Swing).expect("motion");
    scene.advance(0.5).expect("frame");
    add(lines, "scene commands", whole(&scene));
    scene.restore(&snapshot).expect("snapshot");
    scene.advance(0.91).expect("frame");
    add(lines, "scene restored", whole(&scene));

    let mut scene = Scene::<f64>::new(120.0).expect("rate");
    scene.set_sleep(Some(1e-3)).expect("sleep");
    let wing = scene.joint(Sinusoid::new([0.0, 0.05], 4.0 * std::f64::consts::PI, [0.0, 0.0]));
    let late = scene.joint(Curve::linear(&[2.0, 2.5], &[[0.0, 0.0], [0.2, 0.0]]).expect("keys"));
    let mut hung = vec![];
    for (joint, angle) in [(wing, 0.2), (wing, 0.5), (late, 1e-9), (late, 0.3)] {
        hung.push(scene.hang(joint, Hung::new(0.3, 9.81), [angle], [0.0]).expect("hung"));
        scene.set_damping(hung[hung.len() - 1], 8.0).expect("damping");
    }
    scene.warm_up(1.0).expect("warm");
    let (mut numbers, mut awake) = (states(&scene, &hung), Vec::new());
    for _ in 0..6 {
        scene.advance(0.6).expect("frame");
        awake.push(scene.awake().0 as f64);
    }
    numbers.extend(states(&scene, &hung).into_iter().chain(awake));
    add(lines, "scene sleep", numbers);
    let closed = scene.close_loop(60, 30, 1e-9).expect("loop");
    let baked = scene.bake(&hung[..2], 60, 1e-3).expect("baked");
    let keys = baked.iter().flat_map(|one| one.keys().collect::<Vec<_>>());
    let keys = keys.flat_map(|(t, q, v)| [t, q[0], v[0]]);
    add(lines, "scene loop", states(&scene, &hung).into_iter().chain([closed.gap]).chain(keys));

    let mut scene = Scene::<f32>::new(60.0).expect("rate");
    let wing = scene.joint(Sinusoid::new([0.05, 0.02], 9.0, [0.0, 1.0]));
    let hang = |k: u8| {
        let system = Hung::new(0.2 + 0.02 * f32::from(k), 9.81);
        scene.hang(wing, system, [0.1 * f32::from(k)], [0.0]).expect("hung")
    };
    let hung: Vec<_> = (0..20).map(hang).collect();
    scene.advance(1.7).expect("frame");
    let numbers = hung.iter().flat_map(|&hung| {
        let (q, v) = scene.state(hung);
        [q[0], v[0]].map(f64::from)
    });
    add(lines, "scene f32", numbers);
}

#[inline]
fn analysis(lines: &mut Vec<String>) {
    let double = Double::new([1.0, 0.7], [0.9, 1.1], 9.81);
    let rest = equilibrium(&double, 0.0, [0.2, -0.1]).expect("equilibrium");
    let linear = linearize(&double, 0.0, &rest, &[0.0; 2]);
    let modes = linear.normal_modes().expect("modes");
    let shapes = modes.shapes.iter().copied();
    let modes = modes.squared_frequencies.iter().copied().chain(shapes);
    add(lines, "double modes", rest.into_iter().chain(modes));
    let forced = Forced::new(0.25);
    let damped = linearize(&forced, 0.0, &[0.3], &[0.1]).damped_modes().expect("modes");
    let damped = damped.iter().flat_map(|mode| {
        [mode.eigenvalue.re, mode.eigenvalue.im, mode.shape[0].re, mode.shape[0].im]
    });
    add(lines, "forced damped_modes", damped);
    let varied = Variational::<_, 1, VARIED>::new(forced.clone());
    let (q, v) = varied.start([0.2], [0.3]);
    let end =
        solve(&varied, (0.0, 3.0), q, v).method(Dop853).rtol(1e-11).run().expect("variational").end;
    add(lines, "forced variational", numbers_of(&end));
    let spectrum = lyapunov(&varied, 0.0, [0.2], [0.3]).transient(5.0).run(20.0).expect("spectrum");
    let errors = spectrum.standard_errors.clone();
    add(lines, "forced lyapunov", spectrum.exponents.into_iter().chain(errors));
    let simple = Simple::new(1.0);
    let section = poincare(&simple, (0.0, 20.0), [1.3], [0.0], |_, q, _| q[0]).rtol(1e-10);
    let crossings = section.start().expect("section");
    let crossings = crossings.flat_map(|state| numbers_of(&state.expect("crossing")));
    add(lines, "simple poincare", crossings);
    let bars = four_bar();
    let start = assemble(&bars, 0.0, [1.0, 0.4, 1.8], [2.0, 0.0, 0.0]).hold("α").run();
    let start = start.expect("assembled");
    let (momenta, mass) = (
        bars.momenta(At::of(0.0, &start.q, &start.v)),
        bars.mass_matrix(At::of(0.0, &start.q, &start.v)),
    );
    let numbers = numbers_of(&start).into_iter().chain(momenta);
    add(lines, "four_bar assembled", numbers.chain(mass.iter().copied()));
}

/// Returns the moments of a body.
fn moments(body: &Body) -> [f64; 6] {
    let ([x, y], [xx, xy, yy]) = (body.center, body.central);
    [body.mass, x, y, xx, xy, yy]
}

#[inline]
fn bodies(lines: &mut Vec<String>) {
    let corner = Polygon::new(&[[0.0, 0.0], [0.3, -0.2], [-0.1, -0.25], [-0.2, -0.1]]);
    let hole = [[0.0, -0.1], [0.05, -0.12], [0.0, -0.15]];
    let corner = corner.expect("polygon").hole(&hole).expect("hole");
    let ellipse = Ellipse::new([0.1, 0.2], 0.5, 0.3, 0.4).expect("ellipse");
    let outline = Outline::new(FillRule::EvenOdd)
        .move_to([0.0, 0.0])
        .cubic_to([0.2, -0.5], [0.2, -1.0], [0.0, -1.2])
        .line_to([0.3, -0.4])
        .quad_to([-0.4, -0.5], [-0.1, 0.1])
        .body(0.4)
        .expect("outline");
    let parts = [
        corner.body(3.0).expect("body"),
        ellipse.body(2.0).expect("body").rotated(0.3),
        outline,
        Body::rod(0.7, [0.0, 0.1], [0.4, -0.5]).expect("rod").with_pivot([0.1, 0.0]),
        Body::rectangle(0.5, 0.4, 0.2).expect("plank").scaled(1.5),
        Body::disc(0.2, 0.3).expect("disc").translated([0.3, 0.1]),
    ];
    let sum = Body::compound(parts).expect("compound").without(parts[3]).expect("without");
    add(lines, "bodies", parts.iter().chain([&sum]).flat_map(moments));
    let density = |[x, y]: [f64; 2]| 2.0 + x * x - y;
    let estimates = [
        corner.quadrature(density, 1e-6).expect("quadrature"),
        ellipse.quadrature(density, 1e-6).expect("quadrature"),
        corner.monte_carlo(density, 500, 9).expect("samples"),
    ];
    let errors = estimates.iter().flat_map(|one| [one.mass_error, one.inertia_error]);
    let numbers = estimates.iter().flat_map(|one| moments(&one.body)).chain(errors);
    add(lines, "estimates", numbers.collect::<Vec<_>>());
}
