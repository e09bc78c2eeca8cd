//! Errors at the end against published and high-precision digits.

use super::systems::{
    DoublePendulum, HenonHeiles, Kepler, MovingPendulum, Pendulum, SHAKEN, double_pendulum,
    henon_heiles, oscillator, pendulum, shaken,
};
use super::{distance, fixed};
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::integrate::{
    Dop853, Dprkn12, Leapfrog, Rk4, Solution, Srkn6b, Srkn14a, Stats, SymplecticEuler, solve,
};
use pendulum_runtime::system::Driven;

/// The pendulum at t = 100, from 1.3 at rest.
const PENDULUM: [f64; 2] = [0.029429667179564377788823966, -1.2100149998864702546148483];

/// The chaotic double pendulum at t = 10, from (2, 2.5) at rest.
const CHAOTIC: [f64; 4] = [
    -0.87121375423784908225211262002,
    0.496465638832208351668027167202,
    1.74267166332543351683557441542,
    -1.63636427051421256734327374519,
];

/// The regular double pendulum at t = 100, from (0.5, −0.25) at rest.
const REGULAR: [f64; 4] = [
    0.268517909805266652887785519904,
    -0.424955772876473185056390670537,
    0.145710024766195778264940544579,
    -0.560065536725151040213534517241,
];

fn pendulum_error(method: impl Method<Pendulum<f64>, 1>, steps: u64) -> f64 {
    let end = fixed(&pendulum(), 100.0, [1.3], [0.0], method, steps);
    distance(&end.q, &end.v, &PENDULUM)
}

fn chaotic_error(method: impl Method<DoublePendulum<f64>, 2>, steps: u64) -> f64 {
    let end = fixed(&double_pendulum(), 10.0, [2.0, 2.5], [0.0; 2], method, steps);
    distance(&end.q, &end.v, &CHAOTIC)
}

/// Asserts that an error is between 0.4 times and twice the published error. A much smaller error
/// is suspicious.
fn assert_near(error: f64, published: f64) {
    assert!(
        0.4 * published < error && error < 2.0 * published,
        "{error:e} instead of {published:e}"
    );
}

#[test]
fn splitting_methods_on_the_pendulum() {
    // Steps for 2400, 4800 and 19200 evaluations.
    for (evaluations, b6, a14) in
        [(2400, 9.5e-7, 3.5e-9), (4800, 6.8e-8, 3.2e-10), (19200, 2.8e-10, 7.8e-14)]
    {
        assert_near(pendulum_error(Srkn6b, evaluations / 6), b6);
        assert_near(pendulum_error(Srkn14a, evaluations / 14), a14);
    }
}

#[test]
fn leapfrog_on_the_pendulum() {
    // The errors of kick-drift-kick are 6.9e-3 and 1.7e-3; those of drift-kick-drift are three
    // times smaller.
    assert_near(pendulum_error(Leapfrog, 2400), 6.9e-3 / 3.0);
    assert_near(pendulum_error(Leapfrog, 4800), 1.7e-3 / 3.0);
}

#[test]
fn rk4_on_the_chaotic_double_pendulum() {
    for (steps, published) in [
        (100, 8.2e-2),
        (200, 3.8e-3),
        (400, 1.4e-4),
        (800, 5.6e-6),
        (1600, 2.5e-7),
        (6400, 6.8e-10),
    ] {
        assert_near(chaotic_error(Rk4, steps), published);
    }
}

#[test]
fn symplectic_euler_on_the_double_pendulum_is_as_poor_as_said() {
    assert_near(chaotic_error(SymplecticEuler, 25_600), 0.23);
    assert_near(chaotic_error(SymplecticEuler, 102_400), 0.057);
}

