//! The pictures: energy and phase as functions of time, separation of chaotic runs, error as a
//! function of the step for motions with kinks.

use check::report::{Curve, Figure};
use pictures::{Axis, Chart, Picture, color};
use std::error::Error;
use std::path::Path;

/// The texts of a picture.
struct Page {
    figure: Figure,
    file: &'static str,
    title: &'static str,
    x: &'static str,
    y: &'static str,
    /// `true` if the axis of time or step is logarithmic.
    logarithmic: bool,
    /// Lines for comparison: a name, a factor and a power of x, or a growth rate on a linear axis.
    guides: &'static [(&'static str, f64, f64)],
}

const PAGES: &[Page] = &[
    Page {
        figure: Figure::Energy,
        file: "stability-energy.svg",
        title: "Energy of a pendulum from 1.3 rad: bounded for symplectic methods, linear for Dop853",
        x: "t in s",
        y: "largest error until t, relative to the energy above rest",
        logarithmic: true,
        guides: &[("grows as √t", 2e-17, 0.5), ("grows as t", 1e-17, 1.0)],
    },
    Page {
        figure: Figure::Phase,
        file: "stability-phase.svg",
        title: "Phase of the same pendulum: the error from rounding grows about as t√t",
        x: "t in s",
        y: "error in s",
        logarithmic: true,
        guides: &[("grows as t", 3e-17, 1.0), ("grows as t√t", 1e-18, 1.5)],
    },
    Page {
        figure: Figure::Separation,
        file: "stability-separation.svg",
        title: "Double pendulums that start a last digit apart separate at the Lyapunov exponent",
        x: "t in s",
        y: "distance",
        logarithmic: false,
        guides: &[("grows as exp(0.46 t)", 1e-16, 0.46)],
    },
    Page {
        figure: Figure::Kinks,
        file: "stability-kinks.svg",
        title: "A pivot keyed 24 times a second: only hidden keys cost a method its order",
        x: "step in s",
        y: "error after 5 s, in rad",
        logarithmic: true,
        guides: &[
            ("first order", 1.0, 1.0),
            ("second order", 1.0, 2.0),
            ("fourth order", 30.0, 4.0),
        ],
    },
];

/// Draws every picture that has curves, and returns the names of the files.
pub(crate) fn draw(folder: &Path, curves: &[Curve]) -> Result<Vec<&'static str>, Box<dyn Error>> {
    let mut drawn = Vec::new();
    for page in PAGES {
        let own: Vec<&Curve> = curves
            .iter()
            .filter(|curve| curve.figure == page.figure && !curve.points.is_empty())
            .collect();
        if !own.is_empty() {
            page.draw(&folder.join(page.file), &own)?;
            drawn.push(page.file);
        }
    }
    Ok(drawn)
}

impl Page {
    fn draw(&self, path: &Path, curves: &[&Curve]) -> Result<(), Box<dyn Error>> {
        let all = || curves.iter().flat_map(|curve| &curve.points);
        let ends = |values: &mut dyn Iterator<Item = f64>| {
            let values = values.filter(|value| value.is_finite());
            values.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)))
        };
        let (bottom, top) = ends(&mut all().map(|point| point.1));
        let (left, right) = ends(&mut all().map(|point| point.0));
        let x = if self.logarithmic {
            Axis::logarithmic(self.x)
        } else {
            Axis::linear(self.x).range(0.0, right)
        };
        // Zero has no logarithm.
        let y = Axis::logarithmic(self.y).range(bottom.max(1e-16) / 1.5, top * 1.5);
        let mut chart = Chart::new(x, y);
        for &(name, factor, rate) in self.guides {
            let height =
                |x: f64| factor * if self.logarithmic { x.powf(rate) } else { (rate * x).exp() };
            let place = |k: i32| {
                let part = f64::from(k) / 200.0;
                if self.logarithmic { left * (right / left).powf(part) } else { right * part }
            };
            let points = (0..=200).map(place).map(|x| (x, height(x)));
            chart = chart.curve(pictures::Curve::new(points).width(1.0).dashed().name(name));
        }
        for (curve, color) in curves.iter().zip(color::CURVES.into_iter().cycle()) {
            let points = curve.points.iter().copied();
            chart = chart.curve(pictures::Curve::new(points).color(color).name(&curve.name));
        }
        Picture::new(self.title, (960, 560)).chart(chart).save(path)
    }
}
