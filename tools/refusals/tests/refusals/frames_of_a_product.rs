use pendulum_runtime::lagrangian;

lagrangian! {
    pub struct Bones { m: kg, l: m, g: m/s^2 = 9.81 }

    coordinate A: rotation;
    coordinate B: rotation;
    let a = l*A*[0, 0, 1];
    let b = a + l*B*[0, 0, 1];
    kinetic = m/2*(|dot(a)|^2 + |dot(b)|^2) + m*l^2/12*(|angular_velocity(A)|^2 + |angular_velocity(B)|^2);
    potential = m*g*(height(a) + height(b));
    output side: [1; 3] = A*B*[1, 0, 0];
}

fn main() {}
