//! The errors of a pendulum whose pivot shakes a thousand times a second, in units of the
//! tolerance. `cargo test --test methods fast_drive -- --ignored --nocapture` prints the figures of
//! `pendulum-runtime/src/guide/accuracy.md`.

use core::f64::consts::TAU;
use pendulum_runtime::jet::Series;
use pendulum_runtime::motion::{Analytic, Derivatives, Sample, Side, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use pendulum_runtime::time::Time;

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Kapitza { l, g }
    coordinate θ;
    driven x: [1; 2];
    let r = x + l*[sin(θ), -cos(θ)];
    kinetic = |ṙ|^2/2;
    potential = g*height(r);
}

const FREQUENCY: f64 = 1000.0 * TAU;
const PHASE: f64 = 0.3;

/// The same vertical drive, computed entirely in two words.
#[derive(Clone, Copy, Debug)]
struct Exact {
    amplitude: f64,
}

impl Exact {
    fn at(self, t: Time) -> [DoubleDouble; 3] {
        let [a, w, phase] = [self.amplitude, FREQUENCY, PHASE].map(DoubleDouble::from);
        let (sin, cos) =
            (w * (DoubleDouble::from(t.to_f64()) + DoubleDouble::from(t.low())) + phase).sin_cos();
        [a * sin, a * w * cos, -(a * w * w * sin)]
    }
}

impl Motion<DoubleDouble, 2> for Exact {
    const HAS: Derivatives = Derivatives::ALL;

    fn sample(&self, t: Time, _: Side, _: Derivatives) -> Sample<DoubleDouble, 2> {
        let ([position, velocity, acceleration], zero) = (self.at(t), DoubleDouble::from(0.0));
        Sample {
            position: [zero, position],
            velocity: [zero, velocity],
            acceleration: [zero, acceleration],
        }
    }

    fn next_kink(&self, _: f64) -> Option<f64> {
        None
    }

    fn analytic(&self) -> Option<&dyn Analytic<DoubleDouble, 2>> {
        Some(self)
    }
}

impl Analytic<DoubleDouble, 2> for Exact {
    fn series(
        &self,
        t: Time,
        _: Side,
        component: usize,
        count: usize,
        position: &mut Series<DoubleDouble>,
    ) {
        let w = DoubleDouble::from(FREQUENCY);
        let [mut even, mut odd, _] =
            if component == 0 { [DoubleDouble::from(0.0); 3] } else { self.at(t) };
        for (k, coefficient) in position.iter_mut().take(count).enumerate() {
            *coefficient = even;
            let next = -(w * w * even) / DoubleDouble::from(((k + 1) * (k + 2)) as f64);
            (even, odd) = (odd, next);
        }
    }

    fn next_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_break(&self, _: f64) -> Option<f64> {
        None
    }

    fn last_kink(&self, _: f64) -> Option<f64> {
        None
    }
}

/// Computes the error of θ after some seconds, in units of the tolerance.
macro_rules! missed {
    ($shaken:expr, $method:expr, $seconds:expr, $rtol:expr, $exact:expr) => {{
        let run = solve(&$shaken, (0.0, $seconds), [2.9], [0.0])
            .method($method)
            .rtol($rtol)
            .atol($rtol)
            .run()
            .unwrap();
        let missed = (DoubleDouble::from(run.end.q[0]) - $exact).abs().to_f64() / $rtol;
        println!("  {:.0e}: {missed:9.2e} tolerances off; {}", $rtol, run.stats);
        missed
    }};
}

#[test]
#[ignore = "tens of seconds without optimization: `.ci/run` runs it"]
fn a_kilohertz_costs_no_digits() {
    for (amplitude, seconds) in [(1e-3, 1.0), (1e-3, 3.0), (1e-2, 3.0)] {
        let [start, zero, l, g] = [2.9, 0.0, 1.0, 9.81].map(DoubleDouble::from);
        let trusted = Kapitza::new(l, g).driven_by(Exact { amplitude });
        let exact = |q| {
            solve(&trusted, (0.0, seconds), [q], [zero])
                .method(Taylor::new())
                .rtol(1e-20)
                .run()
                .unwrap()
                .end
                .q[0]
        };
        let end = exact(start);
        let amplified = (exact(start + DoubleDouble::from(1e-12)) - end).abs().to_f64() / 1e-12;
        println!("{amplitude} m, {seconds} s, the motion amplifies errors {amplified:.1} times");
        let shaken = Kapitza::new(1.0, 9.81).driven_by(Sinusoid::new(
            [0.0, amplitude],
            FREQUENCY,
            [0.0, PHASE],
        ));
        for rtol in [1e-6, 1e-9, 1e-12, 1e-13] {
            // The measured errors over the amplification are at most 1.6, 1.7 and 9.4.
            assert!(missed!(shaken, Dop853, seconds, rtol, end) < 5.0 * amplified);
            assert!(missed!(shaken, Picard, seconds, rtol, end) < 6.0 * amplified);
            assert!(missed!(shaken, Taylor::new(), seconds, rtol, end) < 30.0 * amplified);
        }
    }
}
