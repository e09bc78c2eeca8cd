//! Any number of threads gives the same bits.

use pendulum_runtime::ensemble::Ensemble;
use pendulum_runtime::integrate::Problem;
use pendulum_runtime::motion::{Curve, Sinusoid, Still};
use pendulum_runtime::scene::Scene;
use systems::pendulums::{Double, Hanging};
use systems::problems;
use systems::random::Random;

/// Runs `work` on this number of threads.
fn on<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> R {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

#[test]
fn folds_do_not_depend_on_threads() {
    let double = |k: usize| Problem {
        system: problems::Double::new([1.0, 0.5 + 0.05 * (k % 10) as f64], [1.0, 0.7], 9.8),
        time: (0.0, 1.0 + 0.1 * (k % 7) as f64),
        q: [0.3 * (k % 10) as f64, -0.2 * (k / 10 % 10) as f64],
        v: [0.1, 0.0],
    };
    // The bits of the sum depend on the order of the additions.
    let sums = |n: usize| {
        let values = Ensemble::new(0..n, double).rtol(1e-9);
        let values = values.map(|k, solution| (solution.end.q[0].sin() * solution.end.v[1], k));
        let gathered = values
            .fold(
                || (0.0_f64, Vec::new()),
                |(sum, mut members), (value, k)| {
                    members.push(k);
                    (sum + value, members)
                },
                |(sum, mut members), (later, more)| {
                    members.extend(more);
                    (sum + later, members)
                },
            )
            .unwrap();
        (gathered.value.0.to_bits(), gathered.value.1, gathered.tally)
    };
    let on = |threads: usize| on(threads, || [1, 7, 8, 9, 64, 333].map(sums));
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(7));
}

/// The threads determine the lane of each member.
#[test]
fn lanes_do_not_depend_on_threads() {
    let mut random = Random::new(9);
    let times: Vec<f64> = (0..12).map(|k| 0.5 * f64::from(k)).collect();
    let places: Vec<[f64; 2]> =
        times.iter().map(|_| [random.uniform(0.0, 0.4), random.uniform(0.0, 0.4)]).collect();
    let curve = Curve::catmull_rom(&times, &places).unwrap();
    let starts: Vec<_> = (0..100)
        .map(|_| [0.1, 1.0, 0.3, -2.0, 0.0].map(|low| low + random.uniform(0.0, 1.0)))
        .collect();
    // Some of them go back in time.
    let member = |k: usize| {
        let [start, length, l, q, v] = starts[k];
        let time = if k % 5 == 3 { (start + length, start) } else { (start, start + length) };
        let system = problems::Hung::new(l, 9.81).driven_by(curve.clone());
        Problem { system, time, q: [q], v: [v] }
    };
    let on = |threads: usize| {
        on(threads, || {
            let all = Ensemble::new(0..100, member).rtol(1e-9).shard(4);
            all.map(|_, solution| solution.clone()).collect().unwrap().value
        })
    };
    let one = on(1);
    assert!(one == on(2) && one == on(5));
}

/// Creates a scene of a thousand joints with kinks between ticks, and enough pendulums for every
/// thread.
fn crowd() -> Scene<f64> {
    let mut scene = Scene::new(240.0).unwrap();
    let mut random = Random::new(7);
    for index in 0..1000 {
        let mut time = 0.0;
        let times: [f64; 5] = core::array::from_fn(|_| {
            time += random.uniform(0.05, 0.2);
            time
        });
        let values = times.map(|_| [random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)]);
        let joint = match index % 3 {
            0 => scene.joint(Curve::linear(&times, &values).unwrap()),
            1 => scene.joint(Sinusoid::new(values[0], random.uniform(3.0, 9.0), values[1])),
            _ => scene.joint(Still::new(values[0])),
        };
        for _ in 0..12 {
            let hanging = Hanging::new(0.1, random.uniform(0.05, 1.0));
            scene.hang(joint, hanging, [random.uniform(-1.0, 1.0)], [0.0]).unwrap();
        }
        scene.hang(joint, Double::new(0.1, 0.3, 1e-4), [0.1, 0.2], [0.0, 0.0]).unwrap();
    }
    scene
}

#[test]
fn scenes_do_not_depend_on_threads() {
    let alone = {
        let mut scene = crowd();
        scene.set_parallel(false);
        scene.advance(0.2).unwrap();
        scene.checksum()
    };
    for threads in [1, 2, 3, 7] {
        let many = on(threads, || {
            let mut scene = crowd();
            // Otherwise the load of the machine determines whether several threads are used.
            scene.set_always_fork(true);
            scene.advance(0.2).unwrap();
            scene.checksum()
        });
        assert_eq!(many, alone, "{threads}");
    }
}
