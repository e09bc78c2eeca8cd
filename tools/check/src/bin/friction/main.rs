//! Dry friction against smooth forces, and impacts with friction:
//! `cargo run --profile zoo -p check --bin friction -- [COUNT] [NAME]`.
//!
//! Each of `COUNT` random members of every family (60 unless given) is solved at a random tolerance.
//! Its reference has forces F tanh(r/ε) in place of F sign(r), by `Rodas4`, extrapolated to ε = 0.
//! Ten thousand random impacts of a rod and of an arm on a rough floor show what they add to the
//! energy. The program fails if a bar is missed.

#![allow(mixed_script_confusables)]

mod blocks;

use blocks::{
    Arm, Belt, Joints, Patchy, Pin, Pressed, Rod, Slider, SoftBelt, SoftJoints, SoftPatchy,
    SoftPin, SoftPressed, SoftSlider, SoftStack, SoftStribeck, SoftTrain, Stack, Stribeck, Train,
};
use check::crowd;
use core::f64::consts::PI;
use pendulum_runtime::integrate::{Failure, Solution};
use pendulum_runtime::prelude::*;
use std::process::ExitCode;
use systems::random::Random;

/// The greatest number of steps of a run.
const MOST: u64 = 100_000;
/// The widest of the three references; each further one has half the width of the one before.
const WIDTH: f64 = 1e-5;

/// The coordinates at the end and the number of steps.
type End = Result<(Vec<f64>, u64), String>;

/// A member of a family: a run at a tolerance, and a reference with a width.
struct Member {
    dry: Box<dyn Fn(f64) -> End>,
    soft: Box<dyn Fn(f64) -> End>,
}

fn end<const N: usize>(run: Result<Solution<f64, N>, Failure<f64, N>>) -> End {
    let solution = run.map_err(|failure| failure.error.to_string())?;
    Ok((solution.end.q.to_vec(), solution.stats.accepted))
}

/// Creates a member from both systems, their starts and the interval.
macro_rules! member {
    ($end:expr, $dry:expr, $soft:expr, $q:expr, $v:expr) => {{
        let (q, v) = ($q, $v);
        member!($end, $dry, $soft, q, v, q, v)
    }};
    ($end:expr, $dry:expr, $soft:expr, $q:expr, $v:expr, $p:expr, $w:expr) => {{
        let (dry, soft, q, v, p, w) = ($dry, $soft, $q, $v, $p, $w);
        Member {
            dry: Box::new(move |tolerance| {
                let run = solve(&dry, (0.0, $end), q, v).rtol(tolerance).atol(tolerance);
                end(run.max_steps(MOST).run())
            }),
            soft: Box::new(move |width| {
                let system = soft(width);
                let run = solve(&system, (0.0, $end), p, w).method(Rodas4);
                end(run.rtol(1e-10).atol(1e-10).max_steps(10 * MOST).run())
            }),
        }
    }};
}

