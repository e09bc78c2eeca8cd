//! Ensembles over the ranks of MPI: the ranks of one program under `mpirun` share the shards. Each
//! rank uses its threads, and rank 0 gets the value, with the same bits as a single process.
//!
//! OpenMPI or MPICH must be installed, on Debian `libopenmpi-dev openmpi-bin libclang-dev`.
//!
//! ```no_run
//! # mod system {
//! #     pendulum_runtime::lagrangian! {
//! #         pub struct Pendulum { l }
//! #         coordinate θ;
//! #         kinetic = (l*θ̇)^2/2;
//! #         potential = -l*cos(θ);
//! #     }
//! # }
//! # use system::Pendulum;
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use pendulum_runtime::prelude::*;
//!
//! let universe = mpi::initialize().ok_or("MPI does not start")?;
//! let world = universe.world();
//! let swings = Ensemble::new(0..1_000_000, |k| Problem {
//!     system: Pendulum::new(1.0),
//!     time: (0.0, 10.0),
//!     q: [1e-6 * k as f64],
//!     v: [0.0],
//! });
//! let all = swings.map(|_, solution| solution.end.q[0].abs());
//! let largest = all.fold_in(&pendulum_mpi::Ranks::new(&world), || 0.0, f64::max, f64::max)?;
//! if let Some(largest) = largest {
//!     println!("{}", largest.value);
//! }
//! # Ok(())
//! # }
//! ```

use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, Destination, Source};
use pendulum_runtime::ensemble::{Desk, Team};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, Receiver, Sender, TryRecvError};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// The last byte of a message, which is its type.
const REQUEST: u8 = 0;
const SHARD: u8 = 1;
const THROUGH: u8 = 2;

/// The time between two polls for messages. A waiting rank sleeps, so that its core is free for
/// other ranks.
const PAUSE: Duration = Duration::from_micros(100);

/// A request of a thread to the thread that communicates with other ranks.
enum Order {
    /// Request a shard from the root.
    Take(Sender<Option<usize>>),
    /// Send a shard.
    Send(usize, Vec<u8>),
    /// All threads of the rank have finished.
    Finish,
}

/// A team of the ranks of a communicator. Rank 0 is the root: it assigns shards one by one to ranks
/// that request them.
///
/// Only the thread that calls `fold_in` uses MPI, so any level of thread support is sufficient.
pub struct Ranks<'w> {
    world: &'w SimpleCommunicator,
    orders: Orders,
    inbox: Receiver<Order>,
}

/// The queue of requests of all threads of a rank.
struct Orders {
    rank: i32,
    /// The next shard; used only on the root.
    next: AtomicUsize,
    orders: Mutex<Sender<Order>>,
}

impl<'w> Ranks<'w> {
    /// Creates a team of the ranks of `world`. Each value can be used for a single call of
    /// `fold_in`.
    pub fn new(world: &'w SimpleCommunicator) -> Self {
        let (orders, inbox) = mpsc::channel();
        let (rank, next, orders) = (world.rank(), AtomicUsize::new(0), Mutex::new(orders));
        Self { world, orders: Orders { rank, next, orders }, inbox }
    }
}

impl Orders {
    fn order(&self, order: Order) {
        let orders = self.orders.lock().unwrap_or_else(PoisonError::into_inner);
        // Without a receiver, the ensemble has ended.
        let _ = orders.send(order);
    }

    fn next(&self) -> usize {
        self.next.fetch_add(1, Ordering::Relaxed)
    }
}

impl Desk for Orders {
    fn take(&self) -> Option<usize> {
        if self.rank == 0 {
            return Some(self.next());
        }
        let (answer, shard) = mpsc::channel();
        self.order(Order::Take(answer));
        shard.recv().ok().flatten()
    }

    fn send(&self, shard: usize, bytes: Vec<u8>) {
        self.order(Order::Send(shard, bytes));
    }

    fn finish(&self) {
        self.order(Order::Finish);
    }
}

impl Team for Ranks<'_> {
    fn desk(&self) -> &dyn Desk {
        &self.orders
    }

    fn is_root(&self) -> bool {
        self.orders.rank == 0
    }

    fn serve(&self, receive: &mut dyn FnMut(usize, &[u8])) {
        let (mut under_way, mut here) = (self.world.size() - 1, true);
        while here || self.is_root() && 0 < under_way {
            let mut idle = true;
            match self.inbox.try_recv() {
                Ok(Order::Take(answer)) => {
                    let root = self.world.process_at_rank(0);
                    root.send(&[REQUEST][..]);
                    let (shard, _) = root.receive::<u64>();
                    let _ = answer.send(usize::try_from(shard).ok());
                    idle = false;
                }
                Ok(Order::Send(shard, mut bytes)) => {
                    bytes.extend((shard as u64).to_le_bytes());
                    bytes.push(SHARD);
                    self.world.process_at_rank(0).send(&bytes[..]);
                    idle = false;
                }
                Ok(Order::Finish) | Err(TryRecvError::Disconnected) => {
                    here = false;
                    if !self.is_root() {
                        self.world.process_at_rank(0).send(&[THROUGH][..]);
                    }
                }
                Err(TryRecvError::Empty) => {}
            }
            if self.is_root() && self.world.any_process().immediate_probe().is_some() {
                let (message, status) = self.world.any_process().receive_vec::<u8>();
                match message.split_last() {
                    Some((&SHARD, rest)) => {
                        if let Some((bytes, shard)) = rest.split_last_chunk() {
                            receive(u64::from_le_bytes(*shard) as usize, bytes);
                        }
                    }
                    Some((&THROUGH, _)) => under_way -= 1,
                    _ => {
                        let shard = self.orders.next() as u64;
                        self.world.process_at_rank(status.source_rank()).send(&shard);
                    }
                }
                idle = false;
            }
            if idle {
                thread::sleep(PAUSE);
            }
        }
    }
}
