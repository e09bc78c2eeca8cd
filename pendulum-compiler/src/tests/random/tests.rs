//! Laws that hold for every random system. `RANDOM_SEED=17 RANDOM_COUNT=1` tests a single system,
//! `RANDOM_COUNT=100000` more systems.

use super::check::{Derived, PLAIN, PRECISE};
use super::interpret::Values;
use super::{Outcome, outcome};
use crate::compile::derived;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use random_systems::generate::{self, Manner};
use random_systems::reference::State;
use random_systems::state::{precise, state};
use random_systems::transform::{SCALE, back, gauged, moved, reversed, scaled, turned};
use random_systems::tree::System;

pub(super) fn variable(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|text| text.parse().ok())
}

/// Returns the systems of a test, for one of every `share` seeds.
fn systems(count: u64, share: u64, manner: Manner) -> impl Iterator<Item = System> {
    let first = variable("RANDOM_SEED").unwrap_or(0);
    let count = variable("RANDOM_COUNT").unwrap_or(count);
    (first..first + count).filter(move |seed| count == 1 || seed % share == 0).map(move |seed| {
        let system = generate::system(seed, manner);
        if count == 1 {
            println!("{}", system.source("Random"));
        }
        system
    })
}

/// Accelerations, mass matrix, momenta, forces, energies, powers, velocities from momenta,
/// Jacobians and conserved quantities agree with the reference.
#[test]
fn what_is_derived_is_what_is_written() {
    let (mut compared, mut unsound) = (0, 0);
    for system in systems(200, 1, Manner::Tame) {
        match outcome(&system) {
            Outcome::Compared(findings) => {
                compared += 1;
                let wrong = findings.wrong();
                assert!(
                    wrong.is_empty(),
                    "seed {}: {wrong:?} in\n{}",
                    system.seed,
                    system.source("Random")
                );
                // The generator creates positive kinetic energies.
                assert!(0.0 < findings.pivot, "seed {}: pivot {}", system.seed, findings.pivot);
            }
            Outcome::Unsound => unsound += 1,
            Outcome::Refused(messages) => {
                panic!("seed {}: {messages} for\n{}", system.seed, system.source("Random"))
            }
        }
    }
    assert!(unsound * 20 <= compared, "{unsound} of {compared} have no value");
}

/// A wild system may be refused or have no value, but its values are correct.
#[test]
fn wild_systems_are_derived_or_refused() {
    for system in systems(120, 1, Manner::Wild) {
        if let Outcome::Compared(findings) = outcome(&system) {
            // If a function has an infinite slope, a simplified derivative may have no value.
            let wrong: Vec<_> =
                findings.wrong().into_iter().filter(|row| 1e-6 < row.1 && 1e-6 < row.2).collect();
            assert!(
                wrong.is_empty(),
                "wild seed {}: {wrong:?} in\n{}",
                system.seed,
                system.source("Random")
            );
        }
    }
}

/// Returns the accelerations and momenta of a system.
fn outputs<T: Float>(system: &System, state: &State<T>) -> [Vec<T>; 2] {
    let source = system.source("Random");
    let mut errors = crate::messages::Errors::default();
    let found = derived(&source, &mut errors, |model, graph, motion, _| {
        let derived = Derived { model, graph, motion };
        let values = Values::new(state);
        [&motion.accelerations, &motion.momenta]
            .map(|roots| values.of(derived.model, derived.graph, roots))
    });
    found.unwrap_or_else(|| panic!("seed {}: {:?} for\n{source}", system.seed, errors.messages()))
}

/// Returns the largest difference relative to the largest expected value or to one, or zero if an
/// expected value is not finite.
fn difference<T: Float>(found: &[T], expected: &[T]) -> f64 {
    let scale = expected.iter().fold(1.0, |scale: f64, x| scale.max(x.to_f64().abs()));
    if !expected.iter().all(|x| x.is_finite()) {
        return 0.0;
    }
    found
        .iter()
        .zip(expected)
        .map(|(&a, &b)| (a - b).to_f64().abs() / scale)
        .fold(0.0, |worst, own| if own.is_nan() || worst < own { own } else { worst })
}

/// A total derivative in L does not change the accelerations.
#[test]
fn gauge_terms_change_nothing() {
    for system in systems(200, 8, Manner::Tame) {
        let (seed, gauged) = (system.seed, gauged(&system));
        let state = state(&system, seed);
        let own = difference(&outputs(&gauged, &state)[0], &outputs(&system, &state)[0]);
        assert!(own < 1e-10, "seed {seed}: {own} for\n{}", gauged.source("Random"));
        let state: State<DoubleDouble> = precise(&system, &state);
        let own = difference(&outputs(&gauged, &state)[0], &outputs(&system, &state)[0]);
        assert!(own < PRECISE, "seed {seed}: {own} for\n{}", gauged.source("Random"));
    }
}

/// c L has the accelerations of L and c times its momenta.
#[test]
fn the_scale_of_energy_cancels() {
    for system in systems(200, 8, Manner::Tame) {
        let (seed, scaled) = (system.seed, scaled(&system));
        let state = state(&system, seed);
        let [accelerations, momenta] = outputs(&system, &state);
        let [found, larger] = outputs(&scaled, &state);
        let own = difference(&found, &accelerations);
        assert!(own < PLAIN, "seed {seed}: {own} for\n{}", scaled.source("Random"));
        let expected: Vec<f64> = momenta.iter().map(|p| SCALE * p).collect();
        assert!(difference(&larger, &expected) < PLAIN, "seed {seed}: {larger:?} and {expected:?}");
    }
}

/// A time-reversed motion has the same accelerations and the opposite momenta.
#[test]
fn motions_run_backwards() {
    for system in systems(200, 8, Manner::Tame) {
        let (seed, reversed) = (system.seed, reversed(&system));
        let state = state(&system, seed);
        let [accelerations, momenta] = outputs(&system, &state);
        let [found, opposite] = outputs(&reversed, &turned(&state));
        let own = difference(&found, &accelerations);
        assert!(own < PLAIN, "seed {seed}: {own} for\n{}", reversed.source("Random"));
        let expected: Vec<f64> = momenta.iter().map(|p| -p).collect();
        assert!(
            difference(&opposite, &expected) < PLAIN,
            "seed {seed}: {opposite:?} and {expected:?}"
        );
    }
}

/// The same motion in other coordinates.
#[test]
fn other_coordinates_give_the_same_motion() {
    for system in systems(200, 8, Manner::Tame) {
        let seed = system.seed;
        let system = System { forces: Vec::new(), ..system };
        let moved = moved(&system);
        let new = state(&moved, seed);
        let [accelerations, _] = outputs(&moved, &new);
        let [q, v, a] = back(&system, [&new.q, &new.v, &accelerations]);
        let [expected, _] = outputs(&system, &State { q, v, ..new });
        let own = difference(&a, &expected);
        // The mass matrices are positive, but their condition is not bounded.
        assert!(
            own < 1e-9,
            "seed {seed}: {own} for\n{}and\n{}",
            system.source("Random"),
            moved.source("Random")
        );
    }
}

/// The systems in the written file are those of the generator.
#[test]
fn written_systems_are_up_to_date() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/language/random_systems/blocks.rs");
    let text = super::written::file();
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(path, &text).unwrap();
    }
    let found = std::fs::read_to_string(path).unwrap_or_default();
    assert!(
        found == text,
        "`UPDATE_GOLDEN=1 cargo test -p pendulum-compiler written` writes {path} anew"
    );
}
