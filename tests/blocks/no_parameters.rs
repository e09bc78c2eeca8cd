//! A struct without parameters, named as the scalar usually is, and one inside a function.

use pendulum_runtime::prelude::*;

lagrangian! {
    struct T {}
    coordinate x;
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = -1/|[x, y]|;
}

fn main() {
    lagrangian! {
        struct Local { k }
        coordinate x;
        kinetic = ẋ^2/2;
        potential = k*x^2/2;
    }
    let inner = Local::new(4.0).accelerations(0.0, &[0.5], &[0.0], &());
    assert_eq!(inner, [-2.0]);
    let outer = T::new().accelerations(0.0, &[1.0, 0.0], &[0.0, 0.0], &());
    assert_eq!(outer, [-1.0, 0.0]);
}
