//! The course note's four systems, each in its three notations, compared with equations derived by
//! hand.
//!
//! "Equations of Motion for a Translating Compound Pendulum" (CMU 15-462) writes the kinetic energy
//! with ⊥, in components and in complex numbers; all three have to give exactly the same equations.

use pendulum_runtime::motion::Sample;
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::System;

use systems::random::Random;

/// θ̈ = −g sin θ / L.
mod simple {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        /// With ⊥.
        pub struct Perp { m: kg, L: m, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        let y = L * [sin(θ), -cos(θ)];
        kinetic = m/2 * |θ̇*perp(y)|^2;
        potential = m*g*height(y);
    }

    lagrangian! {
        /// In components.
        pub struct Components { m: kg, L: m, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        kinetic = m/2 * ((L*θ̇*cos(θ))^2 + (L*θ̇*sin(θ))^2);
        potential = -m*g*L*cos(θ);
    }

    lagrangian! {
        /// In complex numbers.
        pub struct Complex { m: kg, L: m, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        let y = L * exp(i*(θ - π/2));
        kinetic = m/2 * |i*θ̇*y|^2;
        potential = m*g*height(y);
    }
}

/// θ̈ = −⟨ẍ, y⊥⟩/L² − g sin θ / L.
mod moving {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        /// With ⊥.
        pub struct Perp { m: kg, L: m, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        driven x: [m; 2];
        let y = L * [sin(θ), -cos(θ)];
        kinetic = m/2 * |ẋ + θ̇*perp(y)|^2;
        potential = m*g*height(x + y);
    }

    lagrangian! {
        /// In components.
        pub struct Components { m: kg, L: m, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        driven x: [m; 2];
        kinetic = m/2 * ((ẋ.x + L*θ̇*cos(θ))^2 + (ẋ.y + L*θ̇*sin(θ))^2);
        potential = m*g*(x.y - L*cos(θ));
    }

    lagrangian! {
        /// In complex numbers.
        pub struct Complex { m: kg, L: m, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        driven x: [m; 2];
        let y = L * exp(i*(θ - π/2));
        kinetic = m/2 * |ẋ + i*θ̇*y|^2;
        potential = m*g*height(x + y);
    }
}

/// θ̈ = −m g h(e^{i(θ+π/2)} c)/I.
mod compound {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        /// With ⊥; König's theorem splits the energy at the centre of mass.
        pub struct Perp { m: kg, c: [m; 2], I: kg*m^2, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        let r = cos(θ)*c + sin(θ)*perp(c);
        kinetic = m/2*|θ̇*perp(r)|^2 + (I - m*|c|^2)/2 * θ̇^2;
        potential = m*g*height(r);
    }

    lagrangian! {
        /// In components.
        pub struct Components { m: kg, c: [m; 2], I: kg*m^2, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        kinetic = I/2 * θ̇^2;
        potential = m*g*(c.x*sin(θ) + c.y*cos(θ));
    }

    lagrangian! {
        /// In complex numbers.
        pub struct Complex { m: kg, c: [m; 2], I: kg*m^2, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        let r = exp(i*θ)*c;
        kinetic = m/2*|i*θ̇*r|^2 + (I - m*|c|^2)/2 * θ̇^2;
        potential = m*g*height(r);
    }
}

/// The note's approximation: θ̈ = −⟨ẍ, y⊥⟩/L² − m g h(e^{i(θ+π/2)} c)/I, whose Lagrangian has the
/// coupling I/L² instead of m.
mod approximate {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        /// With ⊥.
        pub struct Perp { m: kg, L: m, c: [m; 2], I: kg*m^2, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        driven x: [m; 2];
        let y = L * [sin(θ), -cos(θ)];
        kinetic = I/(2*L^2) * |ẋ + θ̇*perp(y)|^2;
        potential = m*g*height(cos(θ)*c + sin(θ)*perp(c));
    }

    lagrangian! {
        /// In components.
        pub struct Components { m: kg, L: m, c: [m; 2], I: kg*m^2, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        driven x: [m; 2];
        kinetic = I/(2*L^2) * ((ẋ.x + L*θ̇*cos(θ))^2 + (ẋ.y + L*θ̇*sin(θ))^2);
        potential = m*g*(c.x*sin(θ) + c.y*cos(θ));
    }

    lagrangian! {
        /// In complex numbers.
        pub struct Complex { m: kg, L: m, c: [m; 2], I: kg*m^2, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        driven x: [m; 2];
        let y = L * exp(i*(θ - π/2));
        kinetic = I/(2*L^2) * |ẋ + i*θ̇*y|^2;
        potential = m*g*height(exp(i*θ)*c);
    }
}

/// The exact equation: I θ̈ = −m⟨ẍ + g e_y, (e^{iθ} c)⊥⟩.
mod exact {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        /// With ⊥.
        pub struct Perp { m: kg, c: [m; 2], I: kg*m^2, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        driven x: [m; 2];
        let r = cos(θ)*c + sin(θ)*perp(c);
        kinetic = m/2*|ẋ + θ̇*perp(r)|^2 + (I - m*|c|^2)/2 * θ̇^2;
        potential = m*g*height(x + r);
    }

    lagrangian! {
        /// In components.
        pub struct Components { m: kg, c: [m; 2], I: kg*m^2, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        driven x: [m; 2];
        let p = c.x*cos(θ) - c.y*sin(θ);
        let q = c.x*sin(θ) + c.y*cos(θ);
        kinetic = m/2*((ẋ.x - θ̇*q)^2 + (ẋ.y + θ̇*p)^2) + (I - m*|c|^2)/2 * θ̇^2;
        potential = m*g*(x.y + q);
    }

    lagrangian! {
        /// In complex numbers.
        pub struct Complex { m: kg, c: [m; 2], I: kg*m^2, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        driven x: [m; 2];
        let r = exp(i*θ)*c;
        kinetic = m/2*|ẋ + i*θ̇*r|^2 + (I - m*|c|^2)/2 * θ̇^2;
        potential = m*g*height(x + r);
    }
}

/// The hand-written accelerations, each with the sum of the magnitudes of its terms. If terms
/// cancel, the error of every formula is relative to this sum.
mod hand {
    pub(crate) fn simple(l: f64, g: f64, θ: f64) -> (f64, f64) {
        let a = -g * θ.sin() / l;
        (a, a.abs())
    }

    pub(crate) fn moving(l: f64, g: f64, θ: f64, ddx: [f64; 2]) -> (f64, f64) {
        let perp = [l * θ.cos(), l * θ.sin()];
        let terms = [-ddx[0] * perp[0] / (l * l), -ddx[1] * perp[1] / (l * l), -g * θ.sin() / l];
        (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum())
    }

    /// h(e^{i(θ+π/2)} c) = c₁ cos θ − c₂ sin θ.
    pub(crate) fn compound(m: f64, c: [f64; 2], i: f64, g: f64, θ: f64) -> (f64, f64) {
        let terms = [-m * g * c[0] * θ.cos() / i, m * g * c[1] * θ.sin() / i];
        (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum())
    }

    pub(crate) fn approximate(
        m: f64,
        l: f64,
        c: [f64; 2],
        i: f64,
        g: f64,
        θ: f64,
        ddx: [f64; 2],
    ) -> (f64, f64) {
        let forcing = moving(l, 0.0, θ, ddx);
        let weight = compound(m, c, i, g, θ);
        (forcing.0 + weight.0, forcing.1 + weight.1)
    }

    pub(crate) fn exact(m: f64, c: [f64; 2], i: f64, g: f64, θ: f64, ddx: [f64; 2]) -> (f64, f64) {
        let (s, k) = θ.sin_cos();
        // (e^{iθ} c)⊥ = (−(c₁ s + c₂ k), c₁ k − c₂ s).
        let up = ddx[1] + g;
        let terms = [
            m * ddx[0] * c[0] * s / i,
            m * ddx[0] * c[1] * k / i,
            -m * up * c[0] * k / i,
            m * up * c[1] * s / i,
        ];
        (terms.iter().sum(), terms.iter().map(|term| term.abs()).sum())
    }
}

/// Asserts that the relative differences at 10⁴ random states are small.
fn compare(name: &str, mut at: impl FnMut(&mut Random) -> ([f64; 3], (f64, f64))) {
    let mut random = Random::new(462);
    let mut worst = 0.0f64;
    for _ in 0..10_000 {
        let (generated, (expected, scale)) = at(&mut random);
        assert!(
            generated.iter().all(|value| value.to_bits() == generated[0].to_bits()),
            "{name}: notations differ: {generated:?}"
        );
        worst = worst.max((generated[0] - expected).abs() / scale);
    }
    println!("{name}: {worst:.1e}");
    assert!(worst <= 1e-14, "{name}: {worst}");
}

fn sample(position: [f64; 2], velocity: [f64; 2], acceleration: [f64; 2]) -> (Sample<f64, 2>,) {
    (Sample { position, velocity, acceleration },)
}

macro_rules! three {
    ($module:ident, ($($parameter:expr),*), |$system:ident| $value:expr) => {[
        { let $system = $module::Perp::new($($parameter),*); $value },
        { let $system = $module::Components::new($($parameter),*); $value },
        { let $system = $module::Complex::new($($parameter),*); $value },
    ]};
}

#[test]
fn simple_pendulum() {
    compare("simple", |random| {
        let (m, l, θ, ω) = (
            random.uniform(0.1, 10.0),
            random.uniform(0.1, 10.0),
            random.uniform(-10.0, 10.0),
            random.uniform(-9.0, 9.0),
        );
        (
            three!(simple, (m, l), |system| system.accelerations(At::of(0.0, &[θ], &[ω]))[0]),
            hand::simple(l, 9.81, θ),
        )
    });
}

#[test]
fn moving_pendulum() {
    compare("moving", |random| {
        let (m, l, θ, ω) = (
            random.uniform(0.1, 10.0),
            random.uniform(0.1, 10.0),
            random.uniform(-10.0, 10.0),
            random.uniform(-9.0, 9.0),
        );
        let [x, dx, ddx] =
            [1.0, 3.0, 30.0].map(|size| [random.uniform(-size, size), random.uniform(-size, size)]);
        let inputs = sample(x, dx, ddx);
        let at = At { t: 0.0, q: &[θ], v: &[ω], inputs: &inputs };
        (
            three!(moving, (m, l), |system| system.accelerations(at)[0]),
            hand::moving(l, 9.81, θ, ddx),
        )
    });
}

/// Returns a body whose inertia about the pivot is larger than that of a point mass at its centre.
fn body(random: &mut Random) -> (f64, [f64; 2], f64) {
    let m = random.uniform(0.1, 10.0);
    let c = [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)];
    (m, c, m * (c[0] * c[0] + c[1] * c[1] + random.uniform(0.01, 1.0)))
}

#[test]
fn compound_pendulum() {
    compare("compound", |random| {
        let (m, c, i) = body(random);
        let (θ, ω) = (random.uniform(-10.0, 10.0), random.uniform(-9.0, 9.0));
        (
            three!(compound, (m, c, i), |system| system.accelerations(At::of(0.0, &[θ], &[ω]))[0]),
            hand::compound(m, c, i, 9.81, θ),
        )
    });
}

#[test]
fn approximate_moving_compound_pendulum() {
    compare("approximate moving compound", |random| {
        let (m, c, i) = body(random);
        let (l, θ, ω) =
            (random.uniform(0.1, 2.0), random.uniform(-10.0, 10.0), random.uniform(-9.0, 9.0));
        let [x, dx, ddx] =
            [1.0, 3.0, 30.0].map(|size| [random.uniform(-size, size), random.uniform(-size, size)]);
        let inputs = sample(x, dx, ddx);
        let at = At { t: 0.0, q: &[θ], v: &[ω], inputs: &inputs };
        let generated = three!(approximate, (m, l, c, i), |system| system.accelerations(at)[0]);
        (generated, hand::approximate(m, l, c, i, 9.81, θ, ddx))
    });
}

#[test]
fn exact_moving_compound_pendulum() {
    compare("exact moving compound", |random| {
        let (m, c, i) = body(random);
        let (θ, ω) = (random.uniform(-10.0, 10.0), random.uniform(-9.0, 9.0));
        let [x, dx, ddx] =
            [1.0, 3.0, 30.0].map(|size| [random.uniform(-size, size), random.uniform(-size, size)]);
        let inputs = sample(x, dx, ddx);
        let at = At { t: 0.0, q: &[θ], v: &[ω], inputs: &inputs };
        let generated = three!(exact, (m, c, i), |system| system.accelerations(at)[0]);
        (generated, hand::exact(m, c, i, 9.81, θ, ddx))
    });
}

macro_rules! facts {
    ($module:ident) => {
        [
            <$module::Perp as System<1>>::FACTS,
            <$module::Components as System<1>>::FACTS,
            <$module::Complex as System<1>>::FACTS,
        ]
    };
}

#[test]
fn the_three_notations_print_one_equation() {
    for facts in
        [facts!(simple), facts!(moving), facts!(compound), facts!(approximate), facts!(exact)]
    {
        for other in &facts {
            assert_eq!(other.equations, facts[0].equations);
        }
    }
    assert_eq!(facts!(simple)[0].equations, "θ̈ = −g·sin θ/L");
    assert_eq!(facts!(moving)[0].equations, "θ̈ = −(g·sin θ + ẍ.x·cos θ + ẍ.y·sin θ)/L");
    assert_eq!(facts!(simple)[0].unused, ["m"]);
}

/// |ẋ|² m/2 and m g h(x) occur in L but not in the equations, which need only ẍ.
#[test]
fn terms_that_cannot_matter_vanish() {
    use pendulum_runtime::motion::Derivatives;
    for facts in facts!(exact) {
        assert_eq!(facts.inputs[0].accelerations, Derivatives::ACCELERATION);
        assert_eq!(facts.inputs[0].momenta, Derivatives::VELOCITY);
        assert!(
            facts.velocity_free
                && facts.constant_mass_matrix
                && !facts.autonomous
                && !facts.separable
        );
    }
    for facts in facts!(simple) {
        assert!(
            facts.velocity_free
                && facts.constant_mass_matrix
                && facts.autonomous
                && facts.separable
        );
    }
}

/// The hand-written systems for the integrators, over any scalar.
mod hand_systems {
    use pendulum_runtime::motion::Sample;
    use pendulum_runtime::scalar::Real;
    use pendulum_runtime::system::{At, Facts, System};

    /// The equations of the note.
    #[derive(Clone, Copy, Debug)]
    pub(crate) enum Equation {
        Moving,
        Approximate,
        Exact,
    }

    /// θ̈ written by hand; with a pivot at rest, the last two equations of the note become the
    /// first two.
    #[derive(Clone, Copy, Debug)]
    pub(crate) struct Hand<T> {
        pub(crate) equation: Equation,
        pub(crate) m: T,
        pub(crate) l: T,
        pub(crate) c: [T; 2],
        pub(crate) i: T,
        pub(crate) g: T,
    }

    impl<T: Real> System<1> for Hand<T> {
        type Scalar = T;
        type Inputs = (Sample<T, 2>,);
        type With<U: Real> = Hand<U>;
        type Prepared = ();

        const FACTS: Facts = Facts::new("Hand", &["θ"]);

        fn map<U: Real>(&self, mut map: impl FnMut(T) -> U) -> Hand<U> {
            let (m, l, c) = (map(self.m), map(self.l), self.c.map(&mut map));
            Hand { equation: self.equation, m, l, c, i: map(self.i), g: map(self.g) }
        }

        fn prepare(&self) {}

        fn accelerations(&self, At { q, inputs, .. }: At<'_, T, Self::Inputs, 1>) -> [T; 1] {
            let (sin, cos) = q[0].sin_cos();
            let [ddx, ddy] = inputs.0.acceleration;
            let forcing = -(ddx * cos + ddy * sin) / self.l;
            let across = self.c[0] * cos - self.c[1] * sin;
            let along = self.c[0] * sin + self.c[1] * cos;
            [match self.equation {
                Equation::Moving => forcing - self.g * sin / self.l,
                Equation::Approximate => forcing - self.m * self.g * across / self.i,
                Equation::Exact => -self.m * ((ddy + self.g) * across - ddx * along) / self.i,
            }]
        }

        fn energy(&self, _: At<'_, T, Self::Inputs, 1>) -> T {
            unreachable!("only the accelerations are compared")
        }

        fn power(&self, _: At<'_, T, Self::Inputs, 1>) -> T {
            unreachable!("only the accelerations are compared")
        }

        fn momenta(&self, _: At<'_, T, Self::Inputs, 1>) -> [T; 1] {
            unreachable!("the motion has no kink")
        }

        fn velocities(&self, _: T, _: &[T; 1], _: &[T; 1], _: &Self::Inputs) -> [T; 1] {
            unreachable!("the motion has no kink")
        }

        fn mass_matrix(&self, _: At<'_, T, Self::Inputs, 1>) -> nalgebra::SMatrix<T, 1, 1> {
            unreachable!("only the accelerations are compared")
        }

        fn forces(&self, _: At<'_, T, Self::Inputs, 1>) -> [T; 1] {
            unreachable!("only the accelerations are compared")
        }

        fn momentum_rates(&self, _: At<'_, T, Self::Inputs, 1>) -> [T; 1] {
            unreachable!("only the accelerations are compared")
        }
    }
}

use hand_systems::{Equation, Hand};
use pendulum_runtime::motion::{Sinusoid, Still};

/// Asserts that generated and hand-written systems agree within 1e-12 over ten seconds.
fn together<A: Dynamics<1, Scalar = f64>, B: Dynamics<1, Scalar = f64>>(generated: &A, hand: &B) {
    let run = |error: &mut f64, found: [f64; 2], expected: [f64; 2]| {
        for (found, expected) in found.iter().zip(&expected) {
            *error = error.max((found - expected).abs());
        }
    };
    let mut worst = 0.0;
    let (q, v) = ([0.7], [-0.4]);
    let fixed = |end: pendulum_runtime::integrate::State<f64, 1>| [end.q[0], end.v[0]];
    let a = solve(generated, (0.0, 10.0), q, v).method(Rk4).steps(5000).run().unwrap();
    let b = solve(hand, (0.0, 10.0), q, v).method(Rk4).steps(5000).run().unwrap();
    run(&mut worst, fixed(a.end), fixed(b.end));
    let a =
        solve(generated, (0.0, 10.0), q, v).method(Dop853).rtol(1e-12).atol(1e-12).run().unwrap();
    let b = solve(hand, (0.0, 10.0), q, v).method(Dop853).rtol(1e-12).atol(1e-12).run().unwrap();
    run(&mut worst, fixed(a.end), fixed(b.end));
    println!("after ten seconds: {worst:.1e}");
    assert!(worst <= 1e-12, "{worst}");
}

#[test]
fn ten_seconds_agree() {
    let hand = |equation| Hand { equation, m: 0.8, l: 1.2, c: [0.3, -1.1], i: 1.5, g: 9.81 };
    let shake = || Sinusoid::new([0.2, 0.1], 5.0, [0.3, 1.0]);
    let still = || (Still::new([0.0; 2]),);
    together(&simple::Perp::new(0.8, 1.2), &Driven::new::<1>(hand(Equation::Moving), still()));
    together(
        &moving::Complex::new(0.8, 1.2).driven_by(shake()),
        &Driven::new::<1>(hand(Equation::Moving), (shake(),)),
    );
    together(
        &compound::Perp::new(0.8, [0.3, -1.1], 1.5),
        &Driven::new::<1>(hand(Equation::Exact), still()),
    );
    let approximate = approximate::Components::new(0.8, 1.2, [0.3, -1.1], 1.5);
    together(
        &approximate.driven_by(shake()),
        &Driven::new::<1>(hand(Equation::Approximate), (shake(),)),
    );
    together(
        &exact::Complex::new(0.8, [0.3, -1.1], 1.5).driven_by(shake()),
        &Driven::new::<1>(hand(Equation::Exact), (shake(),)),
    );
}
