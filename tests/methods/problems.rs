//! Generated systems, compared with reference digits.
//!
//! The values were computed with arbitrary-precision Taylor series at two precisions that agree
//! beyond the given digits, and were compared with the closed form, if any (Jacobi and Bessel
//! functions, Kepler's equation). Parameters are exact.

use pendulum_runtime::integrate::{LaneDynamics, Solution, State};
use pendulum_runtime::jet::JetDynamics;
use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::prelude::*;

use systems::distance::distance;
use systems::problems::{
    Cart, Double, Elastic, Five, Forced, HenonHeiles, Hoop, Kapitza, Kepler, Simple, Spherical,
    Triple,
};

lagrangian! {
    /// P07: the pivot moves as ¼ sin 2t, written as a function of time.
    pub struct Shaken {}
    coordinate q;
    let r = [sin(2*t)/4 + sin(q), -cos(q)];
    kinetic = |ṙ|^2/2;
    potential = height(r);
}

lagrangian! {
    /// P17: a pendulum on a horizontally driven pivot.
    pub struct DrivenCart { M, b, a, Ω, g }
    coordinate x;
    lagrangian = M*b^2*ẋ^2/2 + M*b*ẋ*a*Ω*cos(x)*cos(Ω*t) + M*a^2*Ω^2*cos(Ω*t)^2/2 + M*g*b*cos(x);
}

lagrangian! {
    /// P19: a mass matrix that depends on time.
    pub struct Lengthening {}
    coordinate q;
    let l = 1 + t/8;
    lagrangian = l^2*q̇^2/2 - l*q^2/2;
}

lagrangian! {
    /// P21: a term linear in the velocities.
    pub struct Foucault { W }
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2 + W*(x*ẏ - y*ẋ);
    potential = (x^2 + y^2)/2;
}

lagrangian! {
    /// P43: a hardening spring.
    pub struct Duffing {}
    coordinate x;
    kinetic = ẋ^2/2;
    potential = x^2/2 + x^4/4;
}

lagrangian! {
    /// P46: damping inside L.
    pub struct Caldirola { c }
    coordinate q;
    lagrangian = exp(c*t)*(q̇^2 - q^2)/2;
}

/// Asserts that every error is within a hundred tolerances. From t = 50 on, the errors of earlier
/// steps have grown for many periods, and the bound is ten thousand tolerances.
fn check<D: JetDynamics<N, Scalar = f64> + LaneDynamics<N>, const N: usize>(
    dynamics: &D,
    q: [f64; N],
    v: [f64; N],
    rows: &[(f64, &[f64])],
) {
    for &(t, expected) in rows {
        check_within(if t < 50.0 { 100.0 } else { 1e4 }, dynamics, q, v, (t, expected));
    }
}

fn check_within<D: JetDynamics<N, Scalar = f64> + LaneDynamics<N>, const N: usize>(
    factor: f64,
    dynamics: &D,
    q: [f64; N],
    v: [f64; N],
    (t, expected): (f64, &[f64]),
) {
    let problem = || solve(dynamics, (0.0, t), q, v);
    let near = |solution, tolerance| near(&solution, (t, expected), factor * tolerance);
    for tolerance in [1e-6, 1e-8, 1e-10] {
        near(problem().method(Dop853).rtol(tolerance).atol(tolerance).run().unwrap(), tolerance);
    }
    for tolerance in [1e-4, 1e-7, 1e-10, 1e-13] {
        near(problem().method(Picard).rtol(tolerance).run().unwrap(), tolerance);
    }
    for tolerance in [1e-6, 1e-10, 1e-14, 1e-17] {
        // The steps of `Taylor` are long, and the bound is not below rounding.
        near(
            problem().method(Taylor::new()).rtol(tolerance).run().unwrap(),
            3.0 * tolerance.max(1e-15),
        );
    }
}

/// Makes the same checks, and also those of `Dprkn12`, which supports only these systems.
fn check_velocity_free<D, const N: usize>(
    dynamics: &D,
    q: [f64; N],
    v: [f64; N],
    rows: &[(f64, &[f64])],
) where
    D: JetDynamics<N, Scalar = f64, System: VelocityFree<N>> + LaneDynamics<N>,
{
    check(dynamics, q, v, rows);
    for &(t, expected) in rows {
        let problem = || solve(dynamics, (0.0, t), q, v);
        for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
            let bound = if t < 50.0 { 100.0 * tolerance } else { 1e4 * tolerance };
            near(
                &problem().method(Dprkn12).rtol(tolerance).atol(tolerance).run().unwrap(),
                (t, expected),
                bound,
            );
        }
    }
}

fn near<const N: usize>(solution: &Solution<f64, N>, (t, expected): (f64, &[f64]), bound: f64) {
    let Solution { end, stats, .. } = solution;
    assert_eq!(end.t, t);
    for (found, expected) in end.q.iter().chain(&end.v).zip(expected) {
        let error = (found - expected).abs() / expected.abs().max(1.0);
        assert!(error <= bound, "{stats}: {found} for {expected}, error {error:.1e}");
    }
}

