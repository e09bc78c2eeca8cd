//! Small motions of constrained systems, compared with minimal coordinates and closed forms.

use pendulum_runtime::analysis::{
    DampedMode, Linearization, StateSpace, equilibrium, linearize, state_space,
};
use pendulum_runtime::integrate::{Event, assemble};
use pendulum_runtime::motion::Side;
use pendulum_runtime::nalgebra::{Complex, DVector};
use pendulum_runtime::prelude::*;
use pendulum_runtime::time::Time;
use systems::constrained::{Ball, Disc, FourBar, Loops2};

lagrangian! {
    /// Two bobs on rods in Cartesian coordinates, damped by the air.
    #[derive(Clone, Debug)]
    pub struct Rods { m: [kg; 2], L: [m; 2], c: kg/s, g: m/s^2 = 9.81 }
    coordinate x[2]: m;
    coordinate y[2]: m;
    input push: N;
    kinetic = sum(k in 0..2, m[k]/2*(ẋ[k]^2 + ẏ[k]^2));
    potential = g*(m[0]*y[0] + m[1]*y[1]);
    dissipation = c/2*sum(k in 0..2, ẋ[k]^2 + ẏ[k]^2);
    force x[1] = push;
    constraint upper: |[x[0], y[0]]| = L[0];
    constraint lower: |[x[1] - x[0], y[1] - y[0]]| = L[1];
    output tip: m = x[1];
    output tension: N = -reaction(upper);
}

lagrangian! {
    /// The same in angles.
    #[derive(Clone, Debug)]
    pub struct Angles { m: [kg; 2], L: [m; 2], c: kg/s, g: m/s^2 = 9.81 }
    coordinate θ[2]: rad;
    input push: N;
    let a = L[0]*[sin(θ[0]), -cos(θ[0])];
    let b = a + L[1]*[sin(θ[1]), -cos(θ[1])];
    kinetic = m[0]/2*|ȧ|^2 + m[1]/2*|ḃ|^2;
    potential = g*(m[0]*height(a) + m[1]*height(b));
    dissipation = c/2*(|ȧ|^2 + |ḃ|^2);
    force θ[0] = push*L[0]*cos(θ[0]);
    force θ[1] = push*L[1]*cos(θ[1]);
    output tip: m = L[0]*sin(θ[0]) + L[1]*sin(θ[1]);
}

const M: [f64; 2] = [0.7, 1.2];
const L: [f64; 2] = [0.9, 0.5];

/// Returns the real and imaginary parts of the eigenvalues of A.
fn spectrum(model: &StateSpace) -> Vec<(f64, f64)> {
    let values = model.a.clone().schur().complex_eigenvalues();
    let mut values: Vec<(f64, f64)> = values.iter().map(|value| (value.re, value.im)).collect();
    values.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.total_cmp(&b.0)));
    values
}

fn assert_close(a: &[(f64, f64)], b: &[(f64, f64)], bound: f64) {
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        assert!((a.0 - b.0).abs() < bound && (a.1 - b.1).abs() < bound, "{a:?} {b:?}");
    }
}

#[test]
fn modes_are_those_of_the_angles() {
    let rods = Rods::new(M, L, 0.3).controlled_by(|_, _, _| 0.0);
    let angles = Angles::new(M, L, 0.3).controlled_by(|_, _, _| 0.0);
    let rest = equilibrium(&rods, 0.0, [0.05, 0.02, -0.85, -1.45]).unwrap();
    let small = linearize(&rods, 0.0, &rest, &[0.0; 4]);
    let expected = linearize(&angles, 0.0, &[0.0; 2], &[0.0; 2]);
    let (own, other) = (small.normal_modes().unwrap(), expected.normal_modes().unwrap());
    assert_eq!(own.squared_frequencies.len(), 2);
    for (a, b) in own.squared_frequencies.iter().zip(&other.squared_frequencies) {
        assert!((a - b).abs() < 1e-9 * b, "{a} {b}");
    }
    // Shapes keep the rods, and have the norm 1 in the metric of the masses.
    for mode in 0..2 {
        let shape: Vec<f64> = (0..4).map(|row| own.shapes[(row, mode)]).collect();
        assert!(shape[2].abs() < 1e-9 && shape[3].abs() < 1e-9);
        let norm = M[0] * shape[0] * shape[0] + M[1] * shape[1] * shape[1];
        assert!((norm - 1.0).abs() < 1e-9);
    }
    let (own, other) = (small.damped_modes().unwrap(), expected.damped_modes().unwrap());
    assert_eq!(own.len(), other.len());
    for (a, b) in own.iter().zip(&other) {
        assert!((a.eigenvalue - b.eigenvalue).norm_sqr() < 1e-18, "{a} {b}");
    }
}

