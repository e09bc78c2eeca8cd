//! Generated systems over numbers in two words: as a reference for `f64`, and integrated to many
//! more digits.

use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::{DoubleDouble, Float};

use systems::problems::{Double, Five, Simple};
use systems::random::Random;

lagrangian! {
    /// Numbers of more digits than a double holds.
    pub struct Long {}
    coordinate x;
    kinetic = ẋ^2/2;
    potential = 3.14159265358979323846264338327950*x - 123456789012345678901234567*x/98765432109876543210;
}

lagrangian! {
    pub struct Spherical { l, g, c }
    coordinate θ;
    coordinate φ;
    let r = l*[sin(θ)*cos(φ), sin(θ)*sin(φ), -cos(θ)];
    kinetic = |ṙ|^2/2;
    potential = g*height(r) + exp(-|r|/3)*sqrt(1 + θ^2) + (1 + θ^2)^0.1;
    dissipation = c*(θ̇^2 + φ̇^2)/2;
}

/// Energies relative to their values at rest.
mod above_rest {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        pub struct Swing { m, l, g }
        coordinate q;
        kinetic = m*l^2*q̇^2/2;
        potential = m*g*l*(1 - cos(q));
    }

    lagrangian! {
        /// From the top.
        pub struct Top { m, l, g }
        coordinate q;
        kinetic = m*l^2*q̇^2/2;
        potential = m*g*l*(1 + cos(q));
    }

    lagrangian! {
        /// From where it was released.
        pub struct Released { a, g }
        coordinate q;
        kinetic = q̇^2/2;
        potential = g*(cos(a) - cos(q));
    }

    lagrangian! {
        pub struct Links { m: [1; 2], l: [1; 2], g }
        coordinate θ[2];
        let y[k in 0..2] = sum(j in 0..=k, l[j]*[sin(θ[j]), 1 - cos(θ[j])]);
        kinetic = sum(k in 0..2, m[k]/2*|ẏ[k]|^2);
        potential = sum(k in 0..2, m[k]*g*height(y[k]));
    }

    lagrangian! {
        pub struct Sphere { l, g }
        coordinate θ;
        coordinate φ;
        kinetic = l^2*(θ̇^2 + sin(θ)^2*φ̇^2)/2;
        potential = g*l*(1 - cos(θ));
    }
}

fn number(digits: &str) -> DoubleDouble {
    digits.parse().unwrap()
}

/// The states of the pendulum from 1.3 at rest, computed by `tests/data/pendulum.py`.
const PENDULUM: [(f64, [&str; 2]); 3] = [
    (1.0, ["0.832363138943072881433597355408384023", "-0.900701076177291930639209149753437501"]),
    (10.0, ["-1.16616038193295767624254503427640491", "-0.502365010112425268211326236345613615"]),
    (100.0, ["0.0294296671795643777888239656418586152", "-1.21001499988647025461484826150757903"]),
];

fn error(q: [DoubleDouble; 1], v: [DoubleDouble; 1], exact: [&str; 2]) -> f64 {
    let [q, v] = [q[0] - number(exact[0]), v[0] - number(exact[1])];
    q.abs().max(v.abs()).to_f64()
}

#[test]
fn an_extrapolated_leapfrog_reaches_28_digits() {
    let system = Simple::new(DoubleDouble::from(1.0));
    let (end, exact) = PENDULUM[0];
    // The error is a series in even powers of the step, which Neville's scheme removes one by one
    // (Gragg 1965). Powers of two divide the interval into steps that are equal to the last digit.
    let steps: Vec<u64> = (2..=12).map(|k| 1 << k).collect();
    let mut row: Vec<[DoubleDouble; 2]> = Vec::new();
    for (k, &count) in steps.iter().enumerate() {
        let solution = solve(&system, (0.0, end), [number("1.3")], [0.0.into()])
            .method(Leapfrog)
            .steps(count)
            .run()
            .unwrap();
        let mut entry = [solution.end.q[0], solution.end.v[0]];
        for j in 0..k {
            let ratio = DoubleDouble::ratio(count as f64, steps[k - 1 - j] as f64);
            let divisor = ratio * ratio - 1.0.into();
            let above = core::mem::replace(&mut row[j], entry);
            entry = core::array::from_fn(|i| entry[i] + (entry[i] - above[i]) / divisor);
        }
        row.push(entry);
    }
    let [q, v] = row[steps.len() - 1];
    let found = error([q], [v], exact);
    assert!(found < 1e-28, "{found:e}");
}

