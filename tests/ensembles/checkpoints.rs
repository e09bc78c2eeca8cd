//! Checkpoints: no finished shard is lost, and the result has the bits of an uninterrupted run.

use crate::ways::double;
use pendulum_runtime::ensemble::{Ensemble, EnsembleError, Gathered};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

const MEMBERS: usize = 400;
const SHARD: usize = 2;

/// Returns the path of a folder for a test; an existing folder is removed.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("pendulum-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    folder
}

/// Computes a sum whose bits depend on the order of the additions, and the list of the members in
/// their order. One member fails.
fn run(
    folder: Option<&Path>,
    tag: &str,
    pause: Duration,
) -> Result<Gathered<(f64, Vec<usize>)>, EnsembleError> {
    let problem = |k: usize| {
        let mut problem = double(k);
        if k == 77 {
            problem.v[0] = f64::NAN;
        }
        problem
    };
    let mapped = Ensemble::new(0..MEMBERS, problem).shard(SHARD).map(|k, solution| {
        std::thread::sleep(pause);
        (solution.end.q[0].sin() * solution.end.v[1], k)
    });
    let identity = || (0.0, Vec::new());
    let add = |(sum, mut members): (f64, Vec<usize>), (value, k): (f64, usize)| {
        members.push(k);
        (sum + value, members)
    };
    let merge = |(sum, mut members): (f64, Vec<usize>), (later, more): (f64, Vec<usize>)| {
        members.extend(more);
        (sum + later, members)
    };
    let mapped = mapped.tag(tag);
    let mapped = if let Some(folder) = folder { mapped.checkpoint(folder) } else { mapped };
    mapped.fold(identity, add, merge)
}

fn shards(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<_> = entries.map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "bin"));
    files.sort();
    files
}

/// Compares two results. Of errors, only the text is compared, because checkpoints store only the
/// text.
fn assert_same(a: &Gathered<(f64, Vec<usize>)>, b: &Gathered<(f64, Vec<usize>)>) {
    assert_eq!((a.value.0.to_bits(), &a.value.1), (b.value.0.to_bits(), &b.value.1));
    let counts = |gathered: &Gathered<(f64, Vec<usize>)>| {
        let tally = &gathered.tally;
        let failures: Vec<_> = tally.failures.iter().map(ToString::to_string).collect();
        (tally.members, tally.failed, tally.accepted, tally.evaluations, failures)
    };
    assert_eq!(counts(a), counts(b));
}

/// The run of the child process that is killed. Without a folder in the environment, the test does
/// nothing.
#[test]
fn child() {
    if let Some(folder) = std::env::var_os("PENDULUM_CHECKPOINT") {
        run(Some(Path::new(&folder)), "", Duration::from_millis(3)).unwrap();
    }
}

