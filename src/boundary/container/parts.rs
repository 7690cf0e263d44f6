//! The parts of a container by name.

use std::ops::Range;

use glam::DVec2;

use super::Container;
use crate::boundary::parts::{Parts, Placed};
use crate::boundary::{Boundary, Part, Region, WallError};
use crate::error::Rounded;
use crate::quantity::accept;
use crate::{Disk, Kind};

/// Largest number of walls of a container.
const MOST_WALLS: usize = 1 << 16;

/// Largest number of periods over which a part may extend in one direction, and largest product of both
/// numbers. Each brick has an image for each period, and each image may overlap a large part of the cells.
const MOST_PERIODS: [f64; 2] = [64.0, 256.0];

/// Smallest stroke of a part, relative to its coordinates. The positions of a part with a smaller stroke are
/// lost in rounding.
const LEAST_STROKE: f64 = 4096.0 * f64::EPSILON;

/// Parts.
impl Container {
    /// Creates a container of parts that enclose the disks.
    ///
    /// The container's own walls are a rectangle around the parts, which no disk touches.
    ///
    /// # Errors
    /// The same as for [`add_part`](Self::add_part).
    ///
    /// ```
    /// use granular_edmd::boundary::{Boundary, Container, Part};
    /// use granular_edmd::glam::DVec2;
    ///
    /// // A drum about the origin that turns clockwise once in 20 time units.
    /// let turning = -std::f64::consts::TAU / 20.0;
    /// let drum = Part::drum(DVec2::ZERO, 10.0)?.with_rotation(DVec2::ZERO, turning)?;
    /// let container = Container::around([("drum", drum)])?;
    /// let rim = container.walls_of("drum").unwrap().start;
    /// let surface = container.surface(rim, DVec2::new(0.0, -9.5), 0.0);
    /// assert_eq!((surface.normal, surface.velocity.x), (DVec2::Y, 10.0 * turning));
    /// # Ok::<(), granular_edmd::boundary::WallError>(())
    /// ```
    pub fn around<N: Into<String>>(parts: impl IntoIterator<Item = (N, Part)>) -> Result<Self, WallError> {
        /// Room beyond the parts, relative to their size.
        const ROOM: f64 = 1.0 / 16.0;
        let parts: Vec<(String, Part)> = parts.into_iter().map(|(name, part)| (name.into(), part)).collect();
        let Region { min, max } = Region::enclosing(parts.iter().map(|(_, part)| part.swept_bounds()));
        let size = if parts.is_empty() { DVec2::ONE } else { max - min };
        let room = DVec2::splat(ROOM * size.max_element());
        let corner = if parts.is_empty() { DVec2::ZERO } else { min - room };
        let (width, height) = (size.x + 2.0 * room.x, size.y + 2.0 * room.y);
        Self::closed(width, height)?.shifted(corner)?.with_parts(parts)
    }

    /// Returns the same container with an additional part.
    ///
    /// # Errors
    /// The same as for [`add_part`](Self::add_part).
    pub fn with_part(self, name: impl Into<String>, part: Part) -> Result<Self, WallError> {
        self.with_parts([(name.into(), part)])
    }

