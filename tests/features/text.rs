//! Solutions, states, bodies and baked motions that are written as text and read again.

use pendulum_runtime::body::Body;
use pendulum_runtime::integrate::{AdaptiveStep, Event, FixedStep, Saved, Stats};
use pendulum_runtime::motion::Still;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::DoubleDouble;
use pendulum_runtime::scene::{Baked, Scene};
use systems::problems::{Double, Hung, Simple};

fn solution() -> Solution<f64, 2> {
    let upright = |_: f64, q: &[f64; 2], _: &[f64; 2]| q[0];
    let events = [Event::new(upright)];
    solve(&Double::new([1.0; 2], [0.5; 2], 9.81), (0.0, 1.5), [1.0, 0.7], [0.1, 0.0])
        .every(0.25)
        .dense()
        .events(&events)
        .run()
        .unwrap()
}

#[test]
fn a_solution_comes_back_whole() {
    let solution = solution();
    assert!(!solution.events.is_empty());
    let text = serde_json::to_string(&solution).unwrap();
    let read: Solution<f64, 2> = serde_json::from_str(&text).unwrap();
    assert_eq!(read, solution);
    assert_eq!(read.column("theta_dot[1]"), solution.column("θ̇[1]"));
    assert_eq!(read.at(0.7321), solution.at(0.7321));
    assert_eq!(read.to_string(), solution.to_string());
    assert_eq!(serde_json::to_string(&read).unwrap(), text);
}

#[test]
fn a_damaged_solution_is_refused() {
    let value = serde_json::to_value(solution()).unwrap();
    let damaged = |change: fn(&mut serde_json::Value)| {
        let mut value = value.clone();
        change(&mut value);
        serde_json::from_value::<Solution<f64, 2>>(value).unwrap_err().to_string()
    };
    let message = damaged(|value| value["q"].as_array_mut().unwrap().truncate(2));
    assert!(message.contains("not as many states as times"), "{message}");
    let message = damaged(|value| value["velocities"].as_array_mut().unwrap().clear());
    assert!(message.contains("not the names of 2 coordinates"), "{message}");
    let message = damaged(|value| value["dense"]["ends"][0][0] = 3.into());
    assert!(message.contains("dense output"), "{message}");
    let message = damaged(|value| value["dense"]["values"].as_array_mut().unwrap().truncate(9));
    assert!(message.contains("dense output"), "{message}");
    let message = damaged(|value| value["end"]["q"] = vec![1.0].into());
    assert!(message.contains("invalid length 1, expected 2 numbers"), "{message}");
    let message = damaged(|value| value["stats"]["method"] = "x".repeat(65).into());
    assert!(message.contains("not the name of a method"), "{message}");
    // A state of two coordinates is not a state of one coordinate.
    assert!(serde_json::from_value::<Solution<f64, 1>>(value).is_err());
}

#[test]
fn states_stats_and_bodies_come_back() {
    let solution = solution();
    let text = serde_json::to_string(&(solution.end, solution.stats)).unwrap();
    let read: (State<f64, 2>, Stats) = serde_json::from_str(&text).unwrap();
    assert_eq!(read, (solution.end, solution.stats));

    let body = Body::point(0.3, [0.1, -0.7]).unwrap() + Body::point(0.2, [0.3, 0.1]).unwrap();
    let text = serde_json::to_string(&body).unwrap();
    assert_eq!(serde_json::from_str::<Body>(&text).unwrap(), body);
}

#[test]
fn baked_motions_come_back() {
    let mut scene = Scene::<f64>::new(60.0).unwrap();
    let hook = scene.joint(Still::new([0.0, 0.0]));
    let bob = scene.hang(hook, Hung::new(0.4, 9.81), [0.8], [0.0]).unwrap();
    let baked = scene.bake(&[bob], 60, 1e-3).unwrap();
    let text = serde_json::to_string(&baked).unwrap();
    let read: Vec<Baked<f64, 1>> = serde_json::from_str(&text).unwrap();
    assert_eq!(read, baked);

    let value = serde_json::to_value(&baked[0]).unwrap();
    assert_eq!(value["states"][0], serde_json::json!([[0.8], [0.0]]));
    for (place, index, bad, reason) in [
        ("ticks", 1, serde_json::json!(0), "ascending"),
        ("states", 0, serde_json::json!([[0.8, 0.1], [0.0]]), "coordinates"),
    ] {
        let mut value = value.clone();
        value[place][index] = bad;
        let message = serde_json::from_value::<Baked<f64, 1>>(value).unwrap_err().to_string();
        assert!(message.contains(reason), "{message}");
    }
}

/// The counters of constraints are read with their names.
#[test]
fn stats_of_constraints_are_read_as_they_were_written() {
    let bob = systems::constrained::Bob::new(1.0, 1.0);
    let solution = solve(&bob, (0.0, 1.0), [1.0, 0.0], [0.0; 2]).every(0.5).run().unwrap();
    let text = serde_json::to_string(&solution).unwrap();
    let back: Solution<f64, 2> = serde_json::from_str(&text).unwrap();
    assert_eq!(back, solution);
    assert_eq!(back.stats.constraints.unwrap().independence.constraint, "rod");
}

/// Saves integrations after twenty steps and continues them with what is read from their text.
macro_rules! saved {
    ($simple:expr, $q:expr, $v:expr, $events:expr; $($method:expr => $control:expr),+ $(,)?) => {$(
        let fresh = || {
            let run = Integrator::owning($simple, $method, 0.1, [$q], [$v]).unwrap();
            run.control($control).unwrap().events($events).unwrap()
        };
        let (mut whole, mut second) = (fresh(), fresh());
        (0..20).for_each(|_| whole.step().unwrap());
        let saved = whole.save();
        let read: Saved = serde_json::from_str(&serde_json::to_string(&saved).unwrap()).unwrap();
        assert_eq!(read, saved);
        second.restore(&read).unwrap();
        for _ in 0..20 {
            whole.step().unwrap();
            second.step().unwrap();
        }
        assert_eq!(second.save(), whole.save());
    )+};
}

#[test]
fn integrations_go_on_from_their_text() {
    let zero = Event::new(|_: f64, q: &[f64; 1], _: &[f64; 1]| q[0]).rising();
    let events = [zero, Event::at([0.5, 1.25])];
    saved!(Simple::new(9.81), 1.3, 0.2, events.clone();
        Auto => AdaptiveStep::new(), Dop853 => AdaptiveStep::new(), Picard => AdaptiveStep::new(),
        Taylor::new() => AdaptiveStep::new(), Gauss::<2>::new() => FixedStep::new(0.02),
        Leapfrog => FixedStep::new(0.01));
    let wide = DoubleDouble::from;
    saved!(Simple::new(wide(9.81)), wide(1.3), wide(0.2), Vec::new();
        Taylor::new() => AdaptiveStep::new().rtol(1e-25));
}