#[test]
fn every_method_runs() {
    fn at_the_end(method: impl Method<Simple<DoubleDouble>, 1>, steps: u64) -> f64 {
        let system = Simple::new(DoubleDouble::from(1.0));
        let (end, exact) = PENDULUM[1];
        let solution = solve(&system, (0.0, end), [number("1.3")], [0.0.into()])
            .method(method)
            .steps(steps)
            .run()
            .unwrap();
        assert_eq!(solution.end.t, end);
        error(solution.end.q, solution.end.v, exact)
    }
    // Coefficients in one word limit the accuracy to 1e-16; those of the first three methods are
    // exact.
    for (found, bound) in [
        (at_the_end(Rk4, 20_000), 1e-14),
        (at_the_end(Leapfrog, 2000), 1e-5),
        (at_the_end(SymplecticEuler, 2000), 1e-2),
        (at_the_end(Srkn6b, 2000), 1e-11),
        (at_the_end(Srkn14a, 500), 1e-14),
        (at_the_end(Dop853, 200), 1e-15),
    ] {
        assert!(found < bound, "{found:e} {bound:e}");
    }
}

#[test]
fn tolerances_are_those_of_the_scalar() {
    let system = Simple::new(DoubleDouble::from(1.0));
    let run = |rtol: f64| {
        solve(&system, (0.0, 0.01), [number("1.3")], [0.0.into()])
            .method(Dop853)
            .rtol(rtol)
            .atol(rtol)
            .run()
    };
    assert!(run(1e-20).is_ok());
    let message = run(1e-31).unwrap_err().to_string();
    assert!(message.contains("ten machine epsilons"), "{message}");
    assert!(
        solve(&Simple::new(1.0), (0.0, 1.0), [1.3], [0.0])
            .method(Dop853)
            .rtol(1e-20)
            .run()
            .is_err()
    );
}

#[test]
fn dense_output_knows_both_words_of_a_time() {
    let system = Simple::new(DoubleDouble::from(1.0));
    let solution = solve(&system, (0.0, 1.0), [number("1.3")], [0.0.into()])
        .method(Rk4)
        .steps(3000)
        .dense()
        .run()
        .unwrap();
    let at = |t: f64| solution.at(t).unwrap();
    // Within steps, the quintic has errors of 1e-20, far below the effect of one unit in the last
    // place of t.
    let (t, next) = (0.7, 0.7_f64.next_up());
    let difference = at(next).q[0] - at(t).q[0];
    let expected = at(t).v[0] * DoubleDouble::from(next - t);
    assert!(
        ((difference - expected) / expected).to_f64().abs() < 1e-10,
        "{difference:e} {expected:e}"
    );
}

/// Compares accelerations over `f64` with those over two words. Returns the largest error relative
/// to the largest acceleration.
macro_rules! apart {
    ($n:literal, $system:expr, $q:expr, $v:expr) => {{
        let (system, q, v): (_, [f64; $n], [f64; $n]) = ($system, $q, $v);
        let wide = system.map(DoubleDouble::from);
        let narrow = system.accelerations(At::of(0.0, &q, &v));
        let wide = wide.accelerations(At::of(
            0.0.into(),
            &q.map(DoubleDouble::from),
            &v.map(DoubleDouble::from),
        ));
        let largest = wide.iter().fold(0.0_f64, |largest, a| largest.max(a.to_f64().abs()));
        (0..$n).fold(0.0_f64, |worst, i| {
            worst.max((DoubleDouble::from(narrow[i]) - wide[i]).to_f64().abs())
        }) / largest
    }};
}

#[test]
fn accelerations_of_one_word_are_good_to_their_condition() {
    let mut random = Random::new(11);
    let mut worst = [0.0_f64; 3];
    for _ in 0..10_000 {
        let mut state = |_| random.uniform(-3.1, 3.1);
        let found = [
            apart!(
                2,
                Double::new([1.0, 0.7], [0.9, 1.1], 9.81),
                core::array::from_fn(&mut state),
                core::array::from_fn(&mut state)
            ),
            apart!(
                5,
                Five::new([1.0; 5], [1.0; 5], 9.81),
                core::array::from_fn(&mut state),
                core::array::from_fn(&mut state)
            ),
            apart!(
                2,
                Spherical::new(1.1, 9.81, 0.3),
                [0.5 + 0.3 * state(0).abs(), state(1)],
                core::array::from_fn(&mut state)
            ),
        ];
        worst = core::array::from_fn(|i| worst[i].max(found[i]));
    }
    assert!(worst[0] < 5e-15 && worst[1] < 5e-14 && worst[2] < 5e-15, "{worst:?}");
    assert!(worst.iter().all(|error| 1e-16 < *error), "{worst:?}");
}

