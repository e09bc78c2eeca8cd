//! Tests of the results and errors of the reader.

use super::Bvh;
use super::read::LARGEST;
use crate::random::Random;
use core::ops::Bound;
use pendulum_core::attitude::Attitude;
use pendulum_core::motion::{Attitudes, Derivatives, Motion, Sample, Side};
use pendulum_core::scalar::Real;
use pendulum_core::time::Time;

/// An arm with a shoulder that rotates and translates, and a hand that rotates about two axes.
const ARM: &str = "HIERARCHY
ROOT Shoulder
{
  OFFSET 5 6 7
  CHANNELS 4 Xposition Yposition Zposition Zrotation
  JOINT left hand {
    OFFSET 2 0 0
    CHANNELS 2 Zrotation Xrotation
    End Site
    {
      OFFSET 0 1 0
    }
  }
}
MOTION
Frames: 3
Frame Time: .025
0 0 0 0 0 0
1 2 3 90 0 0
0 0 0 0 90 90
";

fn read(text: &str) -> Bvh {
    Bvh::read(text).unwrap_or_else(|error| panic!("{error}"))
}

fn message(text: &str) -> String {
    Bvh::read(text).expect_err("it was read").to_string()
}

#[track_caller]
fn close(a: [f64; 3], b: [f64; 3]) {
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12), "{a:?} is not {b:?}");
}

#[test]
fn names_parents_and_times() {
    let arm = read(ARM);
    let names: Vec<_> =
        arm.joints.iter().map(|joint| (joint.name.as_str(), joint.parent, joint.end)).collect();
    assert_eq!(
        names,
        [
            ("Shoulder", None, false),
            ("left hand", Some(0), false),
            ("left hand end", Some(1), true)
        ]
    );
    assert_eq!((arm.frames(), arm.frame_time()), (3, 0.025));
}

#[test]
fn a_right_angle_turns_all_that_hangs_on_the_joint() {
    let pose = read(ARM).pose(1);
    close(pose[0], [1.0, 2.0, 3.0]);
    close(pose[1], [1.0, 4.0, 3.0]);
    close(pose[2], [0.0, 4.0, 3.0]);
}

/// R_z(90°) R_x(90°) e_y = R_z e_z = e_z; the other order would give R_x(90°) R_z(90°) e_y =
/// R_x(−e_x) = −e_x.
#[test]
fn rotations_are_applied_in_the_order_of_the_channels() {
    close(read(ARM).pose(2)[2], [2.0, 0.0, 1.0]);
    close(
        read(&ARM.replace("Zrotation Xrotation", "Xrotation Zrotation")).pose(2)[2],
        [1.0, 0.0, 0.0],
    );
}

/// R_y(90°) e_z = e_x.
#[test]
fn a_turn_is_right_handed_about_each_axis() {
    for (axis, from, to) in [
        ("X", "0 1 0", [0.0, 0.0, 1.0]),
        ("Y", "0 0 1", [1.0, 0.0, 0.0]),
        ("Z", "1 0 0", [0.0, 1.0, 0.0]),
    ] {
        let text = format!(
            "HIERARCHY\nROOT a {{ OFFSET 0 0 0 CHANNELS 1 {axis}rotation\nEnd Site {{ OFFSET {from} }} }}\nMOTION\nFrames: 1\n\
             Frame Time: 1\n90\n"
        );
        close(read(&text).pose(0)[1], to);
    }
}

#[test]
fn positions_on_any_joint_take_the_place_of_the_offset() {
    let text = ARM.replace("CHANNELS 2 Zrotation Xrotation", "CHANNELS 2 Yposition Xrotation");
    let pose = read(&text).pose(2);
    close(pose[1], [2.0, 90.0, 0.0]);
    close(pose[2], [2.0, 90.0, 1.0]);
}

#[test]
fn line_ends_case_and_blank_lines_do_not_matter() {
    let arm = read(ARM);
    assert_eq!(arm, read(&ARM.replace('\n', "\r\n")));
    assert_eq!(arm, read(&ARM.replace('\n', "\n\n")));
    assert_eq!(arm, read(&ARM.replace('\n', "\r")));
    assert_eq!(arm, read(&ARM.replace('\n', "\r\r\n")));
    assert_eq!(arm, read(&ARM.replacen('\n', "\r", 9)));
    assert_eq!(
        arm,
        read(&format!("\u{feff}{}", ARM.replace("Frame Time: .025", "frame  time:.025")))
    );
    assert_eq!(arm, read(&ARM.replace("Zrotation", "ZROTATION")));
}

