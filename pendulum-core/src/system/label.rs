//! Names and units of coordinates and velocities, as stored in a solution.

use super::name;
use crate::system::facts::Facts;

/// The name of a column and the unit of its numbers, empty if no unit was given.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Label {
    pub(crate) name: String,
    pub(crate) unit: String,
}

/// The labels of all coordinates and of all velocities.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Labels {
    pub(crate) coordinates: Vec<Label>,
    pub(crate) velocities: Vec<Label>,
}

/// The source of the labels of a solution. The labels are created on demand.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// The facts of the system.
    Facts(&'static Facts),
    /// Labels read from a file.
    #[cfg_attr(not(feature = "serde"), allow(dead_code))]
    Read(Labels),
}

impl Source {
    /// Returns the labels of `count` coordinates and of their velocities.
    pub(crate) fn labels(&self, count: usize) -> Labels {
        match self {
            Self::Facts(facts) => Labels::new(facts, count),
            Self::Read(labels) => labels.clone(),
        }
    }
}

impl Labels {
    /// Creates the labels of `count` coordinates. Coordinates without a name are `q[0]`, `q[1]`, …,
    /// and their velocities `v[0]`, `v[1]`, ….
    fn new(facts: &Facts, count: usize) -> Self {
        let ascii = !facts.equations.is_empty() && facts.equations.is_ascii();
        let mut labels = Self { coordinates: Vec::new(), velocities: Vec::new() };
        for index in 0..count {
            let name = facts.coordinates.get(index).filter(|name| !name.is_empty());
            let (coordinate, velocity) = match name {
                Some(name) => ((*name).into(), name::velocity(name, ascii)),
                None => (format!("q[{index}]"), format!("v[{index}]")),
            };
            let unit = facts.coordinate_units.get(index).copied().unwrap_or_default();
            labels.coordinates.push(Label { name: coordinate, unit: unit.into() });
            labels.velocities.push(Label { name: velocity, unit: per_second(unit) });
        }
        labels
    }

    /// Returns the index of the coordinate with this name, as parsed by [`name::read`].
    pub(crate) fn coordinate(&self, name: &str) -> Option<usize> {
        let wanted = name::read(name);
        self.coordinates.iter().position(|label| name::read(&label.name) == wanted)
    }

    /// Returns the names of all columns: `t`, the coordinates, the velocities.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        let labels = self.coordinates.iter().chain(&self.velocities);
        core::iter::once("t").chain(labels.map(|label| label.name.as_str()))
    }
}

/// Returns the unit of a velocity; empty if the unit of the coordinate is not known.
fn per_second(unit: &str) -> String {
    match unit {
        "" => String::new(),
        "s" => "1".into(),
        _ if unit.ends_with("/s") => format!("{unit}^2"),
        _ => format!("{unit}/s"),
    }
}

#[cfg(test)]
mod tests {
    use super::{Labels, per_second};
    use crate::system::Facts;

    #[test]
    fn units_of_velocities_are_per_second() {
        assert_eq!(
            ["rad", "1", "", "s", "m/s"].map(per_second),
            ["rad/s", "1/s", "", "1", "m/s^2"].map(String::from)
        );
    }

    #[test]
    fn nameless_coordinates_are_numbered() {
        let labels = Labels::new(&Facts::new("", &["x"]), 2);
        let names = |labels: &[super::Label]| -> Vec<String> {
            labels.iter().map(|label| label.name.clone()).collect()
        };
        assert_eq!(names(&labels.coordinates), ["x", "q[1]"]);
        assert_eq!(names(&labels.velocities), ["ẋ", "v[1]"]);
    }
}
