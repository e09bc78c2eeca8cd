//! Tests of motions against closed forms, finite differences and limits from both sides.

use super::*;
use crate::motion::input::Input;
use crate::scalar::Real;
use crate::time::Time;

const TIMES: [f64; 6] = [0.0, 0.4, 0.7, 1.5, 1.9, 3.0];

fn at<const D: usize, M: Motion<f64, D>>(motion: &M, t: f64) -> Sample<f64, D> {
    motion.sample(Time::new(t), Side::After, Derivatives::ALL)
}

fn before<const D: usize, M: Motion<f64, D>>(motion: &M, t: f64) -> Sample<f64, D> {
    motion.sample(Time::new(t), Side::Before, Derivatives::ALL)
}

fn has<M: Motion<f64, 1>>(_: &M) -> Derivatives {
    M::HAS
}

fn kinks<const D: usize, M: Motion<f64, D>>(motion: &M, from: f64, to: f64) -> Vec<f64> {
    let mut found = Vec::new();
    let mut t = from;
    while let Some(kink) = motion.next_kink(t).filter(|&kink| kink <= to) {
        assert!(t < kink);
        found.push(kink);
        t = kink;
    }
    found
}

/// Checks that velocities and accelerations match finite differences of positions and velocities.
fn consistent<const D: usize, M: Motion<f64, D>>(motion: &M, times: impl Iterator<Item = f64>) {
    let h = 1e-5;
    for t in times {
        let (low, here, high) = (at(motion, t - h), at(motion, t), at(motion, t + h));
        for d in 0..D {
            let velocity = (high.position[d] - low.position[d]) / (2.0 * h);
            let acceleration = (high.velocity[d] - low.velocity[d]) / (2.0 * h);
            assert!(
                (velocity - here.velocity[d]).abs() < 1e-7,
                "velocity at {t}: {velocity} and {}",
                here.velocity[d]
            );
            assert!((acceleration - here.acceleration[d]).abs() < 1e-6, "acceleration at {t}");
        }
    }
}

fn cubic(t: f64) -> [f64; 2] {
    [1.0 - 2.0 * t + t * t * t, 0.5 * t * t - 0.25 * t * t * t]
}

fn cubic_velocity(t: f64) -> [f64; 2] {
    [-2.0 + 3.0 * t * t, t - 0.75 * t * t]
}

#[test]
fn a_clamped_spline_reproduces_cubics() {
    let values: Vec<[f64; 2]> = TIMES.iter().map(|&t| cubic(t)).collect();
    let spline = Curve::clamped(&TIMES, &values, cubic_velocity(0.0), cubic_velocity(3.0)).unwrap();
    for k in 0..=300 {
        let t = 3.0 * f64::from(k) / 300.0;
        let sample = if k == 300 { before(&spline, t) } else { at(&spline, t) };
        let (position, velocity, acceleration) =
            (cubic(t), cubic_velocity(t), [6.0 * t, 1.0 - 1.5 * t]);
        for d in 0..2 {
            assert!((sample.position[d] - position[d]).abs() < 2e-14);
            assert!((sample.velocity[d] - velocity[d]).abs() < 1e-13);
            assert!((sample.acceleration[d] - acceleration[d]).abs() < 1e-12);
        }
    }
}

#[test]
fn a_spline_has_continuous_accelerations() {
    let values: Vec<[f64; 1]> = TIMES.iter().map(|&t| [(3.0 * t).rem_euclid(1.0)]).collect();
    let spline = Curve::spline(&TIMES, &values).unwrap();
    for &key in &TIMES[1..5] {
        let (left, right) = (before(&spline, key), at(&spline, key));
        assert!((left.velocity[0] - right.velocity[0]).abs() < 1e-12);
        assert!((left.acceleration[0] - right.acceleration[0]).abs() < 1e-11);
    }
    assert!(at(&spline, 0.0).acceleration[0].abs() < 1e-12);
    assert_eq!(kinks(&spline, -1.0, 10.0), [0.0, 3.0]);
    consistent(&spline, (1..29).map(|k| 0.1 * f64::from(k) + 0.03));
}

