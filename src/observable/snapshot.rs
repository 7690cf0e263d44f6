//! Snapshots: the state of a run at one time, with marks by which observers recognize a system and its
//! walls.

use std::cell::OnceCell;
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec2;

use crate::boundary::{Boundary, Domain, Probe, Region, Surface, Wall, WallView};
use crate::{Disk, Gravity};

/// A mark that is unique in this process; 0 until it is assigned.
///
/// It is not written to files, and measurements that differ only in marks compare equal.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Mark(usize);

impl Mark {
    /// No mark.
    pub(super) const NONE: Self = Self(0);

    /// Returns a new mark.
    pub(crate) fn new() -> Self {
        static NEXT: AtomicUsize = AtomicUsize::new(1);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }

    /// Returns whether both marks are assigned and equal.
    pub(super) const fn is_same(self, other: Self) -> bool {
        self.0 == other.0 && self.0 != 0
    }

    /// Returns whether both marks are assigned and different.
    pub(super) const fn is_other(self, other: Self) -> bool {
        self.0 != other.0 && self.0 != 0 && other.0 != 0
    }
}

impl PartialEq for Mark {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// The state of a run at one time: the disks as copies, the walls, gravity.
///
/// Changes of these copies do not affect the run. The copies are made on request, so the start of a run costs
/// nothing for an observer that only reads the time.
#[derive(Clone)]
pub struct Snapshot<'a> {
    time: f64,
    disks: Disks<'a>,
    domain: Domain,
    gravity: Gravity,
    walls: Option<Walls<'a>>,
    wall_count: usize,
    /// Marks of the run and of its walls.
    marks: [Mark; 2],
}

/// The moving disks of a run, which a snapshot copies only on request.
pub(crate) trait Moving {
    /// Returns the number of disks.
    fn count(&self) -> usize;

    /// Returns copies of all disks at a time offset.
    fn copies(&self, offset: f64) -> Vec<Disk>;
}

#[derive(Clone)]
enum Disks<'a> {
    Given(&'a [Disk]),
    Moving { source: &'a dyn Moving, offset: f64, copies: OnceCell<Vec<Disk>> },
}

/// The boundary of a run, and the time of a snapshot as an offset from the boundary's time origin.
#[derive(Clone, Copy)]
struct Walls<'a> {
    boundary: &'a dyn Boundary,
    time: f64,
}

impl fmt::Debug for Snapshot<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} disks at time {:?}", self.len(), self.time)
    }
}

impl<'a> Snapshot<'a> {
    /// Creates a snapshot of `disks` at an absolute time.
    ///
    /// The engine creates snapshots, and tests may do so.
    pub fn new(time: f64, disks: &'a [Disk], domain: Domain, gravity: impl Into<Gravity>) -> Self {
        let (disks, gravity, marks) = (Disks::Given(disks), gravity.into(), [Mark::default(); 2]);
        Self { time, disks, domain, gravity, walls: None, wall_count: 0, marks }
    }

    /// Creates a snapshot of moving disks, at an absolute time and its offset, with the walls around the
    /// disks.
    pub(crate) fn of_run(
        time: f64,
        offset: f64,
        source: &'a dyn Moving,
        boundary: &'a dyn Boundary,
        gravity: Gravity,
        marks: [Mark; 2],
    ) -> Self {
        let disks = Disks::Moving { source, offset, copies: OnceCell::new() };
        let (domain, walls, wall_count) = (boundary.domain(), None, 0);
        Self { time, disks, domain, gravity, walls, wall_count, marks }.with_walls(boundary, offset)
    }

    /// Returns the same snapshot with the walls of a boundary, at this offset from the boundary's time
    /// origin.
    #[must_use]
    pub fn with_walls(self, boundary: &'a dyn Boundary, time: f64) -> Self {
        Self { walls: Some(Walls { boundary, time }), wall_count: boundary.wall_count(), ..self }
    }

    /// Returns the same snapshot with a number of walls but no boundary, for tests of observers.
    #[must_use]
    pub fn with_wall_count(self, wall_count: usize) -> Self {
        Self { wall_count, ..self }
    }

    /// Returns the absolute time of the snapshot.
    pub const fn time(&self) -> f64 {
        self.time
    }

