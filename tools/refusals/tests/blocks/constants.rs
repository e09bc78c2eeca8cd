//! Constants and unit structs of the user with the names of parameters and of bindings in generated
//! code.

#![allow(non_upper_case_globals, non_camel_case_types, dead_code, mixed_script_confusables)]

use pendulum_runtime::prelude::*;
use pendulum_runtime::system::Jacobians;

const t: f64 = 1.0;
const q: f64 = 1.0;
const v: [f64; 2] = [1.0, 2.0];
const p: u8 = 0;
const g: f64 = 9.81;
const k: usize = 0;
const inputs: f64 = 0.0;
const value: i32 = 0;
const values: i32 = 0;
const all: i32 = 0;
const entries: i32 = 0;
const column: i32 = 0;
const row: i32 = 0;
const map: i32 = 0;
const prepared: i32 = 0;
static at_time: i32 = 0;
static at_position: i32 = 0;
struct both;
struct columns;
struct index;
struct system;
struct lifted;
struct parameter;
struct acceleration;

lagrangian! {
    struct Beside { m, g, k = 2, c: [1; 2] }
    coordinate θ;
    driven system;
    kinetic = m*(θ̇ + dot(system))^2/2;
    potential = m*g*(1 - cos(θ)) + k*θ^2*c.x*c.y;
}

// Long enough for Jacobians to be computed by dual numbers.
lagrangian! {
    struct Chain { l, q: [1; 8] }
    coordinate θ[8];
    driven v;
    let y[j in 0..8] = sum(n in 0..=j, l*[sin(θ[n]), -cos(θ[n])]) + [v, 0];
    kinetic = sum(j in 0..8, q[j]*|ẏ[j]|^2/2);
    potential = sum(j in 0..8, q[j]*height(y[j]));
}

mod bare {
    #![no_implicit_prelude]

    ::pendulum_runtime::lagrangian! {
        pub struct Beside { m, L, g, c: [1; 2] }
        coordinate θ;
        coordinate z;
        driven x: [1; 2];
        kinetic = m*(L^2*θ̇^2 + ż^2 + inner(ẋ, ẋ))/2;
        potential = m*g*L*(1 - cos(θ))*c.x;
    }

    ::pendulum_runtime::lagrangian! {
        pub struct Chain { l, q: [1; 8] }
        coordinate θ[8];
        let y[j in 0..8] = sum(n in 0..=j, l*[sin(θ[n]), -cos(θ[n])]);
        kinetic = sum(j in 0..8, q[j]*|ẏ[j]|^2/2);
        potential = sum(j in 0..8, q[j]*height(y[j]));
    }
}

fn main() {
    let beside = Beside::new(2.0, 10.0, [1.0, 0.5]).driven_by(motion::Still::new([0.0]));
    assert_eq!((beside.system.g, beside.system.k), (10.0, 2.0));
    let bare = bare::Beside::new(2.0, 1.0, 10.0, [1.0, 0.5]);
    let still = (motion::Sample::<f64, 2>::zero(),);
    let mut conserved = [0.0; 1];
    bare.conserved(At { t: 0.0, q: &[0.1, 0.0], v: &[0.0, 3.0], inputs: &still }, &mut conserved);
    assert_eq!(conserved, [6.0]);
    let chain = bare::Chain::new(1.0, [1.0; 8]);
    let other = Chain::new(1.0, [1.0; 8]);
    let (angles, rates) = ([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8], [0.5; 8]);
    let jacobian = chain.position_jacobian(At::of(0.0, &angles, &rates));
    assert_eq!(jacobian, other.position_jacobian(At { t: 0.0, q: &angles, v: &rates, inputs: &(motion::Sample::zero(),) }));
    let mut slopes = [[0.0; 8]; 9];
    chain.parameter_jacobian(At::of(0.0, &angles, &rates), &mut slopes);
    assert!(slopes[0][0] != 0.0);
}
