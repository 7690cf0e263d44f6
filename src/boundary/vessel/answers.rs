//! The methods of a vessel that the engine calls.

use std::borrow::Cow;

use glam::DVec2;

use super::{Vessel, Wall};
use crate::boundary::area::Curves;
use crate::boundary::{
    Boundary, Domain, FirstTouch, Impact, Overlap, Probe, Reaction, Region, Surface, Touch,
};
use crate::{Fingerprint, Flight, ParameterError};

/// Relative difference below which the radii of a disk and a hollow count as equal.
const TIGHT: f64 = 1e-9;

impl Boundary for Vessel {
    fn domain(&self) -> Domain {
        self.container.domain()
    }

    fn interior(&self) -> Domain {
        self.container.interior()
    }

    fn wall_count(&self) -> usize {
        self.container.wall_count() + self.walls.len()
    }

    fn wall_name(&self, wall: usize) -> Cow<'_, str> {
        let known = wall.checked_sub(self.container.wall_count()).and_then(|brick| self.walls.get(brick));
        let Some(placed) = known.map(|known| &self.parts[known.part]) else {
            return self.container.wall_name(wall);
        };
        match placed.part.bricks().len() {
            1 => placed.name.as_str().into(),
            bricks if wall - placed.first < bricks => {
                format!("{}, brick {}", placed.name, wall - placed.first).into()
            }
            bricks => format!("{}, corner {}", placed.name, wall - placed.first - bricks).into(),
        }
    }

    fn set_time_origin(&mut self, origin: f64) {
        self.container.set_time_origin(origin);
        self.origin = origin;
        for placed in &mut self.parts {
            placed.phase = placed.part.phase(origin);
        }
    }

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.container.may_touch(region, radius) || self.parts_may_touch(region, radius)
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let first = self.first_touch_with_parts(flight, until, self.container.first_touch(flight, until));
        if self.has_patches { first.map(|touch| self.on_patch(touch, flight)) } else { first }
    }

    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        match wall.checked_sub(self.container.wall_count()) {
            Some(brick) => self.surface_of_brick(brick, position, time),
            None => self.container.surface(wall, position, time),
        }
    }

    fn wall_point(&self, wall: usize, time: f64) -> Option<DVec2> {
        let Some(brick) = wall.checked_sub(self.container.wall_count()) else {
            return self.container.wall_point(wall, time);
        };
        let Wall { part, brick } = self.walls.get(brick)?;
        let placed = &self.parts[*part];
        let (place, aside) = brick.anchor();
        Some(placed.part.travel().pose(placed.phase.after(time)).outward(place) + aside)
    }

    fn edges(&self, time: f64) -> Domain {
        self.container.edges(time)
    }

    fn wall_motion(&self, wall: usize, time: f64) -> Option<(DVec2, f64)> {
        let Some(brick) = wall.checked_sub(self.container.wall_count()) else {
            return self.container.wall_motion(wall, time);
        };
        let placed = &self.parts[self.walls.get(brick)?.part];
        if placed.first == wall { placed.part.travel().moved(placed.phase.after(time)) } else { None }
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let parts = self.overlap_with_parts(probe);
        Overlap::deepest(self.container.overlap(probe).into_iter().chain(parts))
    }

    fn area(&self, region: &Region, radius: f64, time: f64) -> Option<f64> {
        let depends_on_kind = self.parts.iter().any(|placed| placed.part.is_full_for_some());
        (!depends_on_kind).then(|| self.free_area(region, radius, time))
    }

    fn curves(&self, region: &Region, radius: f64, time: f64) -> Option<Curves> {
        let mut curves = self.container.curves(region, radius, time).filter(|_| self.knows_all_curves())?;
        curves.0.extend(self.curves_of_parts(region, radius, time));
        Some(curves)
    }

    fn react(&mut self, impact: &Impact) -> Reaction {
        // Parts have no mass.
        if impact.wall < self.container.wall_count() { self.container.react(impact) } else { Reaction::None }
    }

    fn may_meet(&self, wall: usize, region: &Region, radius: f64, until: f64) -> bool {
        if wall < self.container.wall_count() {
            self.container.may_meet(wall, region, radius, until)
        } else {
            self.may_touch(region, radius)
        }
    }

    fn state(&self) -> Vec<f64> {
        self.container.state()
    }

    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        self.container.set_state(state)
    }

    fn wall_lines(&self, time: f64) -> Vec<Vec<DVec2>> {
        self.outline(self.origin + time).map(|(_, line)| line).collect()
    }

    fn tight_fit(&self, radius: f64) -> Option<usize> {
        let first = self.hollows.partition_point(|&(hollow, _)| hollow < radius * (1.0 - TIGHT));
        let &(hollow, wall) = self.hollows.get(first)?;
        (hollow <= radius * (1.0 + TIGHT)).then_some(wall)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        let vessel = Fingerprint::of("Vessel").part(self.container.fingerprint()?);
        self.parts.iter().try_fold(vessel, |vessel, placed| {
            Some(vessel.text(&placed.name).part(placed.part.fingerprint()?))
        })
    }
}
