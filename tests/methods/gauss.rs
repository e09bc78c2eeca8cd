//! The Gauss methods: order, digits, and conserved quantities.
//!
//! The digits are those of `tests/methods/problems.rs`.

use pendulum_runtime::error::Error;
use pendulum_runtime::integrate::FixedStep;
use pendulum_runtime::integrate::method::Method;
use pendulum_runtime::motion::{Curve, Sinusoid};
use pendulum_runtime::prelude::*;

use systems::distance::distance;
use systems::keys::keys;
use systems::problems::{
    Cart, DampedElastic, Double, Forced, Hoop, Hung, Kepler, Simple, Spherical,
};

/// Returns two links and bobs of one metre and one kilogram, with g = 1 m/s².
fn double() -> Double<f64> {
    Double::new([1.0; 2], [1.0; 2], 1.0)
}

fn after<D: Dynamics<N, Scalar = f64>, const N: usize>(
    dynamics: &D,
    end: f64,
    q: [f64; N],
    v: [f64; N],
    method: impl Method<D, N>,
    steps: u64,
) -> ([f64; N], [f64; N]) {
    let end = solve(dynamics, (0.0, end), q, v).method(method).steps(steps).run().unwrap().end;
    (end.q, end.v)
}

const SIMPLE: [f64; 2] = [-1.16616038193295767624254, -0.502365010112425268211326];
const SHAKEN: [f64; 2] = [0.0342105591464723414299261, -1.02072871213303888830643];
const FORCED: [f64; 2] = [-6.16862184561575671593007, 1.73729062797933203483616];
const DOUBLE: [f64; 4] = [
    -0.317126753679008418729030,
    0.502495051916668693314933,
    -0.152579088816347670822437,
    -0.159373774298781573884821,
];
const CHAOTIC: [f64; 4] = [
    -0.871213754237849082252113,
    0.496465638832208351668027,
    1.74267166332543351683557,
    -1.63636427051421256734327,
];

/// Asserts the order from the errors at `steps` and twice as many steps, within a tenth.
fn assert_order(name: &str, order: f64, steps: u64, error: impl Fn(u64) -> f64) {
    let (coarse, fine) = (error(steps), error(2 * steps));
    let found = (coarse / fine).log2();
    assert!(
        (found - order).abs() < 0.1 * order + 0.1,
        "{name}: order {found:.2} from {coarse:e} to {fine:e}"
    );
}

fn orders<const S: usize>(steps: u64) {
    let (gauss, order) = (Gauss::<S>::new(), 2.0 * S as f64);
    let shaken = Hung { l: 1.0, g: 1.0 }.driven_by(Sinusoid::new([0.25, 0.0], 2.0, [0.0; 2]));
    assert_order("simple", order, steps, |n| {
        distance(after(&Simple::new(1.0), 10.0, [1.3], [0.0], gauss, n), &SIMPLE)
    });
    assert_order("driven", order, 2 * steps, |n| {
        distance(after(&shaken, 10.0, [0.5], [0.0], gauss, n), &SHAKEN)
    });
    assert_order("forced", order, 2 * steps, |n| {
        distance(after(&Forced::new(0.25), 10.0, [0.0], [0.0], gauss, n), &FORCED)
    });
    assert_order("double", order, 2 * steps, |n| {
        distance(after(&double(), 10.0, [0.5, -0.25], [0.0; 2], gauss, n), &DOUBLE)
    });
    let newton =
        |n| distance(after(&double(), 10.0, [0.5, -0.25], [0.0; 2], gauss.newton(), n), &DOUBLE);
    assert_order("double by Newton", order, 2 * steps, newton);
}

#[test]
fn the_order_is_twice_the_number_of_stages() {
    orders::<1>(400);
    orders::<2>(100);
    orders::<3>(60);
    orders::<4>(40);
}

#[test]
fn eight_stages_have_order_sixteen() {
    // There are few steps between the coarsest asymptotic step and the limit of rounding.
    let error =
        |n| distance(after(&Simple::new(1.0), 10.0, [1.3], [0.0], Gauss::<8>::new(), n), &SIMPLE);
    assert!(
        error(5) < 1e-5 && error(10) < 1e-9 && error(16) < 1e-12 && error(24) < 2e-15,
        "{:e} {:e} {:e} {:e}",
        error(5),
        error(10),
        error(16),
        error(24)
    );
}

