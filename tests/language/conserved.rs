//! Conserved quantities: found at compile time, named, and constant along the motion.

use pendulum_runtime::prelude::*;
use pendulum_runtime::system::System;

use systems::pendulums::Hanging;
use systems::problems::Kepler;

lagrangian! {
    pub struct CartPole { M: kg, m: kg, l: m, g: m/s^2 = 9.81 }
    coordinate x: m;
    coordinate θ: rad;
    let r = [x + l*sin(θ), -l*cos(θ)];
    kinetic = M/2*ẋ^2 + m/2*|ṙ|^2;
    potential = m*g*height(r);
}

lagrangian! {
    pub struct Spherical { m: kg, l: m, g: m/s^2 = 9.81 }
    coordinate θ: rad;
    coordinate φ: rad;
    let r = l*[sin(θ)*cos(φ), sin(θ)*sin(φ), -cos(θ)];
    kinetic = m/2*|ṙ|^2;
    potential = m*g*height(r);
}

lagrangian! {
    /// Three masses joined by two rods, thrown into space.
    pub struct FreeChain { m: [kg; 3], l: [m; 2] }
    coordinate x: m;
    coordinate y: m;
    coordinate θ[2]: rad;
    let r[k in 0..3] = [x, y] + sum(j in 0..k, l[j]*cis(θ[j]));
    kinetic = sum(k in 0..3, m[k]/2*|ṙ[k]|^2);
}

lagrangian! {
    /// Three bodies in a plane that attract each other.
    pub struct ThreeBodies { m: [kg; 3], G: N*m^2/kg^2 }
    coordinate x[3]: m;
    coordinate y[3]: m;
    let r[k in 0..3] = [x[k], y[k]];
    kinetic = sum(k in 0..3, m[k]/2*|ṙ[k]|^2);
    potential = -G*sum(j in 0..3, sum(k in 0..j, m[j]*m[k]/|r[j] - r[k]|));
}

lagrangian! {
    /// Friction on the cart: its momentum is lost.
    pub struct Rubbing { M: kg, c: kg/s }
    coordinate x: m;
    coordinate y: m;
    kinetic = M/2*(ẋ^2 + ẏ^2);
    dissipation = c/2*ẋ^2;
}

/// Returns the conserved quantities at the start and after five seconds.
fn values<S: System<N, Scalar = f64, Inputs = ()>, const N: usize, const C: usize>(
    system: &S,
    q: [f64; N],
    v: [f64; N],
) -> [[f64; C]; 2] {
    assert_eq!(S::FACTS.conserved.len(), C);
    let end =
        solve(system, (0.0, 5.0), q, v).method(Dop853).rtol(1e-13).atol(1e-13).run().unwrap().end;
    let mut found = [[0.0; C]; 2];
    system.conserved(At::of(0.0, &q, &v), &mut found[0]);
    system.conserved(At::of(5.0, &end.q, &end.v), &mut found[1]);
    found
}

fn constant<const C: usize>([start, end]: [[f64; C]; 2]) {
    for (start, end) in start.iter().zip(&end) {
        assert!((start - end).abs() < 1e-11 * start.abs().max(1.0), "{start} has become {end}");
        assert!(start.abs() > 1e-3, "a value that is zero anyway shows nothing");
    }
}

#[test]
fn the_cart_keeps_its_momentum() {
    assert_eq!(<CartPole as System<2>>::FACTS.conserved, ["p_x"]);
    constant::<1>(values(&CartPole::new(2.0, 1.0, 0.5), [0.0, 2.0], [0.3, -1.0]));
}

#[test]
fn the_spherical_pendulum_keeps_its_angular_momentum() {
    assert_eq!(<Spherical as System<2>>::FACTS.conserved, ["p_φ"]);
    constant::<1>(values(&Spherical::new(1.0, 0.5), [1.0, 0.0], [0.3, 2.0]));
}

#[test]
fn a_planet_keeps_its_angular_momentum() {
    assert_eq!(<Kepler as System<2>>::FACTS.conserved, ["x·p_y − y·p_x"]);
    constant::<1>(values(&Kepler::new(1.0), [0.7, 0.1], [0.0, 1.2]));
}

#[test]
fn a_free_chain_keeps_both_momenta_and_its_angular_momentum() {
    assert_eq!(
        <FreeChain as System<4>>::FACTS.conserved,
        ["p_x", "p_y", "p_θ[0] + p_θ[1] − y·p_x + x·p_y"]
    );
    constant::<3>(values(
        &FreeChain::new([1.0, 0.4, 0.7], [0.5, 0.8]),
        [0.0, 0.0, 0.3, 1.5],
        [1.0, 2.0, 3.0, -4.0],
    ));
}

#[test]
fn three_bodies_keep_both_momenta_and_their_angular_momentum() {
    let turn = "x[0]·p_y[0] − y[0]·p_x[0] − y[1]·p_x[1] − y[2]·p_x[2] + x[1]·p_y[1] + x[2]·p_y[2]";
    let sums = ["p_x[0] + p_x[1] + p_x[2]", "p_y[0] + p_y[1] + p_y[2]"];
    assert_eq!(<ThreeBodies as System<6>>::FACTS.conserved, [sums[0], sums[1], turn]);
    let bodies = ThreeBodies::new([3.0, 1.0, 0.5], 1.0);
    constant::<3>(values(
        &bodies,
        [0.0, 2.0, -3.0, 0.1, 0.3, -1.0],
        [0.1, -0.2, 0.3, -0.2, 1.1, -0.8],
    ));
}

#[test]
fn a_driven_pendulum_keeps_nothing() {
    assert!(<Hanging as System<1>>::FACTS.conserved.is_empty());
}

#[test]
fn friction_takes_what_it_works_on() {
    assert_eq!(<Rubbing as System<2>>::FACTS.conserved, ["p_y"]);
}
