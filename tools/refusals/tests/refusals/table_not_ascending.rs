//! A table with a point twice.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Block { m: kg }
    coordinate x: m;
    table f(x: m): N = [(0, 0), (0.1, 3), (0.1, 4)], outside = linear;
    kinetic = m/2*x_dot^2;
    force x = -f(x);
}

fn main() {}