/// A family: its name, and a random member.
type Family = (&'static str, fn(&mut Random) -> Member);

const FAMILIES: [Family; 9] = [
    ("slider", |from| {
        let [p, ω, f, v] = draw(from, [(1.0, 5.0), (1.0, 6.0), (0.2, 3.0), (-3.0, 3.0)]);
        let soft = move |ε| SoftSlider::new(p, ω, f, ε);
        member!(10.0, Slider::new(p, ω, f), soft, [0.0], [v])
    }),
    ("patchy", |from| {
        let [k, p, ω, f] = draw(from, [(0.5, 4.0), (0.0, 2.0), (0.5, 3.0), (0.1, 1.0)]);
        let [r, x, v] = draw(from, [(0.0, 0.8), (-2.0, 2.0), (-2.0, 2.0)]);
        let soft = move |ε| SoftPatchy::new(k, p, ω, f, r, ε);
        member!(12.0, Patchy::new(k, p, ω, f, r), soft, [x], [v])
    }),
    ("belt", |from| {
        let [k, u, w, f] = draw(from, [(0.3, 4.0), (0.2, 2.0), (0.2, 2.0), (0.1, 2.0)]);
        let [x, v] = draw(from, [(-1.0, 1.0), (-1.0, 1.0)]);
        let soft = move |ε| SoftBelt::new(k, u, w, f, ε);
        member!(12.0, Belt::new(k, u, w, f), soft, [x], [v])
    }),
    ("pin", |from| {
        let [g, p, ω, f] = draw(from, [(1.0, 9.8), (0.0, 3.0), (0.5, 4.0), (0.1, 2.0)]);
        let [x, v] = draw(from, [(-2.0, 2.0), (-2.0, 2.0)]);
        let soft = move |ε| SoftPin::new(g, p, ω, f, ε);
        member!(8.0, Pin::new(g, p, ω, f), soft, [x], [v])
    }),
    ("train", |from| {
        let [k, p, ω] = draw(from, [(0.5, 4.0), (0.5, 4.0), (0.5, 3.0)]);
        let [f, b, c] = draw(from, [(0.1, 1.0); 3]);
        let (q, v) = (draw(from, [(-1.0, 1.0); 3]), draw(from, [(-1.0, 1.0); 3]));
        let soft = move |ε| SoftTrain::new(k, p, ω, f, b, c, ε);
        member!(10.0, Train::new(k, p, ω, f, b, c), soft, q, v)
    }),
    ("stack", |from| {
        let [m, p, ω, f, b] =
            draw(from, [(0.3, 2.0), (1.0, 8.0), (0.5, 4.0), (0.1, 1.5), (0.1, 1.5)]);
        let v = draw(from, [(-2.0, 2.0); 2]);
        let soft = move |ε| SoftStack::new(m, p, ω, f, b, ε);
        member!(10.0, Stack::new(m, p, ω, f, b), soft, [0.0; 2], v)
    }),
    ("stribeck", |from| {
        let [k, p, ω, f] = draw(from, [(0.5, 4.0), (0.5, 3.0), (0.5, 3.0), (0.1, 1.0)]);
        let [s, w, x] = draw(from, [(0.0, 1.0), (0.1, 1.0), (-2.0, 2.0)]);
        let soft = move |ε| SoftStribeck::new(k, p, ω, f, s, w, ε);
        member!(10.0, Stribeck::new(k, p, ω, f, s, w), soft, [x], [0.0])
    }),
    ("pressed", |from| {
        let [g, p, ω, w, μ] =
            draw(from, [(3.0, 9.8), (1.0, 5.0), (0.5, 4.0), (0.5, 4.0), (0.1, 0.6)]);
        let (d, v) = (g * from.uniform(0.1, 0.9), from.uniform(-2.0, 2.0));
        let soft = move |ε| SoftPressed::new(g, p, ω, d, w, μ, ε);
        let dry = Pressed::new(g, p, ω, d, w, μ);
        member!(10.0, dry, soft, [0.0; 2], [v, 0.0], [0.0], [v])
    }),
    ("joints", |from| {
        let [g, p, ω, f, b] =
            draw(from, [(1.0, 9.8), (1.0, 8.0), (0.5, 4.0), (0.1, 2.0), (0.1, 2.0)]);
        let q = draw(from, [(-1.0, 1.0); 2]);
        let soft = move |ε| SoftJoints::new(g, p, ω, f, b, ε);
        member!(5.0, Joints::new(g, p, ω, f, b), soft, q, [0.0; 2])
    }),
];

fn draw<const K: usize>(random: &mut Random, ranges: [(f64, f64); K]) -> [f64; K] {
    ranges.map(|(low, high)| random.uniform(low, high))
}

/// What a member has shown.
struct Score {
    family: usize,
    /// The error over the tolerance, or the text of an error.
    found: Result<f64, String>,
    /// The doubt of the reference over the tolerance.
    doubt: f64,
    steps: u64,
}

/// Returns the largest distance between two lists, as far as both go.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()))
}

fn score(family: usize, run: usize) -> Score {
    let mut random = Random::new((1000 * family + run) as u64);
    random.bits();
    let member = FAMILIES[family].1(&mut random);
    let tolerance = random.uniform(f64::ln(1e-6), f64::ln(1e-3)).exp();
    let references = [1.0, 0.5, 0.25].map(|part| (member.soft)(part * WIDTH));
    let failed = |text: &String| Score {
        family,
        found: Err(format!("reference: {text}")),
        doubt: f64::INFINITY,
        steps: 0,
    };
    let [Ok((wide, _)), Ok((half, _)), Ok((quarter, _))] = &references else {
        let text = references.iter().find_map(|run| run.as_ref().err());
        return text.map_or_else(|| failed(&String::new()), failed);
    };
    let extrapolated = |wide: &[f64], narrow: &[f64]| -> Vec<f64> {
        wide.iter().zip(narrow).map(|(wide, narrow)| 2.0 * narrow - wide).collect()
    };
    let (coarse, fine) = (extrapolated(wide, half), extrapolated(half, quarter));
    let doubt = apart(&coarse, &fine) / tolerance;
    match (member.dry)(tolerance) {
        Ok((end, steps)) => {
            Score { family, found: Ok(apart(&end, &fine) / tolerance), doubt, steps }
        }
        Err(text) => Score { family, found: Err(text), doubt, steps: 0 },
    }
}

