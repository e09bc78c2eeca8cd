//! A table with a parameter in a point.

use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Block { m: kg, L: m }
    coordinate x: m;
    table f(x: m): N = [(0, 0), (L, 3)], outside = linear;
    kinetic = m/2*x_dot^2;
    force x = -f(x);
}

fn main() {}
