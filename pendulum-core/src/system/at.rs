//! The arguments of the functions of a system.

/// A state at a time with the samples of the inputs, as the functions of a
/// [`System`](crate::system::System) take it.
///
/// A system without inputs is evaluated at [`At::of`], one with inputs at
/// `At { t, q: &q, v: &v, inputs: &inputs }`. The parameters are plain types and not those of a
/// system, so that they follow from the fields, and systems with equal inputs share a value. The
/// functions of [`Dynamics`](crate::system::Dynamics) take the time in two words and sample the
/// inputs themselves.
///
/// ```
/// use pendulum_runtime::prelude::*;
///
/// # mod system {
/// pendulum_runtime::lagrangian! {
///     pub struct Spring { k, m }
///     coordinate x;
///     kinetic = m*ẋ^2/2;
///     potential = k*x^2/2;
/// }
/// # }
/// # use system::Spring;
/// let spring = Spring::new(4.0, 2.0);
/// let at = At::of(0.0, &[1.0], &[3.0]);
/// assert_eq!(spring.accelerations(at), [-2.0]);
/// assert_eq!(spring.energy(at), 11.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct At<'a, T, I, const N: usize> {
    /// The time in seconds.
    pub t: T,
    /// The coordinates.
    pub q: &'a [T; N],
    /// The velocities q̇.
    pub v: &'a [T; N],
    /// The samples of driven and control inputs, `()` without inputs.
    pub inputs: &'a I,
}

impl<'a, T, const N: usize> At<'a, T, (), N> {
    /// Creates the arguments of a system without inputs.
    #[inline]
    pub const fn of(t: T, q: &'a [T; N], v: &'a [T; N]) -> Self {
        Self { t, q, v, inputs: &() }
    }
}
