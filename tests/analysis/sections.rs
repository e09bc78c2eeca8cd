//! Poincaré sections with known crossings.

use pendulum_runtime::analysis::poincare;
use pendulum_runtime::integrate::Direction;
use pendulum_runtime::prelude::*;
use systems::problems::{HenonHeiles, Kepler};

mod blocks {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        /// Two oscillators that do not know of each other.
        pub struct Pair { a, b }
        coordinate x;
        coordinate y;
        kinetic = (ẋ^2 + ẏ^2)/2;
        potential = (a^2*x^2 + b^2*y^2)/2;
    }

    lagrangian! {
        /// A motion that ends in a pole.
        pub struct Falling { k }
        coordinate x;
        kinetic = ẋ^2/2;
        potential = -k/x;
    }
}

use blocks::*;

#[test]
fn crossings_come_in_order_at_their_times_in_one_direction() {
    // x = sin 2t rises through zero at every multiple of π, where y = cos 3t.
    let pair = Pair::new(2.0, 3.0);
    let section =
        || poincare(&pair, (0.0, 20.0), [0.0, 1.0], [2.0, 0.0], |_, q, _| q[0]).rtol(1e-12);
    let pi = std::f64::consts::PI;
    let rising: Vec<State<f64, 2>> = section().start().unwrap().map(Result::unwrap).collect();
    assert_eq!(rising.len(), 6);
    for (k, state) in rising.iter().enumerate() {
        let t = (k + 1) as f64 * pi;
        assert!((state.t - t).abs() < 1e-10 && state.q[0].abs() < 1e-10, "{state:?}");
        assert!((state.q[1] - (3.0 * t).cos()).abs() < 1e-9, "{state:?}");
    }
    let count = |direction| section().direction(direction).start().unwrap().count();
    assert_eq!((count(Direction::Falling), count(Direction::Both)), (6, 12));
    let other = section().method(Dop853).start().unwrap();
    for (a, b) in rising.iter().zip(other) {
        assert!((a.t - b.unwrap().t).abs() < 1e-9);
    }
}

#[test]
fn an_ellipse_has_one_point() {
    let kepler = Kepler::new(1.0);
    let (q, v) = ([1.5, 0.0], [0.0, 0.5_f64.sqrt()]);
    let section = poincare(&kepler, (0.0, 200.0), q, v, |_, q, _| q[1]).rtol(1e-13);
    // a = 1/(2/r − v²), T = 2π a^{3/2}.
    let period = std::f64::consts::TAU * (1.0 / (2.0 / 1.5 - 0.5_f64)).powf(1.5);
    let mut count = 0;
    for (k, state) in section.start().unwrap().enumerate() {
        let state = state.unwrap();
        assert!((state.t - (k + 1) as f64 * period).abs() < 1e-8, "{state:?}");
        assert!((state.q[0] - 1.5).abs() < 1e-9 && (state.v[1] - v[1]).abs() < 1e-9, "{state:?}");
        count += 1;
    }
    assert_eq!(count, (200.0 / period) as usize);
}

#[test]
fn points_of_henon_and_heiles_lie_on_the_energy_surface_and_in_the_plane() {
    let system = HenonHeiles::new(1.0);
    let (q, v) = ([0.0, 0.1], [(0.2_f64 - 0.01 + 2e-3 / 3.0).sqrt(), 0.0]);
    let energy = system.energy_at(0.0, &q, &v);
    let section = poincare(&system, (0.0, 1e4), q, v, |_, q, _| q[0]).rtol(1e-11);
    let mut count = 0;
    for state in section.start().unwrap().take(100) {
        let state = state.unwrap();
        assert!(state.q[0].abs() < 1e-12 && 0.0 < state.v[0], "{state:?}");
        assert!((system.energy_at(state.t, &state.q, &state.v) - energy).abs() < 1e-9);
        count += 1;
    }
    assert_eq!(count, 100);
}

#[test]
fn a_surface_that_is_never_crossed_ends_the_iterator() {
    let pair = Pair::new(2.0, 3.0);
    let never = |_: f64, q: &[f64; 2], _: &[f64; 2]| q[0] - 5.0;
    let mut section = poincare(&pair, (0.0, 50.0), [0.0, 1.0], [2.0, 0.0], never).start().unwrap();
    assert!(section.next().is_none() && section.next().is_none());
    assert!(50.0 <= section.state().t);
}

#[test]
fn errors_are_given_once() {
    let falling = Falling::new(1.0);
    let section = poincare(&falling, (0.0, 5.0), [1.0], [0.0], |_, q, _| 0.5 - q[0]);
    let found: Vec<_> = section.start().unwrap().collect();
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].is_ok() && found[1].is_err(), "{found:?}");

    let empty = |time| poincare(&falling, time, [1.0], [0.0], |_, q, _| q[0]).start();
    assert!(empty((1.0, 0.0)).is_err() && empty((0.0, f64::INFINITY)).is_err());
    assert_eq!(empty((0.0, 0.0)).unwrap().count(), 0);
}
