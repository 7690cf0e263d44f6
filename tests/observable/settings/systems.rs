//! The settings: small dense gases in all kinds of boxes and vessels. A new setting is one more entry.

use std::f64::consts::{PI, TAU};

use granular_edmd::boundary::{Boundary, Container, Domain, Part, Region, Wall};
use granular_edmd::collision::{CollisionRule, ContactDuration, Elastic, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::initial::Radii;
use granular_edmd::observable::Observer;
use granular_edmd::simulation::{BoxedBoundary, BoxedRule, Inlet, Limits, Rescaling};
use granular_edmd::wall::{Piston, Sinusoidal};
use granular_edmd::{Disk, Gravity, Kind, Simulation, initial};

use oracles::free_area;

use super::log::{Log, State};
use support::report::report;

type Failure = Box<dyn std::error::Error>;
pub(super) type Run = Simulation<BoxedRule, BoxedBoundary>;

/// Ends of the pieces of a run: one between two samples, one on a sample.
const ENDS: [f64; 3] = [7.3, 20.0, 36.5];

/// The other kind of disk.
pub(super) const OTHER: Kind = Kind::new(1);

/// A box or vessel with disks in it.
pub(super) struct Setting {
    pub(super) name: &'static str,
    make: fn() -> Result<Run, Failure>,
    /// What is done to a run between two pieces of it.
    between: fn(&mut Run) -> Result<(), Failure>,
    is_driven: bool,
    pub(super) walls_move: bool,
    /// Whether the walls of a state leave matter free at a place, in closed form.
    pub(super) is_free: fn(DVec2, &State) -> bool,
    /// A rectangle to be measured, which holds most of the disks.
    pub(super) region: Region,
    /// A rectangle that is away from all walls by 1.5; it may reach to periodic seams.
    pub(super) bulk: Region,
}

impl Setting {
    fn new(name: &'static str, make: fn() -> Result<Run, Failure>) -> Self {
        let (region, bulk) = (rectangle(0.0, 0.0, 10.0, 8.0), rectangle(1.75, 2.5, 8.25, 6.0));
        let is_free = |place: DVec2, _: &State| rectangle_has(&rectangle(0.0, 0.0, 10.0, 8.0), place);
        Self { name, make, between: |_| Ok(()), is_driven: false, walls_move: false, is_free, region, bulk }
    }

    /// Runs all pieces while an observer watches, and returns what happened, or the reason why the observer
    /// refuses.
    pub(super) fn run(&self, observer: &mut dyn Observer) -> Result<Log, String> {
        let mut log = Log::new().map_err(|error| error.to_string())?;
        let mut run = (self.make)().map_err(|error| report(&*error))?;
        let mut driving = Rescaling::new(1.0, every(0.75)).map_err(|error| error.to_string())?;
        for (piece, end) in ENDS.into_iter().enumerate() {
            if piece > 0 {
                (self.between)(&mut run).map_err(|error| report(&*error))?;
            }
            let mut both = (&mut log, &mut *observer);
            let ended = if self.is_driven {
                run.run_driven(&Limits::until(end), &mut driving, &mut both)
            } else {
                run.run_until(end, &mut both)
            };
            ended.map_err(|error| report(&error))?;
        }
        Ok(log)
    }

    pub(super) fn gravity(&self) -> Gravity {
        (self.make)().map_or(Gravity::from(0.0), |run| run.gravity())
    }

    pub(super) fn domain(&self) -> Domain {
        (self.make)().map_or(Domain::new(0.0, 1.0, 0.0, 1.0), |run| run.boundary().domain())
    }

    /// Returns the mean free area of a rectangle in some states.
    pub(super) fn mean_area<'a>(&self, region: &Region, states: impl Iterator<Item = &'a State>) -> f64 {
        let states: Vec<&State> = states.take(if self.walls_move { usize::MAX } else { 1 }).collect();
        states.iter().map(|state| self.free_area(region, state)).sum::<f64>() / states.len() as f64
    }

    /// Returns the free area of a rectangle in a state, by many points.
    pub(super) fn free_area(&self, region: &Region, state: &State) -> f64 {
        free_area(region, &|place| (self.is_free)(place, state))
    }
}