#[test]
fn a_periodic_spline_closes_without_a_kink() {
    let mut values: Vec<[f64; 1]> = TIMES.iter().map(|&t| [(2.1 * t).rem_euclid(1.3)]).collect();
    values[TIMES.len() - 1] = values[0];
    let spline = Curve::periodic(&TIMES, &values).unwrap();
    let (end, start) = (before(&spline, 3.0), at(&spline, 0.0));
    assert!((end.position[0] - start.position[0]).abs() < 1e-14);
    assert!((end.velocity[0] - start.velocity[0]).abs() < 1e-13);
    assert!((end.acceleration[0] - start.acceleration[0]).abs() < 1e-12);
    assert_eq!(Motion::<f64, 1>::next_kink(&spline, 0.5), None);
    for turn in [-3.0, 1.0, 1000.0] {
        let (a, b) = (at(&spline, 0.9), at(&spline, 0.9 + 3.0 * turn));
        assert!((a.acceleration[0] - b.acceleration[0]).abs() < 1e-9);
    }
    consistent(&spline, (0..90).map(|k| 0.1 * f64::from(k) + 0.033));
}

#[test]
fn one_piece_can_be_periodic() {
    let spline = Curve::periodic(&[0.0, 2.0], &[[1.0], [1.0]]).unwrap();
    assert_eq!(at(&spline, 1.3).position, [1.0]);
}

#[test]
fn what_ends_elsewhere_than_it_begins_is_not_periodic() {
    let refused = Curve::periodic(&[0.0, 1.0, 2.0], &[[0.0, 1.0], [1.0, 2.0], [0.0, 5.0]]);
    let message = refused.unwrap_err().to_string();
    assert!(message.starts_with("component 1 begins at 1.0 and ends at 5.0; repeat"), "{message}");
    // The last value may differ by a rounding error.
    let turn = std::f64::consts::TAU;
    let values: Vec<[f64; 1]> = (0..5).map(|k| [(turn / 4.0 * f64::from(k)).sin()]).collect();
    assert!(values[4] != values[0]);
    Curve::periodic(&[0.0, 1.0, 2.0, 3.0, 4.0], &values).unwrap();
}

#[test]
fn catmull_rom_reproduces_parabolas() {
    let values: Vec<[f64; 1]> = TIMES.iter().map(|&t| [2.0 - t + 3.0 * t * t]).collect();
    let curve = Curve::catmull_rom(&TIMES, &values).unwrap();
    for k in 0..30 {
        let t = 0.1 * f64::from(k);
        let sample = at(&curve, t);
        assert!((sample.position[0] - (2.0 - t + 3.0 * t * t)).abs() < 1e-13);
        assert!((sample.velocity[0] - (6.0 * t - 1.0)).abs() < 1e-12);
        assert!((sample.acceleration[0] - 6.0).abs() < 1e-11);
    }
}

#[test]
fn linear_keys_jump_in_velocity_where_they_bend() {
    let linear =
        Curve::linear(&[0.0, 1.0, 2.0, 3.0, 4.0], &[[0.0], [1.0], [2.0], [2.0], [1.0]]).unwrap();
    // No kink at 1: the slopes on both sides are equal.
    assert_eq!(kinks(&linear, -1.0, 9.0), [0.0, 2.0, 3.0, 4.0]);
    assert_eq!(before(&linear, 2.0).velocity, [1.0]);
    assert_eq!(at(&linear, 2.0).velocity, [0.0]);
    assert_eq!(before(&linear, 0.0).velocity, [0.0]);
    assert_eq!(at(&linear, 0.0).velocity, [1.0]);
    assert_eq!(at(&linear, 2.5).acceleration, [0.0]);
    assert_eq!(at(&linear, 9.0).position, [1.0]);
    assert_eq!(at(&linear, -9.0).position, [0.0]);
}

