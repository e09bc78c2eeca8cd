//! Tests of joints that move as they are told.

use super::{Course, Live, Path, Steer};
use pendulum_core::motion::{Derivatives, Motion, Sample, Side};
use pendulum_core::time::Time;

/// Follows `position` in frames of the lengths `frames`, and passes each frame, its times and
/// the path during it to `check`.
fn follow(
    live: Live<1>,
    frames: &[f64],
    position: impl Fn(f64) -> f64,
    mut check: impl FnMut(usize, [f64; 2], &Path<1>),
) {
    let mut path = Path::new(0.0, &live);
    path.interrupted = false;
    let [mut before, mut begin] = [0.0; 2];
    for (index, &length) in frames.iter().enumerate() {
        let end = begin + length;
        path.tell(&[position(end)]);
        path.frame([before, begin, end]);
        check(index, [begin, end], &path);
        (before, begin) = (begin, end);
    }
}

/// Compares samples in lanes with single ones, before, in and after the last two frames.
pub(in crate::sampling) fn lanes_have_the_bits_of_single_samples<M, const D: usize>(
    motion: &M,
    [begin, end]: [f64; 2],
) where
    M: Motion<f64, D>,
{
    let times: Vec<Time> = (-60..=45)
        .map(|k| Time::new(begin) + f64::from(k) / 40.0 * (end - begin))
        .chain([Time::new(end), Time::new(begin)])
        .collect();
    let bits = |sample: &Sample<f64, D>| sample.map(f64::to_bits);
    for wanted in [Derivatives::POSITION, Derivatives::ACCELERATION, Derivatives::ALL] {
        for times in times.chunks(11) {
            let mut samples = vec![Sample::zero(); times.len()];
            motion.sample_all(times, wanted, &mut samples);
            for (&t, sample) in times.iter().zip(&samples) {
                let alone = motion.sample(t, Side::After, wanted);
                assert_eq!(bits(&alone), bits(sample), "{t}");
            }
        }
    }
}

#[test]
fn paths_have_the_same_bits_in_lanes() {
    for live in [Live::new([0.0]), Live::new([0.0]).smoothed()] {
        let steps = |t: f64| (1.3 * t).sin();
        follow(live, &[1.0, 1.5, 0.3, 1.0, 2.0], steps, |_, times, path| {
            lanes_have_the_bits_of_single_samples(path, times);
        });
    }
}

fn at(path: &Path<1>, t: f64) -> Sample<f64, 1> {
    path.sample(Time::new(t), Side::After, Derivatives::ALL)
}

fn within([begin, end]: [f64; 2]) -> impl Iterator<Item = f64> {
    (0..100).map(move |k| begin + 0.01 * f64::from(k) * (end - begin))
}

/// Lengths of frames between 1 and `spread`.
fn unequal(spread: f64) -> [f64; 60] {
    core::array::from_fn(|k| 1.0 + (spread - 1.0) * (0.5 + 0.5 * (1.7 * (k * k) as f64).sin()))
}

#[test]
fn a_sudden_start_peaks_at_1_52_of_the_speed() {
    let mut most = 0.0f64;
    follow(
        Live::new([0.0]),
        &[1.0; 9],
        |t| (t - 4.0).max(0.0),
        |_, times, path| {
            most = within(times).map(|t| at(path, t).velocity[0]).fold(most, f64::max);
        },
    );
    assert!((1.51..1.53).contains(&most), "{most}");
}

#[test]
fn a_sudden_stop_overshoots_by_0_23_of_the_way_of_a_frame() {
    let mut most = 0.0f64;
    follow(
        Live::new([0.0]),
        &[1.0; 12],
        |t| t.min(6.0),
        |_, times, path| {
            most = within(times).map(|t| at(path, t).position[0]).fold(most, f64::max);
        },
    );
    assert!((6.22..6.24).contains(&most), "{most}");
}

#[test]
fn a_frame_ends_exactly_where_it_was_told() {
    let position = |t: f64| (0.3 * t).sin();
    follow(Live::new([0.0]), &unequal(4.0), position, |_, [_, end], path| {
        assert_eq!(at(path, end).position[0], position(end));
    });
}

#[test]
fn velocity_and_acceleration_are_continuous_across_frames_of_any_length() {
    for live in [Live::new([0.0]), Live::new([0.0]).smoothed()] {
        let mut last = Sample::zero();
        follow(
            live,
            &unequal(4.0),
            |t| (0.3 * t).sin(),
            |_, [begin, end], path| {
                assert_eq!(at(path, begin), last);
                let almost = at(path, begin + (1.0 - 1e-9) * (end - begin));
                last = at(path, end);
                let jump = almost.acceleration[0] - last.acceleration[0];
                assert!(jump.abs() < 1e-7, "{jump}");
            },
        );
    }
}

