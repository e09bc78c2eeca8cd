//! The final states of every method and of eleven kinds of systems, and the numbers of every other
//! feature, as hashes, which are the same in every build on every machine.

#![allow(missing_docs)]

mod features;

use crate::constrained::Bob;
use crate::problems::{Cart, Double, Forced, Hung, Kepler, Simple, Spherical};
use pendulum_runtime::integrate::State;
use pendulum_runtime::motion::Curve;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float, Lanes};
use pendulum_runtime::system::System;

lagrangian! {
    /// A star in a galaxy, whose spring is the parameter: its bits are those of this block.
    pub struct HenonHeiles { k }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = k*(x^2 + y^2)/2 + x^2*y - y^3/3;
}

lagrangian! {
    /// Eliminated link by link.
    pub struct Chain { m: [1; 9], l: [1; 9], g }
    coordinate θ[9];
    let y[k in 0..9] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..9, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..9, m[k]*g*height(y[k]));
}

lagrangian! {
    /// All elementary functions.
    pub struct Functions { a }
    coordinate u;
    coordinate v;
    kinetic = (2 + tanh(u))*u̇^2/2 + exp(-a*v^2)*v̇^2 + u̇*v̇/(4 + u^2 + v^2);
    potential = ln(1 + u^2) + sqrt(1 + v^2) + cosh(u/4) + atan(v)*sinh(u/5) + asin(u/(3 + u^2))
        + acos(v/(4 + v^2)) + (1 + u^2)^a + tan(u/(2 + u^2)) + atan2(v, 3 + u^2)/5;
}

