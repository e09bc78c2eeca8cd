//! A table of lengths that is applied to a velocity.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Block { m: kg }
    coordinate x: m;
    table f(x: m): N = [(0, 0), (0.1, 3)], outside = linear;
    kinetic = m/2*x_dot^2;
    force x = -f(x_dot);
}

fn main() {}
