//! A struct without parameters that has the usual name of the scalar, and a struct inside a
//! function.

use pendulum_runtime::prelude::*;

lagrangian! {
    struct T {}
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = -1/|[x, y]|;
}

#[allow(dead_code)]
const L: f64 = 3.0;

lagrangian! {
    /// A parameter beside a constant of the same name.
    struct Beside { L }
    coordinate x;
    driven X: [1; 2];
    kinetic = L^2*(ẋ + inner(dot(X), [1, 0]))^2/2;
}

fn main() {
    let beside = Beside::new(2.0).driven_by(motion::Still::new([0.0, 1.0]));
    assert_eq!(beside.system.L, 2.0);
    lagrangian! {
        struct Local { k }
        coordinate x;
        kinetic = ẋ^2/2;
        potential = k*x^2/2;
    }
    let inner = Local::new(4.0).accelerations(At::of(0.0, &[0.5], &[0.0]));
    assert_eq!(inner, [-2.0]);
    let outer = T::new().accelerations(At::of(0.0, &[1.0, 0.0], &[0.0, 0.0]));
    assert_eq!(outer, [-1.0, 0.0]);
}
