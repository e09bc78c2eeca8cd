//! Sensitivities, compared with reference digits, closed forms and differences of neighbouring
//! motions.

use pendulum_runtime::analysis::{Variational, variational_size};
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::motion::{Curve, Motions};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float};
use pendulum_runtime::system::Jacobians;
use pendulum_runtime::system::System;

pub(crate) mod blocks {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        /// v̇ = cos t − p v − sin x.
        #[derive(Clone)]
        pub struct Forced { p }
        coordinate x;
        kinetic = ẋ^2/2;
        potential = -cos(x);
        dissipation = p*ẋ^2/2;
        force x = cos(t);
    }

    lagrangian! {
        /// ÿ + (a − 2 q cos 2t) y = 0.
        #[derive(Clone)]
        pub struct Mathieu { a, q }
        coordinate y;
        kinetic = ẏ^2/2;
        potential = (a - 2*q*cos(2*t))*y^2/2;
    }

    lagrangian! {
        #[derive(Clone)]
        pub struct Simple { g, l }
        coordinate θ;
        kinetic = l^2*θ̇^2/2;
        potential = -g*l*cos(θ);
    }

    lagrangian! {
        #[derive(Clone)]
        pub struct Double { g, m }
        coordinate θ[2];
        let y[k in 0..2] = sum(j in 0..=k, [sin(θ[j]), -cos(θ[j])]);
        kinetic = |ẏ[0]|^2/2 + m*|ẏ[1]|^2/2;
        potential = g*height(y[0]) + m*g*height(y[1]);
    }

    lagrangian! {
        /// Two links on a moving pivot, damped.
        #[derive(Clone)]
        pub struct Hung { g, m, l, c }
        coordinate θ[2];
        driven x: [1; 2];
        let y[k in 0..2] = x + sum(j in 0..=k, l*[sin(θ[j]), -cos(θ[j])]);
        kinetic = |ẏ[0]|^2/2 + m*|ẏ[1]|^2/2;
        potential = g*height(y[0]) + m*g*height(y[1]);
        dissipation = c*θ̇[0]^2/2;
    }
}

use blocks::*;

fn close(found: f64, expected: f64, within: f64) {
    assert!(
        (found - expected).abs() <= within,
        "{found} instead of {expected}, off by {:e}",
        found - expected
    );
}

#[test]
fn the_forced_pendulum_has_the_published_sensitivities() {
    // The digits of `tests/data/variational.py`; rounded, they agree with heyoka.py's tutorial on
    // variational equations.
    const M: usize = variational_size(1, 1);
    let system = Variational::<_, 1, M>::new(Forced::new(0.4));
    let (q, v) = system.start([0.2], [0.3]);
    let end =
        solve(&system, (0.0, 3.0), q, v).method(Dop853).rtol(1e-14).atol(1e-14).run().unwrap().end;
    let own = system.state(&end);
    let expected = [
        (own.q, own.v, [0.11757214931110473655, -1.2494065591871065318]),
        (
            system.by_position(&end, 0).0,
            system.by_position(&end, 0).1,
            [-0.42547799684275369339, -0.19171818343890700153],
        ),
        (
            system.by_velocity(&end, 0).0,
            system.by_velocity(&end, 0).1,
            [0.41983648992585684417, -0.51871994406285746946],
        ),
        (
            system.by_parameter(&end, 0).0,
            system.by_parameter(&end, 0).1,
            [-0.25807427091440042944, 0.86792700365180577626],
        ),
    ];
    for (q, v, expected) in expected {
        close(q[0], expected[0], 2e-14);
        close(v[0], expected[1], 2e-14);
    }
    // Damping contracts every area by e^(−pt) (Liouville).
    close(system.transition(&end).determinant(), (-1.2_f64).exp(), 1e-14);
}

