//! The energy of motions with friction: its change is the work of forces and belts, less the heat
//! of the frictions and what impacts take.

use crate::discs::Dragged;
use crate::frictions::{Belt, Rubbing, Stack};
use crate::rough::{Block, Ladder};
use crate::wires::Hoop;
use pendulum_runtime::integrate::Solution;
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::Dynamics;

/// Asserts that the balance closes to ten tolerances, in the scale of the energy.
fn closes<D: Dynamics<N, Scalar = f64>, const N: usize>(
    name: &str,
    system: &D,
    run: &Solution<f64, N>,
    tolerance: f64,
) {
    let (work, energy) = (run.work(system).unwrap(), run.energy(system));
    let [.., end] = energy[..] else { panic!("{name}: no output") };
    let off = work.power + work.jumps - (end - energy[0]);
    let scale = energy.iter().fold(1.0, |most, energy| f64::max(most, energy.abs()));
    assert!(off.abs() <= 10.0 * tolerance * scale, "{name} at {tolerance:e}: off by {off:e}");
    assert!(1e-3 < work.power.abs(), "{name}: {work:?}");
    assert!(run.frictions.iter().any(|slip| slip.direction != 0), "{name} never slides");
}

#[test]
fn energy_with_its_losses_closes_to_ten_tolerances() {
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        macro_rules! closes {
            ($name:literal, $system:expr, $end:literal, $q:expr, $v:expr) => {{
                let system = $system;
                let run = solve(&system, (0.0, $end), $q, $v).rtol(tolerance);
                let run = run.every($end / 40.0).dense().run().unwrap();
                closes($name, &system, &run, tolerance);
            }};
        }
        closes!("spring", Rubbing::new(1.0, 1.0, 0.1, 0.4, 0.7, 0.3), 20.0, [1.05], [0.2]);
        closes!("belt", Belt::new(2.0, 3.0, 0.5, 1.0, 0.3), 12.0, [0.0], [0.3]);
        closes!("stack", Stack::new(1.0, 2.0, 0.5, 0.4, 0.5), 6.0, [0.0; 2], [1.0, -1.0]);
        closes!("block", Block::new(1.0, 0.3, 0.5, 2.0, 0.0), 3.0, [0.0, 0.5], [2.0, 0.0]);
        closes!("hoop", Hoop::new(1.0, 0.2, 9.81), 6.0, [0.6, -0.8], [2.4, 1.8]);
        // Its end passes the floor while its friction comes to rest there: no impulse stops it.
        let (a, θ) = (0.95_f64, 0.69_f64);
        let start = [a * θ.sin(), a * θ.cos(), θ];
        closes!("ladder", Ladder::new(a, 0.29, 0.35), 2.0, start, [0.0; 3]);
        let plate = Dragged { m: 1.0, k: 2.0, c: 0.8, Ω: 1.0, F: 0.6, D: 0.2 };
        closes!("plate", plate, 8.0, [0.5, 0.2], [0.0; 2]);
    }
}
