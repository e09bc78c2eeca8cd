//! A constraint that follows from another constraint.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Bob { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    kinetic = m/2*(x_dot^2 + y_dot^2);
    potential = m*g*y;
    constraint rod: |[x, y]| = L;
    constraint again: x^2 + y^2 = L^2;
}

fn main() {}
