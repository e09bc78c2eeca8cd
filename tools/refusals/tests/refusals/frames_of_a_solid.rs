use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Top { B: solid, g: m/s^2 = 9.81 }

    coordinate R: rotation;
    let w = angular_velocity(R);
    kinetic = inner(w, B.inertia*w)/2;
    potential = B.mass*g*height(R*B.center);
}

fn main() {}