#[test]
fn simple_pendulum() {
    let rows: &[(f64, &[f64])] = &[
        (10.0, &[-1.1661603819329576, -0.5023650101124253]),
        (100.0, &[0.029429667179564377, -1.2100149998864702]),
    ];
    check_velocity_free(&Simple::new(1.0), [1.3], [0.0], rows);
}

#[test]
fn rotating_pendulum() {
    let rows: &[(f64, &[f64])] = &[
        (10.0, &[19.87640094701566, 2.298921936358899]),
        (100.0, &[197.0317563811194, 1.728864241968679]),
    ];
    check_velocity_free(&Simple::new(1.0), [0.0], [2.5], rows);
}

#[test]
fn shaken_pendulum() {
    let rows: &[(f64, &[f64])] = &[
        (10.0, &[0.03421055914647234, -1.0207287121330388]),
        (50.0, &[-0.35055563609273926, 0.30835191370301085]),
    ];
    check_velocity_free(&Shaken::new(), [0.5], [0.0], rows);
}

#[test]
fn kapitza_pendulum() {
    let rows: &[(f64, &[f64])] = &[
        (1.0, &[3.2643217255576467, -0.12406205100505013]),
        (10.0, &[3.1362047226008802, 0.2834411532990609]),
    ];
    check_velocity_free(
        &Kapitza::new().driven_by(Sinusoid::new([0.125], 32.0, [core::f64::consts::FRAC_PI_2])),
        [3.0],
        [0.0],
        rows,
    );
}

#[test]
fn forced_pendulum() {
    let rows: &[(f64, &[f64])] = &[
        (10.0, &[-6.168621845615757, 1.737290627979332]),
        (50.0, &[0.7040624384916191, 2.055512968233903]),
    ];
    check(&Forced::new(0.25), [0.0], [0.0], rows);
}

#[test]
fn driven_cart_pendulum() {
    let rows: &[(f64, &[f64])] = &[(10.0, &[-0.18695198168314425, -0.1689817201169616])];
    check_velocity_free(&DrivenCart::new(0.1, 0.2, 0.3, 0.4, 0.5), [0.1], [0.2], rows);
}

#[test]
fn lengthening_pendulum() {
    let rows: &[(f64, &[f64])] = &[(10.0, &[-0.02432864987058898])];
    check(&Lengthening::new(), [1.0], [0.0], rows);
}

#[test]
fn foucault_pendulum() {
    let rows: &[(f64, &[f64])] = &[(10.0, &[-0.321960573374494, 0.7299553718288757])];
    check(&Foucault::new(0.125), [1.0, 0.0], [0.0, 0.0], rows);
}

#[test]
fn double_pendulum() {
    let rows: &[(f64, &[f64])] = &[(
        10.0,
        &[-0.31712675367900844, 0.5024950519166687, -0.15257908881634766, -0.15937377429878158],
    )];
    check(&Double::new([1.0; 2], [1.0; 2], 1.0), [0.5, -0.25], [0.0; 2], rows);
}

#[test]
fn double_pendulum_in_si() {
    let rows: &[(f64, &[f64])] = &[(
        1.0,
        &[-0.6250876998063907, -1.0345850856800123, -3.9222795728879767, -1.3030992486963313],
    )];
    check(
        &Double::new([1.0; 2], [1.0; 2], 9.81),
        [core::f64::consts::FRAC_PI_2; 2],
        [0.0; 2],
        rows,
    );
}

#[test]
fn triple_pendulum() {
    let rows: &[(f64, &[f64])] = &[(
        1.0,
        &[
            0.7570459900109529,
            1.278528340559466,
            1.8356052075854008,
            -0.40236756479337554,
            -0.4958978601485023,
            -0.3897362808874442,
        ],
    )];
    check(&Triple::new([1.0; 3], [1.0; 3], 1.0), [1.0, 1.5, 2.0], [0.0; 3], rows);
}

#[test]
fn five_link_chain() {
    let rows: &[(f64, &[f64])] = &[
        (
            1.0,
            &[
                0.3723126758671864,
                0.38991501623521474,
                0.5707681878095295,
                0.8323376241212982,
                1.094564015322161,
                0.12696172928491076,
                -0.06102077256611663,
                -0.3456872097473087,
                -0.36862025351320055,
                -0.3488793452720735,
            ],
        ),
        (
            10.0,
            &[
                0.05220813867706581,
                0.10782852392603176,
                0.13529170011065064,
                0.37745677737390876,
                0.5996624870071492,
                0.08314433921914811,
                0.17844954577523378,
                0.15080145243260565,
                0.6663452994883651,
                0.950937414991749,
            ],
        ),
    ];
    check(&Five::new([1.0; 5], [1.0; 5], 1.0), [0.25, 0.5, 0.75, 1.0, 1.25], [0.0; 5], rows);
}

