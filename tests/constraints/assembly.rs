//! States that fulfil constraints near a guess, and multipliers along a solution.

use pendulum_runtime::error::{Error, Part};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Float as _;
use pendulum_runtime::system::System;
use systems::constrained::{
    ANDREWS_START, Bob, CarAxis, FourBar, Sleigh, andrews, car_axis, four_bar,
};

const BOB: Bob = Bob { m: 2.0, L: 1.0, g: 9.81 };

/// Returns the larger component of the loop vector of the four-bar, from its definition.
fn gap(bars: &FourBar, q: &[f64; 3]) -> f64 {
    let [l, m, n] = bars.l;
    let x = l * q[0].cos() + m * q[1].cos() - bars.d - n * q[2].cos();
    let y = l * q[0].sin() + m * q[1].sin() - n * q[2].sin();
    x.hypot(y)
}

#[test]
fn a_bob_goes_to_the_rod_along_the_radius() {
    // With equal masses, the result is the nearest point of the circle.
    let state = assemble(&BOB, 0.0, [3.0, -4.0], [0.0, 0.0]).run().unwrap();
    assert!((state.q[0] - 0.6).abs() < 1e-15 && (state.q[1] + 0.8).abs() < 1e-15, "{state:?}");
}

#[test]
fn velocities_lose_their_part_along_the_rod() {
    let state = assemble(&BOB, 0.0, [0.6, -0.8], [1.0, 2.0]).run().unwrap();
    // The projection of (1, 2) onto the tangent (0.8, 0.6).
    assert!((state.v[0] - 1.6).abs() < 1e-15 && (state.v[1] - 1.2).abs() < 1e-15, "{state:?}");
}

#[test]
fn what_is_held_keeps_its_bits_and_closes_the_loop() {
    let bars = four_bar();
    let guess = [0.7, 0.4, 1.6];
    assert!(1e-2 < gap(&bars, &guess));
    let state = assemble(&bars, 0.0, guess, [1.25, 0.0, 0.0]).hold("alpha").run().unwrap();
    assert_eq!((state.q[0].to_bits(), state.v[0].to_bits()), (0.7f64.to_bits(), 1.25f64.to_bits()));
    assert!(gap(&bars, &state.q) < 5e-16, "{:e}", gap(&bars, &state.q));
    // The rates, from differences of assembled positions.
    let h = 1e-5;
    let at = |angle: f64| {
        let mut q = state.q;
        q[0] = angle;
        assemble(&bars, 0.0, q, [0.0; 3]).hold("α").run().unwrap().q
    };
    let (after, before) = (at(0.7 + h), at(0.7 - h));
    for i in 1..3 {
        let rate = 1.25 * (after[i] - before[i]) / (2.0 * h);
        assert!((state.v[i] - rate).abs() < 1e-8, "{i}: {} {rate}", state.v[i]);
    }
    // An integration accepts this start.
    solve(&bars, (0.0, 0.1), state.q, state.v).run().unwrap();
}

#[test]
fn steps_are_the_shortest_in_the_metric_of_the_mass_matrix() {
    // Near the manifold M δq is a combination of the gradients, in any units.
    let bars = four_bar();
    let start = assemble(&bars, 0.0, [0.7, 0.4, 1.6], [0.0; 3]).run().unwrap().q;
    let guess = [start[0] + 1e-7, start[1] - 2e-7, start[2] + 3e-7];
    let end = assemble(&bars, 0.0, guess, [0.0; 3]).run().unwrap().q;
    let change = nalgebra::Vector3::from_fn(|i, _| end[i] - guess[i]);
    let momentum = bars.mass_matrix(At::of(0.0, &end, &[0.0; 3])) * change;
    let gradients = bars.constraint_jacobian(At::of(0.0, &end, &[0.0; 3]));
    let tangent = gradients.row(0).cross(&gradients.row(1));
    let along = tangent.dot(&momentum.transpose()) / (tangent.norm() * momentum.norm());
    assert!(along.abs() < 1e-5, "{along:e}");
}

#[test]
fn andrews_mechanism_comes_back_to_its_start() {
    let mut guess = ANDREWS_START;
    for (i, q) in guess.iter_mut().enumerate().skip(1) {
        *q += 0.01 * (i as f64 - 3.5);
    }
    // With one degree of freedom, β determines the other angles.
    let state = assemble(&andrews(), 0.0, guess, [0.0; 7]).hold("β").run().unwrap();
    for (found, known) in state.q.iter().zip(ANDREWS_START) {
        assert!((found - known).abs() < 1e-12, "{:?}", state.q);
    }
}

#[test]
fn constraints_that_move_give_velocities() {
    // The guide turns about the origin: the rate of x_b x_l + y_b y_l vanishes.
    let axis: CarAxis = car_axis();
    let state = assemble(&axis, 0.0, [0.0, 0.5, 1.0, 0.5], [0.0; 4]).run().unwrap();
    // ẋ_l + ẏ_b y_l = 0 with ẏ_b = rω = 1 and y_l = 1/2.
    assert!((state.v[0] + 0.5).abs() < 1e-15, "{:?}", state.v);
}

