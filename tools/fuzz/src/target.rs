//! The targets of random input.

#[cfg(any(feature = "gltf", feature = "svg"))]
use crate::files::changed;
use crate::files::mutated;
use pendulum_compiler::{compile, expand};
use pendulum_runtime::import::bvh::Bvh;
use proc_macro2::TokenStream;
use random_systems::Random;
use random_systems::generate::{self, Manner};
use random_systems::tokens::{BLOCKS, mutate, soup, transplant};

/// The outcome of a case.
pub(crate) enum Verdict {
    Taken,
    Refused,
    Wrong(String),
}

/// A reader under test.
pub(crate) struct Target {
    pub(crate) name: &'static str,
    /// Runs the case of a seed.
    pub(crate) case: fn(u64) -> Verdict,
}

/// All targets.
pub(crate) const TARGETS: &[Target] = &[
    Target { name: "tokens", case: tokens },
    Target { name: "mutated-blocks", case: mutated_blocks },
    Target { name: "blocks", case: blocks },
    Target { name: "equations", case: equations },
    Target { name: "motion-capture", case: motion_capture },
    #[cfg(feature = "gltf")]
    Target { name: "gltf", case: gltf },
    #[cfg(feature = "gltf")]
    Target { name: "bones", case: bones },
    #[cfg(feature = "svg")]
    Target { name: "svg", case: svg },
];

/// Expands random tokens, in some cases after a struct.
fn tokens(seed: u64) -> Verdict {
    let mut random = Random(seed);
    let mut tokens = parsed("::p;");
    if random.once_in(2) {
        tokens.extend(parsed("struct S { m, L: m }"));
    }
    tokens.extend(soup(&mut random, 0));
    expansion(tokens)
}

/// Expands blocks of the tests and random blocks with some tokens changed.
fn mutated_blocks(seed: u64) -> Verdict {
    let mut random = Random(seed);
    let block = if random.once_in(2) {
        parsed(random.of(BLOCKS))
    } else {
        parsed(&format!("::p; {}", generate::system(seed, Manner::Wild).source("S")))
    };
    expansion(if random.once_in(2) {
        mutate(block, &mut random)
    } else {
        transplant(block, &mut random)
    })
}

/// Expands random systems of any kind.
fn blocks(seed: u64) -> Verdict {
    expansion(parsed(&format!("::p; {}", generate::system(seed, Manner::Wild).source("S"))))
}

/// Compiles random tame systems as text. None may be refused.
fn equations(seed: u64) -> Verdict {
    let source = generate::system(seed, Manner::Tame).source("Random");
    let verdict = match compile(&source) {
        Ok(compiled) if compiled.equations.is_empty() => {
            Verdict::Wrong(format!("no equations of {source}"))
        }
        Ok(_) => Verdict::Taken,
        Err(mistakes) => Verdict::Wrong(format!("refused: {mistakes:?}")),
    };
    forget_sources();
    verdict
}

/// Discards the spans of tokens, which are kept otherwise.
fn forget_sources() {
    proc_macro2::extra::invalidate_current_thread_spans();
}

const JUMPS: &[u8] = include_bytes!("../../../examples/data/jumps.bvh");

/// Reads an invalid motion capture.
fn motion_capture(seed: u64) -> Verdict {
    let mut random = Random(seed);
    // Most of the file consists of rows of numbers.
    let length = if random.once_in(2) { JUMPS.len() } else { 4000 + random.below(6000) };
    let bytes = mutated(&JUMPS[..length], &mut random);
    match Bvh::read(&String::from_utf8_lossy(&bytes)) {
        Ok(_) => Verdict::Taken,
        Err(_) => Verdict::Refused,
    }
}

/// Bones of VRM 1.0 and of VRM 0.x; if the first extension has another name, the second one counts.
#[cfg(feature = "gltf")]
const BONES: &[u8] = br#"{"asset":{"version":"2.0"},"nodes":[{"translation":[0,1.5,0],"children":[1]},
{"translation":[0.1,0.1,0],"rotation":[0,0,0.6,0.8],"children":[2]},{"translation":[0,0.2,0],"scale":[1,1,1],
"children":[3]},{"translation":[0.05,0.1,0]}],"extensions":{"VRMC_springBone":{"specVersion":"1.0","colliders":
[{"node":0,"shape":{"sphere":{"offset":[0,0.1,0],"radius":0.05}}},{"node":3,"shape":{"capsule":{"radius":0.02,
"tail":[0,0.1,0]}},"extensions":{"VRMC_springBone_extended_collider":{"shape":{"plane":{"normal":[0,1,0]}}}}}],
"colliderGroups":[{"colliders":[0,1]}],"springs":[{"center":0,"joints":[{"node":1,"stiffness":0.8,"gravityPower":
0.1,"hitRadius":0.01},{"node":2,"dragForce":0.4},{"node":3}],"colliderGroups":[0]}]},"VRM":{"secondaryAnimation":
{"boneGroups":[{"stiffiness":0.8,"gravityDir":{"x":0,"y":-1,"z":0},"bones":[1],"colliderGroups":[0]}],
"colliderGroups":[{"node":0,"colliders":[{"offset":{"x":0,"y":0.1,"z":0},"radius":0.1}]}]}}}}"#;