/// Returns the hash of Fowler, Noll and Vo (FNV-1a) of all bits of a state.
pub fn hash(numbers: impl IntoIterator<Item = f64>) -> u64 {
    let bytes = numbers.into_iter().flat_map(|number| number.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Returns the time and both words of each coordinate and velocity.
fn numbers_of<T: Float, const N: usize>(state: &State<T, N>) -> Vec<f64> {
    // The second word is the difference from the first word.
    let words = |x: &T| [x.to_f64(), (*x - T::from_f64(x.to_f64())).to_f64()];
    core::iter::once(state.t).chain(state.q.iter().chain(&state.v).flat_map(words)).collect()
}

macro_rules! run {
    ($lines:ident, $system:literal, $dynamics:expr, $q:expr, $v:expr, $($name:literal $method:expr => $($setting:ident $value:expr),+;)+) => {$(
        let end = solve($dynamics, (0.0, 5.0), $q, $v).method($method)$(.$setting($value))+.run().expect($system).end;
        $lines.push(format!("{} {} {:016x}", $system, $name, hash(numbers_of(&end))));
    )+};
}

/// Runs methods of every kind: classical, adaptive, series, implicit.
macro_rules! kinds {
    ($lines:ident, $system:literal, $dynamics:expr, $q:expr, $v:expr) => {
        run! { $lines, $system, $dynamics, $q, $v,
            "Rk4" Rk4 => step 0.03;
            "Dop853" Dop853 => rtol 1e-9;
            "Taylor" Taylor::new() => rtol 1e-15;
            "Picard" Picard => rtol 1e-12;
            "Gauss2" Gauss::<2>::new() => step 0.01;
        }
    };
}

/// Runs all other methods that support every system.
macro_rules! others {
    ($lines:ident, $system:literal, $dynamics:expr, $q:expr, $v:expr) => {
        run! { $lines, $system, $dynamics, $q, $v,
            "SymplecticEuler" SymplecticEuler => step 0.01;
            "Picard-steps" Picard => step 0.1;
            "Rodas4" Rodas4 => rtol 1e-5;
            "Gauss1" Gauss::<1>::new() => step 0.02;
            "Gauss3" Gauss::<3>::new() => step 0.03;
            "Gauss4" Gauss::<4>::new() => step 0.03;
            "Gauss8" Gauss::<8>::new() => step 0.04;
            "Gauss2-Newton" Gauss::<2>::new().newton() => step 0.02;
        }
    };
}

/// Runs the methods for velocity-free systems.
macro_rules! velocity_free {
    ($lines:ident, $system:literal, $dynamics:expr, $q:expr, $v:expr) => {
        run! { $lines, $system, $dynamics, $q, $v,
            "Leapfrog" Leapfrog => step 0.01;
            "Srkn6b" Srkn6b => step 0.03;
            "Srkn14a" Srkn14a => step 0.05;
            "Dprkn12" Dprkn12 => rtol 1e-9;
        }
    };
}

/// Returns a line for each system and method, then for each other feature: names and hash.
///
/// The function is inline, so that it is compiled only in crates that call it.
///
/// # Panics
///
/// Panics if a method fails.
#[inline]
pub fn all() -> Vec<String> {
    let mut lines = Vec::new();
    let times = [0.0, 0.7, 1.9, 2.4, 4.0, 5.5];
    let keys = [[0.0, 0.0], [0.3, 0.1], [-0.2, 0.05], [0.1, -0.1], [0.4, 0.0], [0.0, 0.2]];
    let (spline, line) =
        (Curve::spline(&times, &keys).expect("keys"), Curve::linear(&times, &keys).expect("keys"));
    let links: [f64; 9] = core::array::from_fn(|i| 0.3 + 0.1 * i as f64);

    let simple = Simple::new(1.0);
    kinds!(lines, "simple", &simple, [1.3], [0.0]);
    others!(lines, "simple", &simple, [1.3], [0.0]);
    velocity_free!(lines, "simple", &simple, [1.3], [0.0]);
    let stars = HenonHeiles::new(1.0);
    run! { lines, "henon_heiles", &stars, [0.1, 0.0], [0.0, 0.5],
        "Srkn14a" Srkn14a => step 0.05;
        "Taylor" Taylor::new() => rtol 1e-15;
    }
    let (smooth, kinked) =
        (Hung::new(0.5, 9.81).driven_by(spline), Hung::new(0.5, 9.81).driven_by(line));
    kinds!(lines, "hung_spline", &smooth, [0.3], [0.0]);
    run! { lines, "hung_lines", &kinked, [0.3], [0.0],
        "Leapfrog" Leapfrog => step 0.01;
        "Srkn6b" Srkn6b => step 0.03;
        "Dprkn12" Dprkn12 => rtol 1e-9;
        "Dop853" Dop853 => rtol 1e-9;
        "Picard" Picard => rtol 1e-9;
    }
    kinds!(lines, "forced", &Forced::new(0.25), [0.0], [0.0]);
    let double = Double::new([1.0, 0.7], [0.9, 1.1], 9.81);
    kinds!(lines, "double", &double, [0.5, -0.25], [0.0; 2]);
    others!(lines, "double", &double, [0.5, -0.25], [0.0; 2]);
    kinds!(lines, "cart", &Cart::new(2.0, 1.0, 1.0, 1.0), [0.0, 2.0], [0.0; 2]);
    kinds!(lines, "spherical", &Spherical::new(1.0, 1.0), [1.0, 0.0], [0.0, 1.0]);
    kinds!(lines, "kepler", &Kepler::new(1.0), [0.7, 0.0], [0.0, 1.3]);
    run! { lines, "chain", &Chain::new(links, [0.2; 9], 9.81), links, [0.0; 9],
        "Rk4" Rk4 => step 0.01;
        "Dop853" Dop853 => rtol 1e-9;
        "Picard" Picard => rtol 1e-9;
    }
    let bob = Bob::new(0.7, 1.3);
    let bob_at = ([1.3 * 0.96, -1.3 * 0.28], [0.28, 0.96]);
    kinds!(lines, "bob", &bob, bob_at.0, bob_at.1);
    run! { lines, "bob", &bob, bob_at.0, bob_at.1,
        "Rattle2" Rattle::<2>::new() => step 0.01;
        "Rattle8" Rattle::<8>::new() => step 0.05;
    }
    kinds!(lines, "functions", &Functions::new(0.3), [0.4, -0.7], [0.5, 0.2]);

    let narrow = Double::new([1.0f32, 0.7], [0.9, 1.1], 9.81);
    run! { lines, "double_f32", &narrow, [0.5, -0.25], [0.0; 2],
        "Rk4" Rk4 => step 0.03;
    }
    let wide = Double::new([1.0, 0.7], [0.9, 1.1], 9.81).map(DoubleDouble::from);
    let start = [0.5, -0.25].map(DoubleDouble::from);
    run! { lines, "double_wide", &wide, start, [DoubleDouble::from(0.0); 2],
        "Taylor" Taylor::new() => rtol 1e-28;
    }
    features::all(&mut lines);
    lines
}

/// Compares lines with those lines of `tests/data/determinism.txt` for which `belongs` is `true`,
/// or writes them there, with `UPDATE_GOLDEN=1`.
///
/// # Panics
///
/// Panics if lines differ, or if the file cannot be read or written.
pub fn compare(found: &[String], belongs: impl Fn(&str) -> bool) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/determinism.txt");
    let text = std::fs::read_to_string(path).expect("the file of hashes");
    let (expected, others): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| belongs(line));
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        let mut lines: Vec<&str> = found.iter().map(String::as_str).chain(others).collect();
        // Files are last, whichever lines are new.
        lines.sort_by_key(|line| line.starts_with("import "));
        return std::fs::write(path, lines.join("\n") + "\n").expect("the file of hashes");
    }
    let differ: Vec<String> = found
        .iter()
        .zip(&expected)
        .filter(|(found, expected)| found != expected)
        .map(|(a, b)| format!("{a} for {b}"))
        .collect();
    assert!(
        differ.is_empty() && found.len() == expected.len(),
        "{} lines for {}\n{}",
        found.len(),
        expected.len(),
        differ.join("\n")
    );
}

