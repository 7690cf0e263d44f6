//! Names of walls that are made at run time, and are found in errors.

use granular_edmd::boundary::{
    Boundary, Container, Domain, FirstTouch, Overlap, Probe, Region, Surface, Touch, WallView,
};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::BuildError;
use granular_edmd::{Disk, Flight, Simulation};

/// A container whose walls are named by someone else, or not at all.
struct Named(Container, Option<Vec<String>>);

impl Boundary for Named {
    fn domain(&self) -> Domain {
        self.0.domain()
    }
    fn wall_count(&self) -> usize {
        self.0.wall_count()
    }
    fn wall(&self, wall: usize, _time: f64) -> WallView<'_> {
        let name = self.1.as_ref().and_then(|names| names.get(wall));
        name.map_or_else(|| WallView::new(format!("wall {wall}")), |name| WallView::new(name.as_str()))
    }
    fn set_time_origin(&mut self, origin: f64) {
        self.0.set_time_origin(origin);
    }
    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.0.may_touch(region, radius)
    }
    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        self.0.first_touch(flight, until)
    }
    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        self.0.surface(wall, position, time)
    }
    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        self.0.overlap(probe)
    }
}

fn overlapped(names: Option<Vec<String>>) -> String {
    let boundary = Named(Container::closed(8.0, 6.0).unwrap(), names);
    let disk = Disk::new(DVec2::new(4.0, 0.25), 0.5).unwrap();
    match Simulation::builder(Elastic, boundary).disks([disk]).build() {
        Err(BuildError::OverlapsWall { wall, .. }) => wall,
        other => panic!("{:?}", other.err()),
    }
}

#[test]
fn names_made_at_run_time_are_told() {
    let names = (0..4).map(|k| format!("side {k} of my box")).collect();
    assert_eq!(overlapped(Some(names)), "side 0 of my box");
    assert_eq!(overlapped(Some(Vec::new())), "wall 0");
    assert_eq!(overlapped(None), "wall 0");
}