pub(super) fn every(interval: f64) -> granular_edmd::observable::SampleTimes {
    granular_edmd::observable::SampleTimes::every(interval).expect("a positive interval")
}

pub(super) fn rectangle(left: f64, bottom: f64, right: f64, top: f64) -> Region {
    Region::new(DVec2::new(left, bottom), DVec2::new(right, top))
}

fn rectangle_has(region: &Region, place: DVec2) -> bool {
    let Region { min, max, .. } = region;
    place.x >= min.x && place.x <= max.x && place.y >= min.y && place.y <= max.y
}

fn rough() -> Result<ContactDuration<Frictional>, Failure> {
    Ok(ContactDuration::new(Frictional::from_inelasticity(0.05, 0.1, 0.3)?, 1e-2)?)
}

/// A gas of 24 disks of radius 0.4 in a boundary.
fn gas(boundary: impl Boundary + Send + Sync + 'static, gravity: impl Into<Gravity>) -> Result<Run, Failure> {
    let disks = initial::scattered(&boundary, 24, 0.4, 8.0, 1)?;
    of(boundary, disks, rough()?, gravity)
}

fn of(
    boundary: impl Boundary + Send + Sync + 'static,
    disks: Vec<Disk>,
    rule: impl CollisionRule + Send + Sync + 'static,
    gravity: impl Into<Gravity>,
) -> Result<Run, Failure> {
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 2)?;
    let (rule, boundary): (BoxedRule, BoxedBoundary) = (Box::new(rule), Box::new(boundary));
    Ok(Simulation::builder(rule, boundary).disks(disks).gravity(gravity).build()?)
}

fn closed() -> Result<Container, Failure> {
    Ok(Container::closed(10.0, 8.0)?)
}

fn points<const N: usize>(points: [(f64, f64); N]) -> [DVec2; N] {
    points.map(DVec2::from)
}

/// Height of the moving floor, and place of the moving right wall.
fn floor(time: f64) -> f64 {
    0.3 * (TAU * time / 5.3).sin()
}

fn moving() -> Result<Run, Failure> {
    let container = closed()?
        .with_motion(Wall::Floor, Sinusoidal::new(0.3, TAU / 5.3)?)?
        .with_motion(Wall::Right, Sinusoidal::new(0.3, TAU / 5.3)?)?;
    gas(container, 0.1)
}

fn obstructed() -> Result<Run, Failure> {
    let block = Part::block(points([(0.0, 0.0), (3.0, 0.0), (0.0, 2.0)]))?;
    let peg = Part::peg(DVec2::new(8.5, 6.5), 1.0)?;
    gas(closed()?.with_part("block", block)?.with_part("peg", peg)?, 0.1)
}

fn mixed() -> Result<Run, Failure> {
    let disks = initial::disks_from_radii(Radii::uniform(0.25, 0.5)?.draw(24, 3), 2.0)?;
    of(closed()?, initial::scattered_mix(&closed()?, disks, 8.0, 1)?, rough()?, 0.1)
}

fn of_two_kinds() -> Result<Run, Failure> {
    let disks = initial::scattered(&closed()?, 24, 0.4, 8.0, 1)?;
    let other = |(index, disk): (usize, Disk)| if index % 3 == 0 { disk.with_kind(OTHER) } else { disk };
    of(closed()?, disks.into_iter().enumerate().map(other).collect(), rough()?, 0.1)
}

fn coming_and_going() -> Result<Run, Failure> {
    let mut run = gas(closed()?.absorbing(Wall::Floor)?, 0.1)?;
    let model = Disk::new(DVec2::ZERO, 0.4)?.with_velocity(DVec2::new(0.4, -0.8))?.with_kind(OTHER);
    run.add_inlet(Inlet::new(points([(1.0, 6.5), (9.0, 7.5)]), [model], every(0.8), 5)?)?;
    Ok(run)
}

/// Puts each disk where the mirror image of another one was.
fn put_elsewhere(run: &mut Run) -> Result<(), Failure> {
    let mirrored =
        |_, disk: Disk| disk.with_position(DVec2::new(10.0 - disk.position().x, disk.position().y));
    Ok(run.map_disks(mirrored)?)
}

