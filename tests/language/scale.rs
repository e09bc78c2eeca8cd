//! Models of another size: parameters scaled by the metres in their units.

use pendulum_runtime::body::Body;
use pendulum_runtime::error::Error;
use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::prelude::*;

lagrangian! {
    /// A weight on a spring below a hand; the unit of `c` follows from the others.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Toy { m: kg, L: m, k: N/m, c, B: body, w: [m; 2], e: m^(1/2), g: m/s^2 = 9.81 }
    coordinate θ: rad;
    coordinate s: m;
    driven x: [m; 2];
    let y = x + (L + s)*[sin(θ), -cos(θ)] + w;
    kinetic = m/2*|ẏ|^2 + integral(r in B, |dot(x + cis(θ)*r)|^2/2);
    potential = m*g*y.y + k/2*(s - e^2)^2;
    dissipation = c/2*ṡ^2;
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Bare { k, m }
    coordinate x;
    kinetic = m/2*ẋ^2;
    potential = k/2*x^2;
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Numbers {}
    coordinate y;
    kinetic = ẏ^2/2;
    potential = 9.81*y;
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Tabled { m: kg }
    coordinate x: m;
    table f(x: m): N = [(0, 0), (1, 2), (2, 5)], outside = linear;
    kinetic = m/2*ẋ^2;
    force x = -f(x);
}

fn toy() -> Toy {
    let body = Body { mass: 0.3, center: [0.02, 0.05], central: [0.004, 0.001, 0.007] };
    Toy::new(0.2, 0.3, 12.0, 0.4, body, [0.01, 0.02], 0.2)
}

/// The angle and the extension after a time, on a path of a hand that is `scale` times as long and
/// takes `slow` times as long; the extension as a part of the scale.
fn moved(toy: Toy, scale: f64, slow: f64) -> [f64; 2] {
    let hand = Sinusoid::new([0.05 * scale, 0.02 * scale], 7.0 / slow, [0.0, 1.0]);
    let (q, v) = ([0.4, 0.03 * scale], [0.1 / slow, 0.2 * scale / slow]);
    let run = solve(&toy.driven_by(hand), (0.0, slow), q, v).method(Rk4).steps(200).run().unwrap();
    [run.end.q[0], run.end.q[1] / scale]
}

#[test]
fn a_model_of_another_size_does_the_same_at_the_same_times() {
    let here = moved(toy(), 1.0, 1.0);
    for scale in [0.25, 4.0, 0.1, 1.7, 30.0] {
        let there = moved(toy().resized(scale).unwrap(), scale, 1.0);
        // Powers of four, whose root is a power of two, change exponents only.
        let exact = [0.25, 4.0].contains(&scale);
        let off = (0..2).map(|i| (there[i] - here[i]).abs()).fold(0.0, f64::max);
        assert!(if exact { off == 0.0 } else { off < 1e-13 }, "{scale}: {off:e}");
    }
    let other = moved(toy(), 4.0, 1.0);
    assert!(0.01 < (other[0] - here[0]).abs(), "the size matters: {other:?}");
}

#[test]
fn parameters_change_by_the_metres_in_their_units() {
    let Toy { m, L, k, c, B, w, e, g } = toy().resized(4.0).unwrap();
    assert_eq!((m, L, k, c), (0.2, 1.2, 12.0, 0.4));
    assert_eq!((B.mass, B.center, B.central), (0.3, [0.08, 0.2], [0.064, 0.016, 0.112]));
    assert_eq!((w, e, g), ([0.04, 0.08], 0.4, 39.24));
}

/// The small gravity is as if time ran slower by the root of the scale.
#[test]
fn with_gravity_kept_time_runs_by_the_root_of_the_scale() {
    let rigid = |toy: Toy| Toy { k: 0.0, c: 0.0, ..toy };
    let here = moved(rigid(toy()), 1.0, 1.0);
    for scale in [4.0, 1.7] {
        let large = Toy { g: 9.81, ..rigid(toy()).resized(scale).unwrap() };
        let there = moved(large, scale, scale.sqrt());
        let off = (0..2).map(|i| (there[i] - here[i]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-12, "{scale}: {off:e}");
    }
}

#[test]
fn what_has_no_known_units_is_not_scaled() {
    let unit = |quantity| Err(Error::Unit { quantity });
    assert_eq!(Bare::new(1.0, 2.0).resized(2.0).map(|_| ()), unit("k"));
    assert_eq!(Numbers::<f64>::new().resized(2.0).map(|_| ()), unit("y"));
    assert_eq!(Tabled::new(1.0).resized(2.0).map(|_| ()), unit("m"));
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(toy().resized(scale), Err(Error::Setting { name: "resized", .. })));
    }
}