#[test]
fn two_words_are_assembled_to_both() {
    use pendulum_runtime::scalar::DoubleDouble;
    let bob = BOB.map(DoubleDouble::from);
    let [x, y, u, zero] = [0.3, -0.9, 1.0, 0.0].map(DoubleDouble::from);
    let state = assemble(&bob, 0.0, [x, y], [u, zero]).hold("x").run().unwrap();
    let [_, y] = state.q;
    assert!((x * x + y * y - DoubleDouble::from(1.0)).abs().to_f64() < 1e-30);
    assert!((x * state.v[0] + y * state.v[1]).abs().to_f64() < 1e-30);
}

#[test]
fn a_sleigh_keeps_its_place_and_loses_its_skid() {
    let sleigh = Sleigh { m: 1.0, I: 1.0, a: 0.0 };
    let state = assemble(&sleigh, 0.0, [3.0, -2.0, 0.0], [1.5, 0.7, 0.2]).run().unwrap();
    assert_eq!(state.q, [3.0, -2.0, 0.0]);
    assert_eq!(state.v, [1.5, 0.0, 0.2]);
}

#[test]
fn without_constraints_the_guess_stays() {
    let simple = systems::constrained::Simple { L: 1.0, g: 9.81 };
    let state = assemble(&simple, 2.0, [0.3], [0.4]).run().unwrap();
    assert_eq!((state.t, state.q, state.v), (2.0, [0.3], [0.4]));
}

#[test]
fn a_loop_that_does_not_close_is_named() {
    let mut bars = four_bar();
    bars.l = [0.1, 0.1, 0.1];
    let error = assemble(&bars, 0.0, [0.7, 0.4, 1.6], [0.0; 3]).run().unwrap_err();
    let Error::NotAssembled { part: Part::Position, constraint, residual, unit, .. } = error else {
        panic!("{error}")
    };
    assert!(constraint.starts_with("loop.") && unit == "m");
    // The reach is 0.3, and the distance is 1.
    assert!(0.49 < residual && residual < 1.0, "{residual}");
}

#[test]
fn too_much_that_is_held_is_named() {
    let error = assemble(&BOB, 0.0, [3.0, -4.0], [0.0; 2]).hold("x").run().unwrap_err();
    assert!(matches!(error, Error::NotAssembled { constraint: "rod", .. }), "{error}");
    let all = assemble(&BOB, 0.0, [0.6, -0.7], [0.0; 2]).hold("x").hold("y").run().unwrap_err();
    assert!(matches!(all, Error::NotAssembled { constraint: "rod", .. }), "{all}");
    // If both held coordinates are consistent, nothing has to be solved.
    assemble(&BOB, 0.0, [0.0, -1.0], [0.3, 0.0]).hold("x").hold("y").run().unwrap();
}

#[test]
fn the_centre_of_a_circle_leads_nowhere() {
    let error = assemble(&BOB, 0.0, [0.0, 0.0], [0.0; 2]).run().unwrap_err();
    assert!(matches!(error, Error::NotAssembled { constraint: "rod", .. }), "{error}");
}

#[test]
fn names_that_do_not_exist_list_those_that_do() {
    let error = assemble(&BOB, 0.0, [0.0, -1.0], [0.0; 2]).hold("z").run().unwrap_err();
    assert_eq!(error.to_string(), "there is no coordinate `z` to hold; there are `x`, `y`");
}

#[test]
fn guesses_that_are_not_finite_are_refused() {
    let error = assemble(&BOB, 0.0, [f64::NAN, -1.0], [0.0; 2]).run().unwrap_err();
    assert!(matches!(error, Error::InitialState { part: Part::Position, .. }), "{error}");
}

#[test]
fn the_pull_of_a_pendulum_is_weight_and_centripetal_force() {
    let solution =
        solve(&BOB, (0.0, 3.0), [0.6, -0.8], [0.0; 2]).rtol(1e-10).every(0.1).run().unwrap();
    let columns = solution.reactions(&BOB).unwrap();
    assert_eq!(columns.len(), 1);
    for (state, λ) in solution.iter().zip(&columns[0]) {
        // 2 L λ = −(m v²/L − m g y/L), from energy v² = 2 g (y₀ − y).
        let [_, y] = state.q;
        let pull = 2.0 * (2.0 * 9.81 * (-0.8 - y)) - 2.0 * 9.81 * y;
        assert!((2.0 * λ + pull).abs() < 1e-7, "{λ} {pull}");
        assert_eq!(*λ, BOB.reactions_at(state.t, &state.q, &state.v)[0]);
    }
    let table = solution.table_with_reactions(&BOB).unwrap();
    let header: Vec<String> = table.header().collect();
    assert!(header.last().unwrap().starts_with("λ_rod ["), "{header:?}");
    assert_eq!(table.column("λ_rod").unwrap(), columns[0]);
}
