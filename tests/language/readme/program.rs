use pendulum_runtime::prelude::*;

lagrangian! {
    /// A bob on a spring; the air slows its swing.
    pub struct SpringPendulum { m: kg, k: N/m, L: m, b: kg/s, g: m/s^2 = 9.81 }
    coordinate r: m;
    coordinate theta: rad;
    let bob = r * [sin(theta), -cos(theta)];
    kinetic = m/2 * |dot(bob)|^2;
    potential = m*g*height(bob) + k/2 * (r - L)^2;
    dissipation = b/2 * (r*theta_dot)^2;
}

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pendulum = SpringPendulum::new(1.0, 40.0, 0.5, 0.1);
    println!("{}\n", SpringPendulum::FACTS.equations);
    let motion = solve(&pendulum, (0.0, 2.0), [0.5, 1.0], [0.0; 2]).rtol(1e-9).every(0.4).run()?;
    print!("{}", motion.table());
    Ok(())
}