#[test]
fn places_are_counted_in_any_line_ends() {
    let wrong = ARM.replace("90 90", "90 x");
    for end in ["\n", "\r\n", "\r"] {
        let message = message(&wrong.replace('\n', end));
        assert!(message.starts_with("line 20, column 12: `x` is no number"), "{message}");
    }
}

#[test]
fn one_row_more_than_announced_is_noted() {
    let arm = read(&ARM.replace("Frames: 3", "Frames: 2"));
    assert_eq!((arm.frames(), arm.pose(1)), (2, read(ARM).pose(1)));
    assert_eq!(
        arm.note().unwrap().to_string(),
        "line 20, column 1: a row after the last of 2 frames; correct the number at `Frames:` or remove the row"
    );
    assert_eq!(read(ARM).note(), None);
    // What is no row is no row too many, and two rows too many are another mistake.
    for end in ["END", "0 0 0 0 0", "0 0 0 0 0 0 0", "0 0 0 0 0 zero", "0 0 0 0 0 0\n0 0 0 0 0 0"] {
        let message = message(&format!("{ARM}{end}\n"));
        assert!(message.starts_with("line 21, column 1: a row after the last of 3"), "{message}");
    }
}

/// The line after the last frame is not where the mistake is.
#[test]
fn a_row_on_several_lines_is_reported_where_it_begins() {
    for (row, parts, line) in [
        ("0 0 0 0 0 0", "0 0 0\n 0 0 0", 18),
        ("1 2 3 90 0 0", "  1 2 3\n90 0 0", 19),
        ("1 2 3 90 0 0", "1\n2\n3\n90\n0\n0", 19),
        ("0 0 0 0 90 90", "0 0 0 0 90\n\n90", 20),
    ] {
        let message = message(&ARM.replace(row, parts));
        let column = 1 + parts.len() - parts.trim_start().len();
        assert!(message.starts_with(&format!("line {line}, column {column}: ")), "{message}");
        assert!(
            message.ends_with(
                "6 channels in the hierarchy; give each channel one number, all on one line"
            ),
            "{message}"
        );
    }
    // All rows on two lines.
    let (head, _) = ARM.split_once("0 0 0 0 0 0").unwrap();
    let message = message(&format!("{head}{}", "1 2 3 4\n5 6\n".repeat(3)));
    assert!(message.starts_with("line 18, column 1: 4 numbers in the row"), "{message}");
}

#[test]
fn the_excerpt_is_read() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/data/jumps.bvh");
    let jumps = Bvh::open(path).unwrap();
    assert_eq!((jumps.joints.len(), jumps.frames()), (38, 241));
    let head = jumps.joints.iter().position(|joint| joint.name == "Head end").unwrap();
    let height = jumps.pose(0)[head][1];
    assert!(1.4 < height && height < 1.7, "{height}");
    // Somebody who jumps, but from nowhere to nowhere.
    assert!(jumps.jumps().is_empty(), "{:?}", jumps.jumps());
}

/// Returns a clip of a hand one metre from its shoulder at these angles.
fn swung(rate: f64, degrees: impl IntoIterator<Item = f64>) -> Bvh {
    let rows: Vec<String> = degrees.into_iter().map(|angle| format!("{angle}\n")).collect();
    read(&format!(
        "HIERARCHY\nROOT shoulder {{ OFFSET 0 0 0 CHANNELS 1 Zrotation\nEnd Site {{ OFFSET 1 0 0 }} }}\n\
         MOTION\nFrames: {}\nFrame Time: {}\n{}",
        rows.len(),
        1.0 / rate,
        rows.concat()
    ))
}

