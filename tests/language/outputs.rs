//! Outputs, compared with derivatives by dual numbers and with formulas written by hand.

use pendulum_runtime::motion::{Function, Side, Sinusoid};
use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::Dual;
use pendulum_runtime::system::{Purpose, System};
use pendulum_runtime::time::Time;
use systems::random::Random;

lagrangian! {
    pub struct Crane { m: kg, L: m, k: N/m, g: m/s^2 = 9.81 }
    coordinate r: m;
    coordinate θ: rad;
    driven x: [m; 2];
    input u: N;
    let y = x + (L + r)*[sin(θ), -cos(θ)];
    kinetic = m/2*|ẏ|^2;
    potential = m*g*height(y) + k/2*r^2;
    force r = u;

    /// The place of the load.
    output tip: [m; 2] = y;
    output velocity: [m/s; 2] = ẏ;
    output felt: [m/s^2; 2] = dot(ẏ);
    output load: N = m*(g + height(dot(dot(y))));
    output turn: [1; 2] = cis(θ)^2;
    output angles[k in 0..3]: rad = k*θ;
    output places[k in 0..2]: [m; 2] = x + k*(y - x);
    output bend: 1/s^2 = θ̈;
    output drive: W = u*ṙ;
}

lagrangian! {
    /// Without driven inputs.
    pub struct Swing { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    let y = L*[sin(θ), -cos(θ)];
    kinetic = m/2*|ẏ|^2;
    potential = m*g*height(y);
    output tip: [m; 2] = y;
    output tension: N = m*(g*cos(θ) + L*θ̇^2);
    output same: N = -m*inner(dot(ẏ) + [0, g], y)/L;
}

fn crane() -> Crane {
    Crane::new(1.3, 0.8, 40.0)
}

/// Returns y and, by dual numbers along the motion, ẏ and ÿ.
fn place(crane: &Crane, t: f64, q: [f64; 2], v: [f64; 2], a: [f64; 2]) -> [[f64; 2]; 3] {
    type Two = Dual<Dual<f64>>;
    // t + ε + ε' with x(t) = (sin 3t / 5, t²/4).
    let number = |value: f64, first: f64, second: f64| Dual {
        value: Dual { value, derivative: first },
        derivative: Dual { value: first, derivative: second },
    };
    let time = number(t, 1.0, 0.0);
    let [r, θ]: [Two; 2] = [0, 1].map(|i| number(q[i], v[i], a[i]));
    let constant = |value: f64| number(value, 0.0, 0.0);
    let x = [(constant(3.0) * time).sin() * constant(0.2), time * time * constant(0.25)];
    let length = constant(crane.L) + r;
    let y = [x[0] + length * θ.sin(), x[1] - length * θ.cos()];
    [y.map(|y| y.value.value), y.map(|y| y.value.derivative), y.map(|y| y.derivative.derivative)]
}

#[test]
fn outputs_are_the_derivatives_of_positions() {
    let driven = crane()
        .driven_by(
            Function::new(|t: f64| [0.2 * (3.0 * t).sin(), 0.25 * t * t])
                .velocity(|t| [0.6 * (3.0 * t).cos(), 0.5 * t])
                .acceleration(|t| [-1.8 * (3.0 * t).sin(), 0.5]),
        )
        .controlled_by(|t, q, v| 3.0 * t - q[0] + v[1]);
    let (system, mut random) = (crane(), Random::new(7));
    for _ in 0..10_000 {
        let mut any = || random.uniform(-1.5, 1.5);
        let (t, q, v) = (any(), [0.2 * any(), any()], [any(), any()]);
        let u = 3.0 * t - q[0] + v[1];
        let a = driven.accelerations_at(Time::new(t), Side::After, &q, &v);
        let [y, dy, ddy] = place(&system, t, q, v, a);
        let near = |found: f64, expected: f64| {
            let size = 1.0 + expected.abs() + a[0].abs() + a[1].abs();
            assert!((found - expected).abs() < 1e-13 * size, "{found} {expected}");
        };
        for i in 0..2 {
            near(driven.tip(t, &q, &v)[i], y[i]);
            near(driven.velocity(t, &q, &v)[i], dy[i]);
            near(driven.felt(t, &q, &v)[i], ddy[i]);
            near(driven.places(t, &q, &v)[1][i], y[i]);
        }
        near(driven.load(t, &q, &v), system.m * (system.g + ddy[1]));
        near(driven.turn(t, &q, &v)[0], (2.0 * q[1]).cos());
        near(driven.turn(t, &q, &v)[1], (2.0 * q[1]).sin());
        near(driven.angles(t, &q, &v)[2], 2.0 * q[1]);
        near(driven.bend(t, &q, &v), a[1]);
        near(driven.drive(t, &q, &v), u * v[0]);
        // The forces on the load are k r of the spring, gravity and the input.
        let along = system.m * (ddy[0] * q[1].sin() - ddy[1] * q[1].cos());
        near(along, u - system.k * q[0] + system.m * system.g * q[1].cos());
    }
}

#[test]
fn a_system_without_inputs_needs_none() {
    let (swing, mut random) = (Swing::new(0.4, 1.1), Random::new(3));
    for _ in 0..1000 {
        let (q, v) = ([random.uniform(-3.0, 3.0)], [random.uniform(-3.0, 3.0)]);
        assert!((swing.tip(0.0, &q, &v)[0] - q[0].sin() * swing.L).abs() < 1e-15);
        let (tension, same) = (swing.tension(0.0, &q, &v), swing.same(0.0, &q, &v));
        assert!((tension - same).abs() < 1e-13 * (1.0 + tension.abs()), "{tension} {same}");
    }
    let wide: Swing<f32> = swing.map(|parameter| parameter as f32);
    assert!(
        (f64::from(wide.tension(0.0, &[0.3], &[0.2])) - swing.tension(0.0, &[0.3], &[0.2])).abs()
            < 1e-5
    );
}

#[test]
fn facts_list_the_outputs() {
    let names: Vec<_> = Crane::FACTS.outputs.iter().map(|output| output.name).collect();
    assert_eq!(
        names,
        ["tip", "velocity", "felt", "load", "turn", "angles", "places", "bend", "drive"]
    );
    let outputs = Crane::FACTS.outputs;
    assert_eq!((outputs[0].unit, outputs[0].members, outputs[0].components), ("m", None, Some(2)));
    assert_eq!(outputs[3].names(), ["load"]);
    assert_eq!(outputs[5].names(), ["angles[0]", "angles[1]", "angles[2]"]);
    assert_eq!(outputs[6].names(), ["places[0].x", "places[0].y", "places[1].x", "places[1].y"]);
    assert_eq!(outputs[6].count(), 4);
}

#[test]
fn outputs_by_index_are_the_methods() {
    let driven = crane()
        .driven_by(Sinusoid::new([0.1, 0.2], 4.0, [0.3, 0.1]))
        .controlled_by(|_, q, _| -q[0]);
    let (t, q, v) = (0.3, [0.05, 0.4], [0.2, -1.0]);
    let inputs = driven.inputs_with(Time::new(t), Side::After, Purpose::Outputs, &q, &v);
    let at = At { t, q: &q, v: &v, inputs: &inputs };
    let mut values = [f64::NAN; 5];
    driven.system().output(6, at, &mut values);
    let places = driven.places(t, &q, &v);
    assert_eq!(values[..4], [places[0][0], places[0][1], places[1][0], places[1][1]]);
    assert!(values[4].is_nan());
    // An index without an output and a list that is too short change no values.
    driven.system().output(99, at, &mut values);
    driven.system().output(6, at, &mut []);
    assert_eq!(values[..2], places[0]);
}
