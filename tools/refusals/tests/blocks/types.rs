//! Types, traits and modules of the user with the names of Rust's own items.

#![deny(warnings)]
#![allow(non_camel_case_types, dead_code)]

use pendulum_runtime::prelude::*;

macro_rules! hide {
    ($($name:ident)+) => {
        $(struct $name;)+
    };
}

hide! { f32 f64 u8 u32 u64 usize i32 i64 bool char str String Vec Box }

enum Option {
    Some,
    None,
}

enum Result {
    Ok,
    Err,
}

use Option::{None, Some};
use Result::{Err, Ok};

mod core {}
mod std {}
mod alloc {}
mod pendulum_macros {}

trait Clone {}
trait Copy {}
trait Default {}
trait Debug {}
trait Iterator {}
trait From {}
trait Into {}
trait Fn {}
trait FnMut {}
trait Sized {}
trait Send {}
trait Sync {}
trait Drop {}

lagrangian! {
    /// Everything that a block has.
    #[derive(Clone, Debug)]
    pub struct Rich { m: kg, L: m, c: [m; 2], k: N/m = 2, B: body }
    coordinate theta: rad;
    coordinate z: m;
    driven x: [m; 2];
    let y = L * [sin(theta), -cos(theta)];
    kinetic     = m/2*|x_dot + dot(y) + [0, z_dot]|^2 + integral(p in B, |dot(cis(theta)*p)|^2/2);
    potential   = k/2*max(0, z)^2 + k*inner(c, y);
    dissipation = k*t/2*(1 + sin(z/L))*z_dot^2;
    force theta = k*L*z;
}

lagrangian! {
    struct Empty {}
    coordinate x;
    kinetic = x_dot^2/2;
    potential = x^4;
}

fn main() {
    assert_eq!(Empty::<::core::primitive::f64>::new().accelerations(At::of(0.0, &[1.0], &[0.0])), [-4.0]);
    let _ = (Some, None, Ok, Err);
}
