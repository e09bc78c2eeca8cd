//! Columns by name, tables, and energies along a solution.

use pendulum_runtime::integrate::ColumnError;
use pendulum_runtime::motion::Curve;
use pendulum_runtime::prelude::*;

mod blocks {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        /// A bead that slides on a rod which turns.
        pub struct Arm { m: kg, k: N/m, l: m, c: N*s/m, b: kg*m^2 }
        coordinate φ: rad;
        coordinate r: m;
        coordinate angle;
        let y = r*[cos(φ), sin(φ)];
        kinetic = m/2*|ẏ|^2 + b/2*angle_dot^2;
        potential = k/2*(r - l)^2;
        dissipation = c/2*ṙ^2;
    }

    lagrangian! {
        /// Written in ASCII.
        pub struct Chain { g }
        coordinate theta[3]: rad;
        let y[k in 0..3] = sum(j in 0..=k, [sin(theta[j]), -cos(theta[j])]);
        kinetic = sum(k in 0..3, |dot(y[k])|^2/2);
        potential = sum(k in 0..3, g*height(y[k]));
    }

    lagrangian! {
        /// A mass pulled by a spring, whose other end jerks.
        pub struct Pulled { k, m }
        coordinate x;
        driven u: [1; 2];
        kinetic = m/2*|[ẋ, 0] + u̇|^2;
        potential = k/2*x^2;
    }
}

use blocks::*;

fn arm() -> (Arm, Solution<f64, 3>) {
    let arm = Arm::new(2.0, 30.0, 1.0, 0.0, 2.0);
    let solution = solve(&arm, (0.0, 2.0), [0.1, 1.2, 0.0], [0.7, 0.0, 0.3])
        .rtol(1e-11)
        .every(0.1)
        .run()
        .unwrap();
    (arm, solution)
}

#[test]
fn coordinates_and_velocities_have_columns_in_every_spelling() {
    let (_, solution) = arm();
    let columns = |names: &[&str]| -> Vec<Vec<f64>> {
        names.iter().map(|name| solution.column(name).unwrap()).collect()
    };
    let of = |rows: &[[f64; 3]], index: usize| -> Vec<f64> {
        rows.iter().map(|row| row[index]).collect()
    };
    for found in columns(&["φ", "phi", " ϕ "]) {
        assert_eq!(found, of(&solution.q, 0));
    }
    for found in columns(&["φ̇", "phi_dot", "dot(φ)"]) {
        assert_eq!(found, of(&solution.v, 0));
    }
    for found in columns(&["ṙ", "r\u{307}", "r_dot"]) {
        assert_eq!(found, of(&solution.v, 1));
    }
    assert_eq!(columns(&["angle_dot"])[0], of(&solution.v, 2));
    assert_eq!(columns(&["t"])[0], solution.t);
    assert_eq!(solution.column_names(), ["t", "φ", "r", "angle", "φ̇", "ṙ", "angle_dot"]);
}

#[test]
fn members_of_families_have_columns() {
    let chain = Chain::new(9.81);
    let solution = solve(&chain, (0.0, 0.5), [0.3, 0.2, 0.1], [0.0; 3]).every(0.1).run().unwrap();
    let third: Vec<f64> = solution.v.iter().map(|v| v[2]).collect();
    for name in ["theta_dot[2]", "θ̇[2]", "dot(θ[2])"] {
        assert_eq!(solution.column(name).unwrap(), third, "{name}");
    }
    // A block in ASCII has names in ASCII.
    assert_eq!(solution.column_names()[4], "theta_dot[0]");
    let message = solution.column("θ").unwrap_err().to_string();
    assert_eq!(message, "`θ` is a family; name a member, `theta[0]` … `theta[2]`");
    let message = solution.column("theta[7]").unwrap_err().to_string();
    assert!(
        message.starts_with("there is no column `theta[7]`; did you mean `theta["),
        "{message}"
    );
}

#[test]
fn an_unknown_column_is_an_error_with_the_nearest_name() {
    let (_, solution) = arm();
    let message = |name: &str| solution.column(name).unwrap_err().to_string();
    assert_eq!(message("angel"), "there is no column `angel`; did you mean `angle`?");
    assert_eq!(message("R"), "there is no column `R`; did you mean `r`?");
    assert_eq!(message("dr"), "there is no column `dr`; did you mean `ṙ`?");
    assert_eq!(message("v_r"), "there is no column `v_r`; did you mean `ṙ`?");
    assert_eq!(
        message("velocity"),
        "there is no column `velocity`; there are `t`, `φ`, `r`, `angle`, `φ̇`, `ṙ`, `angle_dot`; outputs of the system come by `solution.output(&system, name)`, its energy by `solution.energy(&system)`"
    );
    assert_eq!(
        message("φ̈"),
        "a solution holds no accelerations, so there is no column `φ̈`; evaluate them by `solution.accelerations(&system)`"
    );
    let ColumnError { nearest, .. } = solution.column("Φ_dot").unwrap_err();
    assert_eq!(nearest.as_deref(), Some("φ̇"));
}

#[test]
fn solutions_iterate() {
    let (_, solution) = arm();
    assert_eq!((solution.len(), solution.is_empty()), (21, false));
    let mut count = 0;
    for state in &solution {
        assert_eq!((state.q, state.v), (solution.q[count], solution.v[count]));
        count += 1;
    }
    assert_eq!(count, 21);
    assert_eq!(solution.iter().next_back(), Some(solution.end));
    assert_eq!(solution.iter().nth(3), solution.get(3));
    assert_eq!(solution.iter().rev().skip(5).len(), 16);
    assert_eq!(solution.get(21), None);
}

