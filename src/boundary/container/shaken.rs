//! Walls that slide, and containers that are shaken as a whole.

use super::Container;
use crate::boundary::plane::Slide;
use crate::boundary::{Wall, WallError};
use crate::quantity::finite;
use crate::wall::{Combined, Motion, WallMotion};

impl Container {
    /// Returns the same container with a wall whose surface moves tangentially at this speed, like a conveyor
    /// belt.
    ///
    /// A positive speed moves floor and lid to the right, and the sides up.
    ///
    /// # Errors
    /// If the container has no such wall, if the wall already slides, or if the speed is not finite.
    ///
    /// ```
    /// use granular_edmd::boundary::{Container, Wall};
    /// // A shear cell: the lid moves to the right, the floor to the left.
    /// let cell = Container::closed(20.0, 10.0)?
    ///     .with_periodic_sides()?
    ///     .with_surface_speed(Wall::Lid, 0.5)?
    ///     .with_surface_speed(Wall::Floor, -0.5)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_surface_speed(mut self, wall: Wall, speed: f64) -> Result<Self, WallError> {
        let speed = finite("surface speed", speed)?;
        self.plane_mut(wall)?.set_slide(Slide::Speed(speed))?;
        Ok(self)
    }

    /// Returns the same container with a wall that slides tangentially.
    ///
    /// A positive displacement moves floor and lid to the right, and the sides up. The wall may also move
    /// along its normal.
    ///
    /// # Errors
    /// The same as for [`with_motion`](Self::with_motion), and if the wall slides already.
    pub fn with_sliding(
        mut self,
        wall: Wall,
        motion: impl WallMotion + Send + Sync + 'static,
    ) -> Result<Self, WallError> {
        let motion = Motion::new(motion).map_err(|violation| WallError::Motion { violation })?;
        self.plane_mut(wall)?.set_slide(Slide::Motion { motion, phase: 0.0 })?;
        Ok(self)
    }

    /// Returns the same container, shaken sideways as a whole.
    ///
    /// Side walls move along their normals; floor and lid slide. Parts keep their own motions.
    ///
    /// Vertical motions that were set before are kept, so the floor or the box can move vertically, too.
    ///
    /// # Errors
    /// If the motion gives numbers that are not finite, as for [`with_motion`](Self::with_motion), or jumps,
    /// as a [`Sawtooth`](crate::wall::Sawtooth) does, if a side moves already, or if the floor or the lid
    /// slides already.
    ///
    /// ```
    /// use granular_edmd::boundary::{Boundary, Container, Wall};
    /// use granular_edmd::wall::{BiParabolic, Sinusoidal};
    /// let container = Container::closed(60.0, 150.0)?
    ///     .with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?
    ///     .shaken_sideways(Sinusoidal::new(0.5, 3.0)?)?;
    /// assert_eq!((container.domain().left, container.domain().right), (-0.5, 60.5));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn shaken_sideways(self, motion: impl WallMotion + Send + Sync + 'static) -> Result<Self, WallError> {
        self.shaken([Wall::Left, Wall::Right], [Wall::Floor, Wall::Lid], motion)
    }

    /// Returns the same container, shaken up and down as a whole.
    ///
    /// Floor and lid move along their normals; the sides slide.
    ///
    /// Horizontal motions that were set before are kept.
    ///
    /// # Errors
    /// The same as for [`shaken_sideways`](Self::shaken_sideways), with the walls exchanged.
    pub fn shaken_vertically(
        self,
        motion: impl WallMotion + Send + Sync + 'static,
    ) -> Result<Self, WallError> {
        self.shaken([Wall::Floor, Wall::Lid], [Wall::Left, Wall::Right], motion)
    }

    /// Moves a pair of walls along their normals, which are opposite, with mirrored motions, and lets the
    /// other walls slide.
    fn shaken(
        mut self,
        pair: [Wall; 2],
        others: [Wall; 2],
        motion: impl WallMotion + Send + Sync + 'static,
    ) -> Result<Self, WallError> {
        let [first, second] = pair;
        let motion = Motion::new(motion).map_err(|violation| WallError::Motion { violation })?;
        let mirrored = Combined::of(motion.clone()).scaled(-1.0);
        let mirrored = mirrored.map_err(|_| WallError::Jump)?;
        for (wall, motion) in [(first, motion.clone()), (second, Motion::of(mirrored))] {
            if let Ok(plane) = self.plane_mut(wall) {
                if plane.motion.reach() != (0.0, 0.0) {
                    return Err(WallError::Lost { wall });
                }
                plane.set_motion(motion)?;
            }
        }
        for wall in others {
            if let Ok(plane) = self.plane_mut(wall) {
                plane.set_slide(Slide::Motion { motion: motion.clone(), phase: 0.0 })?;
            }
        }
        self.changed()
    }
}
