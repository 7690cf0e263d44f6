//! The parts of a vessel as lines, for pictures.

use glam::DVec2;

use super::Vessel;
use crate::boundary::brick::Brick;

impl Vessel {
    /// Returns the bricks of all parts at an absolute time, as lines for a picture.
    ///
    /// Each item is the name of the part and a line of points along the brick. The points of an arc are at
    /// most three degrees apart.
    ///
    /// Walls of the container and single points are left out.
    ///
    /// ```
    /// use granular_edmd::boundary::{Part, Vessel};
    /// use granular_edmd::glam::DVec2;
    ///
    /// let paddle = Part::polyline([DVec2::new(1.0, 4.0), DVec2::new(7.0, 4.0)])?;
    /// // A quarter turn takes 1 unit of time.
    /// let paddle = paddle.with_rotation(DVec2::splat(4.0), 0.5 * std::f64::consts::PI)?;
    /// let vessel = Vessel::around([("paddle", paddle)])?;
    /// let lines: Vec<(&str, Vec<DVec2>)> = vessel.outline(1.0).collect();
    /// let (name, line) = &lines[0];
    /// assert_eq!((lines.len(), *name), (1, "paddle"));
    /// assert!(line[0].distance(DVec2::new(4.0, 1.0)) < 1e-12);
    /// # Ok::<(), granular_edmd::boundary::VesselError>(())
    /// ```
    pub fn outline(&self, time: f64) -> impl Iterator<Item = (&str, Vec<DVec2>)> {
        self.parts.iter().flat_map(move |placed| {
            let pose = placed.part.travel().pose(placed.part.phase(time));
            let bricks = placed.part.bricks().iter().filter(|brick| !brick.is_point());
            let line =
                move |brick: &Brick| brick.outline().into_iter().map(|place| pose.outward(place)).collect();
            bricks.map(move |brick| (placed.name.as_str(), line(brick)))
        })
    }
}