#[test]
fn looped_keys_have_kinks_in_every_turn() {
    let linear = Curve::linear(&[0.5, 1.0, 1.6], &[[0.0], [1.0], [0.0]]).unwrap().looped().unwrap();
    let found = kinks(&linear, 0.0, 100.0);
    assert_eq!(found.len(), 181);
    for kink in found {
        let (left, right) = (before(&linear, kink), at(&linear, kink));
        assert!((left.velocity[0] * right.velocity[0]) < 0.0, "at {kink}: {left:?} {right:?}");
        assert!((left.position[0] - right.position[0]).abs() < 1e-12);
    }
    let far = kinks(&linear, 1e6 + 0.05, 1e6 + 11.05);
    assert_eq!(far.len(), 20);
    assert!(
        far.iter()
            .all(|&kink| before(&linear, kink).velocity[0] * at(&linear, kink).velocity[0] < 0.0)
    );
}

#[test]
fn sinusoids_have_exact_derivatives() {
    let circle =
        Sinusoid::new([2.0, 2.0], 3.0, [core::f64::consts::FRAC_PI_2, 0.0]).about([1.0, -1.0]);
    let sample = at(&circle, 0.4);
    let (sin, cos) = 1.2f64.sin_cos();
    assert!((sample.position[0] - (1.0 + 2.0 * cos)).abs() < 1e-15);
    assert!((sample.velocity[1] - 6.0 * cos).abs() < 1e-14);
    assert!((sample.acceleration[1] + 18.0 * sin).abs() < 1e-14);
    consistent(&circle, (0..20).map(f64::from));
}

/// Checks that positions stay within the amplitude for large angles, and that all functions that
/// sample agree bitwise.
#[test]
fn sinusoids_stay_within_their_amplitude() {
    use crate::scalar::{DoubleDouble, Float};
    let word = DoubleDouble::from;
    for w in [6.3e9, 1.0, 7e4, 1e150, 1e270] {
        let motion = Sinusoid::new([1.0, 1.0], w, [0.3, 1e17]);
        for scale in [1.0, 1.7e5, 1e8 / 3.0, 1.1e8, 7e30] {
            // Small and large low words in the same samples.
            let times: [Time; 8] = core::array::from_fn(|lane| {
                Time::new(if lane < 3 {
                    scale * (lane as f64 - 1.3)
                } else {
                    f64::from(lane as i32) / w
                }) + 1e-9 / w
            });
            let lanes = Motion::<f64, 2>::sample_lanes(&motion, &times, Derivatives::POSITION);
            let mut all = [Sample::<f64, 2>::zero(); 8];
            motion.sample_all(&times, Derivatives::POSITION, &mut all);
            for (lane, &t) in times.iter().enumerate() {
                let sample: Sample<f64, 2> = motion.sample(t, Side::After, Derivatives::POSITION);
                for d in 0..2 {
                    let x = sample.position[d];
                    assert!(x.abs() <= 1.0 + 4.0 * f64::EPSILON, "{w:e} · {t:?}: {x}");
                    assert_eq!(x.to_bits(), all[lane].position[d].to_bits(), "{w:e} · {t:?}");
                    assert_eq!(x.to_bits(), lanes.position[d].0[lane].to_bits(), "{w:e} · {t:?}");
                }
                let angle = word(w) * (word(t.to_f64()) + word(t.low())) + word(0.3);
                if angle.abs().to_f64() < 1e18 {
                    let error = (word(sample.position[0]) - angle.sin()).abs().to_f64();
                    assert!(
                        error < 4e-16 + 1e-31 * angle.abs().to_f64(),
                        "{w:e} · {t:?}: {error:e}"
                    );
                }
            }
        }
    }
}

