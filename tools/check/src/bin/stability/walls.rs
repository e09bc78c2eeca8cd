//! Limits that move with time: narrow walls and vibrating floors.

use ::systems::problems::Lifted;
use ::systems::random::Random;
use check::report::{Report, Scale, Test};
use pendulum_runtime::integrate::Failure;
use pendulum_runtime::motion::Sinusoid;
use pendulum_runtime::prelude::*;

pub(crate) const TESTS: &[Test] = &[Test { id: "S30", title: "moving walls", run: walls }];

lagrangian! {
    /// A ball at rest until a narrow wall passes.
    pub struct Paddle { m, c, w, h, e }
    coordinate y;
    kinetic = m*ẏ^2/2;
    limit wall: y >= h*exp(-((t-c)/w)^2), restitution = e;
}

lagrangian! {
    /// A ball over a vibrating floor.
    pub struct Vibrating { a, ω, e, g }
    coordinate y;
    kinetic = ẏ^2/2;
    potential = g*y;
    limit floor: y >= a*sin(ω*t), restitution = e;
}

lagrangian! {
    /// A ball over a floor with crests that are narrower than their period.
    pub struct Crests { h, ω }
    coordinate y;
    kinetic = ẏ^2/2;
    potential = y;
    limit floor: y >= h*cos(ω*t)^100, restitution = 1;
}

lagrangian! {
    /// A ball over a floor that vibrates faster and faster.
    pub struct Chirp { h, ω }
    coordinate y;
    kinetic = ẏ^2/2;
    potential = y;
    limit floor: y >= h*sin(ω*t^2)/20, restitution = 1;
}

/// The number of random members of each family.
const MEMBERS: usize = 60;

/// The worst of several runs over a floor.
#[derive(Default)]
struct Worst {
    /// How far a ball falls below a wall.
    depth: f64,
    failed: f64,
}

impl Worst {
    /// Adds a run of a ball on parabolas between its impacts, with a wall that is sampled every
    /// `apart` seconds.
    fn add(
        &mut self,
        run: Result<Solution<f64, 1>, Failure<f64, 1>>,
        [y, v, g]: [f64; 3],
        apart: f64,
        wall: impl Fn(f64) -> f64,
    ) {
        let Ok(run) = run else {
            self.failed += 1.0;
            return;
        };
        let impacts = run.impacts.iter().map(|impact| (impact.time.to_f64(), &impact.after));
        let mut from = [0.0, y, v];
        for (t, after) in impacts.chain([(run.end.t, &run.end)]) {
            let [begin, y, v] = from;
            let count = ((t - begin) / apart).ceil();
            for k in 1..count as usize {
                let s = (t - begin) * k as f64 / count;
                self.depth = self.depth.max(wall(begin + s) - (y + v * s - 0.5 * g * s * s));
            }
            from = [t, after.q[0], after.v[0]];
        }
    }
}

fn walls(_: Scale, report: &mut Report) {
    let mut random = Random::new(29);
    let (mut late, mut lost, mut off, mut single) = (0.0f64, 0.0, 0.0f64, 0.0);
    for _ in 0..MEMBERS {
        // The wall passes y at t = c − w √ln(h/y), with the rate 2 √ln(h/y) y/w.
        let (c, e, h) =
            (random.uniform(1.0, 9.5), random.uniform(0.5, 1.0), random.uniform(0.5, 9.0));
        let (w, y) = (0.3 * 1e-3f64.powf(random.uniform(0.0, 1.0)), h * random.uniform(0.4, 0.95));
        let root = (h / y).ln().sqrt();
        let (met, end) =
            (c - w * root, |met: f64| y + (1.0 + e) * 2.0 * root * y / w * (10.0 - met));
        let paddle = Paddle { m: 1.0, c, w, h, e };
        macro_rules! count {
            ($($method:expr),*) => {$(
                let run = solve(&paddle, (0.0, 10.0), [y], [0.0]).method($method).rtol(1e-9);
                match run.run() {
                    Ok(run) if run.impacts.len() == 1 => {
                        late = late.max((run.impacts[0].time.to_f64() - met).abs());
                        off = off.max((run.end.q[0] / end(met) - 1.0).abs());
                    }
                    _ => lost += 1.0,
                }
            )*};
        }
        count!(Auto, Picard, Taylor::new(), Dop853, Rodas4);
        let [m, c, w, h, e] = [1.0, c, w, h, e].map(|x| x as f32);
        let run = solve(&Paddle { m, c, w, h, e }, (0.0, 10.0), [y as f32], [0.0]).run();
        single += f64::from(u8::from(!run.is_ok_and(|run| run.impacts.len() == 1)));
    }
    report.row("60 narrow walls, five methods: impacts lost or invented").at_most(lost, 0.0);
    report.row("the same: times of the impacts off").at_most(late, 1e-9);
    report.row("the same: relative distance at t = 10").at_most(off, 1e-7);
    report
        .row("the same walls in single precision, Auto: impacts lost or invented")
        .at_most(single, 0.0);

    let mut worst = Worst::default();
    for _ in 0..MEMBERS {
        let ω = 1e3f64.powf(random.uniform(0.0, 1.0));
        let (a, g) = (random.uniform(0.01, 0.5) * f64::min(1.0, 30.0 / ω), 9.81);
        let (e, y) = (random.uniform(0.8, 1.0), a * random.uniform(1.1, 3.0));
        let floor = Vibrating { a, ω, e, g };
        let moved = Lifted { e, g }.driven_by(Sinusoid::new([a], ω, [0.0]));
        let mut add = |run| worst.add(run, [y, 0.0, g], 0.02 / ω, |t| a * (ω * t).sin());
        add(solve(&floor, (0.0, 0.6), [y], [0.0]).rtol(1e-9).run());
        add(solve(&floor, (0.0, 0.6), [y], [0.0]).method(Dop853).rtol(1e-9).run());
        add(solve(&moved, (0.0, 0.6), [y], [0.0]).rtol(1e-9).run());
        add(solve(&moved, (0.0, 0.6), [y], [0.0]).method(Dop853).rtol(1e-9).run());
    }
    report
        .row("60 vibrating floors, in the equations and driven: depth in m")
        .at_most(worst.depth, 1e-8);
    report.row("the same: errors").at_most(worst.failed, 0.0);

    let mut worst = Worst::default();
    for _ in 0..MEMBERS {
        let (h, ω) = (random.uniform(0.5, 3.0), random.uniform(1.0, 9.0));
        let (lift, v) = (h * random.uniform(0.01, 0.8), random.uniform(1.0, 2.4));
        let crests = |t: f64| h * (ω * t).cos().powi(100);
        let y = crests(0.0) + lift;
        let run = solve(&Crests { h, ω }, (0.0, 5.0), [y], [v]).rtol(1e-10).run();
        worst.add(run, [y, v, 1.0], 0.003 / ω, crests);
        let chirp = |t: f64| h * (ω * t * t).sin() / 20.0;
        let y = chirp(0.0) + lift;
        let run = solve(&Chirp { h, ω }, (0.0, 5.0), [y], [v]).rtol(1e-10).run();
        worst.add(run, [y, v, 1.0], 0.003 / ω, chirp);
    }
    report
        .row("60 floors with narrow crests, and with a rising frequency: depth")
        .at_most(worst.depth, 1e-7);
    report.row("the same: errors").at_most(worst.failed, 0.0);
}
