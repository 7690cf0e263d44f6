//! Vessels of any shape: named parts in a container.

mod answers;
mod index;
mod outline;
mod overlap;
mod room;
mod search;

use std::ops::Range;

use glam::DVec2;

use super::brick::Brick;
use super::part::{Part, Phase, Travel};
use super::{Boundary, Container, VesselError};
use crate::quantity::accept;
use index::Index;

/// Largest number of walls of a vessel.
const MOST_WALLS: usize = 1 << 16;

/// Largest number of periods over which a part may extend in one direction, and largest product of both
/// numbers. Each brick has an image for each period, and each image may overlap a large part of the cells.
const MOST_PERIODS: [f64; 2] = [64.0, 256.0];

/// Smallest stroke of a part, relative to its coordinates. The positions of a part with a smaller stroke are
/// lost in rounding.
const LEAST_STROKE: f64 = 4096.0 * f64::EPSILON;

/// A vessel of any shape: named [parts](Part) in a [`Container`].
///
/// A disk must clear the container's walls and each part: two blocks make a hopper, and a polygon can have
/// pegs in it. Parts may overlap, and may reach beyond the container. Parts are repeated across periodic
/// sides: a part that extends beyond one side enters again at the other, however far it extends. Parts are
/// added, replaced and removed by name, even between runs
/// ([`Simulation::set_boundary`](crate::simulation::Simulation::set_boundary)).
///
/// Initial states keep clear of all parts at their positions at time 0. To pack disks densely among parts
/// that move, pack them with the same parts at rest.
///
/// The walls of the container have the first indices. After them, each brick and each corner of each part is
/// a wall, in the order in which the parts were added. [`walls`](Self::walls) returns the indices of one
/// part.
///
/// ```
/// use granular_edmd::boundary::{Container, Part, Vessel};
/// use granular_edmd::collision::{ContactDuration, Frictional};
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::{Simulation, initial};
///
/// // A silo: two blocks leave an outlet of width 6, which a gate shuts.
/// let slope = [(0.0, 10.0), (7.0, 10.0), (0.0, 20.0)].map(DVec2::from);
/// let other = slope.map(|corner| DVec2::new(20.0 - corner.x, corner.y));
/// let silo = Vessel::new(Container::open(20.0)?)
///     .with("left slope", Part::block(slope)?)?
///     .with("right slope", Part::block(other)?)?
///     .with("gate", Part::polyline([(6.0, 9.9), (14.0, 9.9)].map(DVec2::from))?)?;
///
/// // A lattice begins at the floor. The disks below the gate are left out.
/// let mut disks = initial::lattice(&silo, 200, 0.5)?;
/// disks.retain(|disk| disk.position().y > 10.0);
/// let rule = ContactDuration::new(Frictional::from_inelasticity(0.1, 0.1, 0.3)?, 1e-3)?;
/// let mut run = Simulation::builder(rule, silo).disks(disks).gravity(1.0).build()?;
/// run.run_until(0.5, &mut ())?;
///
/// let mut silo = run.boundary().clone();
/// silo.remove("gate")?;
/// run.set_boundary(silo)?;
/// run.run_until(1.0, &mut ())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Vessel {
    container: Container,
    parts: Vec<Placed>,
    walls: Vec<Wall>,
    index: Index,
    /// The parts that move and that disks may not overlap.
    moving: Vec<u32>,
    /// True if a part treats disks differently from a plain wall.
    has_patches: bool,
    /// For each cell of the index, the parts at rest that fill it.
    filled: Vec<Vec<u32>>,
    /// The radii of all arcs with disks inside, in order, each with the index of its wall.
    hollows: Vec<(f64, usize)>,
    /// Time origin, from which the phases of added parts follow.
    origin: f64,
}

/// A part of a vessel.
#[derive(Debug, Clone)]
struct Placed {
    name: String,
    part: Part,
    /// Index of the first wall.
    first: usize,
    /// Phase of the motion at the time origin.
    phase: Phase,
    /// Lower left and upper right corner of a rectangle that holds the part at all times.
    bounds: (DVec2, DVec2),
    /// Largest coordinate of that rectangle, in magnitude.
    size: f64,
}

impl Placed {
    fn new(name: String, part: Part) -> Self {
        let (low, high) = part.swept_bounds();
        let size = low.abs().max(high.abs()).max_element();
        Self { name, part, first: 0, phase: Phase::default(), bounds: (low, high), size }
    }
}

/// A brick of a part.
#[derive(Debug, Clone, Copy)]
struct Wall {
    part: usize,
    brick: Brick,
}