/// Returns all settings, the columns of the table.
pub(super) fn settings() -> Vec<Setting> {
    let boxes = boxes().into_iter().chain(vessels()).chain(walls_that_move());
    boxes.chain(others()).collect()
}

fn boxes() -> Vec<Setting> {
    vec![
        Setting::new("closed box", || gas(closed()?, 0.0)),
        Setting {
            bulk: rectangle(0.0, 2.5, 10.0, 6.0),
            ..Setting::new("periodic sides", || gas(closed()?.with_periodic_sides()?, 0.1))
        },
        Setting {
            bulk: rectangle(0.0, 0.0, 10.0, 8.0),
            ..Setting::new("periodic both ways", || {
                let container = Container::periodic(10.0, 8.0)?;
                let disks = initial::scattered(&container, 24, 0.4, 8.0, 1)?;
                of(container, disks, Elastic, 0.0)
            })
        },
        Setting {
            is_free: |place, _| place.x >= 0.0 && place.x <= 10.0 && place.y >= 0.0,
            ..Setting::new("open top", || gas(Container::open(10.0)?, 0.3))
        },
    ]
}

fn vessels() -> Vec<Setting> {
    vec![
        Setting {
            is_free: |place, _| place.min_element() >= 0.0 && place.x / 14.0 + place.y / 9.0 <= 1.0,
            region: rectangle(0.0, 0.0, 14.0, 9.0),
            bulk: rectangle(1.75, 1.75, 4.0, 3.5),
            ..Setting::new("triangle", || {
                let part = Part::polygon(points([(0.0, 0.0), (14.0, 0.0), (0.0, 9.0)]))?;
                gas(Container::around([("triangle", part)])?, 0.1)
            })
        },
        Setting {
            is_free: |place, _| place.distance(DVec2::splat(5.0)) <= 5.0,
            region: rectangle(0.0, 0.0, 10.0, 10.0),
            bulk: rectangle(3.0, 3.0, 7.0, 7.0),
            ..Setting::new("drum", || {
                let drum = Part::drum(DVec2::splat(5.0), 5.0)?.with_rotation(DVec2::splat(5.0), 0.3)?;
                gas(Container::around([("drum", drum)])?, 0.1)
            })
        },
        Setting {
            is_free: |place, _| {
                let in_block = place.x / 3.0 + place.y / 2.0 < 1.0;
                let is_inside = rectangle_has(&rectangle(0.0, 0.0, 10.0, 8.0), place);
                is_inside && !in_block && place.distance(DVec2::new(8.5, 6.5)) > 1.0
            },
            bulk: rectangle(3.5, 2.5, 6.0, 5.5),
            ..Setting::new("block and peg", obstructed)
        },
    ]
}

fn walls_that_move() -> Vec<Setting> {
    vec![
        Setting {
            is_free: |place, state| {
                let inward = floor(state.time);
                rectangle_has(&rectangle(0.0, inward, 10.0 - inward, 8.0), place)
            },
            region: rectangle(0.0, -0.3, 10.3, 8.0),
            bulk: rectangle(1.75, 2.5, 8.0, 6.0),
            walls_move: true,
            ..Setting::new("moving walls", moving)
        },
        Setting {
            is_free: |place, state| rectangle_has(&rectangle(0.0, 0.0, 10.0, state.lid), place),
            bulk: rectangle(1.75, 1.75, 8.25, 4.0),
            walls_move: true,
            ..Setting::new("piston", || {
                let lid = Piston::new(20.0, [0.0, 2.0])?.with_force(2.0)?.with_start(0.5, 0.0)?;
                gas(closed()?.with_piston(Wall::Lid, lid)?, 0.1)
            })
        },
    ]
}

fn others() -> Vec<Setting> {
    vec![
        Setting::new("tilted gravity", || gas(closed()?, Gravity::tilted(0.2, PI / 5.0)?)),
        Setting::new("sizes and masses", mixed),
        Setting::new("kinds", of_two_kinds),
        Setting::new("inlet and sink", coming_and_going),
        Setting { between: put_elsewhere, ..Setting::new("put elsewhere", || gas(closed()?, 0.1)) },
        Setting { is_driven: true, ..Setting::new("driven", || gas(closed()?, 0.1)) },
    ]
}
