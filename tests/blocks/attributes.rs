//! Attributes of the struct that its implementations follow, and names that the generated code takes itself.

#![deny(warnings)]

use pendulum_runtime::prelude::*;

lagrangian! {
    #[cfg(any())]
    pub struct Gone { c }
    coordinate q;
    kinetic = c*q_dot^2/2;
}

lagrangian! {
    /// Still here.
    #[deprecated = "take another one"]
    #[derive(Clone, Debug)]
    pub struct Old { c }
    coordinate q;
    driven x;
    kinetic = c*(q_dot + x_dot)^2/2;
    potential = c*q;
}

lagrangian! {
    #[cfg(all())]
    pub struct U { c }
    coordinate q;
    driven x;
    kinetic = c*(q_dot + x_dot)^2/2;
}

fn main() {
    #[allow(deprecated)]
    let old = Old::new(1.0);
    assert_eq!(format!("{old:?}"), "Old { c: 1.0 }");
    assert_eq!(U::new(2.0).map(|c| c + 1.0).c, 3.0);
}