/// A hand swings by 10° at 1 Hz, whose fastest motion is π²/9 m/s, after a T-pose at 60°.
#[test]
fn a_pose_before_the_motion_is_found_and_cut() {
    let swing =
        (0..120).map(|frame| 10.0 * Real::sin(f64::from(frame) * core::f64::consts::PI / 60.0));
    let clip = swung(120.0, [60.0].into_iter().chain(swing.clone()));
    assert_eq!(clip.jumps(), [1]);
    let fastest = |clip: &Bvh| {
        let hand = clip.motion("shoulder end", 1.0).unwrap();
        let speeds = (0..400).map(|k| {
            let t = Time::new(f64::from(k) / 500.0);
            let [x, y, _] =
                Motion::<f64, 3>::sample(&hand, t, Side::After, Derivatives::VELOCITY).velocity;
            Real::sqrt(x * x + y * y)
        });
        speeds.fold(0.0, Real::max)
    };
    let whole = core::f64::consts::PI * core::f64::consts::PI / 9.0;
    assert!(100.0 * whole < fastest(&clip), "{}", fastest(&clip));
    let cut = clip.cut(1..).unwrap();
    assert_eq!(cut, swung(120.0, swing));
    assert!(cut.jumps().is_empty());
    assert!((fastest(&cut) - whole).abs() < 1e-3 * whole, "{}", fastest(&cut));
}

#[test]
fn only_jumps_are_jumps() {
    let slow = |frame: usize| frame as f64 * 0.5;
    let jumps = |degrees: &dyn Fn(usize) -> f64| swung(60.0, (0..20).map(degrees)).jumps();
    let none: [usize; 0] = [];
    assert_eq!(jumps(&slow), none);
    assert_eq!(jumps(&|_| 30.0), none);
    // A pose that is held before the motion, one after it, a wrong frame, and two takes in one.
    assert_eq!(jumps(&|frame| if frame < 4 { 90.0 } else { slow(frame) }), [4]);
    assert_eq!(jumps(&|frame| if frame < 19 { slow(frame) } else { 90.0 }), [19]);
    assert_eq!(jumps(&|frame| if frame == 7 { 70.0 } else { slow(frame) }), [7, 8]);
    assert_eq!(jumps(&|frame| if frame < 11 { slow(frame) } else { 90.0 - slow(frame) }), [11]);
    // Sudden but steady motions, whole turns, and a tremor.
    assert_eq!(jumps(&|frame| frame.saturating_sub(9) as f64 * 20.0), none);
    assert_eq!(jumps(&|frame| frame.min(9) as f64 * 20.0), none);
    assert_eq!(jumps(&|frame| slow(frame) + if frame < 9 { 0.0 } else { 360.0 }), none);
    assert_eq!(jumps(&|frame| if frame == 7 { 1.0 } else { 0.0 }), none);
    // What is short has nothing to compare with, or little.
    assert_eq!(swung(60.0, [0.0]).jumps(), none);
    assert_eq!(swung(60.0, [0.0, 90.0]).jumps(), none);
    assert_eq!(swung(60.0, [90.0, 0.0, 1.0]).jumps(), [1]);
}

#[test]
fn a_clip_is_cut_to_the_frames_of_a_range() {
    let arm = read(ARM);
    assert_eq!(arm.clone().cut(..).unwrap(), arm);
    for cut in [arm.clone().cut(1..), arm.clone().cut(1..=2), arm.clone().cut(1..3)] {
        let cut = cut.unwrap();
        assert_eq!((cut.frames(), cut.pose(0), cut.pose(1)), (2, arm.pose(1), arm.pose(2)));
    }
    assert_eq!(arm.clone().cut(..1).unwrap().pose(5), arm.pose(0));
    for wrong in [
        arm.clone().cut(3..),
        arm.clone().cut(..4),
        arm.clone().cut(..0),
        #[expect(clippy::reversed_empty_ranges)]
        arm.clone().cut(2..1),
        arm.clone().cut(..=usize::MAX),
        arm.clone().cut((Bound::Excluded(usize::MAX), Bound::Unbounded)),
    ] {
        let message = wrong.unwrap_err().to_string();
        assert!(message.starts_with("there are 3 frames, counted from 0, "), "{message}");
    }
}