    /// Returns the same container with a fixed round peg for each of these disks, with its position, radius
    /// and kind.
    ///
    /// The parts are named "peg 0", "peg 1" and so on. A peg of the [default kind](crate::Kind::DEFAULT) of
    /// disks is a plain wall. To place a disk by hand, make it a peg while the others are placed around it.
    ///
    /// # Errors
    /// The same as for [`add_part`](Self::add_part).
    ///
    /// ```
    /// use granular_edmd::boundary::{Boundary, Container};
    /// use granular_edmd::glam::DVec2;
    /// use granular_edmd::{Disk, initial};
    ///
    /// // An intruder on the floor, and a thousand grains around and above it.
    /// let container = Container::closed(60.0, 150.0)?;
    /// let intruder = Disk::new(DVec2::new(30.0, 4.0), 4.0)?.with_mass(64.0)?;
    /// let mut disks = initial::lattice(&container.clone().with_pegs([intruder])?, 1000, 0.5)?;
    /// disks.push(intruder);
    ///
    /// // Two pegs that stay where they are.
    /// let pegs = [Disk::new(DVec2::new(20.0, 9.0), 1.0)?, Disk::new(DVec2::new(40.0, 9.0), 1.0)?];
    /// let board = container.with_pegs(pegs)?;
    /// assert_eq!((board.wall_count(), board.wall(5, 0.0).name.as_ref()), (6, "peg 1"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_pegs(self, disks: impl IntoIterator<Item = Disk>) -> Result<Self, WallError> {
        let number = |name: &str| name.strip_prefix("peg ")?.parse::<usize>().ok();
        let first = self.part_names().filter_map(number).max().map_or(0, |last| last.saturating_add(1));
        let peg = |(number, disk): (usize, Disk)| {
            let kind = if disk.kind() == Kind::DEFAULT { Kind::WALL } else { disk.kind() };
            let peg = Part::peg(disk.position(), disk.radius())?.with_kind(kind);
            Ok((format!("peg {number}"), peg))
        };
        let pegs: Result<Vec<_>, WallError> = (first..).zip(disks).map(peg).collect();
        self.with_parts(pegs?)
    }

    pub(super) fn with_parts(
        mut self,
        parts: impl IntoIterator<Item = (String, Part)>,
    ) -> Result<Self, WallError> {
        let mut placed = self.take_parts();
        for (name, part) in parts {
            self.check_name(&name, &placed)?;
            placed.push(Placed::new(name, part));
        }
        self.rebuilt(placed)
    }

    /// Adds a part.
    ///
    /// A disk must clear the container's walls and each part: two blocks make a hopper, and a polygon can
    /// have pegs in it. Parts may overlap, and may reach beyond the container. Parts are repeated across
    /// periodic sides: a part that extends beyond one side enters again at the other, however far it extends.
    /// The walls of the part come after the walls of all other parts.
    ///
    /// # Errors
    /// If a part or a wall of the container already has this name, if the container would have more than 2¹⁶
    /// walls, if the part extends over more than 64 periods of the container in one direction or more than
    /// 256 in both together, if its motion is lost in the rounding of its coordinates, or if it is a
    /// [piston](Part::with_piston) that disks could push aside. The container then stays unchanged.
    ///
    /// ```
    /// use granular_edmd::boundary::{Container, Part};
    /// use granular_edmd::collision::{ContactDuration, Frictional};
    /// use granular_edmd::glam::DVec2;
    /// use granular_edmd::{Simulation, initial};
    ///
    /// // A silo: two blocks leave an outlet of width 6, which a gate shuts.
    /// let slope = [(0.0, 10.0), (7.0, 10.0), (0.0, 20.0)].map(DVec2::from);
    /// let other = slope.map(|corner| DVec2::new(20.0 - corner.x, corner.y));
    /// let silo = Container::open(20.0)?
    ///     .with_part("left slope", Part::block(slope)?)?
    ///     .with_part("right slope", Part::block(other)?)?
    ///     .with_part("gate", Part::polyline([(6.0, 9.9), (14.0, 9.9)].map(DVec2::from))?)?;
    ///
    /// // A lattice begins at the floor. The disks below the gate are left out.
    /// let mut disks = initial::lattice(&silo, 200, 0.5)?;
    /// disks.retain(|disk| disk.position().y > 10.0);
    /// let rule = ContactDuration::new(Frictional::from_inelasticity(0.1, 0.1, 0.3)?, 1e-3)?;
    /// let mut run = Simulation::builder(rule, silo).disks(disks).gravity(1.0).build()?;
    /// run.run_until(0.5, &mut ())?;
    ///
    /// let mut silo = run.boundary().clone();
    /// silo.remove_part("gate")?;
    /// run.set_boundary(silo)?;
    /// run.run_until(1.0, &mut ())?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn add_part(&mut self, name: impl Into<String>, part: Part) -> Result<(), WallError> {
        *self = self.clone().with_part(name, part)?;
        Ok(())
    }

    /// Removes a part.
    ///
    /// The indices of the walls after it become smaller.
    ///
    /// # Errors
    /// If there is no part of this name. The container then stays unchanged.
    pub fn remove_part(&mut self, name: &str) -> Result<Part, WallError> {
        let number = self.number_of(name)?;
        let mut placed = self.take_parts();
        let removed = placed.remove(number);
        self.set_parts(placed);
        Ok(removed.part)
    }

    /// Returns the part of this name, or `None` if the container has no such part.
    pub fn part(&self, name: &str) -> Option<&Part> {
        self.placed().iter().find(|placed| placed.name == name).map(|placed| &placed.part)
    }

    /// Returns the names of the parts, in the order of their walls.
    pub fn part_names(&self) -> impl Iterator<Item = &str> {
        self.placed().iter().map(|placed| placed.name.as_str())
    }

    /// Returns the indices of the walls of a part, or `None` if the container has no part of this name.
    ///
    /// The container's own walls have the first indices ([`index`](Self::index)). After them, each brick and
    /// each corner of each part is a wall, in the order in which the parts were added.
    pub fn walls_of(&self, name: &str) -> Option<Range<usize>> {
        self.placed().iter().find(|placed| placed.name == name).map(Placed::walls)
    }

    pub(super) fn placed(&self) -> &[Placed] {
        self.parts.as_ref().map_or(&[], |parts| &parts.placed)
    }

    pub(super) fn take_parts(&mut self) -> Vec<Placed> {
        self.parts.take().map_or_else(Vec::new, |parts| parts.placed)
    }

    fn set_parts(&mut self, placed: Vec<Placed>) {
        self.parts = Parts::new(placed, self.domain(), self.planes.len(), self.origin);
    }

    /// Returns the container with its parts, after they or the container's walls have changed.
    fn rebuilt(mut self, placed: Vec<Placed>) -> Result<Self, WallError> {
        let walls: usize = placed.iter().map(|placed| placed.part.all_bricks().count()).sum();
        let count = walls + self.planes.len();
        accept(count <= MOST_WALLS, "number of walls of the container", "at most 2^16", count as f64)?;
        placed.iter().try_for_each(|placed| self.check(placed))?;
        self.set_parts(placed);
        Ok(self)
    }

    /// Returns the container after its own walls have changed.
    pub(super) fn changed(mut self) -> Result<Self, WallError> {
        let placed = self.take_parts();
        self.rebuilt(placed)
    }

    fn number_of(&self, name: &str) -> Result<usize, WallError> {
        let number = self.placed().iter().position(|placed| placed.name == name);
        let parts = || self.part_names().map(ToOwned::to_owned).collect();
        number.ok_or_else(|| WallError::Unknown { name: name.to_owned(), parts: parts() })
    }

    fn check_name(&self, name: &str, placed: &[Placed]) -> Result<(), WallError> {
        let is_wall = self.planes.iter().any(|plane| plane.wall.name() == name);
        if is_wall || placed.iter().any(|placed| placed.name == name) {
            return Err(WallError::Duplicate { name: name.to_owned() });
        }
        Ok(())
    }

    /// Checks that a part can be in this container.
    fn check(&self, placed: &Placed) -> Result<(), WallError> {
        let stops_some = !placed.part.stops_none();
        accept(stops_some, "number of kinds for which a part is", "at least 1: leave the part out", 0.0)?;
        let (size, periods) = (placed.bounds.max - placed.bounds.min, self.domain().periods());
        let count = |length: f64, period: f64| if period > 0.0 { (length / period).max(1.0) } else { 1.0 };
        let [across, up] = [count(size.x, periods.x), count(size.y, periods.y)];
        let name = placed.name.clone();
        let (stroke, least) = (placed.part.travel().stroke(), LEAST_STROKE * placed.size);
        let range = format!("0 or at least {}: less is lost in rounding", Rounded(least));
        accept(stroke == 0.0 || stroke >= least, format!("stroke of the part \"{name}\""), range, stroke)?;
        for (periods, most) in [across.max(up), across * up].into_iter().zip(MOST_PERIODS) {
            if periods > most {
                return Err(WallError::TooManyPeriods { name, periods, most });
            }
        }
        if placed.part.is_pushed_aside(&self.domain().region()) {
            return Err(WallError::Guide { name });
        }
        Ok(())
    }
}

/// Writes the parts with their names.
#[cfg(feature = "serde")]
#[expect(clippy::ref_option, reason = "serde passes a reference to the field")]
pub(super) fn named<S: serde::Serializer>(
    parts: &Option<Box<Parts>>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let placed = parts.iter().flat_map(|parts| &parts.placed);
    serializer.collect_seq(placed.map(|placed| (&placed.name, &placed.part)))
}
