//! Solutions as comma-separated values.

use pendulum_runtime::prelude::*;
use pendulum_runtime::scalar::DoubleDouble;

mod blocks {
    use pendulum_runtime::lagrangian;

    lagrangian! {
        #[derive(Clone)]
        pub struct Spring { k: N/m, m: kg }
        coordinate x: m;
        kinetic = m/2*ẋ^2;
        potential = k/2*x^2;
    }
}

use blocks::Spring;

#[test]
fn every_bit_comes_back() {
    let spring = Spring::new(4.0, 1.0);
    let solution = solve(&spring, (0.0, 2.0), [1e-20], [0.3]).every(0.1).run().unwrap();
    let mut text = Vec::new();
    let energy = solution.energy(&spring);
    let table = solution.table().with("energy, total", "J", energy.clone()).unwrap();
    table.to_csv(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("t [s],x [m],ẋ [m/s],\"energy, total [J]\""));
    for (state, energy) in solution.iter().zip(energy) {
        let line = lines.next().unwrap();
        let numbers: Vec<f64> = line.split(',').map(|text| text.parse().unwrap()).collect();
        assert_eq!(numbers, [state.t, state.q[0], state.v[0], energy]);
    }
    assert_eq!(lines.next(), None);
    assert!(text.contains("\n0,1e-20,0.3,"), "{text}");
}

#[test]
fn short_scalars_keep_their_times_and_long_ones_their_digits() {
    let spring = Spring::<f32>::new(4.0, 1.0);
    let solution = solve(&spring, (1000.0, 1000.2), [0.1], [0.3]).every(0.1).run().unwrap();
    let mut text = Vec::new();
    solution.to_csv(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    assert!(text.contains("\n1000.1,") && text.contains("\n1000,0.1,0.3\n"), "{text}");

    let number = DoubleDouble::from_f64;
    let spring = Spring { k: number(4.0), m: number(1.0) };
    let third = number(1.0) / number(3.0);
    let solution = solve(&spring, (0.0, 0.0), [third], [number(0.0)]).run().unwrap();
    let mut text = Vec::new();
    solution.to_csv(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    assert!(text.contains("0.3333333333333333333333333333333"), "{text}");
}
