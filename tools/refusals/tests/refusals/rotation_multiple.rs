use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Body { J: kg*m^2, k: N*m }

    coordinate R: rotation;
    kinetic = J/2*|angular_velocity(R)|^2;
    potential = k*height(R*[0, 0, 1]);
    output turned: [1; 3] = 2*R;
}

fn main() {}
