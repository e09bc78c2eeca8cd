//! Several processes, represented by threads, give the root the same bits as a single process.

use crate::ways::double;
use pendulum_runtime::ensemble::{Desk, Ensemble, EnsembleError, Team};
use pendulum_runtime::integrate::Solution;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, Receiver, Sender};

/// A finished shard, or `None` from a process that has finished.
type Parcel = Option<(usize, Vec<u8>)>;

struct Clerk<'t> {
    next: &'t AtomicUsize,
    post: Mutex<Sender<Parcel>>,
}

impl Desk for Clerk<'_> {
    fn take(&self) -> Option<usize> {
        Some(self.next.fetch_add(1, Ordering::Relaxed))
    }

    fn send(&self, shard: usize, bytes: Vec<u8>) {
        self.post.lock().unwrap().send(Some((shard, bytes))).unwrap();
    }

    fn finish(&self) {
        self.post.lock().unwrap().send(None).unwrap();
    }
}

struct Member<'t> {
    clerk: Clerk<'t>,
    /// For the root: the number of processes and the incoming parcels.
    mail: Option<(usize, Receiver<Parcel>)>,
}

impl Team for Member<'_> {
    fn desk(&self) -> &dyn Desk {
        &self.clerk
    }

    fn is_root(&self) -> bool {
        self.mail.is_some()
    }

    fn serve(&self, receive: &mut dyn FnMut(usize, &[u8])) {
        let Some((count, mail)) = &self.mail else { return };
        let mut under_way = *count;
        while 0 < under_way {
            match mail.recv().unwrap() {
                Some((shard, bytes)) => receive(shard, &bytes),
                None => under_way -= 1,
            }
        }
    }
}

/// Runs `work` as the root of a team of this many processes, and as the other processes.
fn together<R>(processes: usize, work: impl Fn(&Member<'_>) -> Option<R> + Sync) -> R {
    let (next, (post, mail)) = (AtomicUsize::new(0), mpsc::channel());
    let clerk = || Clerk { next: &next, post: Mutex::new(post.clone()) };
    let root = Member { clerk: clerk(), mail: Some((processes, mail)) };
    std::thread::scope(|scope| {
        for _ in 1..processes {
            let (clerk, work) = (clerk(), &work);
            scope.spawn(move || assert!(work(&Member { clerk, mail: None }).is_none()));
        }
        work(&root).unwrap()
    })
}

fn value(_: usize, solution: &Solution<f64, 2>) -> f64 {
    solution.end.v[0].sin()
}

#[test]
fn any_number_of_processes_gives_the_same_bits() {
    let all = || Ensemble::new(5..305, double).shard(4).map(value);
    let add = |(sum, count): (f64, u64), value| (sum + value, count + 1);
    let merge = |a: (f64, u64), b: (f64, u64)| (a.0 + b.0, a.1 + b.1);
    let alone = all().fold(|| (0.0, 0), add, merge).unwrap();
    for processes in [1, 2, 5] {
        let gathered =
            together(processes, |team| all().fold_in(team, || (0.0, 0), add, merge).unwrap());
        assert_eq!(gathered.value.0.to_bits(), alone.value.0.to_bits());
        assert_eq!((gathered.value.1, gathered.missing, gathered.cancelled), (300, 0, false));
        assert_eq!(gathered.tally, alone.tally);
    }
}

#[test]
fn a_team_solves_its_part_only() {
    let folder = std::env::temp_dir().join(format!("pendulum-team-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    // 75 shards of four members.
    let all = || Ensemble::new(5..305, double).shard(4).map(value).checkpoint(&folder);
    let add = |a: f64, b: f64| a + b;
    let part = |index, of| {
        together(3, |team| all().part(index, of).fold_in(team, || 0.0, add, add).unwrap())
    };
    let first = part(0, 2);
    assert_eq!((first.tally.members, first.resumed), (38 * 4, 0));
    assert_eq!((first.missing, first.cancelled), (37, false));
    // The second part reads the shards of the first, in whatever process.
    let second = part(1, 2);
    assert_eq!((second.tally.members, second.resumed), (300, 38));
    assert_eq!((second.missing, second.cancelled), (0, false));
    let alone = Ensemble::new(5..305, double).shard(4).map(value).reduce(|| 0.0, add).unwrap();
    assert_eq!(second.value.to_bits(), alone.value.to_bits());
    let wrong = together(1, |team| Some(all().part(2, 2).fold_in(team, || 0.0, add, add)));
    assert!(matches!(wrong, Err(EnsembleError::Part { index: 2, parts: 2 })));
    std::fs::remove_dir_all(folder).unwrap();
}