#[test]
fn a_state_that_moves_has_independent_coordinates() {
    // Differences along every change of the angles and their rates.
    let push = 0.8;
    let rods = Rods::new(M, L, 0.3).controlled_by(move |_, _, _| push);
    let at = |[α, β, u, w]: [f64; 4]| {
        let [(s0, c0), (s1, c1)] = [α, β].map(f64::sin_cos);
        let (a, b) = (L[0] * u, L[1] * w);
        let q = [L[0] * s0, L[0] * s0 + L[1] * s1, -L[0] * c0, -L[0] * c0 - L[1] * c1];
        (q, [a * c0, a * c0 + b * c1, a * s0, a * s0 + b * s1])
    };
    let here = [0.6, -0.4, 1.1, -0.7];
    let (q, v) = at(here);
    let model = state_space(&rods, 0.0, &q, &v);
    assert_eq!((model.coordinates.len(), model.velocities.len(), model.a.nrows()), (2, 2, 4));
    // States, their rates and the outputs.
    let values = |x: [f64; 4]| {
        let (q, v) = at(x);
        let a = rods.accelerations_at(Time::new(0.0), Side::After, &q, &v);
        let own =
            |of: [f64; 4], which: &[usize]| which.iter().map(|i| of[*i]).collect::<Vec<f64>>();
        let states = [own(q, &model.coordinates), own(v, &model.velocities)].concat();
        let rates = [own(v, &model.coordinates), own(a, &model.velocities)].concat();
        let outputs = vec![rods.tip(0.0, &q, &v), rods.tension(0.0, &q, &v)];
        [states, rates, outputs].map(DVector::from_vec)
    };
    for direction in 0..4 {
        let d = 1e-5;
        let (mut up, mut down) = (here, here);
        (up[direction], down[direction]) = (here[direction] + d, here[direction] - d);
        let (up, down) = (values(up), values(down));
        let [states, rates, outputs] =
            core::array::from_fn(|part| (&up[part] - &down[part]) / (2.0 * d));
        let off = [(&model.a * &states - rates).amax(), (&model.c * states - outputs).amax()];
        assert!(off[0] < 1e-7 && off[1] < 1e-7, "{direction}: {off:?}");
    }
    // The tension depends directly on the force, the position does not.
    assert!(model.d[(1, 0)].abs() > 1e-3 && model.d[(0, 0)] == 0.0);
}

lagrangian! {
    /// A sleigh on a blade, whose centre lies `a` ahead of the blade (Chaplygin), held by a
    /// spring.
    #[derive(Clone, Debug)]
    pub struct Sleigh { m: kg, a: m, J: kg*m^2, c: kg/s, k: N/m }
    coordinate x: m;
    coordinate y: m;
    coordinate θ: rad;
    let center = [x, y] + a*[cos(θ), sin(θ)];
    kinetic = m/2*|dot(center)|^2 + J/2*θ̇^2;
    potential = k/2*y^2;
    dissipation = c/2*(ẋ^2 + ẏ^2);
    constraint blade: ẋ*sin(θ) = ẏ*cos(θ);
}

/// Checks that the modes have the eigenvalues and the eigenvectors of a linear model, and returns
/// the modes.
fn checked<const N: usize>(small: &Linearization<N>, model: &StateSpace) -> Vec<DampedMode<N>> {
    let modes = small.damped_modes().unwrap();
    let mut own = Vec::new();
    for mode in &modes {
        let (λ, φ) = (mode.eigenvalue, mode.shape);
        own.push((λ.re, λ.im));
        if λ.im != 0.0 {
            own.push((λ.re, -λ.im));
        }
        let mass = small.mass.map(|entry| Complex::new(entry, 0.0));
        assert!((φ.dotc(&(mass * φ)).re - 1.0).abs() < 1e-9, "{mode}");
        let coordinates = model.coordinates.iter().map(|&i| φ[i]);
        let x: Vec<_> = coordinates.chain(model.velocities.iter().map(|&i| λ * φ[i])).collect();
        let x = DVector::from_vec(x);
        let off = model.a.map(|entry| Complex::new(entry, 0.0)) * &x - &x * λ;
        assert!(off.norm() < 1e-6 * (1.0 + mode.frequency()) * x.norm(), "{mode}: {off}");
    }
    own.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.total_cmp(&b.0)));
    // Defective zeros have errors of the square root of rounding.
    let distinct = |all: &[(f64, f64)]| -> Vec<(f64, f64)> {
        all.iter().copied().filter(|(re, im)| 1e-3 < re.abs() + im.abs()).collect()
    };
    assert_eq!(own.len(), model.a.nrows());
    assert_close(&distinct(&own), &distinct(&spectrum(model)), 1e-8);
    modes
}

