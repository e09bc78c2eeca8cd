//! Generated and hand-written right-hand sides with the same method and the same problem: pairs in
//! the order A B A B, and the median of their ratios.
//!
//! `cargo bench -p pendulum-runtime --bench rhs`

#![allow(mixed_script_confusables, missing_docs)]

use pendulum_runtime::motion::{Sample, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::Facts;
use pendulum_runtime::system::System;
use std::hint::black_box;
use std::time::Instant;
use systems::pendulums;

/// Defines a hand-written system with accelerations in their mathematical form.
macro_rules! hand {
    ($name:ident { $($field:ident: $type:ty),+ }, $inputs:ty, |$system:ident, $q:ident, $u:ident| $acceleration:expr) => {
        #[derive(Clone, Copy)]
        struct $name<T> { $($field: $type),+ }

        impl<T: Real> System<1> for $name<T> {
            type Scalar = T;
            type Inputs = $inputs;
            type With<U: Real> = $name<U>;
            type Prepared = ();

            const FACTS: Facts = Facts::new(stringify!($name), &["θ"]);

            fn map<U: Real>(&self, _: impl FnMut(T) -> U) -> $name<U> {
                unimplemented!()
            }

            fn prepare(&self) {}

            #[inline]
            fn accelerations(&self, At { q, inputs: $u, .. }: At<'_, T, Self::Inputs, 1>) -> [T; 1] {
                let ($system, $q) = (self, q[0]);
                [$acceleration]
            }

            fn energy(&self, _: At<'_, T, Self::Inputs, 1>) -> T {
                unimplemented!()
            }

            fn power(&self, _: At<'_, T, Self::Inputs, 1>) -> T {
                unimplemented!()
            }

            fn momenta(&self, _: At<'_, T, Self::Inputs, 1>) -> [T; 1] {
                unimplemented!()
            }

            fn velocities(&self, _: T, _: &[T; 1], _: &[T; 1], _: &Self::Inputs) -> [T; 1] {
                unimplemented!()
            }

            fn mass_matrix(&self, _: At<'_, T, Self::Inputs, 1>) -> pendulum_runtime::nalgebra::SMatrix<T, 1, 1> {
                unimplemented!()
            }

            fn forces(&self, _: At<'_, T, Self::Inputs, 1>) -> [T; 1] {
                unimplemented!()
            }

            fn momentum_rates(&self, _: At<'_, T, Self::Inputs, 1>) -> [T; 1] {
                unimplemented!()
            }
        }
    };
}

hand!(Simple { l: T, g: T }, (), |s, q, _u| -s.g * q.sin() / s.l);

hand!(Moving { l: T, g: T }, (Sample<T, 2>,), |s, q, u| {
    let (sin, cos) = q.sin_cos();
    let [x, y] = u.0.acceleration;
    -(x * cos + (y + s.g) * sin) / s.l
});

hand!(Compound { m: T, c: [T; 2], i: T, g: T }, (), |s, q, _u| {
    let (sin, cos) = q.sin_cos();
    -s.m * s.g * (s.c[0] * cos - s.c[1] * sin) / s.i
});

hand!(MovingCompound { m: T, c: [T; 2], i: T, g: T }, (Sample<T, 2>,), |s, q, u| {
    let (sin, cos) = q.sin_cos();
    let [x, y] = u.0.acceleration;
    let (across, along) = (s.c[0] * cos - s.c[1] * sin, s.c[0] * sin + s.c[1] * cos);
    -s.m * ((y + s.g) * across - x * along) / s.i
});

/// Returns the seconds of a run with fixed steps, and the final coordinate.
fn run<D: Dynamics<1, Scalar = f64>>(dynamics: &D) -> (f64, f64) {
    let start = Instant::now();
    let end = solve(black_box(dynamics), (0.0, 20.0), [1.0], [0.2])
        .method(Rk4)
        .steps(20_000)
        .run()
        .map_or(f64::NAN, |solution| solution.end.q[0]);
    (start.elapsed().as_secs_f64(), end)
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn compare<A: Dynamics<1, Scalar = f64>, B: Dynamics<1, Scalar = f64>>(
    name: &str,
    generated: &A,
    hand: &B,
) {
    let (mut times, mut others, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
    let mut difference = 0.0f64;
    for pair in 0..43 {
        let (a, b) = (run(generated), run(hand));
        difference = difference.max((a.1 - b.1).abs());
        // The first three pairs are a warm-up.
        if 2 < pair {
            times.push(a.0);
            others.push(b.0);
            ratios.push(a.0 / b.0);
        }
    }
    let step = 1e9 / 20_000.0;
    println!(
        "{name:<16} generated {:6.1} ns/step   by hand {:6.1} ns/step   ratio {:.3}   end states differ by {difference:.1e}",
        median(&mut times) * step,
        median(&mut others) * step,
        median(&mut ratios),
    );
}

fn main() {
    let shake = || Sinusoid::new([0.2, 0.1], 5.0, [0.3, 1.0]);
    let (m, l, g, c, i) = (0.8, 1.2, 9.81, [0.3, -1.1], 1.5);
    println!("RK4, 20 000 steps over 20 s; medians of 40 pairs");
    compare("simple", &pendulums::Simple::new(m, l), &Simple { l, g });
    compare(
        "moving",
        &pendulums::Hanging::new(m, l).driven_by(shake()),
        &Driven::new::<1>(Moving { l, g }, (shake(),)),
    );
    compare("compound", &pendulums::Compound::new(m, c, i), &Compound { m, c, i, g });
    let exact = pendulums::MovingCompound::new(m, c, i);
    compare(
        "moving compound",
        &exact.driven_by(shake()),
        &Driven::new::<1>(MovingCompound { m, c, i, g }, (shake(),)),
    );
}
