//! Several processes, represented by threads, give the root the same bits as a single process.

use crate::ways::double;
use pendulum_runtime::ensemble::{Desk, Ensemble, Gathered, Team};
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

impl<'t> Team for Member<'t> {
    type Desk = Clerk<'t>;

    fn desk(&self) -> &Clerk<'t> {
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

fn sum(team: &Member<'_>) -> Option<Gathered<(f64, u64)>> {
    let all = Ensemble::new(5..305, double).shard(4).map(|_, solution| solution.end.v[0].sin());
    let identity = || (0.0, 0);
    let add = |(sum, count), value| (sum + value, count + 1);
    all.fold_in(team, identity, add, |a, b| (a.0 + b.0, a.1 + b.1)).unwrap()
}

#[test]
fn any_number_of_processes_gives_the_same_bits() {
    let alone = Ensemble::new(5..305, double).shard(4).map(|_, solution| solution.end.v[0].sin());
    let alone = alone.reduce(|| 0.0, |a, b| a + b).unwrap();
    for processes in [1, 2, 5] {
        let (next, (post, mail)) = (AtomicUsize::new(0), mpsc::channel());
        let clerk = || Clerk { next: &next, post: Mutex::new(post.clone()) };
        let root = Member { clerk: clerk(), mail: Some((processes, mail)) };
        let gathered = std::thread::scope(|scope| {
            for _ in 1..processes {
                let clerk = clerk();
                scope.spawn(|| assert!(sum(&Member { clerk, mail: None }).is_none()));
            }
            sum(&root).unwrap()
        });
        assert_eq!(gathered.value.0.to_bits(), alone.value.to_bits());
        assert_eq!((gathered.value.1, gathered.missing), (300, 0));
        assert_eq!(gathered.tally, alone.tally);
    }
}