#[test]
fn second_derivatives_are_differences_of_first_ones_in_two_words() {
    const M: usize = variational_size(1, 0);
    let system = Variational::<_, 1, M>::new(Forced::new(DoubleDouble::ratio(4.0, 10.0)));
    let h = DoubleDouble::from(1e-9);
    let columns = |x: DoubleDouble, y: DoubleDouble| {
        let (q, v) = system
            .start([DoubleDouble::ratio(2.0, 10.0) + x], [DoubleDouble::ratio(3.0, 10.0) + y]);
        let end = solve(&system, (0.0, 3.0), q, v).method(Dop853).steps(300).run().unwrap().end;
        [end.q[1], end.v[1], end.q[2], end.v[2]]
    };
    let zero = DoubleDouble::from(0.0);
    let quotient = |up: [DoubleDouble; 4], down: [DoubleDouble; 4]| -> [f64; 4] {
        core::array::from_fn(|i| ((up[i] - down[i]) / (h + h)).to_f64())
    };
    let by_x = quotient(columns(h, zero), columns(-h, zero));
    let by_v = quotient(columns(zero, h), columns(zero, -h));
    let expected = [
        0.27771856625922825524,
        -0.112278503989658678,
        0.22392432903998723368,
        -0.12689065229074557077,
    ];
    for (found, expected) in by_x.into_iter().zip(expected) {
        close(found, expected, 1e-13);
    }
    let expected = [
        0.22392432903998723368,
        -0.12689065229074557077,
        0.60414864695991248881,
        0.12443790781972988121,
    ];
    for (found, expected) in by_v.into_iter().zip(expected) {
        close(found, expected, 1e-13);
    }
}

#[test]
fn floquet_traces_of_the_mathieu_equation() {
    const M: usize = variational_size(1, 0);
    for (a, q, trace, growth) in [
        (1.0, 0.125, -2.03853581929074585533901, 0.062386058345395653242),
        (1.0, 0.5, -2.61241890662466033556423, 0.24314575698414496958),
        (4.0, 1.0, 2.02131439741684163617526, 0.046430323689923045454),
        (0.0625, 0.5, 0.235657979197430304882472, 0.0),
        (-0.0625, 0.4, 1.82996464921464926874513, 0.0),
    ] {
        let period = core::f64::consts::PI;
        let system = Variational::<_, 1, M>::new(Mathieu::new(a, q));
        let (y, v) = system.start([0.1], [0.2]);
        let end = solve(&system, (0.0, period), y, v)
            .method(Dop853)
            .rtol(1e-14)
            .atol(1e-14)
            .run()
            .unwrap()
            .end;
        let monodromy = system.transition(&end);
        close(monodromy.trace(), trace, 1e-13);
        close(monodromy.determinant(), 1.0, 1e-13);
        // The equation is linear: the motion is the product of the transition and the start.
        close(end.q[0], 0.1 * monodromy[(0, 0)] + 0.2 * monodromy[(0, 1)], 1e-14);
        let half = (trace.abs() / 2.0).max(1.0);
        close(half.acosh() / period, growth, 1e-12);
    }
}

/// Compares the columns at the end of a run with fixed steps with differences of neighbouring runs
/// in two words, which are exact to 1e-12.
fn compare<S, const N: usize, const M: usize, X>(
    system: &S,
    motions: &X,
    method: impl Method<Driven<S, X>, N> + Method<Driven<Variational<S, N, M>, X>, M>,
    steps: u64,
) where
    S: Jacobians<N, Scalar = DoubleDouble, With<DoubleDouble> = S> + Clone,
    X: Motions<S::Inputs> + Clone,
{
    let number = DoubleDouble::from;
    let (end, h) = (2.0, number(1e-10));
    let (q0, v0): ([_; N], [_; N]) =
        (core::array::from_fn(|i| number(0.7 - 0.9 * i as f64)), [number(0.4); N]);
    let varied = Variational::<S, N, M>::new(system.clone());
    let (q, v) = varied.start(q0, v0);
    let dynamics = Driven::new::<M>(varied.clone(), motions.clone());
    let found = solve(&dynamics, (0.0, end), q, v).method(method).steps(steps).run().unwrap().end;
    let run = |system: S, q: [DoubleDouble; N], v: [DoubleDouble; N]| {
        let dynamics = Driven::new::<N>(system, motions.clone());
        solve(&dynamics, (0.0, end), q, v).method(method).steps(steps).run().unwrap().end
    };
    assert_eq!(varied.state(&found), run(system.clone(), q0, v0));
    for column in 0..M / N - 1 {
        let end_at = |h: DoubleDouble| {
            let (mut q, mut v, mut index) = (q0, v0, 0);
            if column < N {
                q[column] += h;
            } else if column < 2 * N {
                v[column - N] += h;
            }
            let system = system.map(|parameter| {
                index += 1;
                if index + 2 * N == column + 1 { parameter + h } else { parameter }
            });
            run(system, q, v)
        };
        let (up, down) = (end_at(h), end_at(-h));
        for i in 0..N {
            let (dq, dv) = ((up.q[i] - down.q[i]) / (h + h), (up.v[i] - down.v[i]) / (h + h));
            close((found.q[(1 + column) * N + i] - dq).to_f64(), 0.0, 1e-12);
            close((found.v[(1 + column) * N + i] - dv).to_f64(), 0.0, 1e-12);
        }
    }
}

