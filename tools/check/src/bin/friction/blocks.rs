//! Systems with dry friction, each beside the same system with `tanh` of the rate over the width ε
//! in place of its sign.

#![allow(missing_docs)]

use pendulum_runtime::prelude::*;

/// Declares a system twice, with different endings.
macro_rules! pair {
    ($dry:ident $soft:ident { $($parameters:tt)* } { $($shared:tt)* } { $($own:tt)* } { $($smooth:tt)* }) => {
        lagrangian! {
            pub(crate) struct $dry { $($parameters)* }
            $($shared)*
            $($own)*
        }
        lagrangian! {
            pub(crate) struct $soft { $($parameters)*, ε }
            $($shared)*
            $($smooth)*
        }
    };
}

// A slider under a force that swings.
pair! { Slider SoftSlider { p, ω, f } {
    coordinate x;
    kinetic = ẋ^2/2;
} {
    force x = p*sin(ω*t);
    friction ground: ẋ, force = f;
} {
    force x = p*sin(ω*t) - f*tanh(ẋ/ε);
} }

// A mass on a spring, over ground that is rougher in places.
pair! { Patchy SoftPatchy { k, p, ω, f, r } {
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k/2*x^2;
} {
    force x = p*cos(ω*t);
    friction ground: ẋ, force = f*(1 + r*sin(3*x));
} {
    force x = p*cos(ω*t) - f*(1 + r*sin(3*x))*tanh(ẋ/ε);
} }

// A block on a spring and a belt that runs forwards and backwards.
pair! { Belt SoftBelt { k, u, w, f } {
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k/2*x^2;
} {
    friction belt: ẋ - u*cos(w*t), force = f;
} {
    force x = -f*tanh((ẋ - u*cos(w*t))/ε);
} }

// A pendulum whose joint rubs.
pair! { Pin SoftPin { g, p, ω, f } {
    coordinate θ;
    kinetic = θ̇^2/2;
    potential = -g*cos(θ);
} {
    force θ = p*sin(ω*t);
    friction pin: θ̇, force = f;
} {
    force θ = p*sin(ω*t) - f*tanh(θ̇/ε);
} }

// Three blocks between springs on the ground.
pair! { Train SoftTrain { k, p, ω, f, b, c } {
    coordinate x;
    coordinate y;
    coordinate z;
    kinetic = (ẋ^2 + ẏ^2 + ż^2)/2;
    potential = k/2*((x - y)^2 + (y - z)^2 + x^2);
} {
    force z = p*sin(ω*t);
    friction first: ẋ, force = f;
    friction second: ẏ, force = b;
    friction third: ż, force = c;
} {
    force x = -f*tanh(ẋ/ε);
    force y = -b*tanh(ẏ/ε);
    force z = p*sin(ω*t) - c*tanh(ż/ε);
} }

// A block on the ground and a block that it carries.
pair! { Stack SoftStack { m, p, ω, f, b } {
    coordinate x;
    coordinate y;
    kinetic = ẋ^2/2 + m*ẏ^2/2;
} {
    force x = p*sin(ω*t);
    friction ground: ẋ, force = f;
    friction top: ẏ - ẋ, force = b;
} {
    force x = p*sin(ω*t) - f*tanh(ẋ/ε) + b*tanh((ẏ - ẋ)/ε);
    force y = -b*tanh((ẏ - ẋ)/ε);
} }

// A mass on a spring whose friction falls as the rate grows.
pair! { Stribeck SoftStribeck { k, p, ω, f, s, w } {
    coordinate x;
    kinetic = ẋ^2/2;
    potential = k/2*x^2;
} {
    force x = p*cos(ω*t);
    friction ground: ẋ, force = f*(1 + s*exp(-(ẋ/w)^2));
} {
    force x = p*cos(ω*t) - f*(1 + s*exp(-(ẋ/w)^2))*tanh(ẋ/ε);
} }

// A block on a rough floor, to which a force presses it more and less.
pair! { Pressed SoftPressed { g, p, ω, d, w, μ } {
    coordinate x;
} {
    coordinate y;
    kinetic = (ẋ^2 + ẏ^2)/2;
    potential = g*y;
    force x = p*sin(ω*t);
    force y = d*sin(w*t);
    limit floor: y >= 0, restitution = 0;
    friction grip: ẋ, force = μ*reaction(floor);
} {
    kinetic = ẋ^2/2;
    force x = p*sin(ω*t) - μ*(g - d*sin(w*t))*tanh(ẋ/ε);
} }

// Two pendulums, one on the other, whose joints rub.
pair! { Joints SoftJoints { g, p, ω, f, b } {
    coordinate θ;
    coordinate φ;
    let elbow = [sin(θ), -cos(θ)];
    let bob = elbow + [sin(θ + φ), -cos(θ + φ)];
    kinetic = (|dot(elbow)|^2 + |dot(bob)|^2)/2;
    potential = g*(height(elbow) + height(bob));
} {
    force θ = p*sin(ω*t);
    friction shoulder: θ̇, force = f;
    friction hinge: φ̇, force = b;
} {
    force θ = p*sin(ω*t) - f*tanh(θ̇/ε);
    force φ = -b*tanh(φ̇/ε);
} }

lagrangian! {
    /// A rod of length 2a that strikes a rough floor, at the angle θ from lying.
    pub struct Rod { a, μ, e }
    coordinate x;
    coordinate y;
    coordinate θ;
    kinetic = (ẋ^2 + ẏ^2 + a^2*θ̇^2/3)/2;
    potential = y;
    limit floor: y - a*sin(θ) >= 0, restitution = e;
    friction tip: dot(x - a*cos(θ)), force = μ*reaction(floor);
}

lagrangian! {
    /// Two rods, one on the other, whose end strikes a rough floor.
    pub struct Arm { h, l, m, μ, e }
    coordinate θ;
    coordinate φ;
    let first = [sin(θ), -cos(θ)];
    let second = 2*first + l*[sin(φ), -cos(φ)];
    let tip = 2*first + 2*l*[sin(φ), -cos(φ)];
    kinetic = (|dot(first)|^2 + θ̇^2/3 + m*(|dot(second)|^2 + l^2*φ̇^2/3))/2;
    potential = height(first) + m*height(second);
    limit floor: h + height(tip) >= 0, restitution = e;
    friction end: dot(tip).x, force = μ*reaction(floor);
}
