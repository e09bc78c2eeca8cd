//! The accelerations of chains in two forms: with positions defined by `let` (eliminated from the
//! leaves to the root if that is cheaper), and with positions written out in the kinetic energy
//! (elimination of the full mass matrix).
//!
//! `cargo bench -p pendulum-runtime --bench chains`; medians of 41 pairs in the order A B A B.

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::system::{At, System};
use std::hint::black_box;
use std::time::Instant;

macro_rules! chains {
    ($($module:ident $n:literal)+) => {
        $(mod $module {
            use pendulum_runtime::lagrangian;
            lagrangian! {
                pub(crate) struct Written { m: [kg; $n], l: [m; $n], g: m/s^2 = 9.81 }
                coordinate θ[$n]: rad;
                let y[k in 0..$n] = sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
                kinetic = sum(k in 0..$n, m[k]/2*|ẏ[k]|^2);
                potential = sum(k in 0..$n, m[k]*g*height(y[k]));
            }
            lagrangian! {
                pub(crate) struct Spelled { m: [kg; $n], l: [m; $n], g: m/s^2 = 9.81 }
                coordinate θ[$n]: rad;
                kinetic = sum(k in 0..$n, m[k]/2*|sum(j in 0..=k, l[j]*θ̇[j]*[cos(θ[j]), sin(θ[j])])|^2);
                potential = sum(k in 0..$n, m[k]*g*sum(j in 0..=k, -l[j]*cos(θ[j])));
            }
        })+

        fn main() {
            println!("links   with let   spelled out   ratio");
            $({
                let (masses, lengths) = ([0.7; $n], [0.9; $n]);
                let (written, spelled) = ($module::Written::new(masses, lengths), $module::Spelled::new(masses, lengths));
                let first = || time::<_, $n>(&written);
                let second = || time::<_, $n>(&spelled);
                let mut pairs: Vec<[f64; 2]> = (0..41).map(|_| [first(), second()]).collect();
                let mut ratios: Vec<f64> = pairs.iter().map(|[a, b]| a / b).collect();
                ratios.sort_by(f64::total_cmp);
                pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
                println!("{:5} {:8.1} ns {:10.1} ns {:7.2}", $n, pairs[20][0], pairs[20][1], ratios[20]);
            })+
        }
    };
}

chains!(two 2 three 3 four 4 five 5 six 6 seven 7 eight 8 ten 10 sixteen 16);

/// Returns the nanoseconds per evaluation.
fn time<S: System<N, Scalar = f64, Inputs = ()>, const N: usize>(system: &S) -> f64 {
    let count = 2000;
    let prepared = system.prepare();
    let mut q: [f64; N] = core::array::from_fn(|k| 0.3 * k as f64 - 0.5);
    let v: [f64; N] = core::array::from_fn(|k| 0.2 - 0.1 * k as f64);
    let start = Instant::now();
    for _ in 0..count {
        let a = system.accelerations_prepared(&prepared, At::of(0.0, black_box(&q), black_box(&v)));
        q[0] += 1e-9 * a[0];
    }
    1e9 * start.elapsed().as_secs_f64() / f64::from(count)
}