#[test]
fn columns_are_the_derivatives_of_the_discrete_motion() {
    let number = DoubleDouble::from;
    compare::<_, 1, { variational_size(1, 2) }, _>(
        &Simple::new(number(1.25), number(0.75)),
        &(),
        Leapfrog,
        50,
    );
    compare::<_, 1, { variational_size(1, 1) }, _>(
        &Simple::new(number(1.25), number(0.75)),
        &(),
        Srkn14a,
        10,
    );
    compare::<_, 1, { variational_size(1, 1) }, _>(&Forced::new(number(0.5)), &(), Rk4, 50);
    compare::<_, 2, { variational_size(2, 2) }, _>(
        &Double::new(number(1.25), number(0.75)),
        &(),
        Dop853,
        10,
    );
}

#[test]
fn kinks_are_crossed_by_the_derivatives_of_the_momenta() {
    let number = DoubleDouble::from;
    // The pivot jumps between constant velocities, at times that are ends of steps.
    let hand =
        Curve::linear(&[0.0, 0.5, 1.25, 2.0], &[[0.0, 0.0], [0.3, 0.1], [0.1, -0.2], [0.5, 0.2]])
            .unwrap();
    let system = Hung::new(number(0.75), number(1.25), number(0.5), number(0.25));
    compare::<_, 2, { variational_size(2, 4) }, _>(&system, &(hand,), Rk4, 16);
}

#[test]
fn the_energy_has_no_gradient_along_the_flow() {
    // E(q(t), v(t)) = E(q₀, v₀): the gradient at the end times the transition is the gradient at
    // the start.
    const M: usize = variational_size(2, 0);
    let plain = Double::new(1.0, 1.0);
    let system = Variational::<_, 2, M>::new(plain.clone());
    let (q0, v0) = ([2.0, 2.5], [0.0, 0.25]);
    let (q, v) = system.start(q0, v0);
    let end =
        solve(&system, (0.0, 10.0), q, v).method(Dop853).rtol(1e-13).atol(1e-13).run().unwrap().end;
    let gradient = |q: [f64; 2], v: [f64; 2]| -> [f64; 4] {
        use pendulum_runtime::scalar::Dual;
        let lifted = plain.map(Dual::constant);
        core::array::from_fn(|k| {
            let (mut q, mut v) = (q.map(Dual::constant), v.map(Dual::constant));
            if k < 2 { &mut q[k] } else { &mut v[k - 2] }.derivative = 1.0;
            lifted.energy(At::of(Dual::constant(0.0), &q, &v)).derivative
        })
    };
    let (start, own) = (gradient(q0, v0), system.state(&end));
    let (last, transition) = (gradient(own.q, own.v), system.transition(&end));
    for k in 0..4 {
        let back: f64 = (0..4).map(|i| last[i] * transition[(i, k)]).sum();
        // The entries of the transition are about a thousand.
        close(back, start[k], 1e-8);
    }
}

#[test]
fn facts_and_errors_are_those_of_the_system() {
    const M: usize = variational_size(1, 2);
    let system = Variational::<_, 1, M>::new(Simple::new(1.0, 0.0));
    assert_eq!(<Variational<Simple, 1, M> as System<M>>::FACTS.parameters, ["g", "l"]);
    let (q, v) = system.start([1.0], [0.0]);
    let failure = solve(&system, (0.0, 1.0), q, v).method(Dop853).run().unwrap_err();
    let message = failure.to_string();
    assert!(
        message.contains("acceleration of `θ`") && message.contains("`l`, which is 0.0"),
        "{message}"
    );
}
