//! Times at equal error of this crate and of the peers, for each decade.

use crate::table::{Entry, Party, median};

/// Prints for each system and decade the best time of this crate, the times of the peers and the
/// ratios.
///
/// A ratio is the median over the rounds of the ratio in each round, or the ratio of the medians if
/// an entry comes from a file.
pub fn print(systems: &[&str], entries: &[Entry]) {
    println!(
        "\ntimes in ms at equal error, interpolated in both logarithms; in brackets ours over theirs\n"
    );
    println!("{:<16} {:>6}  {:<28}{PEERS}", "system", "error", "best of ours");
    for system in systems {
        let of_system: Vec<&Entry> = entries
            .iter()
            .filter(|entry| entry.system == *system && entry.error().is_some())
            .collect();
        let select = |choose: &dyn Fn(&Entry) -> bool| -> Vec<&Entry> {
            of_system.iter().copied().filter(|entry| choose(entry)).collect()
        };
        let ours = select(&|entry| entry.party() == Party::Ours);
        let peers = [
            select(&|entry| entry.method == "heyoka Cartesian"),
            select(&|entry| entry.method == "heyoka simplified"),
            select(&|entry| entry.party() == Party::OdeSolvers),
            select(&|entry| entry.party() == Party::DifferentialEquations),
        ];
        for decade in 3..=13 {
            let error = 10f64.powi(-decade);
            let best = best(&ours, error, None);
            if best.is_none() && peers.iter().all(|peer| self::best(peer, error, None).is_none()) {
                continue;
            }
            let name = best.map_or(String::new(), |(seconds, method)| {
                format!("{:9.3} {method}", 1e3 * seconds)
            });
            let columns: String = peers.iter().map(|peer| column(&ours, peer, error)).collect();
            println!("{system:<16} {:>6}  {name:<28}{columns}", format!("1e-{decade}"));
        }
    }
}

const PEERS: &str =
    "   heyoka Cartesian   heyoka simplified  ode_solvers Dop853   differential-eq.";

fn column(ours: &[&Entry], peer: &[&Entry], error: f64) -> String {
    let Some((theirs, _)) = best(peer, error, None) else { return format!("{:>19}", "—") };
    format!(
        "{:>10.3} {:>8}",
        1e3 * theirs,
        ratio(ours, peer, error).map_or(String::new(), |ratio| format!("({ratio:.2})"))
    )
}

fn ratio(ours: &[&Entry], peer: &[&Entry], error: f64) -> Option<f64> {
    let rounds =
        |entries: &[&Entry]| entries.iter().map(|entry| entry.samples.len()).min().unwrap_or(0);
    let rounds = rounds(ours).min(rounds(peer));
    if rounds < 2 {
        return Some(best(ours, error, None)?.0 / best(peer, error, None)?.0);
    }
    let in_round =
        |round| Some(best(ours, error, Some(round))?.0 / best(peer, error, Some(round))?.0);
    let mut ratios = (0..rounds).map(in_round).collect::<Option<Vec<f64>>>()?;
    Some(median(&mut ratios))
}

/// Returns the shortest time in which one of the methods reaches `error`, in one round or as the
/// median over all rounds, and the name of this method.
pub fn best<'a>(entries: &[&'a Entry], error: f64, round: Option<usize>) -> Option<(f64, &'a str)> {
    let mut methods: Vec<&str> = entries.iter().map(|entry| entry.method.as_str()).collect();
    methods.sort_unstable();
    methods.dedup();
    let times = methods.into_iter().filter_map(|method| {
        let points = entries.iter().filter(|entry| entry.method == method).filter_map(|entry| {
            let seconds = round.map_or_else(|| entry.seconds(), |round| entry.samples[round]);
            Some((entry.error()?, seconds))
        });
        time_at(points.collect(), error).map(|seconds| (seconds, method))
    });
    times.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Returns the time for `error` on the Pareto front of `points` (error, seconds), interpolated in
/// both logarithms. If the cheapest point is already more accurate, the result is its time; if no
/// point is accurate enough, `None`.
fn time_at(mut points: Vec<(f64, f64)>, error: f64) -> Option<f64> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut front: Vec<(f64, f64)> = Vec::new();
    for point in points {
        if front.last().is_none_or(|last| point.1 < last.1) {
            front.push(point);
        }
    }
    let next = front.iter().position(|point| error < point.0).unwrap_or(front.len());
    let (better, worse) = (front.get(next.checked_sub(1)?)?, front.get(next));
    Some(worse.map_or(better.1, |worse| {
        let least = better.0.max(1e-18);
        let weight = (error / least).ln() / (worse.0 / least).ln();
        (better.1.ln() * (1.0 - weight) + worse.1.ln() * weight).exp()
    }))
}
