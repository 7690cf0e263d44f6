//! Views of walls, for pictures, files, messages and observers.

use std::borrow::Cow;
use std::fmt;

use glam::DVec2;

use super::brick::Brick;
use super::part::Pose;
use super::{Boundary, Wall};

/// A wall at one time, as pictures, files, messages and observers see it.
///
/// Displayed, it is the name of the wall, with the number of the brick or corner in a part of several bricks.
///
/// ```
/// use granular_edmd::boundary::{Boundary, Container, Part, Wall};
/// use granular_edmd::glam::DVec2;
///
/// let bend = Part::polyline([(2.0, 3.0), (4.0, 3.0), (5.0, 2.0)].map(DVec2::from))?;
/// let container = Container::open(8.0)?.with_part("bend", bend)?;
/// let (floor, brick) = (container.wall(0, 0.0), container.wall(4, 0.0));
/// assert_eq!((floor.name.as_ref(), floor.side), ("floor", Some(Wall::Floor)));
/// assert_eq!((brick.name.as_ref(), brick.to_string()), ("bend", "bend, brick 1".to_owned()));
/// assert_eq!(brick.line(), [DVec2::new(4.0, 3.0), DVec2::new(5.0, 2.0)]);
/// # Ok::<(), granular_edmd::boundary::WallError>(())
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct WallView<'a> {
    /// Name of the wall, or of the part to which it belongs, for messages and measurements.
    pub name: Cow<'a, str>,
    /// A point of the wall, if the boundary knows one.
    ///
    /// The point is no hinge: it moves whenever the wall moves so that the free
    /// [`area`](super::Boundary::area) changes, and if its motion has a period, the area has it, too.
    pub point: Option<DVec2>,
    /// The side of the domain at which the wall stands, for the edge of a picture. The wall is straight and
    /// as long as this side.
    pub side: Option<Wall>,
    /// Displacement of the wall from its rest position, and the phase of its motion: the time minus whole
    /// periods, as [`WallMotion`](crate::wall::WallMotion) expects it, and 0 for a wall with a mass.
    ///
    /// It is `None` for a wall that does not move, and for a wall that moves together with a wall of a
    /// smaller index, as the bricks of a part do.
    pub motion: Option<(DVec2, f64)>,
    /// Energy of a wall with a mass, kinetic and potential.
    pub energy: Option<f64>,
    /// The number of a brick or a corner in a part of several bricks.
    pub(super) number: Option<(&'static str, usize)>,
    line: Vec<DVec2>,
    /// A brick and its position. Points along arcs are computed on request.
    pub(super) brick: Option<(Brick, Pose)>,
}

impl<'a> WallView<'a> {
    /// Creates the view of a wall of this name, of which nothing else is known.
    pub fn new(name: impl Into<Cow<'a, str>>) -> Self {
        let (point, side, motion, energy, number, brick) = (None, None, None, None, None, None);
        Self { name: name.into(), point, side, motion, energy, number, line: Vec::new(), brick }
    }

    /// Returns the view of a wall, or its index where a boundary answered with a wall that it does not have.
    pub(crate) fn of<B: Boundary + ?Sized>(boundary: &'a B, wall: usize, time: f64) -> Self {
        if wall < boundary.wall_count() {
            boundary.wall(wall, time)
        } else {
            Self::new(format!("wall {wall}"))
        }
    }

    /// Returns the same view with a point of the wall.
    #[must_use]
    pub fn with_point(self, point: DVec2) -> Self {
        Self { point: Some(point), ..self }
    }

    /// Returns the same view of a wall that stands at a side of the domain.
    #[must_use]
    pub fn with_side(self, side: Wall) -> Self {
        Self { side: Some(side), ..self }
    }

    /// Returns the same view of a wall with this displacement and phase.
    #[must_use]
    pub fn with_motion(self, displacement: DVec2, phase: f64) -> Self {
        Self { motion: Some((displacement, phase)), ..self }
    }

    /// Returns the same view of a wall with a mass and this energy.
    #[must_use]
    pub fn with_energy(self, energy: f64) -> Self {
        Self { energy: Some(energy), ..self }
    }

    /// Returns the same view with these points along the wall.
    #[must_use]
    pub fn with_line(self, line: Vec<DVec2>) -> Self {
        Self { line, ..self }
    }

    /// Returns points along the wall, for pictures. It has no points at the edge of the domain, which is
    /// drawn anyway, and for single points. The points of an arc are at most three degrees apart.
    pub fn line(&self) -> Vec<DVec2> {
        match self.brick {
            Some((brick, pose)) if !brick.is_point() => {
                brick.outline().into_iter().map(|place| pose.outward(place)).collect()
            }
            _ => self.line.clone(),
        }
    }
}

impl fmt::Display for WallView<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.name)?;
        let Some((kind, number)) = self.number else { return Ok(()) };
        write!(formatter, ", {kind} {number}")
    }
}