    /// Returns the disks, in the order of their indices.
    pub fn disks(&self) -> &[Disk] {
        match &self.disks {
            Disks::Given(disks) => disks,
            Disks::Moving { source, offset, copies } => copies.get_or_init(|| source.copies(*offset)),
        }
    }

    /// Returns the number of disks.
    pub fn len(&self) -> usize {
        match &self.disks {
            Disks::Given(disks) => disks.len(),
            Disks::Moving { source, .. } => source.count(),
        }
    }

    /// Returns whether there are no disks.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the number of walls, or 0 for a snapshot without walls. Indices of walls are less than this
    /// number.
    pub const fn wall_count(&self) -> usize {
        self.wall_count
    }

    /// Returns the view of a wall. Without a boundary, nothing is known about it.
    pub fn wall(&self, wall: usize) -> WallView<'_> {
        let unknown = || WallView::new(format!("wall {wall}"));
        self.walls.map_or_else(unknown, |walls| WallView::of(walls.boundary, wall, walls.time))
    }

    /// Iterates over the views of all walls, in the order of their indices.
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    ///
    /// let gate = Part::polyline([DVec2::new(1.0, 4.0), DVec2::new(7.0, 4.0)])?;
    /// let container = Container::open(8.0)?.with_part("gate", gate)?;
    /// let grain = Disk::new(DVec2::new(4.0, 6.0), 0.5)?;
    /// let run = Simulation::builder(Elastic, container).disks([grain]).build()?;
    /// let snapshot = run.snapshot();
    /// // The gate has a brick and two corners.
    /// let gate = snapshot.walls().position(|wall| wall.name == "gate").ok_or("a gate")?;
    /// assert_eq!((gate, snapshot.wall_count()), (3, 6));
    /// assert_eq!(snapshot.wall(gate).line().len(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn walls(&self) -> impl Iterator<Item = WallView<'_>> {
        (0..self.wall_count).map(|wall| self.wall(wall))
    }

    /// Returns a point of a wall, which moves with the wall, or `None` if the boundary knows no such point. A
    /// circle that turns about its center does not move.
    ///
    /// For a wall of a [`Container`](crate::boundary::Container), the component along the normal is the
    /// position of the wall.
    pub fn wall_point(&self, wall: usize) -> Option<DVec2> {
        self.wall(wall).point
    }

    /// Returns the velocity of a wall's surface at its [point](Self::wall_point), or `None` if the point is
    /// not known.
    pub fn wall_velocity(&self, wall: usize) -> Option<DVec2> {
        Some(self.surface(wall)?.velocity)
    }

    fn surface(&self, wall: usize) -> Option<Surface<'_>> {
        let (walls, point) = (self.walls?, self.wall_point(wall)?);
        Some(walls.boundary.surface(wall, point, walls.time))
    }

    /// Returns the momentum of a wall with a mass, or `None` for other walls.
    pub(super) fn wall_momentum(&self, wall: usize) -> Option<DVec2> {
        let surface = self.surface(wall)?;
        surface.mass.is_finite().then(|| surface.mass * surface.velocity)
    }

    /// Returns the rectangle of the domain with its edges where the walls are at this time.
    ///
    /// The [`domain`](Self::domain) leaves room for walls that move.
    pub fn edges(&self) -> Domain {
        let mut edges = self.domain;
        for (side, point) in self.walls().filter_map(|wall| wall.side.zip(wall.point)) {
            match side {
                Wall::Left => edges.left = point.x,
                Wall::Right => edges.right = point.x,
                Wall::Floor => edges.bottom = point.y,
                Wall::Lid => edges.top = point.y,
            }
        }
        edges
    }

    /// Returns the walls that move: the index of each, its displacement from its position at rest, and the
    /// phase of its motion. The phase is the time minus whole periods, as
    /// [`WallMotion`](crate::wall::WallMotion) expects it.
    ///
    /// Walls that move together, as the bricks of a part do, appear once.
    ///
    /// ```
    /// use granular_edmd::prelude::*;
    ///
    /// let base = BiParabolic::new(0.1, 10.0)?;
    /// let container = Container::closed(8.0, 8.0)?.with_motion(Wall::Floor, base)?;
    /// let grain = Disk::new(DVec2::new(4.0, 6.0), 0.5)?;
    /// let mut run = Simulation::builder(Elastic, container).disks([grain]).build()?;
    /// run.run_until(0.75, &mut ())?;
    /// let &[(wall, displacement, phase)] = run.snapshot().moving_walls().as_slice() else { panic!() };
    /// assert_eq!((wall, displacement.y), (0, base.state(phase).displacement));
    /// assert!((phase - 0.75 % base.period().unwrap()).abs() < 1e-12);
    /// assert_eq!(run.snapshot().edges().bottom, displacement.y);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn moving_walls(&self) -> Vec<(usize, DVec2, f64)> {
        let moved = |(wall, view): (usize, WallView<'_>)| view.motion.map(|(by, phase)| (wall, by, phase));
        self.walls().enumerate().filter_map(moved).collect()
    }

    /// Returns the area of the part of `region` in which the center of a disk of this radius is free, or
    /// `None` if the boundary does not know the area.
    ///
    /// With a radius of 0, the result is the area that matter can fill. A part of the region beyond the
    /// domain has no area.
    pub fn area(&self, region: &Region, radius: f64) -> Option<f64> {
        let (Walls { boundary, time }, inside) = (self.walls?, self.inside(region));
        if inside.min.cmplt(inside.max).all() { boundary.area(&inside, radius, time) } else { Some(0.0) }
    }

    /// Returns the part of a region in the domain. On a torus, the rest are images.
    fn inside(&self, region: &Region) -> Region {
        region.within(&self.domain.region())
    }

    /// Returns the share of a region that matter can fill, or `None` if the share is not known. A snapshot
    /// without walls counts all of the domain as free.
    pub(crate) fn free_share(&self, region: &Region) -> Option<f64> {
        /// Smallest share that counts as completely free, up to rounding.
        const WHOLE: f64 = 1.0 - 1e-12;
        let inside = self.inside(region);
        let is_clear = || self.walls.is_none() || self.is_clear(&inside);
        let area = self.area(region, 0.0).or_else(|| is_clear().then(|| inside.area()))?;
        let share = area / region.area();
        Some(if share > WHOLE { 1.0 } else { share })
    }

    /// Returns whether a region is free of walls at all times, and not inside a wall.
    pub(crate) fn is_clear(&self, region: &Region) -> bool {
        let middle = region.min + 0.5 * (region.max - region.min);
        // Up to four walls are the walls at the sides and ends of the domain.
        self.walls.map_or(self.wall_count <= 4, |Walls { boundary, time }| {
            let is_free = |place| boundary.overlap(&Probe::new(place, 0.0, time)).is_none();
            !boundary.may_touch(region, 0.0) && is_free(middle)
        })
    }

    /// Returns the rectangle for initial states, or the domain if the walls are not known.
    pub(crate) fn interior(&self) -> Domain {
        self.walls.map_or(self.domain, |walls| walls.boundary.interior())
    }

    /// Returns the mark of the run.
    pub(super) const fn system_mark(&self) -> Mark {
        self.marks[0]
    }

    /// Returns the mark of the walls, which changes when other walls are set.
    pub(super) const fn walls_mark(&self) -> Mark {
        self.marks[1]
    }

    /// Returns the rectangle that holds the centers of the disks.
    pub const fn domain(&self) -> Domain {
        self.domain
    }

    /// Returns gravity.
    pub const fn gravity(&self) -> Gravity {
        self.gravity
    }

    /// Returns the walls as polylines, without the edges of the domain, for pictures: the
    /// [lines](WallView::line) of all walls.
    pub fn wall_lines(&self) -> Vec<Vec<DVec2>> {
        self.walls().map(|wall| wall.line()).filter(|line| !line.is_empty()).collect()
    }

    /// Returns a snapshot of other disks, for example of a part of the present disks, in the same domain at
    /// the same time.
    #[must_use]
    pub const fn with_disks<'b>(&self, disks: &'b [Disk]) -> Snapshot<'b>
    where
        'a: 'b,
    {
        let Self { time, domain, gravity, walls, wall_count, marks, .. } = *self;
        Snapshot { time, disks: Disks::Given(disks), domain, gravity, walls, wall_count, marks }
    }

    /// Returns the mean of a quantity over the disks; NaN without disks.
    pub fn mean(&self, quantity: impl Fn(&Disk) -> f64) -> f64 {
        self.disks().iter().map(quantity).sum::<f64>() / self.len() as f64
    }
}
