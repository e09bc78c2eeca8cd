//! The pendulums that the tests of scenes hang up.

use pendulum_runtime::lagrangian;

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Simple { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    let y = L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = m*g*height(y);
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Hanging { m: kg, L: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    driven x: [m; 2];
    let y = x + L * [sin(θ), -cos(θ)];
    kinetic = m/2 * |ẏ|^2;
    potential = m*g*height(y);
}

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Double { m: kg, l: m, c: N*m*s, g: m/s^2 = 9.81 }
    coordinate θ[2]: rad;
    driven x: [m; 2];
    let y[k in 0..2] = x + sum(j in 0..=k, l*[sin(θ[j]), -cos(θ[j])]);
    kinetic = sum(k in 0..2, m/2*|ẏ[k]|^2);
    potential = sum(k in 0..2, m*g*height(y[k]));
    dissipation = c/2*(θ̇[0]^2 + (θ̇[1] - θ̇[0])^2);
}
