//! The stages of the accelerations and Hamilton's equations give the same numbers as the separate
//! functions.

use pendulum_runtime::motion::Sample;
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::Staged;

use systems::random::Random;

lagrangian! {
    /// A driven double pendulum whose second arm is shaken through a spring, with friction.
    pub struct Shaken { m: kg, l: m, k: N/m, c: N*m*s, w: 1/s, g: m/s^2 = 9.81 }
    coordinate θ[2]: rad;
    driven x: [m; 2];
    let y[k in 0..2] = x + sum(j in 0..=k, l*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..2, m/2*|ẏ[k]|^2);
    potential = sum(k in 0..2, m*g*height(y[k])) + k/2*|y[1] - 2*x|^2*cos(w*t);
    dissipation = c/2*(θ̇[0]^2 + (θ̇[1] - θ̇[0])^2);
}

lagrangian! {
    pub struct Chain { m: [kg; 8], l: [m; 8], g: m/s^2 = 9.81 }
    coordinate θ[8]: rad;
    driven x: [m; 2];
    let y[k in 0..8] = x + sum(j in 0..=k, l[j]*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..8, m[k]/2*|ẏ[k]|^2);
    potential = sum(k in 0..8, m[k]*g*height(y[k]));
}

fn compare<S: Staged<N, Scalar = f64, Inputs = (Sample<f64, 2>,)>, const N: usize>(
    system: &S,
    random: &mut Random,
) {
    for _ in 0..100 {
        let mut draw =
            |scale: f64| -> [f64; N] { core::array::from_fn(|_| random.uniform(-scale, scale)) };
        let (q, v) = (draw(3.0), draw(2.0));
        let mut pair = || [random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0)];
        let inputs = (Sample { position: pair(), velocity: pair(), acceleration: pair() },);
        let t = random.uniform(0.0, 10.0);

        let prepared = system.prepare();
        let at_time = S::at_time(t, &inputs);
        let at_position = system.at_position(&prepared, &at_time, t, &q, &inputs);
        let staged =
            system.accelerations_staged(&prepared, &at_time, &at_position, t, &q, &v, &inputs);
        let at = At { t, q: &q, v: &v, inputs: &inputs };
        assert_eq!(staged, system.accelerations(at));

        let p = system.momenta(at);
        let (velocities, rates) = system.hamilton(t, &q, &p, &inputs);
        let expected = system.momentum_rates(at);
        let largest = |values: &[f64; N]| {
            values.iter().fold(1.0f64, |largest, value| largest.max(value.abs()))
        };
        for k in 0..N {
            assert!(
                (velocities[k] - v[k]).abs() < 1e-11 * largest(&v),
                "{} for {}",
                velocities[k],
                v[k]
            );
            assert!(
                (rates[k] - expected[k]).abs() < 1e-10 * largest(&expected),
                "{} for {}",
                rates[k],
                expected[k]
            );
        }
    }
}

#[test]
fn stages_and_hamilton_agree_with_the_whole() {
    let mut random = Random::new(3);
    compare(&Shaken::new(1.3, 0.7, 2.0, 0.3, 5.0), &mut random);
    compare(&Chain::new([1.0, 0.5, 0.7, 1.1, 0.9, 0.4, 0.8, 0.6], [0.4; 8]), &mut random);
}

#[test]
fn what_moves_late_is_not_kept_early() {
    // cos(w·t) contains a parameter; 2·x and similar terms do not.
    assert!(
        size_of::<<Shaken<f64> as Staged<2>>::AtTime>()
            < size_of::<<Shaken<f64> as Staged<2>>::AtPosition>()
    );
}
