//! Systems that scenes support: their lanes, and the layouts of the records of their samples.

#![allow(clippy::inline_always)]

use pendulum_core::motion::Derivatives;
use pendulum_core::scalar::{Float, Lanes, Octet};
use pendulum_core::system::{
    InLanes, InOctets, Input, LaneSystem, Purpose, Samples, Staged, System,
};

/// The number of lanes of a block.
pub(crate) const W: usize = 32;

/// A number for each pendulum of a block.
pub(crate) type Wide<T> = Lanes<T, W>;

/// Returns eight of all lanes.
#[inline(always)]
pub(crate) fn octet<T: Float>(lanes: &Wide<T>, part: usize) -> Octet<T> {
    Octet(lanes.0.as_chunks().0[part])
}

/// A system for all pendulums of a block.
pub(crate) type WideOf<S, const N: usize> = <S as LaneSystem<InLanes<W>, N>>::Wide;

/// A system for eight pendulums of a block.
pub(crate) type OctetOf<S, const N: usize> = <S as LaneSystem<InOctets, N>>::Wide;

/// A system that scenes over the scalar `T` support: every type that `lagrangian!` generates, over
/// `f32` and `f64`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not hang in a scene over `{T}`",
    label = "no system over `{T}` without motions and controllers",
    note = "hang the system itself, without `.driven_by(…)`, `.controlled_by(…)` or `.sampled(…)`: the joints are the first argument of `hang`, and `Scene::set_inputs` sets control inputs"
)]
pub trait SceneSystem<T: Float, const N: usize>:
    System<N, Scalar = T, With<T> = Self>
    + LaneSystem<InLanes<32>, N, Wide: Staged<N, Prepared: Send + Sync> + Send + Sync>
    + LaneSystem<InOctets, N, Wide: Staged<N, Prepared: Send + Sync> + Send + Sync>
    + Sized
    + Send
    + Sync
    + 'static
{
}

impl<S, T: Float, const N: usize> SceneSystem<T, N> for S
where
    S: System<N, Scalar = T, With<T> = S> + Send + Sync + 'static,
    S::With<Wide<T>>: Staged<N, Prepared: Send + Sync> + Send + Sync,
    S::With<Octet<T>>: Staged<N, Prepared: Send + Sync> + Send + Sync,
{
}

/// The layouts of the records of a system, and the properties that select its steps.
pub(crate) struct Layouts<S, const N: usize>(core::marker::PhantomData<S>);