#[test]
fn refusals_say_where_what_and_what_to_do() {
    let cases = [
        ("HIERARCHY", "HIERARCHIE", "line 1, column 1: `HIERARCHIE` where HIERARCHY must stand"),
        ("ROOT Shoulder", "ROOT", "line 2, column 1: a joint without a name"),
        (
            "Shoulder\n{",
            "Shoulder\n",
            "line 4, column 3: `OFFSET` where the brace of a joint must open",
        ),
        ("OFFSET 2 0 0", "OFFSET 2 0", "line 7, column 5: OFFSET with 2 numbers"),
        ("OFFSET 2 0 0", "OFFSET 2 0 zero", "line 7, column 16: `zero` is no number"),
        ("OFFSET 2 0 0", "OFFSET 2 0 NaN", "line 7, column 16: `NaN` is no number"),
        ("OFFSET 2 0 0", "OFFSET 2 0 1e99", "line 7, column 16: `1e99` is no number"),
        ("    OFFSET 2 0 0\n", "", "line 12, column 3: `left hand` has no OFFSET"),
        (
            "OFFSET 2 0 0",
            "OFFSET 2 0 0 OFFSET 0 0 0",
            "line 7, column 18: a second OFFSET in `left hand`",
        ),
        ("OFFSET 2 0 0", "LENGTH 2", "line 7, column 5: `LENGTH` is not known in a hierarchy"),
        ("CHANNELS 2", "CHANNELS 3", "line 8, column 5: 3 channels are announced, 2 names follow"),
        (
            "CHANNELS 2",
            "CHANNELS 99999999999999999999",
            "line 8, column 14: `99999999999999999999` is no number of channels",
        ),
        ("2 Zrotation Xrotation", "1 Wrotation", "line 8, column 16: `Wrotation` is no channel"),
        (
            "4 Xposition Yposition",
            "4 Xposition Xposition",
            "line 5, column 24: `Xposition` twice in one joint",
        ),
        (
            "OFFSET 0 1 0",
            "OFFSET 0 1 0 CHANNELS 1 Xrotation",
            "line 11, column 20: channels in an end site",
        ),
        ("OFFSET 0 1 0", "JOINT finger", "line 11, column 7: a joint inside an end site"),
        ("ROOT Shoulder", "End Site", "line 2, column 1: an end site outside of all joints"),
        ("}\nMOTION", "MOTION", "line 2, column 1: `Shoulder` is not closed before MOTION"),
        ("}\nMOTION", "}\n}\nMOTION", "line 15, column 1: a closing brace outside of all joints"),
        ("Frames: 3", "Frames: three", "line 16, column 9: `three` is no number of frames"),
        ("Frames: 3", "Frames: 0", "line 16, column 9: the file has no frames"),
        (
            "Frames: 3",
            "Frames: 18446744073709551615",
            "line 16, column 9: 18446744073709551615 frames are announced, 3 rows follow",
        ),
        ("Frames: 3", "Frames: 1", "line 19, column 1: a row after the last of 1 frames"),
        ("Frames: 3\n", "", "line 16, column 1: `Frame Time: .025` where `Frames: …` must stand"),
        (".025", "0", "line 17, column 13: a frame time of 0 s"),
        (".025", "-1", "line 17, column 13: a frame time of -1 s"),
        (
            "Time: .025",
            "Tim .025",
            "line 17, column 1: `Frame Tim .025` where `Frame Time: …` must stand",
        ),
        (
            "1 2 3 90 0 0",
            "1 2 3 90 0",
            "line 19, column 11: 5 numbers in the row, 6 channels in the hierarchy",
        ),
    ];
    for (from, to, expected) in cases {
        assert!(ARM.contains(from), "{from}");
        let message = message(&ARM.replacen(from, to, 1));
        assert!(message.starts_with(expected) && message.contains("; "), "{message}");
    }
    for empty in ["", "\u{feff}", " \r\n\t\n", "\r"] {
        assert_eq!(message(empty), "line 1, column 1: the text is empty; give a BVH file");
    }
    assert!(message("HIERARCHY\nMOTION\n").starts_with("line 2, column 1: no joint has a channel"));
}

#[test]
fn a_skeleton_of_any_depth_is_read_or_refused() {
    let text = format!("HIERARCHY\n{}", "ROOT a { OFFSET 0 0 0 ".repeat(5000));
    assert!(message(&text).contains("joints"), "{}", message(&text));
}

