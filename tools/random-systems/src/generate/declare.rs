//! Parameters, coordinates and driven inputs.

use super::Generator;
use crate::tree::{Coordinate, Input, Kind, Parameter};
use systems::random::Random;

const PARAMETERS: [&str; 12] = ["m", "c", "l", "g", "κ", "b", "μ", "s", "R", "a", "ε", "d"];
const COORDINATES: [&str; 8] = ["θ", "φ", "x", "y", "ψ", "r", "q", "h"];
const INPUTS: [&str; 3] = ["u", "z", "f"];

impl Generator {
    pub(crate) fn declare(&mut self) {
        self.system.units = self.random.below(5) < 2;
        let units = self.system.units;
        let mut names = PARAMETERS.to_vec();
        let mut take = |random: &mut Random| names.remove(random.below(names.len())).to_owned();
        for _ in 0..=self.random.below(3) {
            let name = take(&mut self.random);
            self.system.parameters.push(Parameter { name, kind: Kind::Scalar });
        }
        self.system.parameters.push(Parameter { name: "ω".to_owned(), kind: Kind::Rate });
        // Arrays and bodies have units, so that all units are checked.
        if units {
            for kind in [Kind::Vector(2), Kind::Vector(3), Kind::Family(4), Kind::Body] {
                if self.random.below(3) != 0 {
                    let name = take(&mut self.random);
                    self.system.parameters.push(Parameter { name, kind });
                    if kind == Kind::Body {
                        let measures = [("M", Kind::Mass), ("Λ", Kind::Length)];
                        let measures =
                            measures.map(|(name, kind)| Parameter { name: name.to_owned(), kind });
                        self.system.parameters.extend(measures);
                    }
                }
            }
        }
        let mut left = 1 + self.random.below(4);
        let mut names = COORDINATES.to_vec();
        while 0 < left {
            let name = names.remove(self.random.below(names.len())).to_owned();
            let length =
                if self.random.once_in(2) { Some(1 + self.random.below(left)) } else { None };
            left -= length.unwrap_or(1);
            self.system.coordinates.push(Coordinate { name, length });
        }
        for name in INPUTS.iter().take([0, 0, 1, 1, 2][self.random.below(5)]) {
            let components = if units { 1 + self.random.below(3) } else { 1 };
            self.system.inputs.push(Input { name: (*name).to_owned(), components });
        }
    }
}
