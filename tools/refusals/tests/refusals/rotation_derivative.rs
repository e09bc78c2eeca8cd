use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Body { J: kg*m^2, k: N*m }

    coordinate R: rotation;
    kinetic = J/2*|dot(R)|^2;
    potential = k*height(R*[0, 0, 1]);
}

fn main() {}