#[test]
fn trusted_digits() {
    let gauss = Gauss::<4>::new();
    let regular = after(&double(), 10.0, [0.5, -0.25], [0.0; 2], gauss, 400);
    assert!(distance(regular, &DOUBLE) < 1e-14, "{:e}", distance(regular, &DOUBLE));
    let chaotic = after(&double(), 10.0, [2.0, 2.5], [0.0; 2], gauss, 1200);
    assert!(distance(chaotic, &CHAOTIC) < 1e-12, "{:e}", distance(chaotic, &CHAOTIC));
    let chaotic = after(&double(), 10.0, [2.0, 2.5], [0.0; 2], Gauss::<8>::new(), 200);
    assert!(distance(chaotic, &CHAOTIC) < 1e-12, "{:e}", distance(chaotic, &CHAOTIC));
    let cart =
        after(&Cart { M: 2.0, m: 1.0, l: 1.0, g: 1.0 }, 50.0, [0.0, 2.0], [0.0; 2], gauss, 2000);
    let exact = [
        0.540687700043772166835146,
        -0.793433414301177316634101,
        0.382285678608006812261174,
        -1.63509179034836170824199,
    ];
    assert!(distance(cart, &exact) < 1e-12, "{:e}", distance(cart, &exact));
    let spherical = after(&Spherical::new(1.0, 1.0), 50.0, [1.0, 0.0], [0.0, 1.0], gauss, 2000);
    let exact = [
        0.924831930608251379754992,
        61.9023375626447771398751,
        0.212394902413278911180497,
        1.11047076030315927743351,
    ];
    assert!(distance(spherical, &exact) < 1e-12, "{:e}", distance(spherical, &exact));
    let hoop = after(&Hoop::new(), 10.0, [0.5], [0.0], gauss, 400);
    assert!(distance(hoop, &[1.02886014256450250438634, -0.533514923170437428630840]) < 1e-14);
    let kepler =
        after(&Kepler::new(1.0), 20.0, [0.5, 0.0], [0.0, 3.0_f64.sqrt()], Gauss::<8>::new(), 400);
    let exact = [
        -0.578043295303536123275146,
        0.863384000919419280133573,
        -0.959508373038072735626449,
        -0.0650491512671209016771935,
    ];
    assert!(distance(kepler, &exact) < 1e-12, "{:e}", distance(kepler, &exact));
}

/// Returns the largest relative change of the energy of a pendulum over `steps` steps, checked at
/// every hundredth step.
fn drift(steps: u64) -> f64 {
    let (system, q) = (Simple::new(1.0), [1.3]);
    let start = system.energy(At::of(0.0, &q, &[0.0]));
    let mut integrator = Integrator::new(&system, Gauss::<4>::new(), 0.0, q, [0.0])
        .unwrap()
        .control(FixedStep::new(1.0 / 128.0))
        .unwrap();
    let mut largest = 0.0_f64;
    for step in 0..steps {
        integrator.step().unwrap();
        if step % 100 == 0 {
            let energy = system.energy(At::of(0.0, integrator.q(), integrator.v()));
            largest = largest.max(((energy - start) / start).abs());
        }
    }
    largest
}

#[test]
fn energy_changes_by_rounding_only() {
    let drift = drift(100_000);
    assert!(drift < 2e-15, "{drift:e}");
}

/// Takes half a minute: `cargo test --release --test methods gauss -- --ignored`.
#[test]
#[ignore = "ten million steps"]
fn energy_over_ten_million_steps() {
    let (shorter, longer) = (drift(1_000_000), drift(10_000_000));
    println!("10⁶ steps {shorter:e}, 10⁷ steps {longer:e}");
    // A random walk grows by √10, a drift by 10.
    assert!(longer < 1e-14 && longer < 5.0 * shorter.max(1e-15), "{shorter:e} {longer:e}");
}