#[test]
fn velocities_and_accelerations_are_the_derivatives_of_positions() {
    follow(
        Live::new([0.0]),
        &unequal(4.0),
        |t| (0.3 * t).sin(),
        |_, [begin, end], path| {
            let (t, h) = (begin + 0.37 * (end - begin), 1e-4);
            let [a, b, c] = [t - h, t, t + h].map(|t| at(path, t));
            let rate = (c.position[0] - a.position[0]) / (2.0 * h);
            assert!((rate - b.velocity[0]).abs() < 1e-7);
            let change = (c.velocity[0] - a.velocity[0]) / (2.0 * h);
            assert!((change - b.acceleration[0]).abs() < 1e-7);
        },
    );
}

#[test]
fn a_constant_acceleration_is_exact_after_three_samples_in_frames_of_any_length() {
    let path_of = |t: f64| 3.0 + 2.0 * t - 0.25 * t * t;
    follow(Live::new([3.0]), &unequal(4.0), path_of, |index, times, path| {
        for t in within(times).filter(|_| 3 <= index) {
            let state = at(path, t);
            assert!((state.position[0] - path_of(t)).abs() < 1e-12 * t * t);
            assert!((state.velocity[0] - (2.0 - 0.5 * t)).abs() < 1e-12 * t * t);
            assert!((state.acceleration[0] + 0.5).abs() < 1e-10 * t);
        }
    });
}

#[test]
fn smoothed_joints_follow_the_cubic_b_spline() {
    let position = |t: f64| (0.7 * t).sin() + (2.1 * t).cos();
    let live = Live::new([position(0.0)]).smoothed();
    follow(live, &[1.0; 30], position, |index, [begin, end], path| {
        for t in within([begin, end]).filter(|_| 3 <= index) {
            let u = t - begin;
            let bases = [
                (1.0 - u).powi(3),
                3.0 * u.powi(3) - 6.0 * u * u + 4.0,
                1.0 + 3.0 * u + 3.0 * u * u - 3.0 * u.powi(3),
                u.powi(3),
            ];
            let points = [end - 3.0, end - 2.0, end - 1.0, end].map(position);
            let spline: f64 = bases.iter().zip(points).map(|(b, p)| b * p / 6.0).sum();
            assert!((at(path, t).position[0] - spline).abs() < 1e-13);
        }
    });
}

#[test]
fn smoothed_joints_are_one_frame_late() {
    follow(
        Live::new([0.0]).smoothed(),
        &[0.5; 30],
        |t| 3.0 * t,
        |index, times, path| {
            for t in within(times).filter(|_| 4 <= index) {
                assert!((at(path, t).position[0] - 3.0 * (t - 0.5)).abs() < 1e-12);
            }
        },
    );
}

#[test]
fn smoothed_joints_do_not_overshoot() {
    let steps = |t: f64| f64::from(u8::from((1.3 * (t + 0.1).floor()).sin() < 0.3));
    for (spread, beyond) in [(1.0, 1e-15), (1.5, 0.02)] {
        let live = Live::new([steps(0.0)]).smoothed();
        follow(live, &unequal(spread), steps, |_, times, path| {
            for t in within(times) {
                let position = at(path, t).position[0];
                assert!((-beyond..=1.0 + beyond).contains(&position), "{position}");
            }
        });
    }
}

#[test]
fn three_equal_samples_are_rest() {
    let mut path = Path::new(0.0, &Live::new([0.0]));
    path.put(0.0, [0.0]);
    let mut frame = |k: i32, position: f64| {
        let end = f64::from(k);
        path.tell(&[position]);
        let course = path.frame([end - 2.0, end - 1.0, end]);
        (course, Motion::<f64, 1>::rest_until(&path, end))
    };
    assert_eq!(frame(1, 0.0), (Course::Continues, f64::INFINITY));
    assert_eq!(frame(2, 1.0), (Course::Starts, 2.0));
    assert_eq!([frame(3, 1.0).1, frame(4, 1.0).1], [3.0, 4.0]);
    assert_eq!(frame(5, 1.0), (Course::Continues, f64::INFINITY));
}

#[test]
fn a_joint_that_is_not_told_comes_to_a_stop_within_the_frame() {
    for live in [Live::new([0.0]), Live::new([0.0]).smoothed()] {
        let mut stopped = Path::new(0.0, &live);
        follow(live, &[1.0; 6], |t| t, |_, _, path| stopped = *path);
        stopped.frame([5.0, 6.0, 7.0]);
        let end = at(&stopped, 7.0);
        assert_eq!([end.position, end.velocity, end.acceleration], [[6.0], [0.0], [0.0]]);
        stopped.frame([6.0, 7.0, 8.0]);
        assert_eq!(at(&stopped, 7.5), end);
    }
}
