//! Serialization of solutions with `serde`.

use crate::integrate::events::{Occurrence, Status};
use crate::integrate::interpolant::dense::DenseOutput;
use crate::integrate::solution::{RunNumber, Solution};
use crate::integrate::state::State;
use crate::integrate::state::arrays::rows;
use crate::integrate::state::impact::Impact;
use crate::integrate::state::slip::Slip;
use crate::integrate::stats::{ConstraintStats, Extreme, Stats};
use crate::system::label::{Label, Labels, Source};
use crate::time::Time;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::{Mutex, PoisonError};

/// The names of methods, constraints, limits and frictions read so far. They live as long as the
/// program, like the names in its code.
static NAMES: Mutex<Vec<&'static str>> = Mutex::new(Vec::new());

/// The maximum number of names that files can add for the life of the program.
const MOST_NAMES: usize = 256;
/// The maximum length of such a name in bytes.
const LONGEST_NAME: usize = 64;

/// Returns a name that lives as long as the program.
fn name<E: Error>(text: String) -> Result<&'static str, E> {
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = names.iter().find(|known| **known == text) {
        return Ok(known);
    }
    if LONGEST_NAME < text.len() || MOST_NAMES <= names.len() {
        return Err(E::custom("not the name of a method, a constraint, a limit or a friction"));
    }
    let name: &'static str = text.leak();
    names.push(name);
    Ok(name)
}

/// The form in which an extreme value is read.
#[derive(Deserialize)]
struct ReadExtreme {
    value: f64,
    t: f64,
    constraint: String,
}

impl<'de> Deserialize<'de> for Extreme {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let ReadExtreme { value, t, constraint } = ReadExtreme::deserialize(deserializer)?;
        Ok(Self { value, t, constraint: name(constraint)? })
    }
}

/// The form in which an impact is read.
#[derive(Deserialize)]
#[serde(bound(deserialize = "T: Deserialize<'de>"))]
struct ReadImpact<T, const N: usize> {
    limit: usize,
    name: String,
    time: Time,
    state: State<T, N>,
    after: State<T, N>,
    impulse: T,
}

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Impact<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let impact = ReadImpact::deserialize(deserializer)?;
        let ReadImpact { limit, name: text, time, state, after, impulse } = impact;
        Ok(Self { limit, name: name(text)?, time, state, after, impulse })
    }
}

/// The form in which an interval of stick or slip is read.
#[derive(Deserialize)]
struct ReadSlip {
    friction: usize,
    name: String,
    start: f64,
    end: f64,
    direction: i8,
}

impl<'de> Deserialize<'de> for Slip {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let ReadSlip { friction, name: text, start, end, direction } =
            ReadSlip::deserialize(deserializer)?;
        Ok(Self { friction, name: name(text)?, start, end, direction })
    }
}

/// The form in which counters are read.
#[derive(Deserialize)]
struct ReadStats {
    #[serde(default)]
    constraints: Option<ConstraintStats>,
    method: String,
    evaluations: u64,
    accepted: u64,
    rejected: u64,
    kinks: u64,
}

impl<'de> Deserialize<'de> for Stats {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let ReadStats { constraints, method, evaluations, accepted, rejected, kinks } =
            ReadStats::deserialize(deserializer)?;
        let method = name(method)?;
        Ok(Self { method, evaluations, accepted, rejected, kinks, constraints })
    }
}

/// The form in which a solution is written and read.
#[derive(Serialize, Deserialize)]
#[serde(bound(serialize = "T: Serialize + Clone", deserialize = "T: Deserialize<'de>"))]
struct Parts<T, const N: usize> {
    coordinates: Vec<Label>,
    velocities: Vec<Label>,
    t: Vec<f64>,
    #[serde(with = "rows")]
    q: Vec<[T; N]>,
    #[serde(with = "rows")]
    v: Vec<[T; N]>,
    end: State<T, N>,
    status: Status,
    events: Vec<Occurrence<T, N>>,
    impacts: Vec<Impact<T, N>>,
    stats: Stats,
    dense: Option<DenseOutput<T, N>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    contacts: Vec<u64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    frictions: Vec<Slip>,
}

impl<T: Serialize + Clone, const N: usize> Serialize for Solution<T, N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let own = self.clone();
        let Self { t, q, v, end, status, events, impacts, frictions, stats, .. } = own;
        let Self { dense, contacts, labels, .. } = own;
        let Labels { coordinates, velocities } = labels.labels(N);
        let parts = Parts {
            coordinates,
            velocities,
            t,
            q,
            v,
            end,
            status,
            events,
            impacts,
            stats,
            dense,
            contacts,
            frictions,
        };
        parts.serialize(serializer)
    }
}

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Solution<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let parts = Parts::deserialize(deserializer)?;
        if [parts.coordinates.len(), parts.velocities.len()] != [N; 2] {
            return Err(D::Error::custom(format!("not the names of {N} coordinates")));
        }
        if [parts.q.len(), parts.v.len()] != [parts.t.len(); 2] {
            return Err(D::Error::custom("not as many states as times"));
        }
        if ![0, parts.t.len()].contains(&parts.contacts.len()) {
            return Err(D::Error::custom("not as many contacts as times"));
        }
        if parts.dense.as_ref().is_some_and(|dense| !dense.is_sound()) {
            return Err(D::Error::custom("the dense output is damaged"));
        }
        let Parts { coordinates, velocities, .. } = parts;
        Ok(Self {
            t: parts.t,
            q: parts.q,
            v: parts.v,
            end: parts.end,
            status: parts.status,
            events: parts.events,
            impacts: parts.impacts,
            frictions: parts.frictions,
            stats: parts.stats,
            dense: parts.dense,
            contacts: parts.contacts,
            labels: Source::Read(Labels { coordinates, velocities }),
            run: RunNumber::default(),
        })
    }
}
