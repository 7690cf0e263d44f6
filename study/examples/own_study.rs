//! A custom study: a rule, a boundary and a sample that the library does not have, swept over two axes.
//!
//! Rough grains in a hot round drum that turns. The study measures how fast they turn with it, for each loss
//! and spin. After a stop or a kill, the same command continues; several of them at the same time share the
//! work.
//!
//! ```text
//! cargo run --release --example own_study
//! ```
//!
//! It takes two seconds. You learn what an experiment is; the tables of the study are in `out/own_study`.

use granular_edmd::boundary::{
    Brick, Domain, FirstTouch, Overlap, Probe, Response, Surface, Thermal, Touch, laws,
};
use granular_edmd::observable::CollisionCounts;
use granular_edmd::prelude::*;
use granular_edmd::quantity::{finite, non_negative};
use granular_edmd::{Fingerprint, Flight};
use granular_edmd_study::{
    Axis, Column, Control, Experiment, ExperimentError, Plan, PlanError, Protocol, Study,
};
use serde::{Deserialize, Serialize};

/// The parameters: a plan varies them by the names of these fields.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Turning {
    disks: usize,
    loss: f64,
    spin: f64,
}

/// Restitution `1 / (1 + loss * speed)`, with friction.
struct Viscous {
    loss: f64,
    friction: Friction,
}

impl CollisionRule for Viscous {
    fn impulse(&self, contact: &Contact) -> Impulse {
        let restitution = 1.0 / (1.0 + self.loss * contact.closing_speed());
        self.friction.impulse(contact, contact.normal_impulse(restitution))
    }
    // With this fingerprint and the drum's, a study notices by itself that rule or walls have changed.
    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Viscous").number(self.loss))
    }
}

/// A round drum about the origin, hot and turning, without gravity.
struct Drum {
    radius: f64,
    rim: Brick,
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
        self.rim.may_touch(region, radius)
    }
    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        self.rim.first_touch(flight, until).map(|time| Touch::new(time, 0)).into()
    }
    fn surface(&self, _wall: usize, position: DVec2, _time: f64) -> Surface<'_> {
        let normal = self.rim.normal(position);
        let surface = Surface::new(normal, -self.spin * self.radius * normal.perp());
        // The rim is hollow, so its radius is negative, and it turns at the same rate everywhere.
        let surface = surface.with_radius(-self.radius).with_angular_velocity(self.spin);
        surface.with_response(Response::Thermal(self.heat))
    }
    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let depth = probe.radius() - self.rim.signed_distance(probe.position());
        (depth > 0.0).then_some(Overlap::new(0, depth))
    }
    fn fingerprint(&self) -> Option<Fingerprint> {
        Some(Fingerprint::of("Drum").number(self.radius).number(self.spin))
    }
}

/// The numbers that are kept of each sample.
#[derive(Serialize, Deserialize)]
struct Flow {
    /// Angular momentum of a disk about the middle, including its spin.
    angular_momentum: f64,
    collisions: u64,
}

impl Experiment for Turning {
    type Rule = Viscous;
    type Boundary = Drum;
    type Observer = CollisionCounts;
    type Sample = Flow;

    // Any edit of this file makes another study, so values of different code are never mixed.
    fn revision() -> Fingerprint {
        Fingerprint::of(include_str!("own_study.rs"))
    }

    fn rule(&self) -> Result<Viscous, ExperimentError> {
        Ok(Viscous {
            loss: non_negative("loss", self.loss)?,
            friction: Friction::from_inelasticity(0.1, 0.3)?,
        })
    }
    fn boundary(&self) -> Result<Drum, ExperimentError> {
        let (radius, spin) = (8.0, finite("spin", self.spin)?);
        Ok(Drum { radius, rim: Brick::circle(DVec2::ZERO, radius)?, spin, heat: Thermal::new(1.0)? })
    }
    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        let disks = initial::scattered(&self.boundary()?, self.disks, 0.5, 16.0, seed)?;
        Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
    }
    fn observer(&self) -> Result<CollisionCounts, ExperimentError> {
        Ok(CollisionCounts::default())
    }
    fn sample(&self, snapshot: &Snapshot<'_>, counts: &mut CollisionCounts) -> Flow {
        let orbit = |disk: &Disk| disk.mass() * disk.position().perp_dot(disk.velocity());
        let spin = |disk: &Disk| disk.moment_of_inertia() * disk.angular_velocity();
        let collisions = std::mem::take(counts).disk_collisions();
        Flow { angular_momentum: snapshot.mean(|disk| orbit(disk) + spin(disk)), collisions }
    }
    fn columns() -> Vec<Column<Self>> {
        vec![
            Column::sampled("angular_momentum", "mass diameter velocity", |m: &Flow| m.angular_momentum),
            Column::sampled("collisions", "1", |m: &Flow| m.collisions),
        ]
    }
}

fn plan(base: Turning) -> Result<Plan<Turning>, PlanError> {
    Plan::new(base, Protocol::new(50, 1000, 1)?, 1)?
        .with_axis(Axis::new("loss", [0.0, 0.1, 0.3])?)?
        .with_axis(Axis::new("spin", [0.05, 0.1, 0.2])?)?
        .with_repeats(3)
}

fn main() -> anyhow::Result<()> {
    let base = Turning { disks: 60, loss: 0.1, spin: 0.1 };
    // A drum that breaks the contract of boundaries would give wrong numbers in silence.
    laws::check(&mut base.boundary()?, 0.5, 1.0, 1)?;
    let study = Study::open_or_create("out/own_study", &plan(base)?)?;
    study.run(&Control::default())?;
    println!("loss  spin  angular momentum");
    for point in study.points() {
        let point = point?;
        let Turning { loss, spin, .. } = point.experiment();
        println!("{loss:4}  {spin:4}  {}", point.mean(|flow| flow.angular_momentum));
    }
    println!("the tables are in {}", study.folder().display());
    Ok(())
}
