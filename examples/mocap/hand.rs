//! The equation of the pendulum, derived by hand: I θ̈ = −m ⟨ẍ + g e_y, (e^{iθ} c)⊥⟩ − c θ̇.

use pendulum_runtime::body::Body;
use pendulum_runtime::motion::{Derivatives, Sample};
use pendulum_runtime::prelude::*;
use pendulum_runtime::system::System;
use pendulum_runtime::system::{Facts, Input};

/// A rigid body that hangs from a moving point.
#[derive(Clone, Debug)]
pub(crate) struct Hand<T = f64> {
    /// The body as seen from its pivot.
    pub(crate) body: Body<T>,
    /// The damping in N m s.
    pub(crate) damping: T,
    /// The gravitational acceleration in m/s².
    pub(crate) g: T,
}

impl<T: Real> Hand<T> {
    /// Returns (e^{iθ} c)⊥, the centre of mass turned by a further quarter.
    fn perp(&self, θ: T) -> [T; 2] {
        let (sin, cos) = θ.sin_cos();
        let [x, y] = self.body.center;
        [-(x * sin + y * cos), x * cos - y * sin]
    }

    /// Returns m ⟨u, (e^{iθ} c)⊥⟩.
    fn moment(&self, u: [T; 2], θ: T) -> T {
        let perp = self.perp(θ);
        self.body.mass * (u[0] * perp[0] + u[1] * perp[1])
    }
}

impl<T: Real> System<1> for Hand<T> {
    type Scalar = T;
    type Inputs = (Sample<T, 2>,);
    type With<U: Real> = Hand<U>;
    type Prepared = ();

    const FACTS: Facts = {
        let mut facts = Facts::new("Hand", &["θ"]);
        facts.parameters =
            &["B.mass", "B.center.x", "B.center.y", "B.xx", "B.xy", "B.yy", "c", "g"];
        facts.inputs = &[Input {
            name: "x",
            components: 2,
            control: false,
            accelerations: Derivatives::ACCELERATION,
            momenta: Derivatives::VELOCITY,
            energy: Derivatives::POSITION.union(Derivatives::VELOCITY),
            power: Derivatives::VELOCITY.union(Derivatives::ACCELERATION),
            outputs: Derivatives::NONE,
        }];
        facts.constant_mass_matrix = true;
        facts
    };

    fn map<U: Real>(&self, mut map: impl FnMut(T) -> U) -> Hand<U> {
        Hand { body: self.body.map(&mut map), damping: map(self.damping), g: map(self.g) }
    }

    fn prepare(&self) {}

    fn accelerations(&self, at: At<'_, T, Self::Inputs, 1>) -> [T; 1] {
        [self.forces(at)[0] / self.body.inertia()]
    }

    fn energy(&self, At { q, v, inputs: (x,), .. }: At<'_, T, Self::Inputs, 1>) -> T {
        let half = T::ratio(1.0, 2.0);
        let speed = x.velocity[0] * x.velocity[0] + x.velocity[1] * x.velocity[1];
        // The height of e^{iθ} c is −⟨e_x, (e^{iθ} c)⊥⟩.
        let height = x.position[1] - self.perp(q[0])[0];
        half * self.body.inertia() * v[0] * v[0] + self.body.mass * (self.g * height - half * speed)
    }

    fn power(&self, At { q, v, inputs: (x,), .. }: At<'_, T, Self::Inputs, 1>) -> T {
        let along = x.velocity[0] * x.acceleration[0] + x.velocity[1] * x.acceleration[1];
        let lift = self.body.mass * (self.g * x.velocity[1] - along);
        lift - v[0] * self.moment(x.acceleration, q[0]) - self.damping * v[0] * v[0]
    }

    fn momenta(&self, At { q, v, inputs: (x,), .. }: At<'_, T, Self::Inputs, 1>) -> [T; 1] {
        [self.body.inertia() * v[0] + self.moment(x.velocity, q[0])]
    }

    fn velocities(&self, _: T, q: &[T; 1], p: &[T; 1], (x,): &Self::Inputs) -> [T; 1] {
        [(p[0] - self.moment(x.velocity, q[0])) / self.body.inertia()]
    }

    fn mass_matrix(&self, _: At<'_, T, Self::Inputs, 1>) -> nalgebra::SMatrix<T, 1, 1> {
        nalgebra::SMatrix::from([[self.body.inertia()]])
    }

    fn forces(&self, At { q, v, inputs: (x,), .. }: At<'_, T, Self::Inputs, 1>) -> [T; 1] {
        let [along, up] = x.acceleration;
        [-self.moment([along, up + self.g], q[0]) - self.damping * v[0]]
    }

    fn momentum_rates(&self, At { q, v, inputs: (x,), .. }: At<'_, T, Self::Inputs, 1>) -> [T; 1] {
        // d/dθ (e^{iθ} c)⊥ = −e^{iθ} c.
        let [down, along] = self.perp(q[0]);
        let turning = -self.body.mass * v[0] * (x.velocity[0] * along - x.velocity[1] * down);
        [turning - self.body.mass * self.g * along - self.damping * v[0]]
    }
}
