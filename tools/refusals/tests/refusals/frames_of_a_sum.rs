use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Body { m: kg, J: kg*m^2, g: m/s^2 = 9.81 }

    coordinate x: [m; 3];
    coordinate R: rotation;
    let w = transpose(R)*angular_velocity(R);
    kinetic = m/2*|dot(x)|^2 + J/2*|w|^2;
    potential = m*g*height(x);
    output turning: [rad/s; 3] = angular_velocity(R) - w;
}

fn main() {}
