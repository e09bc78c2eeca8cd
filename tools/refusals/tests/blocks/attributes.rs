//! Attributes of the struct that also apply to its implementations, and names that the generated
//! code uses.

#![deny(warnings)]
#![allow(non_upper_case_globals)]

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

lagrangian! {
    /// Nobody mentions what begins with an underscore, what is allowed and what is left out.
    pub struct Quiet {
        m,
        _spare: [kg; 2],
        #[allow(unused)]
        known,
    }
    coordinate q;
    kinetic = m*q_dot^2/2;
}

lagrangian! {
    #[allow(unused_variables)]
    #[derive(Clone, Debug)]
    pub struct Allowed { m, c }
    coordinate q;
    kinetic = m*q_dot^2/2;
}

lagrangian! {
    pub struct Expected {
        m,
        #[expect(unused_variables, reason = "not yet")]
        c,
        #[expect(unused)]
        d,
    }
    coordinate q;
    kinetic = m*q_dot^2/2;
}

lagrangian! {
    #[expect(unused_variables)]
    pub struct AllExpected { m, c, d }
    coordinate q;
    kinetic = m*q_dot^2/2;
}

lagrangian! {
    #[derive(Copy, PartialOrd)]
    pub struct Written { m }
    coordinate q;
    kinetic = m*q_dot^2/2;
}

impl<T: Copy> Clone for Written<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T: PartialEq> PartialEq for Written<T> {
    fn eq(&self, other: &Self) -> bool {
        self.m == other.m
    }
}

lagrangian! {
    #[cfg(any())]
    pub struct Nowhere { m, c }
    coordinate q;
    kinetic = m*q_dot^2/2;
}

/// A constant with the name of a parameter that is not mentioned.
const c: f64 = 1.0;

fn main() {
    assert_eq!(Allowed::new(1.0, c).clone().c, c);
    assert_eq!(Quiet::new(c, [2.0, 3.0], 4.0)._spare, [2.0, 3.0]);
    #[allow(deprecated)]
    let old = Old::new(1.0);
    assert_eq!(format!("{old:?}"), "Old { c: 1.0 }");
    let written = Written::new(1.0);
    let copy = written;
    assert!(copy < Written::new(2.0) && copy == written.clone());
    assert_eq!(U::new(2.0).map(|x| x + 1.0).c, 3.0);
}