/// Asserts that no run takes more than twice the published number of evaluations for its error,
/// interpolated between published errors.
fn assert_economical(runs: impl Iterator<Item = (Stats, f64)>, published: &[(f64, f64)]) {
    let &(_, least) = published.last().unwrap();
    for (stats, error) in runs {
        // An error below all published errors is compared with the smallest one.
        let error = if error < least { least } else { error };
        let within = published.windows(2).find(|pair| pair[1].1 <= error && error < pair[0].1);
        let Some(&[(few, large), (many, small)]) = within else {
            panic!("{error:e} is beyond what was published, {stats}")
        };
        let fraction = (large / error).ln() / (large / small).ln();
        let expected = few * (many / few).powf(fraction);
        assert!(
            (stats.evaluations as f64) < 2.0 * expected,
            "{error:e} in {expected:.0} evaluations was published, {stats}"
        );
    }
}

#[test]
fn dop853_on_the_chaotic_double_pendulum() {
    let system = double_pendulum();
    let run = |tolerance| {
        solve(&system, (0.0, 10.0), [2.0, 2.5], [0.0; 2])
            .method(Dop853)
            .rtol(tolerance)
            .atol(tolerance)
    };
    let measured = |solution: Solution<f64, 2>| {
        (solution.stats, distance(&solution.end.q, &solution.end.v, &CHAOTIC))
    };
    let dop853 = [
        (373.0, 1.2e-2),
        (541.0, 1.5e-4),
        (997.0, 1.3e-5),
        (1309.0, 9.4e-8),
        (2113.0, 9.4e-10),
        (2641.0, 8.4e-11),
        (3361.0, 9.2e-12),
        (5353.0, 3.2e-14),
    ];
    let tolerances = [1e-5, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12, 1e-13, 3e-15];
    assert_economical(
        tolerances.iter().map(|tolerance| measured(run(*tolerance).run().unwrap())),
        &dop853,
    );
}

#[test]
fn the_regular_double_pendulum_to_rounding() {
    let solution = solve(&double_pendulum(), (0.0, 100.0), [0.5, -0.25], [0.0; 2])
        .method(Dop853)
        .rtol(2.3e-15)
        .atol(2.3e-15)
        .run()
        .unwrap();
    let error = distance(&solution.end.q, &solution.end.v, &REGULAR);
    assert!(error < 2e-13, "{error:e}, {}", solution.stats);
}

#[test]
fn kepler_orbits_keep_the_tolerance() {
    let orbits = [
        (
            0.1,
            [
                0.21988353520083966128,
                0.94270768463430812852,
                -0.97876598410581765145766665,
                0.32879779909620360826252537,
            ],
        ),
        (
            0.5,
            [
                -0.57804329530352312327514584,
                0.8633840009194192801335730,
                -0.959508373038072735626449,
                -0.065049151267120901677193546,
            ],
        ),
        (
            0.9,
            [
                -1.2952662509875743677171393,
                0.40039389637923215272976962,
                -0.67753909247075658874763664,
                -0.12708381542786861876687033,
            ],
        ),
    ];
    for (e, exact) in orbits {
        let solution = solve(
            &Kepler { mu: 1.0 },
            (0.0, 20.0),
            [1.0 - e, 0.0],
            [0.0, ((1.0 + e) / (1.0_f64 - e)).sqrt()],
        )
        .method(Dop853);
        let solution = solution.rtol(1e-12).atol(1e-12).run().unwrap();
        let error = distance(&solution.end.q, &solution.end.v, &exact);
        assert!(error < 1e-10, "e = {e}: {error:e}, {}", solution.stats);
    }
}

#[test]
fn henon_heiles_by_all_velocity_free_methods() {
    let exact = [
        0.036708919703026082557151060001,
        0.682692239901714863638812348689,
        0.0471639671758451559513300963197,
        -0.0253059588138630476379504876741,
    ];
    let error = |end: pendulum_runtime::integrate::State<f64, 2>| distance(&end.q, &end.v, &exact);
    let (system, q, v) = (henon_heiles(), [0.1, 0.0], [0.0, 0.5]);
    assert!(error(fixed(&system, 10.0, q, v, Srkn6b, 100)) < 1e-7);
    assert!(error(fixed(&system, 10.0, q, v, Srkn14a, 100)) < 1e-12);
    let problem = || solve(&system, (0.0, 10.0), q, v).rtol(1e-13).atol(1e-13);
    assert!(error(problem().method(Dop853).run().unwrap().end) < 1e-12);
    assert!(error(problem().method(Dprkn12).run().unwrap().end) < 1e-13);
}