/// Checks that the phase after 1.5 hours at 1 kHz is as accurate as at the start, and that all
/// functions that sample agree bitwise.
#[test]
fn fast_sinusoids_keep_their_phase() {
    use crate::scalar::{DoubleDouble, Float};
    let (w, phase) = (2000.0 * core::f64::consts::PI, 0.3);
    let motion = Sinusoid::new([1.0], w, [phase]);
    let word = DoubleDouble::from;
    for k in 0..500 {
        let times: [Time; 8] =
            core::array::from_fn(|lane| Time::new(f64::from(8 * k + lane as i32) * 1.37) + 1e-17);
        let lanes = Motion::<f64, 1>::sample_lanes(&motion, &times, Derivatives::ALL);
        let mut all = [Sample::<f64, 1>::zero(); 8];
        motion.sample_all(&times, Derivatives::ALL, &mut all);
        for (lane, &t) in times.iter().enumerate() {
            let sample: Sample<f64, 1> = motion.sample(t, Side::After, Derivatives::ALL);
            let (sin, cos) = (word(w) * (word(t.to_f64()) + word(t.low())) + word(phase)).sin_cos();
            let scaled =
                [sample.position[0], sample.velocity[0] / w, -sample.acceleration[0] / (w * w)];
            for (value, exact) in scaled.into_iter().zip([sin, cos, sin]) {
                let error = (word(value) - exact).abs().to_f64();
                assert!(error < 5e-16, "t = {t:?}: {value} is {error:e} off");
            }
            assert_eq!(sample, all[lane]);
            let wide = [
                lanes.position[0].0[lane],
                lanes.velocity[0].0[lane],
                lanes.acceleration[0].0[lane],
            ];
            assert_eq!([sample.position[0], sample.velocity[0], sample.acceleration[0]], wide);
            let mut series = [0.0; crate::jet::LENGTH];
            Analytic::<f64, 1>::series(&motion, t, Side::After, 0, 2, &mut series);
            assert_eq!([series[0], series[1]], [sample.position[0], sample.velocity[0]]);
        }
    }
}

#[test]
fn steps_jump_at_their_keys() {
    let steps = Curve::steps(&[1.0, 2.0, 3.0, 4.0], &[[5.0], [5.0], [7.0], [6.0]]).unwrap();
    assert_eq!(kinks(&steps, 0.0, 9.0), [3.0, 4.0]);
    assert_eq!((before(&steps, 3.0).position, at(&steps, 3.0).position), ([5.0], [7.0]));
    assert_eq!(
        [0.0, 1.5, 3.5, 4.0, 9.0].map(|t| at(&steps, t).position[0]),
        [5.0, 5.0, 7.0, 6.0, 6.0]
    );
    assert_eq!((at(&steps, 3.5).velocity, at(&steps, 3.5).acceleration), ([0.0], [0.0]));
    // The value of the last piece jumps at the seam, although the last key has that of the first.
    let again = Curve::steps(&[0.0, 1.0, 2.0], &[[0.0], [1.0], [0.0]]).unwrap().looped().unwrap();
    assert_eq!(kinks(&again, 0.5, 4.5), [1.0, 2.0, 3.0, 4.0]);
    assert_eq!((before(&again, 2.0).position, at(&again, 2.0).position), ([1.0], [0.0]));
    let constant = Curve::steps(&[0.0, 2.0], &[[1.0], [1.0]]).unwrap().looped().unwrap();
    assert!(kinks(&constant, -3.0, 9.0).is_empty());
}

/// One component of (t³ − t, 2t²) through its values and velocities at three keys.
#[test]
fn given_velocities_reproduce_cubics() {
    let times = [-1.0, 0.5, 2.0];
    let at_key = |t: f64| ([t * t * t - t, 2.0 * t * t], [3.0 * t * t - 1.0, 4.0 * t]);
    let [a, b, c] = times.map(at_key);
    let curve = Curve::hermite(&times, &[a.0, b.0, c.0], &[[a.1, b.1], [b.1, c.1]]).unwrap();
    for t in [-0.9, -0.2, 0.4, 0.6, 1.3, 1.9] {
        let sample = at(&curve, t);
        let (position, velocity) = at_key(t);
        for (found, expected) in [
            (sample.position, position),
            (sample.velocity, velocity),
            (sample.acceleration, [6.0 * t, 4.0]),
        ] {
            for d in 0..2 {
                assert!((found[d] - expected[d]).abs() < 1e-13, "{t}: {sample:?}");
            }
        }
    }
    let bent = Curve::hermite(&[0.0, 1.0, 2.0], &[[0.0]; 3], &[[[0.0], [1.0]], [[-1.0], [0.0]]]);
    assert_eq!(kinks(&bent.unwrap(), -1.0, 9.0), [0.0, 1.0, 2.0]);
    let one = Curve::hermite(&times, &[a.0, b.0, c.0], &[[a.1, b.1]]).unwrap_err().to_string();
    assert_eq!(
        one,
        "the number of pairs of velocities is 1; it must be less by one than the number of keys"
    );
}

