//! Pucks and balls on plates and springs, compared with a law with sets by events, in Python.

use core::str::FromStr;
use pendulum_runtime::integrate::{Failure, Solution};
use pendulum_runtime::prelude::*;

lagrangian! {
    /// A puck on a spring over a plate whose speed swings.
    #[derive(Clone, Debug)]
    pub struct Plate { k, c, Ω, A, ω, F, S }
    coordinate p: [1; 2];
    kinetic = |dot(p)|^2/2;
    potential = k/2*|p - [c, 0]|^2;
    friction plate: dot(p) - perp(p)*(Ω + A*sin(ω*t)), force = F, static = S;
}

lagrangian! {
    /// Three pucks between springs and a handle that goes round.
    #[derive(Clone, Debug)]
    pub struct Row { k, K, A, ω, F, G, H, σ }
    coordinate x: [1; 2];
    coordinate y: [1; 2];
    coordinate z: [1; 2];
    let handle = A*[cos(ω*t), sin(ω*t)];
    kinetic = (|dot(x)|^2 + |dot(y)|^2 + |dot(z)|^2)/2;
    potential = k/2*(|x - y|^2 + |y - z|^2) + K/2*|x - handle|^2;
    friction first: dot(x), force = F, static = σ*F;
    friction second: dot(y), force = G, static = σ*G;
    friction third: dot(z), force = H, static = σ*H;
}

lagrangian! {
    /// A ball on a spring over a plate that turns, pushed by a force that swings.
    #[derive(Clone, Debug)]
    pub struct Roller { k, Ω, P, ω, F, S }
    coordinate p: [1; 2];
    coordinate α;
    coordinate β;
    kinetic = |dot(p)|^2/2 + (α̇^2 + β̇^2)/5;
    potential = k/2*|p|^2 - P*p.x*sin(ω*t);
    friction plate: dot(p) + [-β̇, α̇] - perp(p)*Ω, force = F, static = S;
}

lagrangian! {
    /// Two pucks on a plate that turns, with a spring between them.
    #[derive(Clone, Debug)]
    pub struct Couple { k, c, Ω, F, G, S, T, d }
    coordinate x: [1; 2];
    coordinate y: [1; 2];
    kinetic = (|dot(x)|^2 + |dot(y)|^2)/2;
    potential = k/2*(|x - y|^2 + |x - [c, 0]|^2);
    dissipation = d/2*(|dot(x)|^2 + |dot(y)|^2);
    friction first: dot(x) - perp(x)*Ω, force = F, static = S;
    friction second: dot(y) - perp(y)*Ω, force = G, static = T;
}

/// Returns the places and velocities at the end.
fn ended<const N: usize>(
    run: Result<Solution<f64, N>, Failure<f64, N>>,
    places: usize,
) -> Vec<f64> {
    let end = run.unwrap().end;
    end.q[..places].iter().chain(&end.v[..places]).copied().collect()
}

#[test]
fn what_sticks_and_slides_in_the_plane_follows_a_law_with_sets() {
    let mut ratios = Vec::new();
    for line in include_str!("../data/discs.txt").lines().filter(|line| !line.starts_with('#')) {
        let mut words = line.split_whitespace();
        let family = words.next().unwrap();
        let x: Vec<f64> = words.map(|word| f64::from_str(word).unwrap()).collect();
        for tolerance in [1e-4, 1e-7] {
            macro_rules! run {
                ($system:ident($($k:literal)*), $end:literal, $q:expr, $v:expr) => {{
                    let system = $system::new($(x[$k]),*);
                    let run = solve(&system, (0.0, $end), $q, $v).rtol(tolerance).atol(tolerance);
                    run.max_steps(10_000).run()
                }};
            }
            let found = match family {
                "table" => ended(run!(Plate(0 1 2 3 4 5 6), 8.0, [x[7], x[8]], [0.0; 2]), 2),
                "chain" => ended(run!(Row(0 1 2 3 4 5 6 7), 12.0, [0.0; 6], [0.0; 6]), 6),
                "ball" => {
                    let (q, v) = ([x[6], x[7], 0.0, 0.0], [x[8], x[9], 0.0, 0.0]);
                    ended(run!(Roller(0 1 2 3 4 5), 8.0, q, v), 2)
                }
                _ => {
                    let (q, v) = ([x[8], x[9], x[10], x[11]], [x[12], x[13], 0.0, 0.0]);
                    ended(run!(Couple(0 1 2 3 4 5 6 7), 10.0, q, v), 4)
                }
            };
            let expected = &x[x.len() - found.len()..];
            let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
            let off = apart.fold(0.0, f64::max);
            assert!(off < 100.0 * tolerance, "{line}: {tolerance:e}, off by {off:e}");
            ratios.push(off / tolerance);
        }
    }
    ratios.sort_by(f64::total_cmp);
    assert!(ratios.len() == 32 && ratios[16] < 1.0, "{ratios:?}");
}
