//! Linear models from control inputs to outputs, compared with textbook models.

use pendulum_runtime::analysis::{Variational, linearize, state_space, variational_size};
use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct CartPole { M: kg, m: kg, L: m, b: N*s/m, g: m/s^2 = 9.81 }
    coordinate s: m;
    coordinate θ: rad;
    driven floor: m;
    input u: N;
    input τ: N*m;
    let tip = [s, floor] + L*[sin(θ), cos(θ)];
    kinetic = M/2*ṡ^2 + m/2*|dot(tip)|^2;
    potential = m*g*height(tip);
    dissipation = b/2*ṡ^2;
    force s = u;
    force θ = τ;
    output tip: [m; 2] = tip;
    output felt: m/s^2 = dot(dot(tip)).x;
    output effort: N = u + τ/L;
}

/// M s̈ = u − bṡ − m g θ + τ'/L and M L θ̈ = −u + bṡ + (M + m) g θ for an upright pole.
#[test]
fn the_inverted_pendulum_of_the_textbook() {
    let (mass, m, l, b, g) = (1.3, 0.4, 0.7, 0.2, 9.81);
    let still = Sinusoid::new([0.0], 1.0, [0.0]);
    let cart = CartPole::new(mass, m, l, b).driven_by(still).controlled_by(|_, q, v| (q[0], v[1]));
    let model = state_space(&cart, 0.0, &[0.2, 0.0], &[0.0, 0.0]);
    #[rustfmt::skip]
    let a = [
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [0.0, -m * g / mass, -b / mass, 0.0],
        [0.0, (mass + m) * g / (mass * l), b / (mass * l), 0.0],
    ];
    let by_torque = (mass + m) / (mass * m * l * l);
    let b =
        [[0.0, 0.0], [0.0, 0.0], [1.0 / mass, -1.0 / (mass * l)], [-1.0 / (mass * l), by_torque]];
    // The output is s̈ + L θ̈ at the top.
    let felt: [f64; 4] = core::array::from_fn(|k| a[2][k] + l * a[3][k]);
    let c = [[1.0, l, 0.0, 0.0], [0.0; 4], felt, [0.0; 4]];
    let d = [[0.0; 2], [0.0; 2], [b[2][0] + l * b[3][0], b[2][1] + l * b[3][1]], [1.0, 1.0 / l]];
    for i in 0..4 {
        for k in 0..4 {
            assert!((model.a[(i, k)] - a[i][k]).abs() < 1e-12, "A {i} {k}: {}", model.a);
            assert!((model.c[(i, k)] - c[i][k]).abs() < 1e-12, "C {i} {k}: {}", model.c);
        }
        for k in 0..2 {
            assert!((model.b[(i, k)] - b[i][k]).abs() < 1e-12, "B {i} {k}: {}", model.b);
            assert!((model.d[(i, k)] - d[i][k]).abs() < 1e-12, "D {i} {k}: {}", model.d);
        }
    }
}

/// Away from rest, the model is the derivative of the motion. The test compares small changes of a
/// run with a constant force with exp(A t).
#[test]
fn the_model_tells_the_next_moment() {
    let cart = |u: f64| {
        CartPole::new(1.3, 0.4, 0.7, 0.2)
            .driven_by(Sinusoid::new([0.1], 5.0, [0.4]))
            .controlled_by(move |_, _, _| (u, 0.1))
    };
    let (q, v, h, small) = ([0.3, 0.5], [0.2, -1.0], 1e-4, 1e-3);
    let model = state_space(&cart(0.7), 0.0, &q, &v);
    let end = |u: f64, q: [f64; 2]| {
        let end = solve(&cart(u), (0.0, h), q, v).rtol(1e-14).atol(1e-16).run().unwrap().end;
        [end.q[0], end.q[1], end.v[0], end.v[1]]
    };
    let base = end(0.7, q);
    let (pushed, moved) = (end(0.7 + small, q), end(0.7, [q[0], q[1] + small]));
    for i in 2..4 {
        let by_force = (pushed[i] - base[i]) / (small * h);
        assert!((by_force - model.b[(i, 0)]).abs() < 2e-3, "{by_force} {}", model.b);
        let by_angle = (moved[i] - base[i]) / (small * h);
        assert!((by_angle - model.a[(i, 1)]).abs() < 0.05, "{by_angle} {}", model.a);
    }
}

lagrangian! {
    pub struct Heater { m: kg, R: ohm }
    coordinate s: m;
    input I: A;
    kinetic = m/2*ṡ^2;
    potential = 0;
    output heat: W = R*I^2;
}

/// The expected derivative is d(R I²)/dI at the held current.
#[test]
fn a_sampled_controller_gives_the_point() {
    let heater = Heater::new(1.0, 0.5).sampled(0.1, |_, _, _| 3.0);
    solve(&heater, (0.0, 0.35), [0.0], [0.0]).run().unwrap();
    let model = state_space(&heater, 0.3, &[0.0], &[0.0]);
    assert_eq!(model.d[(0, 0)], 3.0);
}

lagrangian! {
    /// A point that a constant force draws through air.
    #[derive(Clone)]
    pub struct Drawn { f, c }
    coordinate x;
    coordinate y;
    let v = [ẋ, ẏ];
    kinetic = |v|^2/2;
    potential = -f*x;
    force x = -c*|v|*ẋ;
    force y = -c*|v|*ẏ;
}

/// From rest, ẋ = √(f/c) tanh(√(f c) t); with the velocity u at first, t is later by u/f.
#[test]
fn drag_that_grows_with_the_square_of_the_speed_is_no_obstacle_at_rest() {
    const M: usize = variational_size(2, 0);
    let (f, c, end) = (1.7, 0.6, 2.0);
    let (drawn, rest) = (Drawn::new(f, c), [0.0; 2]);
    assert!(linearize(&drawn, 0.0, &rest, &rest).damping.iter().all(|entry| *entry == 0.0));
    let model = state_space(&drawn, 0.0, &rest, &rest);
    assert!((2..4).all(|i| (0..4).all(|k| model.a[(i, k)] == 0.0)), "{}", model.a);
    let speed = (f / c).sqrt() * ((f * c).sqrt() * end).tanh();
    macro_rules! check {
        ($($method:expr),*) => {$(
            let run = solve(&drawn, (0.0, end), rest, rest).method($method).rtol(1e-8).run();
            let v = run.unwrap().end.v;
            assert!((v[0] - speed).abs() < 1e-6 && v[1] == 0.0, "{}: {v:?}", stringify!($method));
        )*};
    }
    check!(Auto, Picard, Dop853, Rodas4, Taylor::new());
    let variational = Variational::<_, 2, M>::new(drawn);
    let (q, v) = variational.start(rest, rest);
    let run = solve(&variational, (0.0, end), q, v).method(Dop853).rtol(1e-10).run().unwrap();
    let (_, rates) = variational.by_velocity(&run.end, 0);
    let slope = 1.0 - c / f * speed * speed;
    assert!((rates[0] - slope).abs() < 1e-7, "{rates:?} for {slope}");
}