#[test]
fn long_numbers_keep_their_digits() {
    let expected = number("123456789012345678901234567") / number("98765432109876543210")
        - number("3.14159265358979323846264338327950");
    let [wide] =
        Long::<DoubleDouble>::new().accelerations(At::of(0.0.into(), &[0.0.into()], &[0.0.into()]));
    assert!(((wide - expected) / expected).to_f64().abs() < 1e-30, "{wide} {expected}");
    let [narrow] = Long::<f64>::new().accelerations(At::of(0.0, &[0.0], &[0.0]));
    assert_eq!(narrow, expected.to_f64());
}

#[test]
fn aligned_rods_with_a_light_upper_mass_lose_what_the_matrix_loses() {
    // The mass matrix has the determinant m₁ + m₂ sin² Δ: at Δ = 2⁻¹⁰ and a small m₁ its condition
    // is about 1/m₁.
    for exponent in [10, 20, 30, 40] {
        let m1 = 0.5_f64.powi(exponent);
        let found = apart!(
            2,
            Double::new([m1, 1.0], [1.0; 2], 1.0),
            [1.0, 1.0 + 0.5_f64.powi(10)],
            [0.3, -0.7]
        );
        let condition = 1.0 / (m1 + 0.5_f64.powi(20));
        assert!(
            found <= 8.0 * f64::EPSILON * condition,
            "{found:e} at a condition of {condition:e}"
        );
    }
}

/// Returns the relative error of an energy, compared with the same block in two words.
macro_rules! energy_error {
    ($n:literal, $system:expr, $q:expr, $v:expr) => {{
        let (system, q, v): (_, [f64; $n], [f64; $n]) = ($system, $q, $v);
        let wide = system.map(DoubleDouble::from);
        let exact =
            wide.energy(At::of(0.0.into(), &q.map(DoubleDouble::from), &v.map(DoubleDouble::from)));
        ((DoubleDouble::from(system.energy(At::of(0.0, &q, &v))) - exact) / exact).to_f64().abs()
    }};
}

#[test]
fn energies_of_small_swings_keep_their_digits() {
    use above_rest::{Links, Released, Sphere, Swing, Top};
    let mut worst = 0.0_f64;
    for exponent in 0..40 {
        let small = 1.3 * 0.5_f64.powi(exponent);
        // 1 − cos q is zero below 1e-8, and has lost half of its digits at 1e-4.
        worst = worst.max(energy_error!(1, Swing::new(0.3, 1.7, 9.81), [small], [0.0]));
        worst = worst.max(energy_error!(
            1,
            Top::new(0.3, 1.7, 9.81),
            [std::f64::consts::PI - small],
            [small]
        ));
        worst = worst.max(energy_error!(1, Released::new(1.0, 9.81), [1.0 + small], [0.0]));
        worst = worst.max(energy_error!(
            2,
            Links::new([1.0, 0.7], [0.9, 1.1], 9.81),
            [small, 0.3 * small],
            [0.0; 2]
        ));
        worst = worst.max(energy_error!(2, Sphere::new(1.1, 9.81), [small, 0.4], [0.0, 0.5]));
    }
    assert!(worst < 8.0 * f64::EPSILON, "{worst:e}");
}

#[test]
fn the_determinant_of_aligned_links_keeps_its_digits() {
    // Δ has an error of ε, so that the error of every formula is at least ε/Δ; with the square of
    // the cosine it would be ε/Δ².
    for exponent in 1..=24 {
        let gap = 0.7 * 0.5_f64.powi(exponent);
        let found = apart!(
            2,
            Double::new([0.5_f64.powi(52), 1.0], [1.0; 2], 1.0),
            [0.5, 0.5 + gap],
            [0.25, 0.25]
        );
        assert!(found <= 4.0 * f64::EPSILON / gap, "{found:e} at {gap:e}");
    }
}

#[test]
fn taylor_reaches_28_digits() {
    let system = Simple::new(DoubleDouble::from(1.0));
    for (end, exact) in &PENDULUM[..2] {
        let run = |tolerance: f64| {
            let problem =
                solve(&system, (0.0, *end), [number("1.3")], [0.0.into()]).method(Taylor::new());
            let solution = problem.rtol(tolerance).atol(tolerance).run().unwrap();
            error(solution.end.q, solution.end.v, *exact)
        };
        assert!(run(1e-30) < 1e-28, "{:e}", run(1e-30));
        // A looser tolerance has a larger error: the test measures the method and not the rounding
        // errors.
        assert!(1e-29 < run(1e-20), "{:e}", run(1e-20));
    }
}
