//! Two figures in addition to the pictures: the error after a reversal of time, and the variation
//! of the energy.

use pendulum_runtime::integrate::Solution;
use pendulum_runtime::prelude::*;

use systems::work_precision::simple;

/// Integrates the pendulum with g/L = 9.8 from (0.05, 0.025) over 1000 s and back with reversed
/// velocity, and prints the distance from the start.
pub fn forward_and_back() {
    fn line<E>(name: &str, mut run: impl FnMut([f64; 1], [f64; 1]) -> Result<Solution<f64, 1>, E>) {
        let (q, v) = (0.05, 0.025);
        let back = run([q], [v]).and_then(|there| run(there.end.q, [-there.end.v[0]]));
        match back {
            Ok(back) => println!(
                "forward and back over 1000 s, {name}: {:.1e}",
                (back.end.q[0] - q).hypot(back.end.v[0] + v)
            ),
            Err(_) => println!("forward and back over 1000 s, {name}: failed"),
        }
    }
    let pendulum = simple();
    line("Dop853 at 1e-14", |q, v| {
        solve(&pendulum, (0.0, 1000.0), q, v).rtol(1e-14).atol(1e-14).run()
    });
    line("Srkn14a, 50 000 steps", |q, v| {
        solve(&pendulum, (0.0, 1000.0), q, v).method(Srkn14a).steps(50_000).run()
    });
}

/// Prints the relative error of the energy of this pendulum from θ = 1.3 over ten million steps,
/// and over the first hundredth of them.
pub fn energy() {
    let pendulum = simple();
    let started = Integrator::new(&pendulum, Srkn14a, 0.0, [1.3], [0.0]);
    let Ok(mut run) =
        started.and_then(|run| run.control(pendulum_runtime::integrate::FixedStep::new(0.02)))
    else {
        return;
    };
    // The error is relative to the kinetic energy at the bottom, because the zero of the potential
    // energy is arbitrary.
    let scale = pendulum.energy_at(0.0, &[1.3], &[0.0]) - pendulum.energy_at(0.0, &[0.0], &[0.0]);
    let start = pendulum.energy_at(0.0, &[1.3], &[0.0]);
    let mut worst = [0.0f64; 2];
    for step in 1..=10_000_000u32 {
        if run.step().is_err() {
            println!("energy over ten million steps: failed");
            return;
        }
        if step % 1000 == 0 {
            let error = ((pendulum.energy_at(run.t(), run.q(), run.v()) - start) / scale).abs();
            worst[1] = worst[1].max(error);
            worst[0] = if step <= 100_000 { worst[1] } else { worst[0] };
        }
    }
    println!(
        "energy, Srkn14a with h = 0.02 s: off by at most {:.1e} in 10⁵ steps, {:.1e} in 10⁷",
        worst[0], worst[1]
    );
}
