//! A study of one's own: a rule, a wall motion, a sample and two axes that the library does not know.
//!
//! Grains that lose the more the faster they meet, on a floor that shakes with two incommensurate tones. How high do they fly,
//! for each loss and strength? Stopped or killed, the same command goes on; so do any number of them at the same time.
//!
//! ```text
//! cargo run --release --features serde,rayon --example own_study -- --quick
//! cargo run --release --features serde,rayon --example own_study -- --out out --ramp 3
//! ```

mod studies;

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{CollisionRule, Contact, Impulse};
use granular_edmd::observable::{CenterOfMass, CollisionCounts, Observable, Snapshot};
use granular_edmd::study::{
    Axis, Column, Control, Experiment, ExperimentError, Plan, PlanError, Protocol, Study,
};
use granular_edmd::wall::Sinusoidal;
use granular_edmd::{Disk, Fingerprint, initial, quantity};
use kuva::plot::ScatterPlot;
use kuva::render::{figure::Figure, layout::Layout, plots::Plot};
use serde::{Deserialize, Serialize};

/// How high grains fly that lose more in faster collisions.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: studies::Common,
    /// Does this ramp alone, counted from 0.
    #[arg(long)]
    ramp: Option<usize>,
}

/// The parameters: what a plan varies, by the names of these fields.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Hopping {
    disks: usize,
    loss: f64,
    strength: f64,
}

/// Restitution `1 / (1 + loss * speed)`.
#[derive(Debug, Clone, Copy)]
struct Viscous(f64);

impl CollisionRule for Viscous {
    fn impulse(&self, contact: &Contact) -> Impulse {
        Impulse::new(contact.normal_impulse(1.0 / (1.0 + self.0 * contact.closing_speed())), 0.0)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Viscous").number(self.0))
    }
}

/// What is kept of each moment.
#[derive(Debug, Serialize, Deserialize)]
struct Flight {
    height: f64,
    /// Heights of the disks in free flight above all others' mean: a list of any length.
    high: Vec<f64>,
    collisions: u64,
}

impl Experiment for Hopping {
    type Rule = Viscous;
    type Boundary = Container;
    type Observer = CollisionCounts;
    type Sample = Flight;

    fn rule(&self) -> Result<Viscous, ExperimentError> {
        Ok(Viscous(quantity::non_negative("loss", self.loss)?))
    }
    fn boundary(&self) -> Result<Container, ExperimentError> {
        Ok(Container::open(12.0)?.with_motion(Wall::Floor, Sinusoidal::new(0.1 * self.strength, 10.0)?)?)
    }
    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        let disks = initial::lattice(&self.boundary()?, self.disks, 0.5)?;
        Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
    }
    fn gravity(&self) -> f64 {
        0.1
    }
    fn cycle(&self) -> f64 {
        std::f64::consts::TAU / 10.0
    }
    fn sample(&self, snapshot: &Snapshot<'_>, counts: &mut CollisionCounts) -> Flight {
        let height = CenterOfMass.measure(snapshot).y;
        let heights = snapshot.disks().iter().map(|disk| disk.position().y);
        let high = heights.filter(|found| *found > 2.0 * height).collect();
        Flight { height, high, collisions: std::mem::take(counts).disk_collisions() }
    }
    fn columns() -> Vec<Column<Self>> {
        vec![
            Column::sampled("height", "diameter", |flight: &Flight| flight.height),
            Column::sampled("high", "1", |flight: &Flight| flight.high.len()),
            Column::sampled("collisions", "1", |flight: &Flight| flight.collisions),
        ]
    }
}

fn plan(arguments: &Arguments) -> Result<Plan<Hopping>, PlanError> {
    let (protocol, repeats) = if arguments.common.quick {
        (Protocol::new(100, 50, 5), 1)
    } else {
        (Protocol::new(1000, 500, 10), 3)
    };
    Plan::new(Hopping { disks: 40, loss: 0.1, strength: 1.0 }, protocol, arguments.common.seed)?
        .with_axis(Axis::new("loss", [0.05, 0.1, 0.2]))?
        .with_axis(Axis::new("strength", [1.0, 1.5, 2.0]))?
        .with_repeats(repeats)
}

fn main() -> ExitCode {
    studies::end(run(&Arguments::parse()))
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let (folder, plan) = (arguments.common.folder("own_study"), plan(arguments)?);
    if let Some(ramp) = arguments.ramp {
        let summary = Study::open_or_create(&folder, &plan)?.run_ramp(ramp, &Control::default())?;
        println!("ramp {ramp} of {}: {} of {} values", plan.ramps(), summary.finished, summary.total);
        return Ok(());
    }
    let Some(study) = studies::complete(&folder, &plan)? else { return Ok(()) };
    let mut points = Vec::new();
    for record in study.records() {
        let record = record?;
        let height = record.mean(|flight| flight.height);
        println!("loss {}, strength {}: {height}", record.experiment().loss, record.experiment().strength);
        points.push((record.experiment().strength, height.mean(), height.standard_error()));
    }
    let dots = ScatterPlot::new().with_data(points.iter().map(|point| (point.0, point.1)));
    let plots = vec![Plot::Scatter(dots.with_y_err(points.iter().map(|point| point.2)))];
    let layout =
        Layout::auto_from_plots(&plots).with_x_label("strength").with_y_label("height, in diameters");
    studies::write_png(
        Figure::new(1, 1).with_plots(vec![plots]).with_layouts(vec![layout]),
        &study,
        "own_study.png",
    )
}
