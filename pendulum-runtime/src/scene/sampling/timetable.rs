//! The times at which joints are sampled: each time is sampled once for all grids that contain it.

use crate::scene::sampling::clock::Clock;
use crate::scene::sampling::scheme::Grid;
use crate::time::Time;

/// All grids of a scene, and the sampling times for each set of grids that a joint serves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Timetable {
    grids: Vec<Grid>,
    classes: Vec<Class>,
}

#[derive(Clone, Debug)]
struct Class {
    /// The set of grids, by bit.
    grids: u64,
    /// The times of all samples in a tick, as fractions of the tick, in ascending order.
    fractions: Vec<f64>,
    /// For each grid, the indices of the samples used by its evaluations.
    nodes: Vec<Vec<u16>>,
    /// The times of all samples in a batch, tick by tick.
    times: Vec<Time>,
}

impl Timetable {
    /// Returns the bit of a grid, and adds the grid if it is new.
    pub(crate) fn bit(&mut self, grid: Grid) -> u64 {
        let index = self.grids.iter().position(|&known| known == grid).unwrap_or_else(|| {
            self.grids.push(grid);
            self.classes.clear();
            self.grids.len() - 1
        });
        1 << index
    }

    /// Returns the class of a set of grids, and adds the class if it is new.
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

    /// Computes the sampling times of a batch.
    pub(crate) fn begin(&mut self, clock: &Clock, tick: i64, ticks: usize) {
        for Class { fractions, times, .. } in &mut self.classes {
            times.clear();
            for now in tick..tick + ticks as i64 {
                times.extend(fractions.iter().map(|&fraction| clock.within(now, fraction)));
            }
        }
    }

    /// Returns the times at which joints of a class are sampled in a batch, tick by tick.
    pub(crate) fn times(&self, class: u32) -> &[Time] {
        &self.classes[class as usize].times
    }

    #[cfg(test)]
    fn fractions(&self, class: u32) -> &[f64] {
        &self.classes[class as usize].fractions
    }

    /// Returns the number of samples in a tick, and the indices of the samples used by the
    /// evaluations of `grid`.
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