/// Takes a classical Runge–Kutta step over any scalar.
fn classical_step<T: Real, S: System<N, Scalar = T, Inputs = ()>, const N: usize>(
    system: &S,
    q: &mut [T; N],
    v: &mut [T; N],
    h: T,
) {
    let (half, two, six) = (T::from_f64(0.5), T::from_f64(2.0), T::from_f64(6.0));
    let along =
        |x: &[T; N], k: &[T; N], h: T| -> [T; N] { core::array::from_fn(|i| x[i] + h * k[i]) };
    let t = T::from_f64(0.0);
    let (q1, v1) = (*v, system.accelerations(At::of(t, q, v)));
    let (q2, middle) = (along(v, &v1, half * h), along(q, &q1, half * h));
    let v2 = system.accelerations(At::of(t, &middle, &q2));
    let (q3, middle) = (along(v, &v2, half * h), along(q, &q2, half * h));
    let v3 = system.accelerations(At::of(t, &middle, &q3));
    let (q4, last) = (along(v, &v3, h), along(q, &q3, h));
    let v4 = system.accelerations(At::of(t, &last, &q4));
    for i in 0..N {
        q[i] += h / six * (q1[i] + two * (q2[i] + q3[i]) + q4[i]);
        v[i] += h / six * (v1[i] + two * (v2[i] + v3[i]) + v4[i]);
    }
}

/// Returns for systems without drive the number of lanes, out of eight, whose bits differ from
/// those of the same system without lanes after `steps` steps.
#[inline]
pub fn lanes_that_differ(steps: usize) -> Vec<(&'static str, usize)> {
    let links: [f64; 9] = core::array::from_fn(|i| 0.3 + 0.1 * i as f64);
    let double = Double::new([1.0, 0.7], [0.9, 1.1], 9.81);
    let cart = Cart::new(2.0, 1.0, 1.0, 1.0);
    let chain = Chain::new(links, [0.2; 9], 9.81);
    vec![
        ("simple", differing(&Simple::new(1.0), [1.3], [0.0], steps)),
        ("henon_heiles", differing(&HenonHeiles::new(1.0), [0.1, 0.0], [0.0, 0.5], steps)),
        ("forced", differing(&Forced::new(0.25), [0.0], [0.0], steps)),
        ("double", differing(&double, [0.5, -0.25], [0.0; 2], steps)),
        ("cart", differing(&cart, [0.0, 2.0], [0.0; 2], steps)),
        ("spherical", differing(&Spherical::new(1.0, 1.0), [1.0, 0.0], [0.0, 1.0], steps)),
        ("kepler", differing(&Kepler::new(1.0), [0.7, 0.0], [0.0, 1.3], steps)),
        ("chain", differing(&chain, links, [0.0; 9], steps)),
        ("functions", differing(&Functions::new(0.3), [0.4, -0.7], [0.5, 0.2], steps)),
    ]
}

/// The number of lanes.
pub const LANES: usize = 8;

fn differing<S, const N: usize>(system: &S, q: [f64; N], v: [f64; N], steps: usize) -> usize
where
    S: System<N, Scalar = f64, Inputs = (), With<Lanes<f64, LANES>>: System<N, Inputs = ()>>,
{
    let starts = core::array::from_fn(|lane| q.map(|q| q * (1.0 - 0.03 * lane as f64)));
    same_in_lanes(system, starts, v, steps).into_iter().filter(|same| !same).count()
}

/// Returns for each lane whether its bits are those of the same system without lanes, after steps of
/// the classical method.
pub fn same_in_lanes<T: Float, S, const N: usize>(
    system: &S,
    starts: [[T; N]; LANES],
    v: [T; N],
    steps: usize,
) -> [bool; LANES]
where
    S: System<N, Scalar = T, Inputs = (), With<Lanes<T, LANES>>: System<N, Inputs = ()>>,
{
    let (wide, h) = (system.map(Lanes::splat), T::from_f64(0.01));
    let mut qs: [Lanes<T, LANES>; N] =
        core::array::from_fn(|i| Lanes(starts.map(|start| start[i])));
    let mut vs = v.map(Lanes::splat);
    (0..steps).for_each(|_| classical_step(&wide, &mut qs, &mut vs, Lanes::splat(h)));
    core::array::from_fn(|lane| {
        let (mut one, mut speed) = (starts[lane], v);
        (0..steps).for_each(|_| classical_step(system, &mut one, &mut speed, h));
        let bits = |x: &[T; N]| x.map(|x| x.to_f64().to_bits());
        bits(&one) == bits(&qs.map(|q| q.0[lane])) && bits(&speed) == bits(&vs.map(|v| v.0[lane]))
    })
}