#[test]
fn quadratic_invariants_are_kept() {
    let (kepler, q, v) = (Kepler::new(1.0), [0.5, 0.0], [0.0, 3.0_f64.sqrt()]);
    // The angular momentum in Cartesian coordinates, with steps far too long for the orbit.
    let coarse = |end: ([f64; 2], [f64; 2])| {
        end.0[0] * end.1[1] - end.0[1] * end.1[0] - 0.5 * 3.0_f64.sqrt()
    };
    let gauss = after(&kepler, 200.0, q, v, Gauss::<2>::new(), 2000);
    assert!(coarse(gauss).abs() < 1e-14, "{:e}", coarse(gauss));
    assert!(1e-6 < coarse(after(&kepler, 200.0, q, v, Rk4, 2000)).abs());
    // The momenta of cyclic coordinates are exact except for the conversion of velocities to
    // momenta.
    let (cart, spherical) = (Cart { M: 2.0, m: 1.0, l: 1.0, g: 1.0 }, Spherical::new(1.0, 1.0));
    let (q, v) = after(&cart, 50.0, [0.0, 2.0], [0.0; 2], Gauss::<2>::new(), 500);
    assert!(cart.momenta(At::of(50.0, &q, &v))[0].abs() < 1e-15);
    let (q, v) = after(&spherical, 50.0, [1.0, 0.0], [0.0, 1.0], Gauss::<1>::new(), 500);
    assert!((spherical.momenta(At::of(50.0, &q, &v))[1] - 1.0_f64.sin().powi(2)).abs() < 1e-15);
}

/// Returns the largest entry of JᵀΩJ − Ω, where J is the Jacobian of one step of the double
/// pendulum in coordinates and momenta, from central differences of order 6.
fn symplectic_defect(method: impl Method<Double<f64>, 2>, h: f64) -> f64 {
    let system = double();
    let step = |z: [f64; 4]| {
        let q = [z[0], z[1]];
        let v = system.velocities(0.0, &q, &[z[2], z[3]], &());
        let (q, v) = after(&system, h, q, v, method, 1);
        let p = system.momenta(At::of(h, &q, &v));
        [q[0], q[1], p[0], p[1]]
    };
    let start = [0.7, -1.1, 1.5, 0.4];
    let mut jacobian = [[0.0; 4]; 4];
    for column in 0..4 {
        let at = |offset: f64| {
            let mut z = start;
            z[column] += offset;
            step(z)
        };
        let d = 1.0 / 256.0;
        let [near, middle, far] = [1.0, 2.0, 3.0].map(|k| (at(k * d), at(-k * d)));
        for row in 0..4 {
            let difference = |pair: &([f64; 4], [f64; 4])| pair.0[row] - pair.1[row];
            jacobian[row][column] = (45.0 * difference(&near) - 9.0 * difference(&middle)
                + difference(&far))
                / (60.0 * d);
        }
    }
    let mut largest = 0.0_f64;
    for a in 0..4 {
        for b in 0..4 {
            let form: f64 = (0..2)
                .map(|k| jacobian[k][a] * jacobian[k + 2][b] - jacobian[k + 2][a] * jacobian[k][b])
                .sum();
            let omega = if b == a + 2 {
                1.0
            } else if a == b + 2 {
                -1.0
            } else {
                0.0
            };
            largest = largest.max((form - omega).abs());
        }
    }
    largest
}

#[test]
fn a_step_is_symplectic_where_the_mass_matrix_depends_on_the_coordinates() {
    let bound = 1e-10;
    for defect in [
        symplectic_defect(Gauss::<1>::new(), 0.25),
        symplectic_defect(Gauss::<2>::new(), 0.25),
        symplectic_defect(Gauss::<3>::new(), 0.25),
        symplectic_defect(Gauss::<4>::new(), 0.25),
        symplectic_defect(Gauss::<8>::new(), 0.25),
        symplectic_defect(Gauss::<2>::new().newton(), 0.25),
    ] {
        assert!(defect < bound, "{defect:e}");
    }
    let defect = symplectic_defect(Rk4, 0.25);
    assert!(1e4 * bound < defect, "{defect:e}");
}

#[test]
fn motion_reversed_returns() {
    let there = after(&double(), 20.0, [0.5, -0.25], [0.0; 2], Gauss::<3>::new(), 100);
    let back = after(&double(), 20.0, there.0, there.1.map(|v| -v), Gauss::<3>::new(), 100);
    assert!(
        distance(back, &[0.5, -0.25, 0.0, 0.0]) < 1e-12,
        "{:e}",
        distance(back, &[0.5, -0.25, 0.0, 0.0])
    );
}

