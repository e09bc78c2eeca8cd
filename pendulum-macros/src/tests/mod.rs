//! Tests of the whole expansion.
use crate::expand;
use quote::quote;

#[test]
fn moving_pendulum() {
    let tokens = expand(quote! {
        ::pendulum_runtime;
        pub struct MovingPendulum { m: kg, L: m, g: m/s^2 = 9.81 }
        coordinate θ: rad;
        driven x: [m; 2];
        let y = L * [sin(θ), -cos(θ)];
        kinetic = m/2 * |ẋ + ẏ|^2;
        potential = m*g * (height(x) + height(y));
    });
    println!("{tokens}");
}