/// Checks that `curve(t)` is the curve `whole` at `t`, passed `speed` times as fast.
fn same_path(
    curve: &Curve<1>,
    whole: &Curve<1>,
    speed: f64,
    pairs: impl Iterator<Item = (f64, f64)>,
) {
    for (t, original) in pairs {
        let (found, expected) = (at(curve, t), at(whole, original));
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12 * (1.0 + b.abs());
        assert!(close(found.position[0], expected.position[0]), "{t}");
        assert!(close(found.velocity[0], speed * expected.velocity[0]), "{t}");
        assert!(close(found.acceleration[0], speed * speed * expected.acceleration[0]), "{t}");
    }
}

#[test]
fn curves_start_run_and_repeat_as_they_are_told() {
    let values = TIMES.map(|t| [(3.0 * t).rem_euclid(1.0)]);
    let closed = [0.0, 0.3, -0.2, 0.5, 0.1, 0.0].map(|value| [value]);
    for whole in [
        Curve::steps(&TIMES, &values).unwrap(),
        Curve::linear(&TIMES, &values).unwrap(),
        Curve::catmull_rom(&TIMES, &values).unwrap(),
        Curve::spline(&TIMES, &values).unwrap(),
        Curve::clamped(&TIMES, &values, [1.0], [-2.0]).unwrap(),
        Curve::periodic(&TIMES, &closed).unwrap(),
        Curve::linear(&TIMES, &closed).unwrap().looped().unwrap(),
    ] {
        // Exact in binary numbers, so that every kink is known to the bit.
        let moved = whole.clone().starting(8.0).unwrap().speed(2.0).unwrap();
        let pairs = (1..300).map(|k| 0.01 * f64::from(k)).map(|t| (8.0 + 0.5 * t, t));
        same_path(&moved, &whole, 2.0, pairs.filter(|(_, t)| !TIMES.contains(t)));
        let found = kinks(&moved, 8.1, 9.4);
        let expected = kinks(&whole, 0.2, 2.8);
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - (8.0 + 0.5 * expected)).abs() < 1e-14, "{found}");
            assert_eq!(before(&moved, *found).position.len(), 1);
        }
        // The order of the calls has no effect, except on rounding.
        let other = whole.clone().speed(2.0).unwrap().starting(8.0).unwrap();
        same_path(
            &other,
            &moved,
            1.0,
            (1..140).map(|k| 8.0 + 0.011 * f64::from(k)).map(|t| (t, t)),
        );
        // The curve stays continuous at its keys.
        let far = whole.clone().starting(1e6).unwrap();
        for &key in &TIMES[1..5] {
            let [left, right] = [before(&far, 1e6 + key), at(&far, 1e6 + key)];
            let (left, right) = (left.position[0], right.position[0]);
            let jumps = before(&whole, key).position != at(&whole, key).position
                && (before(&whole, key).position[0] - at(&whole, key).position[0]).abs() > 1e-9;
            assert!(jumps || (left - right).abs() < 1e-9, "{left} {right}");
        }
        for wrong in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            let refused = whole.clone().speed(wrong).unwrap_err().to_string();
            assert!(
                refused.starts_with("the speed is ") && refused.contains("positive"),
                "{refused}"
            );
        }
        let refused = whole.clone().starting(f64::NAN).unwrap_err().to_string();
        assert_eq!(refused, "the start is NaN; it must be a finite time");
        // Keys that rounding would bring together.
        let late = whole.starting(1e300);
        assert!(matches!(late, Err(MotionError::NotIncreasing { key: 1, .. })), "{late:?}");
    }
}