#[test]
fn cart_and_pendulum() {
    let rows: &[(f64, &[f64])] = &[
        (
            10.0,
            &[0.3601030233199558, -0.17185634628531316, 0.6685370241174377, -2.0355974422084895],
        ),
        (
            50.0,
            &[0.5406877000437722, -0.7934334143011773, 0.38228567860800683, -1.6350917903483617],
        ),
    ];
    check(&Cart::new(2.0, 1.0, 1.0, 1.0), [0.0, 2.0], [0.0, 0.0], rows);
}

#[test]
fn elastic_pendulum() {
    let rows: &[(f64, &[f64])] = &[
        (10.0, &[1.297416278212364, -0.5542209619402195, 0.2273822556626537, -0.5951884175364048]),
        (
            50.0,
            &[1.2954569154266882, -0.48393643449886625, -0.28262746807212236, 0.6292081204471682],
        ),
    ];
    check(&Elastic::new(8.0, 1.0, 1.0), [1.25, 1.0], [0.0, 0.0], rows);
}

#[test]
fn spherical_pendulum() {
    let rows: &[(f64, &[f64])] = &[
        (10.0, &[0.9967557620902562, 12.384967143243122, 0.0498743741271428, 1.0041898404448073]),
        (50.0, &[0.9248319306082514, 61.902337562644774, 0.2123949024132789, 1.1104707603031594]),
    ];
    check(&Spherical::new(1.0, 1.0), [1.0, 0.0], [0.0, 1.0], rows);
}

#[test]
fn bead_on_a_hoop() {
    let rows: &[(f64, &[f64])] = &[(10.0, &[1.0288601425645025, -0.5335149231704375])];
    check_velocity_free(&Hoop::new(), [0.5], [0.0], rows);
}

#[test]
fn kepler_0_1() {
    let rows: &[(f64, &[f64])] = &[(
        20.0,
        &[0.21988353520083967, 0.9427076846341813, -0.9787659841058176, 0.3287977990962036],
    )];
    check_velocity_free(&Kepler::new(1.0), [0.9, 0.0], [0.0, (1.1_f64 / 0.9).sqrt()], rows);
}

#[test]
fn kepler_0_5() {
    let rows: &[(f64, &[f64])] = &[(
        20.0,
        &[-0.5780432953035362, 0.8633840009194192, -0.9595083730380727, -0.06504915126712091],
    )];
    check_velocity_free(&Kepler::new(1.0), [0.5, 0.0], [0.0, (1.5_f64 / 0.5).sqrt()], rows);
}

#[test]
fn kepler_0_9() {
    let rows: &[(f64, &[f64])] = &[(
        20.0,
        &[-1.2952662509875743, 0.4003938963792322, -0.6775390924707566, -0.12708381542786862],
    )];
    check_velocity_free(
        &Kepler::new(1.0),
        [0.09999999999999998, 0.0],
        [0.0, (1.9_f64 / 0.09999999999999998).sqrt()],
        rows,
    );
}

#[test]
fn duffing_oscillator() {
    let rows: &[(f64, &[f64])] = &[(10.0, &[0.7988747689974143])];
    check_velocity_free(&Duffing::new(), [1.0], [0.0], rows);
}

#[test]
fn caldirola_kanai() {
    let rows: &[(f64, &[f64])] = &[(10.0, &[-0.26907496499090255])];
    check(&Caldirola::new(0.25), [1.0], [0.0], rows);
}

#[test]
fn henon_heiles() {
    let rows: &[(f64, &[f64])] = &[
        (
            10.0,
            &[0.03670891970302608, 0.6826922399017149, 0.04716396717584516, -0.025305958813863046],
        ),
        (
            100.0,
            &[-0.040194237876068815, 0.6790169217720217, 0.038450928951859836, 0.04859483155300364],
        ),
    ];
    check_velocity_free(&HenonHeiles::new(1.0), [0.1, 0.0], [0.0, 0.5], rows);
}

#[test]
fn kepler_0_3() {
    check_velocity_free(
        &Kepler::new(1.0),
        [0.7, 0.0],
        [0.0, (1.3_f64 / 0.7).sqrt()],
        &[(
            20.0,
            &[-0.17770273571404116, 0.9467784719905893, -1.0302941631929696, 0.12110748900539521],
        )],
    );
}

/// Tests every method that supports the system, with steps and tolerances that are known to
/// suffice.
#[test]
fn general_methods_reach_the_double_pendulum() {
    let double = Double::new([1.0; 2], [1.0; 2], 1.0);
    let expected = [
        -0.317126753679008418729,
        0.502495051916668693315,
        -0.152579088816347670822,
        -0.159373774298781573885,
    ];
    let error = |end: State<f64, 2>| distance((end.q, end.v), &expected);
    let problem = || solve(&double, (0.0, 10.0), [0.5, -0.25], [0.0; 2]);
    assert!(error(problem().method(Rk4).steps(4000).run().unwrap().end) < 1e-9);
    assert!(error(problem().method(Dop853).rtol(1e-13).atol(1e-13).run().unwrap().end) < 1e-11);
    assert!(error(problem().method(SymplecticEuler).steps(100_000).run().unwrap().end) < 1e-2);
}
