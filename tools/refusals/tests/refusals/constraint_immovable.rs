//! A constraint without a coordinate.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Bob { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    kinetic = m/2*(x_dot^2 + y_dot^2);
    potential = m*g*y;
    constraint still: L = L + 0*L*t*g*t/L;
}

fn main() {}