#[test]
fn functions_have_what_they_are_given() {
    let position = Function::new(|t| [t]);
    let all = Function::new(|t: f64| [t.abs()])
        .velocity(|t: f64| [if t < 0.0 { -1.0 } else { 1.0 }])
        .acceleration(|_| [0.0])
        .kinks(&[0.0]);
    assert_eq!(has(&position), Derivatives::POSITION);
    assert_eq!(has(&all), Derivatives::ALL);
    assert_eq!(before(&all, 0.0).velocity, [-1.0]);
    assert_eq!(at(&all, 0.0).velocity, [1.0]);
    assert_eq!(kinks(&all, -1.0, 1.0), [0.0]);
}

#[test]
fn what_is_not_asked_is_not_computed() {
    let spline = Curve::spline(&TIMES, &TIMES.map(|t| [t * t])).unwrap();
    let sample: Sample<f64, 1> = spline.sample(Time::new(0.5), Side::After, Derivatives::VELOCITY);
    assert_eq!((sample.position, sample.acceleration), ([0.0], [0.0]));
    assert_ne!(sample.velocity, [0.0]);
}

#[test]
fn times_far_from_zero_keep_their_resolution() {
    let times: Vec<f64> = (0..10).map(|k| 1e9 + f64::from(k)).collect();
    let values: Vec<[f64; 1]> = (0..10).map(|k| [f64::from(k) * 10.0]).collect();
    let linear = Curve::linear(&times, &values).unwrap();
    let sample: Sample<f64, 1> =
        linear.sample(Time::new(1e9) + 1.0 / 3.0, Side::After, Derivatives::ALL);
    assert!((sample.position[0] - 10.0 / 3.0).abs() < 1e-15);
}

#[test]
fn single_precision_and_single_keys_work() {
    let still = Curve::linear(&[1.0], &[[2.0, 3.0]]).unwrap();
    let sample: Sample<f32, 2> = still.sample(Time::new(0.0), Side::After, Derivatives::ALL);
    assert_eq!(sample.position, [2.0, 3.0]);
    assert_eq!(Motion::<f32, 2>::next_kink(&still, 0.0), None);
    assert_eq!(at(&Curve::spline(&[1.0], &[[4.0]]).unwrap(), 1.0).position, [4.0]);
    assert_eq!(at(&Still::new([7.0]), 1.0).position, [7.0]);
}

#[test]
fn bad_keys_are_refused() {
    let none: &[[f64; 1]] = &[];
    let text = |refused: Result<Curve<1>, MotionError>| refused.unwrap_err().to_string();
    assert_eq!(
        text(Curve::linear(&[], none)),
        "the number of keys is 0; it must be 1 or more; use `Still` for a point at rest"
    );
    assert_eq!(Curve::steps(&[0.0], none), Err(MotionError::Lengths { times: 1, values: 0 }));
    assert_eq!(
        Curve::spline(&[0.0, 0.0], &[[1.0], [2.0]]),
        Err(MotionError::NotIncreasing { key: 1, time: 0.0 })
    );
    assert_eq!(
        Curve::catmull_rom(&[0.0, f64::NAN], &[[1.0], [2.0]]),
        Err(MotionError::NotFinite { key: 1 })
    );
    assert_eq!(
        Curve::linear(&[0.0, 1.0], &[[1.0], [f64::INFINITY]]),
        Err(MotionError::NotFinite { key: 1 })
    );
    for alone in
        [Curve::linear(&[0.0], &[[1.0]]).unwrap().looped(), Curve::periodic(&[0.0], &[[1.0]])]
    {
        assert_eq!(
            text(alone),
            "the number of keys is 1; it must be 2 or more to repeat; the last key closes the loop"
        );
    }
    let clamped = |first, last| Curve::clamped(&[0.0, 1.0], &[[1.0], [2.0]], [first], [last]);
    assert_eq!(clamped(f64::NAN, 0.0), Err(MotionError::NotFinite { key: 0 }));
    assert_eq!(clamped(0.0, f64::NAN), Err(MotionError::NotFinite { key: 1 }));
    let still = Still::new([0.0]);
    assert_eq!(
        Attenuated::new(still, f64::NAN, 1.0).unwrap_err().to_string(),
        "the gain is NaN; it must be finite, 1 for the motion as it is"
    );
    assert_eq!(
        Attenuated::new(still, 1.0, 0.0).unwrap_err().to_string(),
        "the speed limit is 0; it must be a positive number of metres per second, infinity for none"
    );
}