/// Any mutation of a file is either read with finite poses, or rejected with an error in one line
/// of text that contains a line number of the file.
#[test]
fn mutations_are_read_or_refused() {
    let scraps = [
        "{",
        "}",
        "JOINT",
        "End Site",
        "OFFSET",
        "CHANNELS 6",
        "MOTION",
        "Frames:",
        "-",
        "1e308",
        "NaN",
        "9999999999",
        "\n",
        "é",
        ":",
    ];
    let mut random = Random::new(462);
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..2000 {
        let mut text: Vec<char> = ARM.chars().collect();
        for _ in 0..=random.bits() % 3 {
            let at = random.bits() as usize % text.len();
            let until = (at + random.bits() as usize % 12).min(text.len());
            match random.bits() % 5 {
                0 => drop(text.drain(at..until)),
                1 => text[at] = char::from(32 + (random.bits() % 95) as u8),
                2 => text.truncate(at.max(1)),
                3 => {
                    let copy = text[at..until].to_vec();
                    text.splice(at..at, copy);
                }
                _ => {
                    let scrap = scraps[random.bits() as usize % scraps.len()];
                    text.splice(at..at, scrap.chars());
                }
            }
        }
        let text: String = text.into_iter().collect();
        match Bvh::read(&text) {
            Ok(bvh) => {
                accepted += 1;
                for frame in 0..bvh.frames() {
                    assert!(
                        bvh.pose(frame).iter().flatten().all(|value| value.abs() < 10.0 * LARGEST),
                        "{text}"
                    );
                }
            }
            Err(error) => {
                refused += 1;
                let (line, column) = error.at.unwrap();
                let length = text.lines().nth(line - 1).map_or(0, |line| line.chars().count());
                assert!((1..=length + 1).contains(&column), "{error} of {length} letters");
                assert!(
                    !error.to_string().contains('\n') && error.to_string().len() < 240,
                    "{error}"
                );
            }
        }
    }
    assert!(100 < accepted && 100 < refused, "{accepted} read, {refused} refused");
}

#[test]
fn a_motion_passes_through_the_positions_in_metres() {
    let arm = read(ARM);
    let hand = arm.motion("left hand", 0.01).unwrap();
    for frame in 0..arm.frames() {
        let t = Time::new(frame as f64 * arm.frame_time());
        let at = Motion::<f64, 3>::sample(&hand, t, Side::Before, Derivatives::POSITION).position;
        close(at, arm.pose(frame)[1].map(|value| 0.01 * value));
    }
}

#[test]
fn an_orientation_passes_through_those_of_the_frames() {
    let arm = read(ARM);
    let turn = |axis: [f64; 3], degrees: f64| Attitude::from_axis_angle(axis, degrees.to_radians());
    let (x, z) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let shoulder = [turn(z, 0.0), turn(z, 90.0), turn(z, 0.0)];
    let hand = [turn(z, 0.0), turn(z, 90.0), turn(z, 90.0) * turn(x, 90.0)];
    for (joint, attitudes) in [("Shoulder", shoulder), ("left hand", hand), ("left hand end", hand)]
    {
        let motion = arm.orientation(joint).unwrap();
        let times = [0.0, 0.025, 0.05];
        let expected = Attitudes::spline(&times, &attitudes).unwrap();
        for k in -5..=60 {
            let t = Time::new(f64::from(k) * 1e-3);
            let [found, exact]: [Sample<f64, 4>; 2] =
                [&motion, &expected].map(|motion| motion.sample(t, Side::After, Derivatives::ALL));
            assert!((0..4).all(|d| (found.position[d] - exact.position[d]).abs() < 1e-14), "{k}");
        }
    }
    assert!(arm.orientation("left foot").is_err());
}

#[test]
fn a_name_that_there_is_not_is_refused_with_those_that_there_are() {
    let error = read(ARM).motion("left foot", 1.0).unwrap_err();
    assert_eq!(
        error.to_string(),
        "no joint is called `left foot`; there are `Shoulder`, `left hand`; give one of these names"
    );
    assert!(read(ARM).motion("left hand", f64::NAN).is_err());
    let error = Bvh::open("no such file.bvh").unwrap_err().to_string();
    assert!(error.starts_with("no such file.bvh: ") && error.ends_with("BVH file"), "{error}");
    let error = Bvh::open(std::env::temp_dir()).unwrap_err().to_string();
    assert!(error.contains(": it is no regular file; "), "{error}");
}

#[test]
fn a_frame_beyond_the_last_is_the_last() {
    assert_eq!(read(ARM).pose(3), read(ARM).pose(2));
}