#[test]
fn a_shaken_pendulum_by_every_method() {
    let driven = shaken();
    let error = |end: pendulum_runtime::integrate::State<f64, 1>| distance(&end.q, &end.v, &SHAKEN);
    assert!(error(fixed(&driven, 10.0, [0.5], [0.0], SymplecticEuler, 10_000)) < 3e-3);
    assert!(error(fixed(&driven, 10.0, [0.5], [0.0], Leapfrog, 10_000)) < 3e-6);
    assert!(error(fixed(&driven, 10.0, [0.5], [0.0], Srkn6b, 200)) < 1e-6);
    assert!(error(fixed(&driven, 10.0, [0.5], [0.0], Srkn14a, 200)) < 1e-11);
    assert!(error(fixed(&driven, 10.0, [0.5], [0.0], Rk4, 1000)) < 1e-8);
    let problem = || solve(&driven, (0.0, 10.0), [0.5], [0.0]).rtol(1e-12).atol(1e-12);
    let solution = problem().method(Dop853).run().unwrap();
    assert!(error(solution.end) < 1e-11, "{}", solution.stats);
    let solution = problem().method(Dprkn12).run().unwrap();
    assert!(error(solution.end) < 1e-12, "{}", solution.stats);
}

#[test]
fn single_precision_reaches_its_last_digits() {
    // 800 steps of Rk4; without compensated sums the error is 2.5e-4.
    let solution = solve(&DoublePendulum { g: 1.0_f32 }, (0.0, 10.0), [2.0, 2.5], [0.0; 2])
        .method(Rk4)
        .steps(800)
        .run()
        .unwrap();
    let error = distance(&solution.end.q.map(f64::from), &solution.end.v.map(f64::from), &CHAOTIC);
    assert!(error < 5e-6, "{error:e}");
}

#[test]
fn single_precision_with_step_control() {
    let pendulum = Pendulum { length: 1.0_f32, g: 1.0 };
    let exact = [-1.166160381932957676242545, -0.50236501011242526821132624];
    let solution = solve(&pendulum, (0.0, 10.0), [1.3], [0.0]).method(Dop853).run().unwrap();
    assert!(
        distance(&solution.end.q.map(f64::from), &solution.end.v.map(f64::from), &exact) < 2e-4,
        "{}",
        solution.stats
    );
}

#[test]
fn a_system_at_rest_stays_there() {
    let solution = solve(&oscillator(1.0), (0.0, 1e6), [0.0], [0.0]).method(Dop853).run().unwrap();
    assert_eq!((solution.end.q, solution.end.v), ([0.0], [0.0]));
    assert!(solution.stats.accepted < 30, "{}", solution.stats);
}

#[test]
fn each_tolerance_may_differ() {
    // Two coordinates of different magnitudes: the small coordinate has its own tolerance.
    let system = henon_heiles();
    let run = |small| {
        solve(&system, (0.0, 3.0), [0.1, 1e-6], [0.0; 2])
            .method(Dop853)
            .rtol(1e-4)
            .atol_each([1e-4, small], [1e-4, small])
    };
    let coarse = run(1e-4).run().unwrap().stats.accepted;
    let fine = run(1e-13).run().unwrap().stats.accepted;
    assert!(coarse < fine, "{coarse} {fine}");
}

#[test]
fn types_of_drives_and_systems_meet() {
    // The bound of `solve` is `Dynamics`: undriven and driven systems both implement it.
    let driven: Driven<MovingPendulum<f64>, _> = shaken();
    assert!(solve(&driven, (0.0, 1.0), [0.5], [0.0]).method(Dop853).run().is_ok());
    assert!(
        solve(&HenonHeiles { lambda: 1.0 }, (0.0, 1.0), [0.1, 0.0], [0.0; 2])
            .method(Dop853)
            .run()
            .is_ok()
    );
}
