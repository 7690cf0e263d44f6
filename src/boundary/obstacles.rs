//! Fixed round obstacles inside another boundary.

use std::borrow::Cow;

use glam::DVec2;

use super::area::{Curve, Curves, Field, Gap, gap, meet};
use super::brick::{ASLANT, Brick};
use super::part::enclosing;
use super::{Boundary, Domain, FirstTouch, Impact, Overlap, Probe, Reaction, Region, Surface, Touch};
use crate::{Disk, Fingerprint, Flight, ParameterError};

/// A boundary with fixed round obstacles inside, such as pegs.
///
/// Each obstacle has the position, the radius and the kind of a disk. It follows the rule of the disks, as a
/// partner of infinite mass at rest. Obstacles may overlap each other and the walls. Among the walls of the
/// boundary, obstacles come last, in the order in which they are given. Each search for a touch tries all of
/// them, so hundreds of obstacles make a run slow.
///
/// [Initial states](crate::initial) keep clear of obstacles. To place a disk by hand, make it an obstacle
/// while the others are placed around it.
///
/// ```
/// use granular_edmd::boundary::{Boundary, Container, Obstacles};
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::{Disk, initial};
///
/// // An intruder on the floor, and a thousand grains around and above it.
/// let container = Container::closed(60.0, 150.0)?;
/// let intruder = Disk::new(DVec2::new(30.0, 4.0), 4.0)?.with_mass(64.0)?;
/// let mut disks = initial::lattice(&Obstacles::new(container.clone(), [intruder]), 1000, 0.5)?;
/// disks.push(intruder);
///
/// // Two pegs that stay where they are.
/// let pegs = [Disk::new(DVec2::new(20.0, 9.0), 1.0)?, Disk::new(DVec2::new(40.0, 9.0), 1.0)?];
/// let board = Obstacles::new(container, pegs);
/// assert_eq!((board.wall_count(), board.wall_name(5)), (6, "obstacle 1".into()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Obstacles<B> {
    boundary: B,
    obstacles: Vec<Disk>,
}

impl<B: Boundary> Obstacles<B> {
    /// Puts obstacles into a boundary, with the positions, radii and kinds of these disks.
    ///
    /// An obstacle outside a periodic domain is moved into it by whole periods.
    pub fn new(boundary: B, obstacles: impl IntoIterator<Item = Disk>) -> Self {
        let domain = boundary.domain();
        // An obstacle whose new position would be out of range keeps its old position.
        let inside = |disk: Disk| disk.with_position(domain.wrapped(disk.position())).unwrap_or(disk);
        Self { obstacles: obstacles.into_iter().map(inside).collect(), boundary }
    }

    /// Returns the boundary without the obstacles.
    pub const fn boundary(&self) -> &B {
        &self.boundary
    }

    /// Returns the obstacles.
    pub fn obstacles(&self) -> &[Disk] {
        &self.obstacles
    }

    /// Returns the circles near a region on which the center of a disk touches an obstacle.
    fn circles(&self, region: &Region, radius: f64) -> Vec<Curve> {
        let circles = self.obstacles.iter().flat_map(|obstacle| {
            let contact = obstacle.radius() + radius;
            self.images(obstacle).map(move |place| Curve::Circle(place, contact))
        });
        circles.filter(|circle| meet(&circle.bounds(), region)).collect()
    }

    /// Returns the positions of an obstacle and of its periodic images.
    fn images(&self, obstacle: &Disk) -> impl Iterator<Item = DVec2> {
        let (place, radius) = (obstacle.position(), obstacle.radius());
        self.boundary.domain().images_of(place - radius, place + radius).map(move |image| place + image)
    }
}

impl<B: Boundary> Boundary for Obstacles<B> {
    fn domain(&self) -> Domain {
        self.boundary.domain()
    }

    fn interior(&self) -> Domain {
        self.boundary.interior()
    }

    fn wall_count(&self) -> usize {
        self.boundary.wall_count() + self.obstacles.len()
    }