#[test]
fn modes_of_a_state_that_moves_are_those_of_its_linear_model() {
    // Constraints of positions: two rods that swing.
    let rods = Rods::new(M, L, 0.3).controlled_by(|_, _, _| 0.4);
    let ((s0, c0), (s1, c1)) = (0.6_f64.sin_cos(), (-0.4_f64).sin_cos());
    let (a, b) = (1.1 * L[0], -0.7 * L[1]);
    let q = [L[0] * s0, L[0] * s0 + L[1] * s1, -L[0] * c0, -L[0] * c0 - L[1] * c1];
    let v = [a * c0, a * c0 + b * c1, a * s0, a * s0 + b * s1];
    checked(&linearize(&rods, 0.0, &q, &v), &state_space(&rods, 0.0, &q, &v));
    // Constraints of velocities: a disc that rolls upright, Ω² = 12/5 ω² − 4/5 g/r.
    let (m, r, g) = (0.8, 0.3, 9.81);
    let disc = Disc::new(m, r, m * r * r / 4.0, m * r * r / 2.0);
    for ω in [2.0, 6.0] {
        let (q, v) = ([0.0; 5], [r * ω, 0.0, 0.0, 0.0, ω]);
        let modes = checked(&linearize(&disc, 0.0, &q, &v), &state_space(&disc, 0.0, &q, &v));
        let squared: f64 = 2.4 * ω * ω - 0.8 * g / r;
        let root = Complex::new(squared, 0.0).sqrt() * Complex::new(0.0, 1.0);
        let found = modes.iter().any(|mode| (mode.eigenvalue - root).norm() < 1e-9)
            || modes.iter().any(|mode| (mode.eigenvalue + root).norm() < 1e-9);
        assert!(found, "{root} {modes:?}");
    }
    // A sleigh in any direction returns to a straight path by m a u/(J + m a²), or leaves it.
    for (u, θ) in [(3.0, 0.4_f64), (-3.0, 0.4), (0.7, -2.0)] {
        let (m, a, inertia) = (1.3, 0.4, 0.2);
        let free = Sleigh::new(m, a, inertia, 0.0, 0.0);
        let (q, v) = ([0.1, -0.2, θ], [u * θ.cos(), u * θ.sin(), 0.0]);
        let modes = checked(&linearize(&free, 0.0, &q, &v), &state_space(&free, 0.0, &q, &v));
        let rate = -m * a * u / (inertia + m * a * a);
        let last = modes.last().unwrap();
        assert!((last.eigenvalue - rate).norm() < 1e-9, "{last} for {rate}");
        let rough = Sleigh::new(m, a, inertia, 0.5, 2.0);
        checked(&linearize(&rough, 0.0, &q, &v), &state_space(&rough, 0.0, &q, &v));
    }
    // A ball on a turntable circles with 2/7 of its rate, also if it begins at rest in the middle.
    let (r, turns) = (0.2, 3.0);
    let ball = Ball::new(0.5, r, 0.4 * 0.5 * r * r, turns);
    for [x, y, u, w] in [[0.0; 4], [0.3, -0.1, 0.2, 0.5]] {
        let (q, v) = ([x, y, 0.0, 0.0], [u, w, (turns * x - w) / r, (u + turns * y) / r]);
        let modes = checked(&linearize(&ball, 0.0, &q, &v), &state_space(&ball, 0.0, &q, &v));
        let last = modes.last().unwrap().eigenvalue;
        assert!((last - Complex::new(0.0, 2.0 / 7.0 * turns)).norm() < 1e-9, "{last}");
    }
}

#[test]
fn a_four_bar_has_one_mode() {
    let bars = FourBar::new([0.4, 1.1, 0.8], 1.0, [0.5, 1.2, 0.7]);
    let guess = assemble(&bars, 0.0, [-1.5, 0.2, -1.2], [0.0; 3]).run().unwrap();
    let rest = equilibrium(&bars, 0.0, guess.q).unwrap();
    let modes = linearize(&bars, 0.0, &rest, &[0.0; 3]).normal_modes().unwrap();
    let [squared] = modes.squared_frequencies[..] else { panic!("{modes:?}") };
    assert!(squared > 1.0, "{squared}");
    // The period of a small swing, measured over many periods.
    let shape: [f64; 3] = core::array::from_fn(|i| rest[i] + 1e-5 * modes.shapes[(i, 0)]);
    let start = assemble(&bars, 0.0, shape, [0.0; 3]).run().unwrap();
    let crossings = Event::new(move |_, q, _| q[0] - rest[0]).rising();
    let run = solve(&bars, (0.0, 8.0), start.q, start.v)
        .rtol(1e-10)
        .atol(1e-15)
        .events(&[crossings])
        .run()
        .unwrap();
    let times: Vec<f64> = run.events.iter().map(|event| event.time.to_f64()).collect();
    let period = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let found = (core::f64::consts::TAU / period).powi(2);
    assert!((found - squared).abs() < 1e-6 * squared, "{found} {squared}");
}