/// Reads an invalid file with spring bones.
#[cfg(feature = "gltf")]
fn bones(seed: u64) -> Verdict {
    use pendulum_runtime::attitude::Attitude;
    use pendulum_runtime::import::gltf::Gltf;

    let mut random = Random(seed);
    let mut whole = BONES.to_vec();
    if random.once_in(2)
        && let Some(at) = whole.windows(6).position(|name| name == b"VRMC_s")
    {
        whole[at] = b'v';
    }
    let bytes = changed(&whole, &mut random);
    let springs = Gltf::read(&bytes).and_then(|file| file.springs());
    let Ok(springs) = springs else { return Verdict::Refused };
    for (number, bone) in springs.bones.iter().enumerate() {
        let turns = [bone.axis, bone.rest].map(Attitude::to_quaternion);
        let mut numbers = turns.iter().flatten().chain(&bone.place).chain(&bone.gravity_dir);
        let carried = bone.carrier.is_none_or(|carrier| carrier < number);
        let finite = numbers.all(|number| number.is_finite()) && 0.0 < bone.length;
        if !carried || !finite || !bone.length.is_finite() {
            return Verdict::Wrong(format!("{bone:?}"));
        }
    }
    Verdict::Taken
}

/// Reads an invalid glTF file, and samples the motions of all its nodes.
#[cfg(feature = "gltf")]
fn gltf(seed: u64) -> Verdict {
    use pendulum_runtime::import::gltf::Gltf;
    use pendulum_runtime::motion::{Derivatives, Motion, Side};
    use pendulum_runtime::time::Time;

    let mut random = Random(seed);
    let whole = include_bytes!("../../../examples/data/dance.gltf");
    let bytes = changed(whole, &mut random);
    let Ok(file) = Gltf::read(&bytes) else { return Verdict::Refused };
    for animation in 0..file.animations().count() {
        for node in 0..file.nodes().count() {
            let Ok(motion) = file.motion(animation, node) else { return Verdict::Refused };
            let sample =
                Motion::<f64, 3>::sample(&motion, Time::new(0.3), Side::After, Derivatives::ALL);
            let kink = Motion::<f64, 3>::next_kink(&motion, 0.3);
            if kink.is_some_and(|kink| kink <= 0.3) {
                return Verdict::Wrong(format!("a kink at {kink:?} after 0.3, {sample:?}"));
            }
        }
    }
    Verdict::Taken
}

/// Reads an invalid drawing.
#[cfg(feature = "svg")]
fn svg(seed: u64) -> Verdict {
    use pendulum_runtime::import::svg::{Drawing, Units};

    const OWL: &[u8] = include_bytes!("../../../examples/data/owl.svg");
    const SMALL: &[u8] = br##"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100"><g id="arm"><circle id="arm.keyed" cx="50" cy="10" r="1"/>
<path d="M 48 10 L 52 10 C 55 40 55 60 52 80 L 48 80 Z M 49 20 h 2 v 2 h -2 z" fill="#123456" fill-opacity="0.5" fill-rule="evenodd"/>
<g id="flag" transform="rotate(20 50 10)"><circle id="flag.pendulum" cx="50" cy="70" r="1" fill="none"/><ellipse cx="50" cy="79" rx="4" ry="9"/></g></g></svg>"##;
    let mut random = Random(seed);
    let whole = if random.once_in(20) { OWL } else { SMALL };
    let bytes = changed(whole, &mut random);
    match Drawing::read(&String::from_utf8_lossy(&bytes), Units { pixel: 0.001, density: 0.3 }) {
        Ok(_) => Verdict::Taken,
        Err(_) => Verdict::Refused,
    }
}

/// Expands tokens. The expansion always exists, even for invalid input.
fn expansion(tokens: TokenStream) -> Verdict {
    let refused =
        expand(tokens).into_iter().any(|token| token.to_string().contains("compile_error"));
    forget_sources();
    if refused { Verdict::Refused } else { Verdict::Taken }
}

fn parsed(text: &str) -> TokenStream {
    text.parse().unwrap_or_else(|error| panic!("{error}: {text}"))
}