    fn wall_name(&self, wall: usize) -> Cow<'_, str> {
        match wall.checked_sub(self.boundary.wall_count()) {
            Some(obstacle) if obstacle < self.obstacles.len() => format!("obstacle {obstacle}").into(),
            _ => self.boundary.wall_name(wall),
        }
    }

    fn set_time_origin(&mut self, origin: f64) {
        self.boundary.set_time_origin(origin);
    }

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        let is_near = |place: DVec2, contact: f64| {
            let nearest = place.clamp(region.min, region.max);
            // The region holds centers of disks. The margin keeps rounding from hiding a touch at its edge.
            nearest.distance(place) <= 1.001 * contact
        };
        self.boundary.may_touch(region, radius)
            || self
                .obstacles
                .iter()
                .any(|obstacle| self.images(obstacle).any(|place| is_near(place, radius + obstacle.radius())))
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let mut first = self.boundary.first_touch(flight, until);
        for (index, obstacle) in self.obstacles.iter().enumerate() {
            for place in self.images(obstacle) {
                let brick = Brick::round(place, obstacle.radius());
                if let Some(time) = brick.first_touch(flight, until.min(first.time())) {
                    let touch = Touch::new(time, self.boundary.wall_count() + index);
                    first = first.or(FirstTouch::At(touch));
                }
            }
        }
        first
    }

    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        let Some(index) = wall.checked_sub(self.boundary.wall_count()) else {
            return self.boundary.surface(wall, position, time);
        };
        let obstacle = &self.obstacles[index];
        let away = self.domain().separation(obstacle.position(), position);
        let surface = Surface::new(away.normalize_or(DVec2::Y), DVec2::ZERO);
        surface.with_kind(obstacle.kind()).with_radius(obstacle.radius())
    }

    fn wall_lines(&self, time: f64) -> Vec<Vec<DVec2>> {
        let circle = |obstacle: &Disk| Brick::round(obstacle.position(), obstacle.radius()).outline();
        self.boundary.wall_lines(time).into_iter().chain(self.obstacles.iter().map(circle)).collect()
    }

    fn wall_point(&self, wall: usize, time: f64) -> Option<DVec2> {
        match wall.checked_sub(self.boundary.wall_count()) {
            Some(index) => self.obstacles.get(index).map(|disk| disk.position() + disk.radius() * ASLANT),
            None => self.boundary.wall_point(wall, time),
        }
    }

    fn edges(&self, time: f64) -> Domain {
        self.boundary.edges(time)
    }

    fn wall_motion(&self, wall: usize, time: f64) -> Option<(DVec2, f64)> {
        self.boundary.wall_motion(wall, time)
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let depth = |(index, obstacle): (usize, &Disk)| {
            let distance = self.domain().separation(obstacle.position(), probe.position()).length();
            Overlap::new(self.boundary.wall_count() + index, probe.radius() + obstacle.radius() - distance)
        };
        let others = self.obstacles.iter().enumerate().map(depth);
        Overlap::deepest(self.boundary.overlap(probe).into_iter().chain(others))
    }

    fn tight_fit(&self, radius: f64) -> Option<usize> {
        self.boundary.tight_fit(radius)
    }

    fn area(&self, region: &Region, radius: f64, time: f64) -> Option<f64> {
        let all = self.boundary.area(region, radius, time)?;
        let region = region.within(&self.domain().region());
        let mut curves = self.circles(&region, radius);
        let ends = curves.iter().map(|circle| (circle.bounds().min, circle.bounds().max));
        let (low, high) = enclosing(ends);
        let region = region.within(&Region::new(low, high));
        let is_taken = |place: DVec2| {
            let touches = |obstacle: &Disk| {
                let apart = self.domain().separation(obstacle.position(), place);
                apart.length() < obstacle.radius() + radius
            };
            self.obstacles.iter().any(touches)
                && self.boundary.overlap(&Probe::new(place, radius, time)).is_none()
        };
        // The curves of a custom boundary's walls are unknown: only overlaps show them.
        let overlap = |probe: &Probe| self.boundary.overlap(probe);
        let gap = |place, reach| gap(overlap, &Probe::new(place, radius, time), reach);
        let inner = self.boundary.curves(&region, radius, time);
        let is_near_wall = |circle: &Curve| self.boundary.may_touch(&circle.bounds(), radius);
        let are_unknown = inner.is_none() && curves.iter().any(is_near_wall);
        let unknown = are_unknown.then_some(&gap as Gap<'_>);
        curves.extend(inner.map(|Curves(inner)| inner).unwrap_or_default());
        Some(all - Field { region, curves, unknown, is_free: &is_taken }.area())
    }

    fn curves(&self, region: &Region, radius: f64, time: f64) -> Option<Curves> {
        let Curves(mut curves) = self.boundary.curves(region, radius, time)?;
        curves.extend(self.circles(region, radius));
        Some(Curves(curves))
    }

    fn react(&mut self, impact: &Impact) -> Reaction {
        // An obstacle never moves, and the inner boundary has no wall of this index.
        if impact.wall < self.boundary.wall_count() { self.boundary.react(impact) } else { Reaction::None }
    }

    fn may_meet(&self, wall: usize, region: &Region, radius: f64, until: f64) -> bool {
        if wall < self.boundary.wall_count() {
            self.boundary.may_meet(wall, region, radius, until)
        } else {
            self.may_touch(region, radius)
        }
    }

    fn state(&self) -> Vec<f64> {
        self.boundary.state()
    }

    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        self.boundary.set_state(state)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let with = Fingerprint::of("Obstacles").part(self.boundary.fingerprint()?);
        Some(self.obstacles.iter().fold(with, |all, obstacle| {
            let DVec2 { x, y } = obstacle.position();
            all.number(x).number(y).number(obstacle.radius()).number(f64::from(obstacle.kind().number()))
        }))
    }
}
