//! Pendulums that carry joints: the outputs of a pendulum with their derivatives in time.

use crate::group::members::{Group, Location};
use crate::lanes::limits::Limits;
use crate::sampling::carried::{Carrier, Ride};
use crate::sampling::turn::product;
use crate::sampling::world::{MOST_NUMBERS, World};
use crate::system::{Layout, Layouts, SceneSystem};
use core::any::Any;
use pendulum_core::attitude::Attitude;
use pendulum_core::integrate::limits;
use pendulum_core::motion::{Sample, Side};
use pendulum_core::scalar::{Dual, Float, Real};
use pendulum_core::system::{At, MOST_CONTROLS, Samples, System};
use pendulum_core::time::Time;

/// A number with its first and second derivative in time. Both parts of the number have the first
/// derivative, as arithmetic of numbers that are dual twice yields it.
pub(crate) type Moving<T> = Dual<Dual<T>>;

fn moving<T: Real>([value, first, second]: [T; 3]) -> Moving<T> {
    Dual {
        value: Dual { value, derivative: first },
        derivative: Dual { value: first, derivative: second },
    }
}

/// Returns the inputs whose numbers, as `layout` arranges them, are `numbers`.
fn inputs<I: Samples<T>, T: Real>(layout: &Layout, numbers: &[T; MOST_NUMBERS]) -> I {
    I::from_numbers(&mut |input, derivative, component| {
        layout.place(input, derivative, component).map_or(T::from_f64(0.0), |place| numbers[place])
    })
}

/// Returns the same inputs with their derivatives. Those of accelerations are not known; outputs
/// that carry a joint do not depend on them.
fn moving_inputs<I: Samples<Moving<T>>, T: Real>(
    layout: &Layout,
    numbers: &[T; MOST_NUMBERS],
) -> I {
    I::from_numbers(&mut |input, derivative, component| {
        moving(core::array::from_fn(|more| {
            let place = if derivative + more < 3 {
                layout.place(input, derivative + more, component)
            } else {
                None
            };
            place.map_or(T::from_f64(0.0), |place| numbers[place])
        }))
    })
}

/// Computes the states of the joints that a pendulum carries at both ends of a tick.
///
/// A pendulum that is not computed is rigid: it has neither velocities nor accelerations, and moves
/// with its joints only. The same holds where an output or an acceleration is not finite.
///
/// A tick begins with the states at the end of the last one, unless something has changed.
pub(crate) fn frames<S: SceneSystem<T, N>, T: Float, const N: usize>(
    group: &dyn Any,
    world: &World<T>,
    id: u32,
    tick: i64,
    Carrier { rides, known, .. }: &mut Carrier<T>,
) {
    let Some(group) = group.downcast_ref::<Group<S, T, N>>() else { return };
    let layout = const { &Layouts::<S, N>::EVERYTHING };
    let Location { bucket, slot } = group.table[id as usize];
    let (bucket, slot) = (&group.buckets[bucket as usize], slot as usize);
    let (limits, [q, _, v, _, q_before, v_before]) = bucket.numbers(slot);
    let mut parameters = bucket.parameters_of(slot);
    let system = group.prototype.map(|parameter| parameters.next().unwrap_or(parameter));
    let dual = system.map(|parameter| moving([parameter, T::from_f64(0.0), T::from_f64(0.0)]));
    let (awake, zero) = (group.is_awake(id), [T::from_f64(0.0); N]);
    let (driven, mut own) = (const { Layouts::<S, N>::DRIVEN }, bucket.controls_of(slot));
    let controls: [T; MOST_CONTROLS] =
        core::array::from_fn(|_| own.next().unwrap_or(T::from_f64(0.0)));
    let held = controls.map(|control| moving([control, T::from_f64(0.0), T::from_f64(0.0)]));
    for (end, (q, v)) in [(q_before, v_before), (q, v)].into_iter().enumerate() {
        let t = Time::new(world.clock.time(tick + end as i64));
        let numbers: [T; MOST_NUMBERS] = world.numbers(bucket.joints(slot), t);
        let t = T::from_f64(t.to_f64());
        let [last, own] = &mut *known;
        own.clear();
        let now = [t, T::from_f64(f64::from(u8::from(awake)))];
        for part in [&now[..], &q, &v, &numbers[..layout.width], &controls] {
            own.extend_from_slice(part);
        }
        own.extend(bucket.parameters_of(slot));
        // Limits in contact and stops have states that are not among these numbers.
        let plain = const { !Layouts::<S, N>::LIMITED } && limits == Limits::none();
        if plain && own == last {
            for ride in rides.iter_mut() {
                ride.states[end] = ride.states[1];
            }
            continue;
        }
        if !plain {
            own.clear();
        }
        core::mem::swap(last, own);
        let mut rates = [zero; 2];
        if awake {
            let mut inputs = inputs::<S::Inputs, T>(layout, &numbers);
            inputs.set_controls(driven, &controls);
            let mut a = system.accelerations(At { t, q: &q, v: &v, inputs: &inputs });
            let push = limits.push(&q);
            for i in 0..N {
                a[i] += push[i] - limits.damping * v[i];
            }
            if bucket.standing(slot).pushes() {
                a = in_contact(group, world, id, tick + end as i64, (&q, &v));
            }
            rates = [v, a];
        }
        let mut inputs: <S::With<Moving<T>> as System<N>>::Inputs = moving_inputs(layout, &numbers);
        inputs.set_controls(driven, &held);
        let t = moving([t, T::from_f64(1.0), T::from_f64(0.0)]);
        let state = |ride: &Ride, [v, a]: [[T; N]; 2]| {
            let q = core::array::from_fn(|i| moving([q[i], v[i], a[i]]));
            let v = core::array::from_fn(|i| moving([v[i], a[i], T::from_f64(0.0)]));
            let values = |output: usize| {
                let mut values = [moving([T::from_f64(0.0); 3]); 4];
                dual.output(output, At { t, q: &q, v: &v, inputs: &inputs }, &mut values);
                values
            };
            let mut position = values(ride.output);
            if let Some((turn, aside)) = ride.aside {
                let zero = T::from_f64(0.0);
                let aside = aside.map(|part| moving([T::from_f64(part), zero, zero]));
                let aside = Attitude::from_quaternion(values(turn)) * aside;
                for (part, aside) in position.iter_mut().zip(aside) {
                    *part += aside;
                }
            }
            finite(&position)
        };
        for ride in rides.iter_mut() {
            let state = state(ride, rates).or_else(|| state(ride, [zero; 2]));
            ride.states[end] = match state {
                Some(state) => turned(state, ride.rest),
                None => Sample { position: ride.states[1].position, ..Sample::zero() },
            };
        }
    }
}

