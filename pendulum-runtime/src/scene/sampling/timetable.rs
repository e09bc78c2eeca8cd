//! Times within a tick at which joints are sampled: once per time for all grids that need them.

use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::scheme::Grid;
use crate::time::Time;

/// All grids of a scene and, for each set of grids that some joint serves, the times of its
/// samples.
#[derive(Clone, Debug, Default)]
pub(crate) struct Timetable {
    grids: Vec<Grid>,
    classes: Vec<Class>,
}

#[derive(Clone, Debug)]
struct Class {
    /// The grids, by bit.
    grids: u64,
    /// The times of all samples in a tick, in ticks, ascending.
    fractions: Vec<f64>,
    /// By grid, the samples that its evaluations take.
    nodes: Vec<Vec<u16>>,
    /// The times of all samples in a batch, tick by tick.
    times: Vec<Time>,
}

impl Timetable {
    /// The bit of a grid.
    pub(crate) fn bit(&mut self, grid: Grid) -> u64 {
        let index = self.grids.iter().position(|&known| known == grid).unwrap_or_else(|| {
            self.grids.push(grid);
            self.classes.clear();
            self.grids.len() - 1
        });
        1 << index
    }

    /// The class of a set of grids.
    pub(crate) fn class(&mut self, grids: u64) -> u32 {
        if let Some(index) = self.classes.iter().position(|class| class.grids == grids) {
            return index as u32;
        }
        let members = || {
            self.grids
                .iter()
                .enumerate()
                .filter(|(index, _)| grids & (1 << index) != 0)
                .map(|(_, grid)| *grid)
        };
        let mut fractions: Vec<f64> = members().flat_map(Grid::fractions).collect();
        fractions.sort_by(f64::total_cmp);
        fractions.dedup();
        let node = |fraction: f64| fractions.partition_point(|&other| other < fraction) as u16;
        let member = |index: usize| grids & (1 << index) != 0;
        let nodes = self.grids.iter().enumerate();
        let nodes = nodes
            .map(
                |(index, grid)| {
                    if member(index) { grid.fractions().map(node).collect() } else { Vec::new() }
                },
            )
            .collect();
        self.classes.push(Class { grids, fractions, nodes, times: Vec::new() });
        self.classes.len() as u32 - 1
    }

    /// Writes down the times of a batch.
    pub(crate) fn begin(&mut self, clock: &Clock, tick: i64, ticks: usize) {
        for Class { fractions, times, .. } in &mut self.classes {
            times.clear();
            for now in tick..tick + ticks as i64 {
                times.extend(fractions.iter().map(|&fraction| clock.within(now, fraction)));
            }
        }
    }

    /// The times at which joints of a class are sampled in a batch, tick by tick.
    pub(crate) fn times(&self, class: u32) -> &[Time] {
        &self.classes[class as usize].times
    }

    #[cfg(test)]
    fn fractions(&self, class: u32) -> &[f64] {
        &self.classes[class as usize].fractions
    }

    /// The samples in a tick, and those among them that the evaluations of `grid` take.
    pub(crate) fn nodes(&self, class: u32, grid: Grid) -> (usize, &[u16]) {
        let class = &self.classes[class as usize];
        let index = self.grids.iter().position(|&known| known == grid).unwrap_or(0);
        (class.fractions.len(), &class.nodes[index])
    }
}

#[cfg(test)]
mod tests {
    use super::Timetable;
    use crate::scene::sampling::scheme::{Grid, Scheme};

    #[test]
    fn grids_share_their_times() {
        let mut timetable = Timetable::default();
        let (one, two) = (
            Grid { scheme: Scheme::Leapfrog, substeps: 1 },
            Grid { scheme: Scheme::Rk4, substeps: 1 },
        );
        let both = timetable.bit(one) | timetable.bit(two);
        let class = timetable.class(both);
        assert_eq!(timetable.fractions(class), [0.0, 0.5, 1.0]);
        assert_eq!(timetable.nodes(class, one), (3, &[1][..]));
        assert_eq!(timetable.nodes(class, two), (3, &[0, 1, 2][..]));
    }
}
