//! Integrations that are saved between two steps and continue in another integrator with the same
//! bits.

use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::controller::Controller;
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::integrate::{AdaptiveStep, Event, FixedStep, Stats};
use pendulum_runtime::motion::Curve;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use systems::problems::{Double, HenonHeiles, Simple};
use systems::random::{Random, some};

lagrangian! {
    pub struct Hand { L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = |ẏ|^2/2;
    potential = g*height(y);
}

/// Saves a run at random steps, continues with a fresh integrator, and compares all later states.
fn check<const N: usize, D, M, C, T>(
    fresh: impl Fn() -> Integrator<'static, N, D, M, C>,
    steps: u64,
    random: &mut Random,
) where
    T: Float,
    D: Dynamics<N, Scalar = T> + 'static,
    M: Method<D, N>,
    C: Controller<M, D, N>,
{
    let name = M::NAME;
    let mut whole = fresh();
    let mut states = vec![whole.state()];
    for _ in 0..steps {
        whole.step().unwrap();
        // The low words and the saved integration are also compared.
        states.push(whole.state());
    }
    let last = whole.save();
    for _ in some(0..6) {
        let at = (random.uniform(0.0, steps as f64)) as u64;
        let mut first = fresh();
        for _ in 0..at {
            first.step().unwrap();
        }
        let saved = first.save();
        let mut second = fresh();
        // Earlier steps of the restored integrator must have no effect.
        for _ in 0..at / 3 + 2 {
            second.step().unwrap();
        }
        second.restore(&saved).unwrap();
        assert_eq!(second.save(), saved, "{name} at {at}");
        for step in at..steps {
            assert_eq!(second.state(), states[step as usize], "{name} from {at}, at {step}");
            second.step().unwrap();
        }
        let (found, expected): (Stats, Stats) = (second.stats(), whole.stats());
        assert_eq!(second.save(), last, "{name} from {at}");
        assert_eq!(found, expected, "{name} from {at}");
    }
}

/// Returns an adaptive step control with the tolerance `rtol`.
fn adaptive<const N: usize>(rtol: f64) -> AdaptiveStep<N> {
    AdaptiveStep::new().rtol(rtol)
}

macro_rules! every {
    ($random:ident, $system:expr, $q:expr, $v:expr, $steps:expr; $($method:expr => $control:expr),+ $(,)?) => {$(
        check(
            || {
                let zero = Event::new(|_t, q, _v| q[0]).rising();
                let wall = Event::new(|_t, q, _v| q[0] + 0.4).falling().then(|state| state.v[0] *= -0.9);
                Integrator::owning($system, $method, 0.1, $q, $v)
                    .unwrap()
                    .control($control)
                    .unwrap()
                    .events([zero, wall, Event::at([0.5, 1.25])])
                    .unwrap()
            },
            $steps,
            &mut $random,
        );
        check(
            || Integrator::owning($system, $method, 0.1, $q, $v).unwrap().control($control).unwrap(),
            $steps,
            &mut $random,
        );
    )+};
}

#[test]
fn every_method_goes_on_with_the_same_bits() {
    let mut random = Random::new(7);
    every!(random, Simple::new(9.81), [1.3], [0.2], 150;
        Auto => adaptive(1e-9), Auto => FixedStep::new(0.01), Dop853 => adaptive(1e-9),
        Rodas4 => adaptive(1e-6), Dprkn12 => adaptive(1e-11), Picard => adaptive(1e-10),
        Picard => FixedStep::new(0.05), Taylor::new() => adaptive(1e-12), Rk4 => FixedStep::new(0.01),
        Leapfrog => FixedStep::new(0.01), SymplecticEuler => FixedStep::new(0.01), Srkn6b => FixedStep::new(0.02),
        Srkn14a => FixedStep::new(0.05),
        Gauss::<2>::new() => FixedStep::new(0.02), Gauss::<3>::new() => FixedStep::new(0.02),
        Gauss::<2>::new().newton() => FixedStep::new(0.02));
    every!(random, Double::new([1.0, 0.7], [1.0, 0.6], 9.81), [1.3, 0.4], [0.2, 1.0], 80;
        Auto => adaptive(1e-9), Dop853 => adaptive(1e-9), Picard => adaptive(1e-8), Taylor::new() => adaptive(1e-12),
        Rodas4 => adaptive(1e-5), Gauss::<4>::new() => FixedStep::new(0.02));
    every!(random, HenonHeiles::new(1.0), [0.1, 0.3], [0.3, 0.1], 120;
        Auto => adaptive(1e-9), Picard => adaptive(1e-13));
}

/// Saves runs with jumps of velocities at kinks, and with series that were rejected.
#[test]
fn kinks_and_breaks_are_remembered() {
    let mut random = Random::new(11);
    let keys = [0.0, 0.31, 0.72, 1.5, 2.6, 4.0];
    let places = [[0.0, 0.0], [0.3, 0.1], [0.1, 0.0], [0.0, -0.2], [0.2, 0.0], [0.0, 0.0]];
    let by_lines = || Hand::new(1.0).driven_by(Curve::linear(&keys, &places).unwrap());
    let by_spline = || Hand::new(1.0).driven_by(Curve::spline(&keys, &places).unwrap());
    every!(random, by_lines(), [0.3], [0.2], 60;
        Auto => adaptive(1e-9), Dop853 => adaptive(1e-9), Picard => adaptive(1e-10), Taylor::new() => adaptive(1e-10),
        Rk4 => FixedStep::new(0.01), Gauss::<3>::new() => FixedStep::new(0.02));
    every!(random, by_spline(), [0.3], [0.2], 60;
        Auto => adaptive(1e-9), Picard => adaptive(1e-12), Taylor::new() => adaptive(1e-10));
}

#[test]
fn both_words_of_a_scalar_are_saved() {
    let mut random = Random::new(13);
    let simple = || Simple::new(DoubleDouble::from(9.81));
    let (q, v) = ([DoubleDouble::from(1.3)], [DoubleDouble::from(0.2)]);
    check(
        || {
            Integrator::owning(simple(), Taylor::new(), 0.1, q, v)
                .unwrap()
                .control(adaptive(1e-25))
                .unwrap()
        },
        30,
        &mut random,
    );
    check(|| Integrator::owning(simple(), Dop853, 0.1, q, v).unwrap(), 30, &mut random);
}

#[test]
fn a_solve_that_was_interrupted_ends_as_it_would_have() {
    let simple = Simple::new(9.81);
    let problem = || solve(&simple, (0.0, 30.0), [1.3], [0.2]).rtol(1e-10).t_stops(&[7.0, 21.5]);
    let solution = problem().run().unwrap();
    let mut first = problem().start().unwrap();
    first.steps().take(40).for_each(|state| assert!(state.is_ok()));
    let saved = first.save();
    let mut second = problem().start().unwrap();
    second.restore(&saved).unwrap();
    // The saved state does not contain the last step.
    assert_eq!(
        (second.at(second.t()), second.interpolant().is_none()),
        (Some(second.state()), true)
    );
    let end = second.steps().last().unwrap().unwrap();
    assert_eq!((end, second.stats()), (solution.end, solution.stats));
}

#[test]
fn what_does_not_fit_is_refused_and_changes_nothing() {
    let simple = Simple::new(9.81);
    let dop = || Integrator::new(&simple, Dop853, 0.0, [1.0], [0.0]).unwrap();
    let mut saved = dop();
    saved.advance_to(1.0).unwrap();
    let saved = saved.save();
    let refused = |found: Result<(), Error>| {
        let error = found.unwrap_err();
        assert!(matches!(error, Error::Saved { .. }), "{error}");
        assert!(error.to_string().contains("`Dop853`"), "{error}");
    };
    refused(Integrator::new(&simple, Picard, 0.0, [1.0], [0.0]).unwrap().restore(&saved));
    let henon = HenonHeiles::new(1.0);
    refused(Integrator::new(&henon, Dop853, 0.0, [0.1; 2], [0.0; 2]).unwrap().restore(&saved));
    let mut other = dop().events([Event::new(|_t, q, _v| q[0])]).unwrap();
    other.advance_to(0.3).unwrap();
    let before = other.save();
    refused(other.restore(&saved));
    assert_eq!(other.save(), before);
    other.advance_to(0.5).unwrap();
}
