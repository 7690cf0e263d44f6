//! A study of one's own: a rule, a boundary, a mixture and a sample that the library does not know, swept over two axes.
//!
//! Rough grains of two sizes in a hot round drum that turns. How fast do they turn with it, for each loss and spin? Stopped or
//! killed, the same command goes on; so do any number of them at the same time.
//!
//! ```text
//! cargo run --release --features serde,rayon --example own_study -- --quick
//! cargo run --release --features serde,rayon --example own_study -- --out out --ramp 3
//! ```
//!
//! Writes `own_study.png` and the tables of the study.

mod studies;

use std::error::Error;
use std::process::ExitCode;

use clap::Parser;
use granular_edmd::boundary::{Boundary, Domain, Region, Response, Surface, Thermal, Touch};
use granular_edmd::collision::{CollisionRule, Contact, Friction, Impulse};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{CollisionCounts, Snapshot};
use granular_edmd::roots::first_descent_of_quartic;
use granular_edmd::study::{
    Axis, Column, Control, Experiment, ExperimentError, Plan, PlanError, Protocol, Study,
};
use granular_edmd::{Disk, Fingerprint, Flight, initial, quantity};
use kuva::plot::ScatterPlot;
use kuva::render::{figure::Figure, layout::Layout, plots::Plot};
use serde::{Deserialize, Serialize};

/// How fast rough grains turn with a drum.
#[derive(Parser)]
struct Arguments {
    #[command(flatten)]
    common: studies::Common,
    /// Does this ramp alone, counted from 0.
    #[arg(long)]
    ramp: Option<usize>,
}

/// The parameters: a plan varies them by the names of these fields.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Turning {
    loss: f64,
    spin: f64,
    small: usize,
    large: usize,
}

/// Restitution `1 / (1 + loss * speed)`, with friction.
#[derive(Debug, Clone, Copy)]
struct Viscous {
    loss: f64,
    friction: Friction,
}

impl CollisionRule for Viscous {
    fn impulse(&self, contact: &Contact) -> Impulse {
        let restitution = 1.0 / (1.0 + self.loss * contact.closing_speed());
        self.friction.impulse(contact, contact.normal_impulse(restitution))
    }
}

/// A round drum about the origin, hot and turning.
#[derive(Debug, Clone, Copy)]
struct Drum {
    radius: f64,
    spin: f64,
    heat: Thermal,
}

impl Boundary for Drum {
    fn domain(&self) -> Domain {
        Domain::new(-self.radius, self.radius, -self.radius, self.radius)
    }
    fn wall_count(&self) -> usize {
        1
    }
    fn set_time_origin(&mut self, _origin: f64) {}
    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        region.min.abs().max(region.max.abs()).length() + radius >= self.radius
    }
    fn first_touch(&self, flight: &Flight, until: f64) -> Option<Touch> {
        let start = flight.time();
        let (r, v, a) = (flight.position(start), flight.velocity(start), flight.acceleration());
        let free = self.radius - flight.radius();
        let square = -(v.length_squared() + r.dot(a));
        let gap = [
            (free - r.length()) * (free + r.length()),
            -2.0 * r.dot(v),
            square,
            -v.dot(a),
            -0.25 * a.length_squared(),
        ];
        let wait = first_descent_of_quartic(&gap, until - start)?;
        Some(Touch::new((start + wait).min(until), 0))
    }
    fn surface(&self, _wall: usize, position: DVec2, _time: f64) -> Surface<'_> {
        let normal = -position.normalize_or(DVec2::Y);
        Surface::new(normal, -self.spin * self.radius * normal.perp())
            .with_response(Response::Thermal(self.heat))
    }
    fn overlap(&self, position: DVec2, radius: f64, _time: f64) -> Option<(usize, f64)> {
        let depth = position.length() + radius - self.radius;
        (depth > 0.0).then_some((0, depth))
    }
    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Drum").number(self.radius).number(self.spin))
    }
}

/// What is kept of each moment.
#[derive(Debug, Serialize, Deserialize)]
struct Moment {
    /// Angular momentum of a disk about the middle, its own spin included.
    angular_momentum: f64,
    collisions: u64,
    /// Distances of the large disks from the middle: a list of any length.
    large: Vec<f64>,
}

impl Experiment for Turning {
    type Rule = Viscous;
    type Boundary = Drum;
    type Observer = CollisionCounts;
    type Sample = Moment;

    fn rule(&self) -> Result<Viscous, ExperimentError> {
        Ok(Viscous { loss: quantity::non_negative("loss", self.loss)?, friction: Friction::new(0.1, 0.3)? })
    }
    fn boundary(&self) -> Result<Drum, ExperimentError> {
        Ok(Drum { radius: 8.0, spin: quantity::finite("spin", self.spin)?, heat: Thermal::new(1.0)? })
    }
    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        let [small, large] = [Disk::new(DVec2::ZERO, 0.4)?, Disk::new(DVec2::ZERO, 0.7)?];
        let disks = [vec![large; self.large], vec![small; self.small]].concat();
        let disks = initial::placed_at_random(&self.boundary()?, disks, 16.0, seed)?;
        Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
    }
    fn sample(&self, snapshot: &Snapshot<'_>, counts: &mut CollisionCounts) -> Moment {
        let orbit = |disk: &Disk| disk.mass() * disk.position().perp_dot(disk.velocity());
        let large = snapshot.disks().iter().filter(|disk| disk.radius() > 0.5);
        Moment {
            angular_momentum: snapshot
                .mean(|disk| orbit(disk) + disk.moment_of_inertia() * disk.angular_velocity()),
            collisions: std::mem::take(counts).disk_collisions(),
            large: large.map(|disk| disk.position().length()).collect(),
        }
    }
    fn columns() -> Vec<Column<Self>> {
        let mean = |distances: &[f64]| distances.iter().sum::<f64>() / distances.len() as f64;
        vec![
            Column::sampled("angular_momentum", "mass diameter velocity", |moment: &Moment| {
                moment.angular_momentum
            }),
            Column::sampled("collisions", "1", |moment: &Moment| moment.collisions),
            Column::sampled("distance_of_large", "diameter", move |moment: &Moment| mean(&moment.large)),
        ]
    }
}

fn plan(arguments: &Arguments) -> Result<Plan<Turning>, PlanError> {
    let quick = arguments.common.quick;
    let (protocol, repeats) =
        if quick { (Protocol::new(50, 100, 1), 1) } else { (Protocol::new(500, 2000, 2), 3) };
    Plan::new(Turning { loss: 0.1, spin: 0.1, small: 40, large: 12 }, protocol, arguments.common.seed)?
        .with_axis(Axis::new("loss", [0.0, 0.1, 0.3]))?
        .with_axis(Axis::new("spin", [0.05, 0.1, 0.2]))?
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
        let (record, of) = (record?, |moment: &Moment| moment.angular_momentum);
        let (momentum, Turning { loss, spin, .. }) = (record.mean(of), record.experiment());
        println!("loss {loss}, spin {spin}: angular momentum {momentum}");
        points.push((*spin, momentum.mean(), momentum.standard_error()));
    }
    let dots = ScatterPlot::new().with_data(points.iter().map(|point| (point.0, point.1)));
    let plots = vec![Plot::Scatter(dots.with_y_err(points.iter().map(|point| point.2)))];
    let layout = Layout::auto_from_plots(&plots)
        .with_x_label("spin of the drum")
        .with_y_label("angular momentum of a disk");
    let figure = Figure::new(1, 1).with_plots(vec![plots]).with_layouts(vec![layout]);
    studies::write_png(figure, &study, "own_study.png")
}
