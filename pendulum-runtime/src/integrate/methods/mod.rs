//! The methods, one a file.

pub(crate) mod auto;
pub(crate) mod dop853;
pub(crate) mod dprkn12;
pub(crate) mod dprkn8;
pub(crate) mod gauss;
pub(crate) mod leapfrog;
pub(crate) mod picard;
pub(crate) mod quinlan_tremaine;
pub(crate) mod rattle;
pub(crate) mod rk4;
pub(crate) mod rodas4;
pub(crate) mod srkn14a;
pub(crate) mod srkn6b;
pub(crate) mod symplectic_euler;
pub(crate) mod taylor;
pub(crate) mod tsit5;
