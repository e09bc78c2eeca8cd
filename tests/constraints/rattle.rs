//! RATTLE and its compositions: order, symplecticity, reversibility, energy over long times.

use pendulum_runtime::error::{Error, Part};
use pendulum_runtime::integrate::FixedStep;
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use pendulum_runtime::system::System;

lagrangian! {
    /// Two bobs on rods, the second one on the first.
    #[derive(Clone, Debug)]
    pub struct Rods { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate x[2]: m;
    coordinate y[2]: m;
    kinetic = m/2*sum(k in 0..2, ẋ[k]^2 + ẏ[k]^2);
    potential = m*g*(y[0] + y[1]);
    constraint upper: |[x[0], y[0]]| = L;
    constraint lower: |[x[1] - x[0], y[1] - y[0]]|^2 = L^2;
}

lagrangian! {
    /// A bob on a rod whose pivot is driven.
    #[derive(Clone, Debug)]
    pub struct Moving { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    driven p: [m; 2];
    kinetic = m/2*(ẋ^2 + ẏ^2);
    potential = m*g*y;
    constraint rod: |[x, y] - p| = L;
}

const RODS: Rods<f64> = Rods { m: 0.8, L: 1.0, g: 9.81 };

/// Returns the state for angles and rates.
fn state<T: Real>(θ: [T; 2], ω: [T; 2]) -> ([T; 4], [T; 4]) {
    let [(s0, c0), (s1, c1)] = θ.map(|θ| (θ.sin(), θ.cos()));
    (
        [s0, s0 + s1, -c0, -(c0 + c1)],
        [ω[0] * c0, ω[0] * c0 + ω[1] * c1, ω[0] * s0, ω[0] * s0 + ω[1] * s1],
    )
}

fn end<M>(method: M, time: f64, steps: u64) -> ([f64; 4], [f64; 4])
where
    M: Method<Rods<f64>, 4>,
{
    let (q, v) = state([1.0, 1.4], [0.5, -0.3]);
    let end = solve(&RODS, (0.0, time), q, v).method(method).steps(steps).run().unwrap().end;
    (end.q, end.v)
}

/// Returns the largest difference of two states.
fn apart(a: &([f64; 4], [f64; 4]), b: &([f64; 4], [f64; 4])) -> f64 {
    let pairs = a.0.iter().zip(&b.0).chain(a.1.iter().zip(&b.1));
    pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
}

#[test]
fn compositions_have_their_orders() {
    fn order<M: Method<Rods<f64>, 4>>(method: M, steps: u64, exact: &([f64; 4], [f64; 4])) -> f64 {
        let [coarse, fine] = [steps, 2 * steps].map(|steps| apart(&end(method, 2.0, steps), exact));
        (coarse / fine).log2()
    }
    let (q, v) = state([1.0, 1.4], [0.5, -0.3]);
    let exact = solve(&RODS, (0.0, 2.0), q, v).rtol(1e-13).run().unwrap().end;
    let exact = (exact.q, exact.v);
    for (expected, found) in [
        (2.0, order(Rattle::<2>::new(), 800, &exact)),
        (4.0, order(Rattle::<4>::new(), 100, &exact)),
        (6.0, order(Rattle::<6>::new(), 60, &exact)),
        (8.0, order(Rattle::<8>::new(), 40, &exact)),
    ] {
        assert!((found - expected).abs() < 0.35, "{found}, not {expected}");
    }
    assert!(apart(&end(Rattle::<8>::new(), 2.0, 400), &exact) < 1e-11);
}

#[test]
fn the_symplectic_form_is_kept() {
    // Σ m(δx ∧ δv) of two variations along the constraints, by differences in 31 digits.
    let two = DoubleDouble::from_f64;
    let rods = Rods::new(two(0.8), two(1.0));
    let rods = Rods { g: two(9.81), ..rods };
    let run = |change: [f64; 4], steps: u64| {
        let [a, b, c, d] = change.map(|part| two(1e-13 * part));
        let (q, v) = state([two(1.0) + a, two(1.4) + b], [two(0.5) + c, two(-0.3) + d]);
        let end = solve(&rods, (0.0, 1.0), q, v).method(Rattle::<2>::new()).steps(steps).run();
        let end = end.unwrap().end;
        (end.q, end.v)
    };
    let form = |steps: u64| {
        let middle = run([0.0; 4], steps);
        let [one, other] = [[0.3, -1.0, 0.2, 0.7], [1.0, 0.4, -0.6, 0.1]].map(|change| {
            let end = run(change, steps);
            let part = |a: &[DoubleDouble; 4], b: &[DoubleDouble; 4]| -> [f64; 4] {
                core::array::from_fn(|i| (a[i] - b[i]).to_f64() * 1e13)
            };
            (part(&end.0, &middle.0), part(&end.1, &middle.1))
        });
        (0..4).map(|i| one.0[i] * other.1[i] - other.0[i] * one.1[i]).sum::<f64>()
    };
    // The steps are so long that the motion has errors of some percent.
    let [few, more] = [form(12), form(24)];
    assert!((few - more).abs() < 1e-10 * few.abs(), "{few} {more}");
}

#[test]
fn steps_are_reversible() {
    let (q, v) = state([1.0, 1.4], [0.5, -0.3]);
    let there = end(Rattle::<6>::new(), 3.0, 100);
    let back = solve(&RODS, (3.0, 0.0), there.0, there.1).method(Rattle::<6>::new()).steps(100);
    let back = back.run().unwrap().end;
    let off = apart(&(back.q, back.v), &(q, v));
    assert!(off < 1e-12, "{off}");
}

#[test]
fn the_energy_does_not_drift() {
    // A chaotic motion, for which the energy of an explicit method would drift.
    let (q, v) = state([2.0, 2.5], [0.0; 2]);
    let solution = solve(&RODS, (0.0, 400.0), q, v)
        .method(Rattle::<4>::new())
        .step(0.02)
        .every(0.5)
        .run()
        .unwrap();
    let energy = solution.energy(&RODS);
    let off =
        |part: &[f64]| part.iter().fold(0.0, |most: f64, own| most.max((own - energy[0]).abs()));
    let (early, late) = (off(&energy[..100]), off(&energy[700..]));
    assert!(early < 0.02 && late < 3.0 * early, "{early} {late}");
    for state in &solution {
        let [misfits, rates] = RODS.misfits(At::of(state.t, &state.q, &state.v));
        assert!(misfits.iter().all(|misfit| misfit.abs() < 4.0 * f64::EPSILON * 4.0));
        assert!(rates.iter().all(|rate| rate.abs() < 1e-13));
    }
}

#[test]
fn a_driven_pivot_is_followed() {
    let moving = Moving::new(0.3, 0.5).driven_by(Sinusoid::new([0.2, 0.1], 3.0, [0.0, 1.0]));
    let pivot = [0.0, 0.1 * 1.0_f64.sin()];
    let speed = [0.6, 0.3 * 1.0_f64.cos()];
    let run = || solve(&moving, (0.0, 3.0), [pivot[0], pivot[1] - 0.5], speed);
    let exact = run().rtol(1e-12).run().unwrap().end;
    let found = run().method(Rattle::<8>::new()).steps(100).run().unwrap().end;
    for i in 0..2 {
        assert!((found.q[i] - exact.q[i]).abs() < 1e-8, "{} {}", found.q[i], exact.q[i]);
        assert!((found.v[i] - exact.v[i]).abs() < 1e-7, "{} {}", found.v[i], exact.v[i]);
    }
}

#[test]
fn steps_that_are_too_long_name_the_constraint() {
    let (q, v) = state([1.0, 1.4], [0.5, -0.3]);
    let failure = solve(&RODS, (0.0, 10.0), q, v).method(Rattle::<2>::new()).step(2.5).run();
    let error = failure.unwrap_err().error;
    assert!(matches!(error, Error::Inconsistent { part: Part::Position, .. }), "{error}");
}

#[test]
#[ignore = "ten million steps"]
fn energy_over_ten_million_steps() {
    fn worst<M: Method<Rods<f64>, 4>>(method: M, start: ([f64; 4], [f64; 4])) -> [f64; 2] {
        let first = RODS.energy(At::of(0.0, &start.0, &start.1));
        let run = Integrator::new(&RODS, method, 0.0, start.0, start.1).unwrap();
        let mut worst = [0.0_f64; 10];
        let mut run = run.max_steps(u64::MAX).control(FixedStep::new(0.02)).unwrap();
        for tenth in &mut worst {
            for _ in 0..1_000_000 {
                run.step().unwrap();
                let energy = RODS.energy(At::of(0.0, run.q(), run.v()));
                *tenth = tenth.max((energy - first).abs());
            }
        }
        println!("{} {worst:?}", M::NAME);
        [worst[0], worst[9]]
    }
    let (q, v) = state([1.0, 1.4], [0.5, -0.3]);
    for ([first, last], bound) in [
        (worst(Rattle::<2>::new(), (q, v)), 0.1),
        (worst(Rattle::<4>::new(), (q, v)), 1e-4),
        (worst(Rattle::<8>::new(), (q, v)), 1e-10),
    ] {
        assert!(first < bound && last < 2.0 * first + 1e-12, "{first} {last}");
    }
}