impl<S: System<N>, const N: usize> Layouts<S, N> {
    const INPUTS: &'static [usize] = <S::Inputs as Samples<S::Scalar>>::COMPONENTS;
    /// The number of driven inputs, which come before the control inputs. A system written by hand
    /// may list none of its inputs.
    pub(crate) const DRIVEN: usize = {
        let (mut driven, mut index) = (Self::INPUTS.len(), 0);
        while index < S::FACTS.inputs.len() {
            driven -= S::FACTS.inputs[index].control as usize;
            index += 1;
        }
        driven
    };
    /// The number of components of each driven input.
    pub(crate) const COMPONENTS: &'static [usize] = Self::INPUTS.split_at(Self::DRIVEN).0;
    /// The number of components of all control inputs.
    pub(crate) const CONTROLS: usize = {
        let (mut count, mut index) = (0, Self::DRIVEN);
        while index < Self::INPUTS.len() {
            count += Self::INPUTS[index];
            index += 1;
        }
        count
    };
    pub(crate) const FORCES: Layout =
        Layout::new(S::FACTS.inputs, Self::COMPONENTS, Purpose::Accelerations);
    pub(crate) const MOMENTA: Layout =
        Layout::new(S::FACTS.inputs, Self::COMPONENTS, Purpose::Momenta);
    /// The layout of all numbers of the driven inputs.
    pub(crate) const EVERYTHING: Layout = Layout::new(&[], Self::COMPONENTS, Purpose::Outputs);
    /// `true` if the system has constraints.
    pub(crate) const HELD: bool = 0 < S::FACTS.held_constraints();
    /// `true` if constraints restrict velocities only.
    pub(crate) const ROLLS: bool = {
        let (mut rolls, mut index) = (false, 0);
        while index < S::FACTS.held_constraints() {
            rolls |= !S::FACTS.constraints[index].holonomic;
            index += 1;
        }
        rolls
    };
    /// For each coordinate whose turns are watched: `false` if it is in rad, `true` if it has no
    /// unit, as components of rotations. Ticks with limits or frictions are not repeated.
    pub(crate) const MAY_BE_LENGTH: [Option<bool>; N] = {
        let (mut watched, mut index) = ([None; N], 0);
        while index < S::FACTS.coordinate_units.len() && index < N && !Self::LIMITED {
            watched[index] = match S::FACTS.coordinate_units[index].as_bytes() {
                b"rad" => Some(false),
                b"" | b"1" => Some(true),
                _ => None,
            };
            index += 1;
        }
        watched
    };
    /// `true` if the equations are so long that they are evaluated for eight lanes at a time. The
    /// intermediate values of all lanes would fill the first cache, and the compiler would need
    /// minutes for loops over all of them.
    pub(crate) const LONG: bool = 150 <= S::FACTS.cost;
    /// `true` if the system has limits or frictions, which no splitting method keeps.
    pub(crate) const LIMITED: bool = !(S::FACTS.limits.is_empty() && S::FACTS.frictions.is_empty());
    pub(crate) const SPLITS: bool =
        S::FACTS.velocity_free && S::FACTS.constant_mass_matrix && !Self::LIMITED;

    /// Returns the name and the component of a number of the control inputs.
    pub(crate) fn control(mut index: usize) -> (&'static str, usize) {
        for input in S::FACTS.inputs.iter().filter(|input| input.control) {
            if index < input.components {
                return (input.name, index);
            }
            index -= input.components;
        }
        ("", index)
    }
}

/// The places of the derivatives of each input in a record, which contains the derivatives that a
/// purpose needs in sequence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layout {
    /// The place of the first component, by input and derivative; [`NONE`] if the derivative is not
    /// needed.
    begin: [[usize; 3]; 8],
    /// The derivatives of each input.
    pub(crate) wanted: [Derivatives; 8],
    /// The number of values in a record.
    pub(crate) width: usize,
}

const NONE: usize = usize::MAX;

/// The derivatives of a sample in their order.
pub(crate) const ORDERS: [Derivatives; 3] =
    [Derivatives::POSITION, Derivatives::VELOCITY, Derivatives::ACCELERATION];

/// Returns the derivatives of an input that `purpose` needs; all derivatives of an input that a
/// system written by hand does not list.
pub(crate) const fn needed(inputs: &[Input], input: usize, purpose: Purpose) -> Derivatives {
    if input < inputs.len() { inputs[input].derivatives(purpose) } else { Derivatives::ALL }
}

impl Layout {
    /// Returns the layout for `inputs` whose numbers of components are `components`.
    pub(crate) const fn new(inputs: &[Input], components: &[usize], purpose: Purpose) -> Self {
        let (mut begin, mut width, mut input) = ([[NONE; 3]; 8], 0, 0);
        let mut wanted = [Derivatives::NONE; 8];
        while input < components.len() {
            let needed = needed(inputs, input, purpose);
            wanted[input] = needed;
            let mut derivative = 0;
            while derivative < 3 {
                if needed.contains(ORDERS[derivative]) {
                    begin[input][derivative] = width;
                    width += components[input];
                }
                derivative += 1;
            }
            input += 1;
        }
        Self { begin, wanted, width }
    }

    /// Returns the place of a number in a record; `None` if the record does not contain it.
    #[inline(always)]
    pub(crate) fn place(&self, input: usize, derivative: usize, component: usize) -> Option<usize> {
        let begin = self.begin[input][derivative];
        if begin == NONE { None } else { Some(begin + component) }
    }
}