#[test]
fn momenta_carry_the_state_over_kinks() {
    // The value of `tests/language/kinks.rs`.
    let (times, values) = keys();
    let driven = Hung { l: 0.5, g: 9.81 }.driven_by(Curve::linear(&times, &values).unwrap());
    let error = |end: ([f64; 1], [f64; 1])| (end.0[0] + 0.129608683467).abs();
    assert!(error(after(&driven, 5.0, [0.3], [0.0], Gauss::<1>::new(), 480)) < 1e-3);
    assert!(error(after(&driven, 5.0, [0.3], [0.0], Gauss::<3>::new(), 120)) < 1e-9);
    assert!(error(after(&driven, 5.0, [0.3], [0.0], Gauss::<4>::new().newton(), 100)) < 1e-11);
}

#[test]
fn dense_output_follows_the_order() {
    fn largest<const S: usize>(steps: u64) -> f64 {
        let exact = solve(&double(), (0.0, 2.0), [0.5, -0.25], [0.0; 2])
            .rtol(1e-14)
            .atol(1e-14)
            .dense()
            .run()
            .unwrap();
        let found = solve(&double(), (0.0, 2.0), [0.5, -0.25], [0.0; 2])
            .method(Gauss::<S>::new())
            .steps(steps)
            .dense()
            .run()
            .unwrap();
        let mut largest = 0.0_f64;
        for k in 0..=200 {
            let (a, b) =
                (exact.at(f64::from(k) / 100.0).unwrap(), found.at(f64::from(k) / 100.0).unwrap());
            largest = largest.max(distance((a.q, a.v), &[b.q, b.v].concat()));
        }
        largest
    }
    // The velocities are of order S + 1.
    for (coarse, fine, order) in [
        (largest::<1>(20), largest::<1>(40), 2.0),
        (largest::<2>(20), largest::<2>(40), 3.0),
        (largest::<3>(10), largest::<3>(20), 4.0),
        (largest::<4>(10), largest::<4>(20), 5.0),
        (largest::<8>(8), largest::<8>(16), 9.0),
    ] {
        assert!(order - 0.4 < (coarse / fine).log2(), "order {order}: {coarse:e} {fine:e}");
    }
    assert!(largest::<8>(20) < 1e-11, "{:e}", largest::<8>(20));
}

#[test]
fn stiff_springs_by_newton() {
    // The slow motion of a pendulum on a stiff elastic rod, with steps that are thousands of times
    // longer than the fast period.
    let rigid = after(&Simple::new(1.0), 10.0, [1.0], [0.0], Gauss::<8>::new(), 50);
    for k in [1e2_f64, 1e4, 1e6, 1e8, 1e10] {
        let elastic = DampedElastic { k, c: 0.0 };
        let length = 1.0 + 1.0_f64.cos() / k;
        let (q, v) =
            after(&elastic, 10.0, [length, 1.0], [0.0; 2], Gauss::<2>::new().newton(), 1000);
        assert!(
            (q[1] - rigid.0[0]).abs() < 20.0 / k + 1e-6 && (q[0] - 1.0).abs() < 10.0 / k,
            "k = {k:e}: {q:?} {v:?}"
        );
    }
}

#[test]
fn sweeps_that_go_astray_are_reported() {
    let elastic = DampedElastic { k: 1e6, c: 0.0 };
    let failure = solve(&elastic, (0.0, 10.0), [1.0, 1.0], [0.0; 2])
        .method(Gauss::<2>::new())
        .step(0.1)
        .run()
        .unwrap_err();
    match &failure.error {
        Error::NoConvergence { t, coordinate, .. } => {
            assert!(coordinate.name == "r" && 0.0 < *t && *t < 0.1, "{failure}");
        }
        other => panic!("{other:?}"),
    }
    assert!(failure.to_string().contains("Newton"), "{failure}");
    assert_eq!((failure.partial.end.q, failure.partial.end.t), ([1.0, 1.0], 0.0));
    // A value that is not finite from the start leads to the usual error.
    let broken = DampedElastic { k: f64::NAN, c: 0.0 };
    let failure = solve(&broken, (0.0, 1.0), [1.0, 1.0], [0.0; 2])
        .method(Gauss::<2>::new())
        .step(0.1)
        .run()
        .unwrap_err();
    assert!(matches!(failure.error, Error::NotFinite { .. }), "{failure}");
}

#[test]
fn single_precision() {
    let end = solve(&Simple::new(1.0), (0.0_f64, 10.0), [1.3_f32], [0.0])
        .method(Gauss::<3>::new())
        .steps(100)
        .run()
        .unwrap()
        .end;
    assert!((f64::from(end.q[0]) - SIMPLE[0]).abs() < 1e-6, "{end:?}");
}