#[test]
fn what_is_felt_is_cut_and_scaled() {
    // The speed is |cos t|; the part above 0.6 is cut.
    let whole = Sinusoid::new([1.0, 0.0], 1.0, [0.0, 0.0]);
    let felt = Attenuated::new(whole, 0.5, 0.6).unwrap();
    let crossing = 0.6f64.acos();
    let found = kinks(&felt, 0.0, 3.0);
    assert!(found.iter().any(|kink| (kink - crossing).abs() < 1e-14), "{found:?}");
    assert!(
        found.iter().any(|kink| (kink - (std::f64::consts::PI - crossing)).abs() < 1e-14),
        "{found:?}"
    );
    let (fast, slow) = (at(&felt, 0.3), at(&felt, 1.2));
    assert_eq!(fast.position, at(&whole, 0.3).position);
    assert!((fast.velocity[0] - 0.3).abs() < 1e-15 && fast.acceleration[0].abs() < 1e-15);
    assert_eq!(slow.velocity, at(&whole, 1.2).velocity.map(|v| 0.5 * v));
    assert_eq!(slow.acceleration, at(&whole, 1.2).acceleration.map(|a| 0.5 * a));
    let kink = found.iter().copied().find(|kink| (kink - crossing).abs() < 1e-14).unwrap();
    assert!(before(&felt, kink).acceleration[0].abs() < 1e-12);
    assert!((at(&felt, kink).acceleration[0] + 0.5 * crossing.sin()).abs() < 1e-12);
    // The speed on a circle is constant: the acceleration only changes the direction.
    let circle = Sinusoid::new([1.0, 1.0], 2.0, [0.0, std::f64::consts::FRAC_PI_2]);
    let felt = Attenuated::new(circle, 1.0, 1.0).unwrap();
    for t in [0.1, 0.8, 2.3] {
        let (sample, h) = (at(&felt, t), 1e-5);
        let (ahead, behind) = (at(&felt, t + h), at(&felt, t - h));
        assert!((sample.velocity[0].hypot(sample.velocity[1]) - 1.0).abs() < 1e-14);
        for d in 0..2 {
            let difference = (ahead.velocity[d] - behind.velocity[d]) / (2.0 * h);
            assert!((difference - sample.acceleration[d]).abs() < 1e-8, "{t}");
        }
        let only: Sample<f64, 2> =
            felt.sample(Time::new(t), Side::After, Derivatives::ACCELERATION);
        assert_eq!((only.acceleration, only.velocity), (sample.acceleration, [0.0; 2]));
    }
    // It rests while the motion rests, and does not search for kinks there.
    let late =
        Attenuated::new(Curve::linear(&[50.0, 51.0], &[[0.0], [3.0]]).unwrap(), 1.0, 2.0).unwrap();
    assert_eq!(Motion::<f64, 1>::rest_until(&late, 0.0), 50.0);
    assert_eq!(Motion::<f64, 1>::next_kink(&late, 0.0), Some(50.0));
    assert_eq!(at(&late, 50.5).velocity, [2.0]);
    // The kinks do not depend on `t`.
    let two = |t: f64| Motion::<f64, 2>::next_kink(&Attenuated::new(whole, 0.5, 0.6).unwrap(), t);
    assert_eq!(two(0.01), two(0.5));
    assert_eq!(two(2.3), two(3.7));
    assert!(
        Attenuated::new(whole, f64::NAN, 1.0).is_err()
            && Attenuated::new(whole, 1.0, 0.0).is_err()
            && Attenuated::new(whole, 1.0, f64::NAN).is_err()
    );
}

/// Returns the longest step from `t` for `widths` = 10.
fn bound<const D: usize, M: Motion<f64, D>>(motion: &M, t: f64) -> Option<f64> {
    motion.longest_step(t, 10.0)
}

