#![allow(mixed_script_confusables)]
#![deny(unused_variables)]

use pendulum_runtime::lagrangian;

lagrangian! {
    #[derive(Clone, Debug)]
    pub struct Pendulum {
        /// The mass cancels, but it is mentioned.
        m: kg,
        L: m,
        /// Nobody damps.
        c: N*m*s,
        _spare: kg,
        #[allow(unused_variables)]
        known: [m; 2],
        h: m = 2,
        g: m/s^2 = 9.81,
    }

    coordinate θ: rad;
    kinetic = m/2 * (L*θ̇)^2;
    potential = -m*g*L*cos(θ);
}

fn main() {}
