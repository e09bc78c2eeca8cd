#![allow(mixed_script_confusables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Pendulum { m: kg, L: m, g: m/s^2 = 9.81 }

    coordinate θ: rad;
    kinetic = m/2 * (L*θ̇)^2;
    potential = -m*g*L*cos(θ)
}

lagrangian! {
    pub struct Bob { m: kg }

    kinetic = m/2 * θ̇^2;
    coordinate θ: rad
}

lagrangian! {
    pub struct Cart { m: kg }

    coordinate s: m;
    kinetic = m/2*ṡ^2 +
}

fn main() {
    // The statement has been parsed, so that the type is complete.
    let at = pendulum_runtime::system::At::of(0.0, &[0.0], &[0.0]);
    let _: [f64; 1] = pendulum_runtime::system::System::momenta(&Bob::new(1.0), at);
}