#[test]
fn a_disc_that_rolls_upright_is_stable_when_it_is_fast() {
    // A thin disc: Ω² = 12/5 ω² − 4/5 g/r, stable from ω² = g/(3r) on.
    let (m, r, g) = (0.8, 0.3, 9.81);
    let disc = Disc::new(m, r, m * r * r / 4.0, m * r * r / 2.0);
    for ω in [2.0, 6.0] {
        let speed = r * ω;
        let model = state_space(&disc, 0.0, &[0.0; 5], &[speed, 0.0, 0.0, 0.0, ω]);
        // Two constraints of velocities: five coordinates, three velocities.
        assert_eq!((model.coordinates.len(), model.velocities.len()), (5, 3));
        let squared = 2.4 * ω * ω - 0.8 * g / r;
        let root = squared.abs().sqrt();
        let pair =
            if squared < 0.0 { [(-root, 0.0), (root, 0.0)] } else { [(0.0, -root), (0.0, root)] };
        let all = spectrum(&model);
        for (re, im) in pair {
            let near = |&(a, b): &(f64, f64)| (a - re).abs() < 1e-9 && (b - im).abs() < 1e-9;
            assert!(all.iter().any(near), "{re} {im} {all:?}");
        }
        // All other eigenvalues are zero; defective zeros have errors of the square root of
        // rounding.
        let moving = all.iter().filter(|(a, b)| 1e-3 < a.abs() + b.abs());
        assert_eq!(moving.count(), 2, "{all:?}");
    }
}

lagrangian! {
    /// A bob on a rod, in a unit of the constraint that makes its gradient small.
    pub struct Faint { L: m, k: 1/s^2, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    coordinate z: m;
    kinetic = (ẋ^2 + ẏ^2 + ż^2)/2;
    potential = g*y + k*x^2;
    constraint rod: 1e-13*(x^2 + y^2) = 1e-13*L^2;
    constraint wall: 1e9*z = 0;
}

#[test]
fn the_unit_of_a_constraint_does_not_matter() {
    let faint = Faint::new(2.0, 2.0);
    let modes = linearize(&faint, 0.0, &[0.0, -2.0, 0.0], &[0.0; 3]).normal_modes().unwrap();
    let [squared] = modes.squared_frequencies[..] else { panic!("{modes:?}") };
    assert!((squared - (9.81 / 2.0 + 4.0)).abs() < 1e-9, "{squared}");
    let model = state_space(&faint, 0.0, &[0.0, -2.0, 0.0], &[0.0; 3]);
    assert_eq!((model.coordinates, model.velocities), (vec![0], vec![0]));
}

#[test]
fn dependent_constraints_give_no_numbers() {
    // All bars in a line, exactly and to rounding.
    for place in [0.0, core::f64::consts::PI] {
        let (loops, q) = (Loops2::new(1.0, 1.0), [place, place, place, 0.0, 0.0]);
        let model = state_space(&loops, 0.0, &q, &[0.0; 5]);
        assert!(model.a.iter().all(|entry| entry.is_nan()), "{}", model.a);
        let modes = linearize(&loops, 0.0, &q, &[0.0; 5]).normal_modes();
        assert!(modes.is_err(), "{modes:?}");
    }
}

#[test]
fn minimal_coordinates_are_left_as_they_are() {
    let angles = Angles::new(M, L, 0.3).controlled_by(|_, _, _| 0.0);
    let model = state_space(&angles, 0.0, &[0.1, 0.2], &[0.0; 2]);
    assert_eq!((model.coordinates, model.velocities), (vec![0, 1], vec![0, 1]));
    let rest = state_space(&angles, 0.0, &[0.0; 2], &[0.0; 2]);
    let rods = Rods::new(M, L, 0.3).controlled_by(|_, _, _| 0.0);
    let model = state_space(&rods, 0.0, &[0.0, 0.0, -0.9, -1.4], &[0.0; 4]);
    assert_close(&spectrum(&model), &spectrum(&rest), 1e-9);
}