/// Compares `count` members of each family whose name contains `part`. Returns `true` if the bars
/// are met.
fn families(count: usize, part: &str) -> bool {
    let chosen: Vec<usize> =
        (0..FAMILIES.len()).filter(|family| FAMILIES[*family].0.contains(part)).collect();
    let name = |index: usize| FAMILIES[chosen[index / count]].0;
    let scores = crowd::run(chosen.len() * count, 2, name, |index| {
        score(chosen[index / count], index % count)
    });
    println!("family      median   99 %      most     doubt    steps  failed");
    let mut met = true;
    for family in chosen {
        let own = || scores.iter().filter(|score| score.family == family);
        let mut errors: Vec<f64> =
            own().filter_map(|score| score.found.as_ref().ok().copied()).collect();
        errors.sort_by(f64::total_cmp);
        let at = |share: f64| {
            let index = (share * errors.len() as f64) as usize;
            errors.get(index.min(errors.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
        };
        let doubt = own().map(|score| score.doubt).fold(0.0, f64::max);
        let steps = own().map(|score| score.steps).max().unwrap_or(0);
        let failed: Vec<&String> = own().filter_map(|score| score.found.as_ref().err()).collect();
        println!(
            "{:10} {:8.1e} {:8.1e} {:8.1e} {doubt:8.1e} {steps:7} {:6}",
            FAMILIES[family].0,
            at(0.5),
            at(0.99),
            at(1.0),
            failed.len()
        );
        for text in failed.iter().take(3) {
            println!("    {text}");
        }
        met &= at(0.5) <= 1.0 && at(0.99) <= 100.0 && at(1.0) <= 1000.0 && failed.is_empty();
    }
    met
}

/// Adds the energies of the impacts of a run to `most` and `count`.
fn gains<const N: usize>(
    run: Result<Solution<f64, N>, Failure<f64, N>>,
    energy: impl Fn(&[f64; N], &[f64; N]) -> f64,
    (most, count): (&mut f64, &mut usize),
) {
    let impacts = match run {
        Ok(solution) => solution.impacts,
        Err(failure) => failure.partial.impacts,
    };
    for impact in impacts.iter().take(1) {
        let before = energy(&impact.state.q, &impact.state.v);
        let after = energy(&impact.after.q, &impact.after.v);
        *most = f64::max(*most, after / before - 1.0);
        *count += 1;
    }
}

/// Returns the largest relative gain of energy in `wanted` impacts of rods and arms.
fn impacts(wanted: usize) -> f64 {
    let mut random = Random::new(1984);
    let (mut most, mut count) = (f64::NEG_INFINITY, 0);
    while count < wanted {
        let [a, μ, e, θ] = draw(&mut random, [(0.5, 2.0), (0.0, 1.5), (0.0, 1.0), (0.1, PI - 0.1)]);
        let v = draw(&mut random, [(-4.0, 4.0); 3]);
        let start = [0.0, a * θ.sin() + 1e-6, θ];
        let run = solve(&Rod::new(a, μ, e), (0.0, 1e-4), start, v).rtol(1e-8).run();
        let energy =
            |_: &[f64; 3], v: &[f64; 3]| v[0] * v[0] + v[1] * v[1] + a * a * v[2] * v[2] / 3.0;
        gains(run, energy, (&mut most, &mut count));
        let [l, m, θ, φ] = draw(&mut random, [(0.3, 1.5), (0.2, 3.0), (-1.2, 1.2), (-1.2, 1.2)]);
        let v = draw(&mut random, [(-4.0, 4.0); 2]);
        let h = 2.0 * (θ.cos() + l * φ.cos()) + 1e-6;
        let run = solve(&Arm::new(h, l, m, μ, e), (0.0, 1e-4), [θ, φ], v).rtol(1e-8).run();
        let energy = |q: &[f64; 2], v: &[f64; 2]| {
            let first = (1.0 + 1.0 / 3.0 + 4.0 * m) * v[0] * v[0];
            let second = 4.0 / 3.0 * m * l * l * v[1] * v[1];
            first + second + 4.0 * m * l * (q[0] - q[1]).cos() * v[0] * v[1]
        };
        gains(run, energy, (&mut most, &mut count));
    }
    most
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let count = arguments.next().and_then(|count| count.parse().ok()).unwrap_or(60);
    let met = families(count, &arguments.next().unwrap_or_default());
    let gain = impacts(10_000);
    println!("10000 impacts: the energy grows by at most {gain:.1e} of itself");
    // Rates below the tolerance are ended, by a projection that does not ask for the energy.
    if met && gain <= 1e-10 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