#[test]
fn a_run_that_is_killed_fifty_times_loses_nothing() {
    let plain = run(None, "", Duration::ZERO).unwrap();
    let folder = folder("killed");
    let mut seed = 12345_u32;
    let mut random = move |below: u32| {
        seed = seed.wrapping_mul(1664525).wrapping_add(1013904223);
        (seed >> 8) % below
    };
    let (mut killed, mut most) = (0, 0);
    for _ in 0..50 {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "checkpoints::child", "--test-threads", "1"])
            .env("PENDULUM_CHECKPOINT", &folder)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        // Kills the child at a random time, sometimes before its first shard; the wait is bounded.
        let before = shards(&folder).len();
        let patience = if random(8) == 0 { 10 } else { 3000 };
        for _ in 0..patience {
            if before < shards(&folder).len() {
                break;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_micros(u64::from(random(12_000))));
        // The child may already have ended.
        let _ = child.kill();
        killed += u32::from(!child.wait().unwrap().success());
        let files = shards(&folder);
        most = most.max(files.len());
        // A crash of the machine or a full disk may leave incomplete or damaged files.
        if !files.is_empty() && random(3) == 0 {
            let file = &files[random(files.len() as u32) as usize];
            let mut bytes = fs::read(file).unwrap();
            if random(2) == 0 {
                bytes.truncate(random(bytes.len() as u32) as usize);
            } else {
                let place = random(bytes.len() as u32) as usize;
                bytes[place] ^= 1;
            }
            fs::write(file, bytes).unwrap();
        }
    }
    let resumed = run(Some(&folder), "", Duration::ZERO).unwrap();
    assert!(40 <= killed && 10 < most, "{killed} killed, {most} shards");
    assert!(resumed.resumed <= most && most < resumed.resumed + 50);
    assert_same(&resumed, &plain);
    let again = run(Some(&folder), "", Duration::ZERO).unwrap();
    assert_eq!(again.resumed, MEMBERS / SHARD);
    assert_same(&again, &plain);
    let left = fs::read_dir(&folder).unwrap().flatten().count();
    assert_eq!(left, MEMBERS / SHARD + 1, "something is left beside shards and settings");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn other_settings_are_refused_with_both_hashes() {
    let folder = folder("refused");
    run(Some(&folder), "first", Duration::ZERO).unwrap();
    let error = run(Some(&folder), "second", Duration::ZERO).unwrap_err();
    let EnsembleError::Refused { found, hash, difference, .. } = &error else {
        panic!("{error}");
    };
    assert_ne!(found, hash);
    assert_eq!(difference, "there `tag = \"first\"`, here `tag = \"second\"`");
    let text = error.to_string();
    assert!(text.contains(&format!("{found:016x}")) && text.contains(&format!("{hash:016x}")));
    // Without a readable file of settings, the shards reveal the difference.
    fs::write(folder.join("settings.txt"), "torn").unwrap();
    let error = run(Some(&folder), "second", Duration::ZERO).unwrap_err();
    assert!(matches!(error, EnsembleError::Refused { .. }), "{error}");
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn whatever_changes_the_bits_changes_the_hash() {
    let folder = folder("changed");
    macro_rules! attempt {
        ($members:expr, $problem:expr $(, $setting:ident $value:expr)*) => {
            Ensemble::new($members, $problem)$(.$setting($value))*
                .map(|k, _| k)
                .checkpoint(&folder)
                .collect()
        };
    }
    attempt!(0..20, double).unwrap();
    assert_eq!(attempt!(0..20, double).unwrap().resumed, 3);
    let shifted = |k: usize| double(k + 1);
    let shorter = |k: usize| {
        let mut problem = double(k);
        problem.time.1 -= if k == 19 { 1e-9 } else { 0.0 };
        problem
    };
    for (what, attempt) in [
        ("members", attempt!(0..21, double)),
        ("start", attempt!(1..20, double)),
        ("problems", attempt!(0..20, shifted)),
        ("interval", attempt!(0..20, shorter)),
        ("rtol", attempt!(0..20, double, rtol 1e-7)),
        ("atol", attempt!(0..20, double, atol 1e-7)),
        ("method", attempt!(0..20, double, method pendulum_runtime::integrate::Dop853)),
        ("step", attempt!(0..20, double, step 0.1)),
        ("shard", attempt!(0..20, double, shard 5)),
        ("output", attempt!(0..20, double, every 0.1)),
    ] {
        let refused = matches!(attempt, Err(EnsembleError::Refused { .. }));
        assert!(refused, "{what}");
    }
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn parts_share_a_folder() {
    let folder = folder("parts");
    let plain = Ensemble::new(0..100, double).map(|k, _| k).collect().unwrap();
    let part = |index, of| {
        let all = Ensemble::new(0..100, double).map(|k, _| k).checkpoint(&folder);
        all.part(index, of).collect()
    };
    let first = part(0, 3).unwrap();
    assert_eq!((first.resumed, first.missing, first.tally.members), (0, 8, 36));
    assert_eq!(first.value.iter().flatten().count(), 36);
    let second = part(1, 3).unwrap();
    assert_eq!((second.resumed, second.missing), (5, 4));
    part(2, 3).unwrap();
    let all = part(0, 1).unwrap();
    assert_eq!((all.resumed, all.missing, all.cancelled), (13, 0, false));
    assert_eq!(all.value, plain.value);
    assert!(matches!(part(3, 3), Err(EnsembleError::Part { index: 3, parts: 3 })));
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_disk_that_fails_keeps_what_is_finished() {
    let [folder, away] = [folder("failing"), folder("failing-away")];
    let run = || Ensemble::new(0..100, double).map(|k, _| k).checkpoint(&folder);
    // No file can be written into a file.
    let failing = run().on_progress(|progress| {
        if 4 <= progress.shards && fs::rename(&folder, &away).is_ok() {
            fs::write(&folder, "").unwrap();
        }
        ControlFlow::Continue(())
    });
    let error = failing.collect().unwrap_err();
    assert!(matches!(error, EnsembleError::Io { .. }), "{error}");
    fs::remove_file(&folder).unwrap();
    fs::rename(&away, &folder).unwrap();
    let finished = shards(&folder).len();
    assert!((4..13).contains(&finished), "{finished}");
    assert_eq!(run().collect().unwrap().resumed, finished);
    fs::remove_dir_all(folder).unwrap();
}

/// Such a file is computed again and replaced; what it leads to is neither read nor changed.
#[test]
#[cfg(unix)]
fn what_is_no_file_counts_as_damaged() {
    use std::os::unix::fs::symlink;
    let folder = folder("strange");
    let run = || Ensemble::new(0..100, double).map(|k, _| k).checkpoint(&folder).collect().unwrap();
    run();
    let whole = shards(&folder);
    let count = whole.len();
    let target = folder.join("target.txt");
    fs::write(&target, "dear").unwrap();
    fs::create_dir(folder.join("full")).unwrap();
    let pipe = |file: &Path| {
        assert!(Command::new("mkfifo").arg(file).status().unwrap().success());
    };
    pipe(&folder.join("pipe"));
    let zeros = |file: &Path| {
        let file = fs::OpenOptions::new().create(true).append(true).open(file).unwrap();
        file.set_len(1 << 40).unwrap();
    };
    // More than any memory, in files without blocks of their own.
    zeros(&whole[count - 1]);
    assert_eq!(run().resumed, count - 1);
    let strange: [&dyn Fn(&Path); 10] = [
        &zeros,
        &|file| symlink("/dev/zero", file).unwrap(),
        &|file| symlink(folder.join("pipe"), file).unwrap(),
        &|file| symlink(folder.join("full"), file).unwrap(),
        &|file| symlink(file, file).unwrap(),
        &|file| symlink("nowhere", file).unwrap(),
        &|file| symlink(&target, file).unwrap(),
        &pipe,
        &|file| fs::create_dir(file).unwrap(),
        &|file| {
            fs::create_dir(file).unwrap();
            fs::write(file.join("dear.txt"), "dear").unwrap();
        },
    ];
    for (strange, file) in strange.iter().zip(&whole) {
        fs::remove_file(file).unwrap();
        strange(file);
    }
    assert_eq!(run().resumed, count - strange.len());
    assert_eq!(run().resumed, count);
    // The settings likewise.
    for strange in strange {
        fs::remove_file(folder.join("settings.txt")).unwrap();
        strange(&folder.join("settings.txt"));
        assert_eq!(run().resumed, count);
    }
    assert_eq!(fs::read_to_string(&target).unwrap(), "dear");
    let entries = fs::read_dir(&folder).unwrap().flatten();
    let kept = entries.filter(|entry| entry.path().join("dear.txt").is_file()).count();
    assert_eq!(kept, 2);
    // A link to a whole shard is one.
    let moved = folder.join("moved.bin");
    fs::rename(&whole[0], &moved).unwrap();
    symlink(&moved, &whole[0]).unwrap();
    assert_eq!(run().resumed, count);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_cancelled_run_goes_on() {
    let folder = folder("cancelled");
    let all = || Ensemble::new(0..100, double).map(|k, _| k).checkpoint(&folder);
    let stop = all().on_progress(|progress| {
        if progress.shards < 4 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let stopped = stop.collect().unwrap();
    assert!(stopped.cancelled && 32 <= stopped.tally.members);
    assert_eq!(stopped.missing as u64, 13 - stopped.tally.members / 8);
    let mut given = Vec::new();
    let rest = all().for_each(|k, same| given.push((k, same))).unwrap();
    assert!(4 <= rest.resumed && !rest.cancelled);
    given.sort_unstable();
    assert_eq!(given, (0..100).map(|k| (k, k)).collect::<Vec<_>>());
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn shards_with_failed_members_come_back() {
    let folder = folder("failed");
    let first = run(Some(&folder), "", Duration::ZERO).unwrap();
    let again = run(Some(&folder), "", Duration::ZERO).unwrap();
    assert_eq!((first.resumed, again.resumed), (0, MEMBERS / SHARD));
    assert_same(&first, &again);
    assert!(first.tally.failures[0].error.is_some() && again.tally.failures[0].error.is_none());
    fs::remove_dir_all(folder).unwrap();
}