#[test]
fn energy_and_momentum_stay_and_power_is_the_slope_of_the_energy() {
    let (arm, solution) = arm();
    // m/2 (r² φ̇² + ṙ² + ȧ²) + k/2 (r − 1)², and the angular momentum m r² φ̇.
    for (energy, state) in solution.energy(&arm).iter().zip(&solution) {
        let ([_, r, _], [w, u, a]) = (state.q, state.v);
        let expected = r * r * w * w + u * u + a * a + 15.0 * (r - 1.0) * (r - 1.0);
        assert!((energy - expected).abs() < 1e-13);
        assert!((energy - solution.energy(&arm)[0]).abs() < 1e-9);
    }
    let conserved = solution.conserved(&arm);
    assert_eq!(conserved.len(), 2);
    let momentum = 2.0 * 1.2 * 1.2 * 0.7;
    assert!(conserved[0].iter().all(|found| (found - momentum).abs() < 1e-9));
    assert!(conserved[1].iter().all(|found| (found - 0.6).abs() < 1e-12));

    let damped = Arm::new(2.0, 30.0, 1.0, 0.5, 2.0);
    let run = solve(&damped, (0.0, 1.0), [0.1, 1.2, 0.0], [0.7, 0.0, 0.3]);
    let solution = run.rtol(1e-12).every(1e-3).run().unwrap();
    let (energy, power) = (solution.energy(&damped), solution.power(&damped).unwrap());
    for k in 1..solution.len() - 1 {
        let slope = (energy[k + 1] - energy[k - 1]) / 2e-3;
        assert!((slope - power[k]).abs() < 1e-4, "{slope} for {}", power[k]);
        assert!((power[k] + 0.5 * solution.v[k][1] * solution.v[k][1]).abs() < 1e-14);
    }
}

#[test]
fn the_first_of_two_states_at_a_kink_has_the_energy_before_it() {
    // u̇ jumps from 1 to −1 at t = 1; the velocity ẋ jumps by 2 with the momentum m (ẋ + u̇) kept.
    let knots = Curve::linear(&[0.0, 1.0, 2.0], &[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]]).unwrap();
    let system = Pulled::new(1.0, 1.0).driven_by(knots);
    let solution = solve(&system, (0.5, 1.5), [0.0], [0.0]).every_step().run().unwrap();
    let kink = solution.t.windows(2).position(|pair| pair[0] == pair[1]).unwrap();
    // L = (ẋ + u̇)²/2 − x²/2, so that the Jacobi integral is ẋ²/2 − u̇²/2 + x²/2.
    let energy = solution.energy(&system);
    for index in [kink, kink + 1] {
        let (x, v) = (solution.q[index][0], solution.v[index][0]);
        assert!((energy[index] - 0.5 * (v * v - 1.0 + x * x)).abs() < 1e-14);
    }
    assert!((solution.v[kink + 1][0] - solution.v[kink][0] - 2.0).abs() < 1e-12);
}

#[test]
fn tables_have_headers_units_and_further_columns() {
    let (arm, solution) = arm();
    let header: Vec<String> = solution.table().header().collect();
    assert_eq!(header, ["t [s]", "φ [rad]", "r [m]", "angle", "φ̇ [rad/s]", "ṙ [m/s]", "angle_dot"]);
    let table = solution.table().with("energy", "J", solution.energy(&arm)).unwrap();
    assert_eq!(table.rows(), 21);
    assert_eq!(table.column("energy").unwrap(), solution.energy(&arm));
    assert_eq!(table.row(2).nth(1), Some(solution.q[2][0]));
    let error = table.clone().with("short", "", vec![1.0]).unwrap_err().to_string();
    assert_eq!(error, "the column `short` has 1 numbers, the table 21 rows; give one number a row");
    assert!(table.column("enrgy").unwrap_err().to_string().contains("did you mean `energy`?"));
}

#[test]
fn a_solution_prints_a_short_table() {
    let pulled = Pulled::new(1.0, 1.0)
        .driven_by(Curve::linear(&[0.0, 1.0], &[[0.0, 0.0], [0.0, 0.0]]).unwrap());
    let solution = solve(&pulled, (0.0, 12.0), [1.0], [0.0]).rtol(1e-10).every(1.0).run().unwrap();
    let text = solution.to_string();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 1 + 5 + 1 + 5 + 2, "{text}");
    assert_eq!(lines[0], "  t [s]           x          ẋ");
    assert_eq!(lines[2], "1.00000    0.540302  -0.841471");
    assert_eq!(lines[6], "… 3 rows more …");
    assert_eq!(lines[12], "Completed at t = 12");
    assert!(lines[13].contains("steps"), "{text}");
    assert!(format!("{:.3}", solution.table()).contains(" 0.540 "));
    let all = format!("{:#}", solution.table());
    assert_eq!(all.lines().count(), 1 + 13, "{all}");
    let energy = solution.output(&pulled, "energy").unwrap_err().to_string();
    assert!(energy.starts_with("there is no column `energy`; there "), "{energy}");
    assert!(energy.ends_with("the energy by `solution.energy(&system)`"), "{energy}");
}

#[test]
fn nalgebra_comes_along() {
    let matrix: pendulum_runtime::nalgebra::Matrix2<f64> =
        pendulum_runtime::nalgebra::Matrix2::identity();
    assert_eq!(matrix.trace(), 2.0);
}
