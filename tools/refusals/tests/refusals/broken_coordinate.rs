use pendulum_runtime::prelude::*;

lagrangian! {
    pub struct Oscillator { m, k }

    coordinate x
    kinetic = m/2 * x_dot^2;
    potential = k/2 * x^2;
}

fn main() {
    let _ = Oscillator::new(1.0, 1.0).accelerations(At::of(0.0, &[1.0], &[0.0]));
}