/// Returns the accelerations of a pendulum with the forces of its limits in contact and frictions.
fn in_contact<S: SceneSystem<T, N>, T: Float, const N: usize>(
    group: &Group<S, T, N>,
    world: &World<T>,
    id: u32,
    tick: i64,
    (q, v): (&[T; N], &[T; N]),
) -> [T; N] {
    let (detached, t) = (group.read(id), Time::new(world.clock.time(tick)));
    let hung = group.hung(world, &detached);
    limits::accelerations(&hung, t, Side::After, (q, v), &detached.standing)
}

/// Returns the numbers as a sample if they are finite.
fn finite<T: Float>(values: &[Moving<T>; 4]) -> Option<Sample<f64, 4>> {
    let sample = Sample {
        position: values.map(|value| value.value.value.to_f64()),
        velocity: values.map(|value| value.value.derivative.to_f64()),
        acceleration: values.map(|value| value.derivative.derivative.to_f64()),
    };
    let Sample { position, velocity, acceleration } = &sample;
    let mut all = position.iter().chain(velocity).chain(acceleration);
    all.all(|number| number.is_finite()).then_some(sample)
}

/// Returns an attitude that turns first by `rest`.
fn turned(state: Sample<f64, 4>, rest: Option<[f64; 4]>) -> Sample<f64, 4> {
    rest.map_or(state, |rest| Sample {
        position: product(state.position, rest),
        velocity: product(state.velocity, rest),
        acceleration: product(state.acceleration, rest),
    })
}

impl<S: SceneSystem<T, N>, T: Float, const N: usize> Group<S, T, N> {
    /// Returns `true` if an output of a pendulum changes with its velocities or with those of its
    /// joints, whose derivatives in time are not all known, or with its control inputs, which jump.
    pub(crate) fn output_of_more(&self, world: &World<T>, id: u32, output: usize) -> bool {
        let layout = const { &Layouts::<S, N>::EVERYTHING };
        let detached = self.read(id);
        let (system, [q, _, v, ..]) = (self.system_of(&detached.parameters), detached.state);
        let now = Time::new(world.now());
        let numbers: [T; MOST_NUMBERS] = world.numbers(&detached.joints, now);
        let value = |by: f64| {
            let t = T::from_f64(now.to_f64());
            let v = v.map(|v| v + T::from_f64(by));
            let mut inputs = S::Inputs::from_numbers(&mut |input, derivative, component| {
                let place = layout.place(input, derivative, component);
                let number = place.map_or(T::from_f64(0.0), |place| numbers[place]);
                if derivative == 0 { number } else { number + T::from_f64(by) }
            });
            inputs.set_controls(Layouts::<S, N>::DRIVEN, &[T::from_f64(by); MOST_CONTROLS]);
            let mut values = [T::from_f64(0.0); 4];
            system.output(output, At { t, q: &q, v: &v, inputs: &inputs }, &mut values);
            values
        };
        let (here, there) = (value(0.0), value(1.0));
        here.iter().zip(&there).any(|(a, b)| a != b && a.is_finite())
    }
}