/// Parts.
impl Vessel {
    /// Creates a vessel without parts: the container.
    pub const fn new(container: Container) -> Self {
        Self {
            container,
            parts: Vec::new(),
            walls: Vec::new(),
            index: Index::EMPTY,
            moving: Vec::new(),
            has_patches: false,
            filled: Vec::new(),
            hollows: Vec::new(),
            origin: 0.0,
        }
    }

    /// Creates a vessel of parts that enclose the disks without a container.
    ///
    /// The container is a rectangle around the parts, which no disk touches.
    ///
    /// # Errors
    /// The same as for [`put`](Self::put).
    ///
    /// ```
    /// use granular_edmd::boundary::{Boundary, Part, Vessel};
    /// use granular_edmd::glam::DVec2;
    ///
    /// // A drum about the origin that turns clockwise once in 20 time units.
    /// let turning = -std::f64::consts::TAU / 20.0;
    /// let drum = Part::drum(DVec2::ZERO, 10.0)?.with_rotation(DVec2::ZERO, turning)?;
    /// let vessel = Vessel::around([("drum", drum)])?;
    /// let surface = vessel.surface(vessel.walls("drum").unwrap().start, DVec2::new(0.0, -9.5), 0.0);
    /// assert_eq!((surface.normal, surface.velocity.x), (DVec2::Y, 10.0 * turning));
    /// # Ok::<(), granular_edmd::boundary::VesselError>(())
    /// ```
    pub fn around<N: Into<String>>(parts: impl IntoIterator<Item = (N, Part)>) -> Result<Self, VesselError> {
        /// Room beyond the parts, relative to their size.
        const ROOM: f64 = 1.0 / 16.0;
        let parts: Vec<(String, Part)> = parts.into_iter().map(|(name, part)| (name.into(), part)).collect();
        let (mut low, mut high) = (DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY));
        for (_, part) in &parts {
            let (from, to) = part.swept_bounds();
            (low, high) = (low.min(from), high.max(to));
        }
        let size = if parts.is_empty() { DVec2::ONE } else { high - low };
        let room = DVec2::splat(ROOM * size.max_element());
        let corner = if parts.is_empty() { DVec2::ZERO } else { low - room };
        let (width, height) = (size.x + 2.0 * room.x, size.y + 2.0 * room.y);
        Self::of(Container::closed(width, height)?.shifted(corner)?, parts)
    }

    fn of(container: Container, parts: Vec<(String, Part)>) -> Result<Self, VesselError> {
        parts.into_iter().try_fold(Self::new(container), |vessel, (name, part)| vessel.with(name, part))
    }

    /// Returns the same vessel with an additional part.
    ///
    /// # Errors
    /// The same as for [`put`](Self::put).
    pub fn with(mut self, name: impl Into<String>, part: Part) -> Result<Self, VesselError> {
        self.put(name, part)?;
        Ok(self)
    }

    /// Puts a part into the vessel.
    ///
    /// The walls of the part come after the walls of all other parts.
    ///
    /// # Errors
    /// If a part or a wall of the container already has this name, if the vessel would have more than 2¹⁶
    /// walls, if the part extends over more than 64 periods of the container in one direction or more than
    /// 256 in both together, or if its motion is lost in the rounding of its coordinates. The vessel then
    /// stays unchanged.
    pub fn put(&mut self, name: impl Into<String>, part: Part) -> Result<(), VesselError> {
        let name = name.into();
        let mut walls = (0..self.container.wall_count()).map(|wall| self.container.wall_name(wall));
        if self.part(&name).is_some() || walls.any(|wall| wall == name) {
            return Err(VesselError::Duplicate { name });
        }
        let placed = Placed::new(name, part);
        self.check(&placed, 0)?;
        self.parts.push(placed);
        self.number();
        Ok(())
    }

    /// Removes a part from the vessel.
    ///
    /// The indices of the walls after it become smaller.
    ///
    /// # Errors
    /// If there is no part of this name. The vessel then stays unchanged.
    pub fn remove(&mut self, name: &str) -> Result<Part, VesselError> {
        let removed = self.parts.remove(self.place_of(name)?);
        self.number();
        Ok(removed.part)
    }

    /// Replaces the part of this name, and returns the old one.
    ///
    /// # Errors
    /// If there is no part of this name, or for the reasons of [`put`](Self::put). The vessel then stays
    /// unchanged.
    pub fn replace(&mut self, name: &str, part: Part) -> Result<Part, VesselError> {
        let place = self.place_of(name)?;
        let placed = Placed::new(name.to_owned(), part);
        self.check(&placed, self.parts[place].part.all_bricks().count())?;
        let before = std::mem::replace(&mut self.parts[place], placed);
        self.number();
        Ok(before.part)
    }

    fn place_of(&self, name: &str) -> Result<usize, VesselError> {
        let place = self.parts.iter().position(|placed| placed.name == name);
        let parts = || self.parts.iter().map(|placed| placed.name.clone()).collect();
        place.ok_or_else(|| VesselError::Unknown { name: name.to_owned(), parts: parts() })
    }

    /// Checks that a part can be in this vessel, in place of a part with `less` walls.
    fn check(&self, placed: &Placed, less: usize) -> Result<(), VesselError> {
        let count = self.wall_count() - less + placed.part.all_bricks().count();
        accept(count <= MOST_WALLS, "number of walls of the vessel", "at most 2^16", count as f64)?;
        let stops_some = !placed.part.stops_none();
        accept(stops_some, "number of kinds for which a part is", "at least 1: leave the part out", 0.0)?;
        let (low, high) = placed.bounds;
        let periods = self.container.domain().periods();
        let count = |length: f64, period: f64| if period > 0.0 { (length / period).max(1.0) } else { 1.0 };
        let [across, up] = [count(high.x - low.x, periods.x), count(high.y - low.y, periods.y)];
        let name = placed.name.clone();
        for (periods, most) in [across.max(up), across * up].into_iter().zip(MOST_PERIODS) {
            if periods > most {
                return Err(VesselError::TooManyPeriods { name, periods, most });
            }
        }
        let (stroke, least) = (placed.part.travel().stroke(), LEAST_STROKE * placed.size);
        if stroke > 0.0 && stroke < least {
            return Err(VesselError::Stroke { name, stroke, least });
        }
        Ok(())
    }

    /// Returns the part of this name, or `None` if the vessel has no such part.
    pub fn part(&self, name: &str) -> Option<&Part> {
        self.parts.iter().find(|placed| placed.name == name).map(|placed| &placed.part)
    }

    /// Returns the names of the parts, in the order of their walls.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.parts.iter().map(|placed| placed.name.as_str())
    }

    /// Returns the indices of the walls of a part, or `None` if the vessel has no part of this name.
    pub fn walls(&self, name: &str) -> Option<Range<usize>> {
        let placed = self.parts.iter().find(|placed| placed.name == name)?;
        Some(placed.first..placed.first + placed.part.all_bricks().count())
    }

    /// Returns the container.
    pub const fn container(&self) -> &Container {
        &self.container
    }

    /// Numbers the walls, and builds their index.
    fn number(&mut self) {
        self.walls.clear();
        for (number, placed) in self.parts.iter_mut().enumerate() {
            placed.first = self.container.wall_count() + self.walls.len();
            placed.phase = placed.part.phase(self.origin);
            let bricks = placed.part.all_bricks();
            self.walls.extend(bricks.map(|&brick| Wall { part: number, brick }));
        }
        let travel = |wall: &Wall| -> &Travel { self.parts[wall.part].part.travel() };
        self.index = Index::new(
            &self.container.domain(),
            &self.walls,
            |wall| travel(wall).bounds(&wall.brick),
            |wall, region| travel(wall).may_reach(&wall.brick, region, 0.0),
        );
        let moves = |part: &u32| {
            let part = &self.parts[*part as usize].part;
            !part.travel().is_at_rest() && !part.takes_centers()
        };
        self.moving = (0..self.parts.len() as u32).filter(moves).collect();
        self.has_patches = self.parts.iter().any(|placed| placed.part.is_patch());
        self.filled = self.filled_cells();
        let hollows = self.walls.iter().enumerate().filter_map(|(number, wall)| {
            let hollow = wall.brick.hollow().filter(|_| !self.parts[wall.part].part.takes_centers())?;
            Some((hollow, number + self.container.wall_count()))
        });
        self.hollows = hollows.collect();
        self.hollows.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
}

crate::gate::from_file! {
    Vessel { container: Container, parts: Vec<(String, Part)> } => Self::of(container, parts), VesselError
}

#[cfg(feature = "serde")]
impl serde::Serialize for Vessel {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        let parts: Vec<_> = self.parts.iter().map(|placed| (&placed.name, &placed.part)).collect();
        let mut vessel = serializer.serialize_struct("Vessel", 2)?;
        vessel.serialize_field("container", &self.container)?;
        vessel.serialize_field("parts", &parts)?;
        vessel.end()
    }
}
