//! Outputs along a solution, as columns and in tables.

use pendulum_runtime::motion::Curve;
use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Lift { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven h: m;
    input τ: N*m;
    let y = [L*sin(θ), h - L*cos(θ)];
    kinetic = m/2*|ẏ|^2;
    potential = m*g*height(y);
    force θ = τ;
    output tip: [m; 2] = y;
    output speed: m/s = |ẏ|;
    output torque: N*m = τ;
    output both[k in 0..2]: m = k*height(y);
}

#[test]
fn outputs_are_columns() {
    let lift = Lift::new(1.0, 0.5)
        .driven_by(Curve::linear(&[0.0, 1.0, 2.0], &[[0.0], [0.5], [0.0]]).unwrap())
        .sampled(0.25, |_, q, v| -2.0 * q[0] - v[0]);
    let run = solve(&lift, (0.0, 2.0), [0.3], [0.0]).rtol(1e-10).every(0.2).run().unwrap();
    let table = run.table_with_outputs(&lift).unwrap();
    let header: Vec<String> = table.header().collect();
    assert_eq!(
        header[3..],
        ["tip.x [m]", "tip.y [m]", "speed [m/s]", "torque [N*m]", "both[0] [m]", "both[1] [m]"]
    );
    for name in ["tip.x", "tip.y", "speed", "torque", "both[0]", "both[1]"] {
        assert_eq!(table.column(name).unwrap(), run.output(&lift, name).unwrap());
    }
    let torque = run.output(&lift, "torque").unwrap();
    for (index, state) in run.iter().enumerate() {
        let tip = lift.tip(state.t, &state.q, &state.v);
        assert_eq!(table.column("tip.x").unwrap()[index], tip[0]);
        assert!((tip[0] - 0.5 * state.q[0].sin()).abs() < 1e-15);
        assert_eq!(table.column("both[1]").unwrap()[index], tip[1]);
    }
    // The controller holds its value from 1.0 s to 1.2 s and has another value at 1.4 s.
    assert_eq!(torque[5], torque[6]);
    assert_ne!(torque[6], torque[7]);
    assert!((torque[0] + 0.6).abs() < 1e-15);
}

#[test]
fn an_unknown_output_has_a_nearest_one() {
    let lift = Lift::new(1.0, 0.5)
        .driven_by(Curve::linear(&[0.0, 1.0], &[[0.0], [0.5]]).unwrap())
        .controlled_by(|_, _, _| 0.0);
    let run = solve(&lift, (0.0, 1.0), [0.3], [0.0]).run().unwrap();
    let message = run.output(&lift, "sped").unwrap_err().to_string();
    assert!(message.contains("`sped`") && message.contains("`speed`"), "{message}");
    let message = run.output(&lift, "tip").unwrap_err().to_string();
    assert!(message.contains("tip.x"), "{message}");
}
