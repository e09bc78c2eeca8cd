//! Walls that no series detects from far away also turn members back in lanes.

use crate::lanes::{number, same};
use pendulum_runtime::ensemble::Ensemble;
use pendulum_runtime::integrate::{Batch, Event, Problem};
use pendulum_runtime::prelude::*;

lagrangian! {
    /// A ball before a wall at x = 1, as steep as you like.
    #[derive(Clone, Debug)]
    pub struct Ball { k, U = 1 }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = U*exp(k*(x - 1));
}

lagrangian! {
    /// A ball that rolls over a bump at x = 1 or back.
    #[derive(Clone, Debug)]
    pub struct Bump { w, U = 1 }
    coordinate x;
    kinetic = ẋ^2/2;
    potential = U*exp(-((x - 1)/w)^2);
}

/// Returns a ball on its way to the wall.
fn ball(j: usize) -> Problem<Ball, 1> {
    Problem {
        system: Ball::new(50.0 + 400.0 * number(j, 1)),
        time: (0.0, 5.0),
        q: [-number(j, 2)],
        v: [0.5 + number(j, 3)],
    }
}

/// Returns the position of a ball at `t`, from e^(k(x − 1)) = E/cosh²(k u (t − t′)/2) with E =
/// u²/2.
fn turned_back(Problem { system, q, v, .. }: &Problem<Ball, 1>, t: f64) -> f64 {
    let (k, start) = (system.k, system.k * (q[0] - 1.0));
    let energy = 0.5 * v[0] * v[0] + start.exp();
    let half = 0.5 * k * (2.0 * energy).sqrt();
    // ln cosh for numbers that may be large, and its inverse for √(E/e^start).
    let ln_cosh = |x: f64| x.abs() + (0.5 + 0.5 * (-2.0 * x.abs()).exp()).ln();
    let ratio = 0.5 * (energy.ln() - start);
    let turn = (ratio + (1.0 + (1.0 - (-2.0 * ratio).exp()).sqrt()).ln()) / half;
    1.0 + (energy.ln() - 2.0 * ln_cosh(half * (t - turn))) / k
}

#[test]
fn balls_come_back_from_a_steep_wall() {
    let all = Ensemble::new(0..200, ball).rtol(1e-12).every(0.25);
    let all = all.map(|_, solution| solution.clone()).collect().unwrap();
    let mut rejected = 0;
    for (j, member) in all.value.into_iter().enumerate() {
        let member = member.unwrap();
        rejected += member.stats.rejected;
        for (t, [x]) in member.t.iter().zip(&member.q) {
            let error = (x - turned_back(&ball(j), *t)).abs();
            assert!(error < 1e-9, "ball {j} at {t} s: {error:e}");
        }
    }
    assert!(200 < rejected, "{rejected}");
}

/// A ball with less energy than the height of the bump comes back. As with `Taylor`, a bump is
/// detected if a step ends on it.
#[test]
fn balls_pass_over_a_bump_or_come_back() {
    let bump = |j: usize| Problem {
        system: Bump::new(0.04 + 0.01 * number(j, 4)),
        time: (0.0, 10.0),
        q: [-number(j, 5)],
        v: [0.5 + 1.8 * number(j, 6)],
    };
    let all = Ensemble::new(0..100, bump).rtol(1e-10).max_step(0.1);
    let all = all.map(|_, solution| solution.end).collect().unwrap();
    for (j, end) in all.value.into_iter().enumerate() {
        let ([v], end) = (bump(j).v, end.unwrap());
        let expected = if 0.5 * v * v < 1.0 { -v } else { v };
        assert!((end.v[0] - expected).abs() < 1e-7, "ball {j}: {v} at the start, {end:?}");
    }
}

#[test]
fn walls_have_the_bits_of_single_motions() {
    let hits = Event::new(|_, x: &[f64; 1], _| x[0] - 0.9);
    assert!(100 < same!(100, ball, rtol(1e-9), every(0.3), events([hits.clone()])).0);
    assert!(500 < same!(50, ball, rtol(1e-6), every_step()).1);
    same!(50, ball, rtol(1e-13), dense());
    let far = Event::new(|_, x: &[f64; 1], v| if v[0] < 0.0 { x[0] } else { 1.0 }).terminal();
    assert!(50 < same!(100, ball, rtol(1e-9), events([far.clone()])).0);
    for most in [3, 20, 30, 40, 60, 80] {
        same!(30, ball, rtol(1e-9), max_steps(most));
    }
}

/// The bits of a motion do not depend on its neighbours.
#[test]
fn neighbours_change_nothing() {
    let problems: Vec<_> = (0..40).map(ball).collect();
    let together = Batch::new().rtol(1e-11).run(&problems).unwrap();
    let backwards: Vec<_> = problems.iter().rev().cloned().collect();
    let reversed = Batch::new().rtol(1e-11).run(&backwards).unwrap();
    for (j, outcome) in together.into_iter().enumerate() {
        let alone = Batch::new().rtol(1e-11).run(&problems[j..=j]).unwrap().remove(0);
        let outcome = outcome.unwrap();
        assert_eq!(outcome, alone.unwrap(), "ball {j}");
        assert_eq!(&outcome, reversed[39 - j].as_ref().unwrap(), "ball {j}");
    }
}
