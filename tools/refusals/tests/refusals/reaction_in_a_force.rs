//! A reaction in a force.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Bob { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate y: m;
    kinetic = m/2*(x_dot^2 + y_dot^2);
    potential = m*g*y;
    constraint rod: |[x, y]| = L;
    force x = reaction(rod);
}

fn main() {}
