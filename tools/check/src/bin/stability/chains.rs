//! Chains: operations, frequencies, stability limits, and a whip.

use crate::numbers::largest;
use crate::reference;
use crate::systems::chains::{Chain1, Chain8, Chain10, Chain16};
use crate::systems::{Double, Five, Triple};
use crate::tally::{self, Counted};
use check::report::{Report, Scale, Test};
use pendulum_runtime::analysis::linearize;
use pendulum_runtime::prelude::*;

pub(crate) const TESTS: &[Test] = &[
    Test { id: "S20", title: "long chains", run: links },
    Test { id: "S21", title: "whip", run: whip },
];

/// The number of multiplications, additions and divisions of accelerations written by hand, with
/// angles from the vertical and an unrolled elimination.
const BY_HAND: [(usize, [f64; 3]); 7] = [
    (1, [2.0, 0.0, 1.0]),
    (2, [17.0, 8.0, 3.0]),
    (3, [47.0, 25.0, 6.0]),
    (5, [160.0, 90.0, 15.0]),
    (8, [492.0, 280.0, 36.0]),
    (10, [845.0, 480.0, 55.0]),
    (16, [2712.0, 1520.0, 136.0]),
];

fn links(scale: Scale, report: &mut Report) {
    macro_rules! count {
        ($($chain:ident $links:literal)+) => {[$({
            let one = |_| Counted(1.0);
            let system = $chain::new([0.0; $links].map(one), [0.0; $links].map(one), Counted(1.0));
            let prepared = system.prepare();
            let (q, v) = (core::array::from_fn(|i| Counted(0.1 * i as f64)), [Counted(0.5); $links]);
            tally::count(|| system.accelerations_prepared(&prepared, At::of(Counted(0.0), &q, &v)))
        }),+]};
    }
    let counts = count! { Chain1 1 Double 2 Triple 3 Five 5 Chain8 8 Chain10 10 Chain16 16 };
    let all = |operations: [f64; 3]| operations.iter().sum::<f64>();
    let ratios = BY_HAND.iter().zip(&counts);
    let ratio = largest(ratios.map(|((_, hand), found)| all(found.operations()) / all(*hand)));
    report.row("operations of 1 to 16 links over those by hand").at_most(ratio, 1.3);
    let slope = |from: usize, to: usize, links: f64| {
        (counts[to].operations()[0] - counts[from].operations()[0]) / links
    };
    report.row("multiplications for each further link, 10 to 16").at_most(slope(5, 6, 6.0), 33.0);
    report.row("sines with cosines of 16 links").at_most(counts[6].sin_cos, 16.0);

    let chain = Chain10::new([1.0; 10], [1.0; 10], 1.0);
    let modes =
        linearize(&chain, 0.0, &[0.0; 10], &[0.0; 10]).normal_modes().unwrap().squared_frequencies;
    let exact = reference::at("P30", 0.0);
    let off = largest(modes.iter().zip(&exact).map(|(found, exact)| (found / exact - 1.0).abs()));
    report.row("P30, squared frequencies of ten links, relative").at_most(off, 1e-12);

    // The limit of Rk4 is h ω < 2√2: just below it the fastest mode decays, just above it the mode
    // grows.
    let fastest = exact[9].sqrt();
    let steps = scale.pick(1000u32, 2000, 2000);
    let sway = |product: f64| {
        let q = core::array::from_fn(|i| 1e-8 * if i % 2 == 0 { 1.0 } else { -1.0 });
        let run = solve(&chain, (0.0, product / fastest * f64::from(steps)), q, [0.0; 10]);
        let solution = run.method(Rk4).steps(u64::from(steps)).run();
        solution.map_or(f64::INFINITY, |solution| largest(solution.end.q.map(f64::abs)))
    };
    report.row("ten links by Rk4 with h ω = 2.8, from 1e-8 rad").at_most(sway(2.8), 1e-7);
    report.row("the same with h ω = 2.86").between(sway(2.86), 1e-3, f64::INFINITY);
    report
        .row("√(4N) against the frequency of the fastest mode of ten links, relative")
        .at_most((40.0f64.sqrt() / fastest - 1.0).abs(), 0.2);
}

fn whip(_: Scale, report: &mut Report) {
    let masses: [f64; 10] = core::array::from_fn(|i| 0.5f64.powi(i as i32));
    let chain = Chain10::new(masses, [1.0; 10], 1.0);
    let (q, v) = ([core::f64::consts::FRAC_PI_2; 10], [0.0; 10]);
    let energy = |q: &[f64; 10], v: &[f64; 10]| chain.energy(At::of(0.0, q, v));
    let start = energy(&q, &v);
    let run = solve(&chain, (0.0, 20.0), q, v).method(Dop853).rtol(1e-10).atol(1e-10);
    let solution = run.every_step().run().unwrap();
    let states = solution.q.iter().zip(&solution.v);
    let gain = largest(states.map(|(q, v)| energy(q, v) - start));
    report
        .row("gain of energy in 20 s, Dop853, rtol 1e-10")
        .at_most(gain, 1e-9)
        .because("the tolerance bounds the error of a step, a thousand steps add up");
    let lengths: Vec<f64> = solution.t.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let (least, greatest) = lengths[3..lengths.len() - 2]
        .iter()
        .fold((f64::INFINITY, 0.0f64), |(a, b), &h| (a.min(h), b.max(h)));
    report.row("longest step over shortest").between(greatest / least, 3.0, f64::INFINITY);
}