#[test]
fn functions_bound_steps_by_their_resolution() {
    let unknown = || Function::new(|t: f64| [t, 0.0, 0.0]);
    assert_eq!(bound(&unknown(), 1.0), None);
    let known = unknown()
        .resolution(0.25)
        .unwrap()
        .velocity(|_| [1.0, 0.0, 0.0])
        .acceleration(|_| [0.0; 3]);
    assert_eq!(bound(&known, 1.0), Some(2.5));
    let plane = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!(bound(&Projected::new(known.clone(), plane), 1.0), Some(2.5));
    let felt = Attenuated::new(known, 0.5, 1.0).unwrap();
    assert_eq!(bound(&felt, 1.0), Some(2.5));
    assert_eq!(bound(&Still { position: [0.0] }, 1.0), Some(f64::INFINITY));
}

#[test]
fn splines_bound_steps_by_their_keys() {
    let through = |times: &[f64]| Curve::spline(times, &vec![[0.0]; times.len()]).unwrap();
    let even = through(&[0.0, 1.0, 2.0, 3.0]);
    assert_eq!([0.0, 0.5, 2.9, 3.0].map(|t| bound(&even, t)), [Some(10.0); 4]);
    assert_eq!(bound(&through(&[0.0]), 3.0), Some(f64::INFINITY));
    // Two keys at a distance of 0.01 s: half the distance to them, or ten times the distance
    // between them.
    let dense = through(&[0.0, 50.0, 50.01, 100.0]);
    assert_eq!(
        [-1.0, 10.0, 49.9].map(|t| bound(&dense, t).unwrap()),
        [25.5, 20.0, 10.0 * (50.01 - 50.0)]
    );
    // The bound also holds for steps backwards in time.
    assert_eq!(
        [50.05, 60.0, 100.0, 101.0].map(|t| bound(&dense, t).unwrap()),
        [10.0 * (50.01 - 50.0), 0.5 * (60.0 - 50.01), 0.5 * (100.0 - 50.01), 0.5 * (101.0 - 50.01)]
    );
    let again = Curve::periodic(&[0.0, 0.5, 2.0], &[[0.0], [1.0], [0.0]]).unwrap();
    assert_eq!([0.2, 1.0].map(|t| bound(&again, t).unwrap()), [5.0, 5.0]);
    // A bump whose accelerations happen to be equal on both sides of every key.
    let times = [0.0, 100.0, 101.0, 102.0, 103.0, 104.0, 200.0];
    let values = [0.0, 0.0, 1.0, 4.0, 1.0, 0.0, 0.0].map(|value| [value]);
    let slopes = [0.0, 0.0, 3.0, 0.0, -3.0, 0.0, 0.0].map(|slope| [slope]);
    let pairs: Vec<_> = slopes.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    let bump = Curve::hermite(&times, &values, &pairs).unwrap();
    assert_eq!(kinks(&bump, -1.0, 300.0), [0.0; 0]);
    assert_eq!([50.0, 99.9].map(|t| bound(&bump, t)), [Some(25.0), Some(10.0)]);
    // Faster curves have narrower pieces.
    let fast = even.speed(4.0).unwrap();
    assert_eq!(bound(&fast, 0.2), Some(2.5));
}

#[test]
fn motions_need_the_derivatives_of_every_purpose() {
    let (none, all) = (Derivatives::NONE, Derivatives::ACCELERATION);
    let input = Input {
        name: "x",
        components: 1,
        control: false,
        accelerations: none,
        momenta: none,
        energy: none,
        power: none,
        outputs: none,
    };
    assert!(sufficient(&[Derivatives::POSITION], &[input]));
    for input in [
        Input { accelerations: all, ..input },
        Input { momenta: all, ..input },
        Input { energy: all, ..input },
        Input { power: all, ..input },
        Input { outputs: all, ..input },
    ] {
        assert!(!sufficient(&[Derivatives::POSITION], &[input]), "{input:?}");
        assert!(sufficient(&[Derivatives::ALL], &[input]));
    }
}
