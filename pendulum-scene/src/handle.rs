//! Handles of pendulums and of what was added together, and identifiers of scenes.

use core::any::TypeId;
use core::cmp::Ordering;
use core::fmt;
use core::hash::{Hash, Hasher};
use core::marker::PhantomData;
use core::sync::atomic::{AtomicU32, Ordering as Memory};

/// The identifier of a scene in its process, which distinguishes handles and joints of different
/// scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct SceneId(u32);

impl SceneId {
    /// Returns an identifier that is not used by an earlier scene.
    pub(crate) fn next() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        Self(COUNT.fetch_add(1, Memory::Relaxed))
    }
}

/// A handle of a pendulum, which identifies the scene, the type, and the index among the pendulums
/// of this type.
///
/// After the pendulum is [removed](crate::Scene::remove), the handle names none, also if its index
/// is used again. [`Scene::hang`](crate::Scene::hang) returns the handle, and
/// [`Scene::handle`](crate::Scene::handle) finds it by its index. Other scenes do not accept
/// the handle.
pub struct Handle<S, const N: usize> {
    scene: SceneId,
    index: u32,
    /// The number of pendulums that have had this index before.
    generation: u32,
    kind: PhantomData<fn() -> S>,
}

impl<S, const N: usize> Handle<S, N> {
    pub(crate) const fn new(scene: SceneId, index: u32, generation: u32) -> Self {
        Self { scene, index, generation, kind: PhantomData }
    }

    const fn key(self) -> (SceneId, u32, u32) {
        (self.scene, self.index, self.generation)
    }

    pub(crate) const fn scene(self) -> SceneId {
        self.scene
    }

    pub(crate) const fn generation(self) -> u32 {
        self.generation
    }

    /// Returns the index of the pendulum among the pendulums of its type, in the order of hanging,
    /// from 0. Indices of removed pendulums are used again.
    pub const fn index(self) -> u32 {
        self.index
    }
}

impl<S, const N: usize> Clone for Handle<S, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, const N: usize> Copy for Handle<S, N> {}

impl<S, const N: usize> PartialEq for Handle<S, N> {
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

impl<S, const N: usize> Eq for Handle<S, N> {}

impl<S, const N: usize> PartialOrd for Handle<S, N> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Compares by the index within a scene.
impl<S, const N: usize> Ord for Handle<S, N> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key().cmp(&other.key())
    }
}

impl<S, const N: usize> Hash for Handle<S, N> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.key().hash(state);
    }
}

impl<S, const N: usize> fmt::Debug for Handle<S, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Handle").field(&self.index).finish()
    }
}

/// Joints and pendulums that were added together, such as those of a character, to be removed
/// together. [`Scene::bundle`] creates it; copies name the same joints and pendulums.
#[derive(Clone, Debug)]
pub struct Bundle {
    pub(crate) scene: SceneId,
    /// The type, the index and the generation of each pendulum.
    pub(crate) pendulums: Vec<(TypeId, (u32, u32))>,
    /// The index and the generation of each joint.
    pub(crate) joints: Vec<(u32, u32)>,
}

#[cfg(test)]
mod tests {
    use super::{Handle, SceneId};
    use std::collections::{BTreeSet, HashSet};

    /// A type that implements no traits: handles do not require any.
    struct Bob;

    #[test]
    fn handles_are_keys_of_maps() {
        let scene = SceneId::next();
        let handle = |index| Handle::<Bob, 1>::new(scene, index, 0);
        let ordered: BTreeSet<_> = [handle(2), handle(0), handle(2)].into();
        assert!(ordered.into_iter().eq([handle(0), handle(2)]));
        assert_eq!(HashSet::from([handle(1), handle(1)]).len(), 1);
        assert_ne!(Handle::<Bob, 1>::new(SceneId::next(), 1, 0), handle(1));
        assert_ne!(Handle::<Bob, 1>::new(scene, 1, 1), handle(1));
    }
}
