//! A custom boundary: a drum whose rim is hot on one side and cold on the other.
//!
//! ```text
//! cargo run --release -p granular-edmd --example own_boundary
//! ```
//!
//! It takes less than a second. You learn which questions a boundary answers (where it is, when a disk
//! touches it, how its surface moves), and that you can build it from the bricks of the library's parts.

use granular_edmd::Flight;
use granular_edmd::boundary::{
    Brick, Domain, FirstTouch, Overlap, Probe, Response, Surface, Thermal, Touch, WallView, laws,
};
use granular_edmd::observable::EnergyChange;
use granular_edmd::prelude::*;

/// The names of both walls.
const HALVES: [&str; 2] = ["hot half", "cold half"];

/// A round drum about the origin. Its right half is thermal wall 0, its left half thermal wall 1.
#[derive(Clone)]
struct Drum {
    radius: f64,
    rim: Brick,
    temperatures: [Thermal; 2],
}

impl Boundary for Drum {
    fn domain(&self) -> Domain {
        Domain::new(-self.radius, self.radius, -self.radius, self.radius)
    }

    fn wall_count(&self) -> usize {
        2
    }

    fn wall(&self, wall: usize, _time: f64) -> WallView<'_> {
        WallView::new(HALVES[wall])
    }

    // The drum does not move, so it needs no clock.
    fn set_time_origin(&mut self, _: f64) {}

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.rim.may_touch(region, radius)
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let wall = |time| usize::from(flight.position(time).x < 0.0);
        self.rim.first_touch(flight, until).map(|time| Touch::new(time, wall(time))).into()
    }

    fn surface(&self, wall: usize, position: DVec2, _time: f64) -> Surface<'_> {
        let surface = Surface::new(self.rim.normal(position), DVec2::ZERO);
        // The rim is hollow, so its radius is negative for the rules that use it.
        surface.with_radius(-self.radius).with_response(Response::Thermal(self.temperatures[wall]))
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let depth = probe.radius() - self.rim.signed_distance(probe.position());
        (depth > 0.0).then_some(Overlap::new(usize::from(probe.position().x < 0.0), depth))
    }
}

fn main() -> anyhow::Result<()> {
    let radius = 15.0;
    let temperatures = [Thermal::new(2.0)?, Thermal::new(0.5)?];
    let mut drum = Drum { radius, rim: Brick::circle(DVec2::ZERO, radius)?, temperatures };
    // The check of the contract lets disks of radius 1/2 fly in the drum at speed 1.
    laws::check(&mut drum, 0.5, 1.0, 1)?;

    let disks = initial::scattered(&drum, 150, 0.5, radius, 1)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1)?;
    let mut simulation = Simulation::builder(Elastic, drum).disks(disks).build()?;
    // Elastic disks carry the heat from the hot half to the cold one, and lose none.
    simulation.run_until(100.0, &mut ())?;
    let mut heat = EnergyChange::default();
    simulation.run_until(600.0, &mut heat)?;
    for half in HALVES {
        let flow = heat.wall(half).mean() * heat.wall(half).count() as f64 / 500.0;
        println!("{half}: energy {flow:+.2} per unit of time");
    }
    Ok(())
}
