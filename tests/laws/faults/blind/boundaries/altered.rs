//! A boundary, some of whose answers are changed.

use std::borrow::Cow;

use granular_edmd::boundary::{
    Boundary, Domain, FirstTouch, Impact, Overlap, Probe, Reaction, Region, Surface, Touch,
};
use granular_edmd::glam::DVec2;
use granular_edmd::{Fingerprint, Flight, ParameterError};

/// A question about the disks that a wall may meet, and the honest answer.
pub(in crate::faults) struct Asked<'a> {
    pub(in crate::faults) wall: usize,
    pub(in crate::faults) region: &'a Region,
    pub(in crate::faults) radius: f64,
    pub(in crate::faults) until: f64,
    pub(in crate::faults) answer: bool,
}

/// An honest boundary behind functions that change its answers. At first, they change nothing.
pub(in crate::faults) struct Altered {
    pub(in crate::faults) honest: Box<dyn Boundary>,
    /// The last origin that was given.
    pub(in crate::faults) since: f64,
    /// Takes the last origin and the new one, and returns the one that is passed on.
    pub(in crate::faults) origin: Box<dyn Fn(f64, f64) -> f64>,
    /// The origin, and the domain.
    pub(in crate::faults) domain: Box<dyn Fn(f64, Domain) -> Domain>,
    pub(in crate::faults) interior: Box<dyn Fn(Domain) -> Domain>,
    /// The origin, and the number of walls.
    pub(in crate::faults) walls: Box<dyn Fn(f64, usize) -> usize>,
    pub(in crate::faults) may_touch: Box<dyn Fn(&dyn Boundary, &Region, f64) -> bool>,
    pub(in crate::faults) touch: Box<dyn Fn(&dyn Boundary, &Flight, f64) -> FirstTouch<Touch>>,
    /// The surface, the position of the disk, and the time.
    pub(in crate::faults) surface: Box<dyn Fn(&mut Surface<'_>, DVec2, f64)>,
    pub(in crate::faults) overlap: Box<dyn Fn(&dyn Boundary, &Probe) -> Option<Overlap>>,
    /// The answer, the region and the radius.
    pub(in crate::faults) area: Box<dyn Fn(Option<f64>, &Region, f64) -> Option<f64>>,
    pub(in crate::faults) react: Box<dyn Fn(&mut dyn Boundary, &Impact) -> Reaction>,
    pub(in crate::faults) may_meet: Box<dyn Fn(&dyn Boundary, &Asked<'_>) -> bool>,
    pub(in crate::faults) state: Box<dyn Fn(Vec<f64>) -> Vec<f64>>,
    pub(in crate::faults) restored: Box<dyn Fn(&[f64]) -> Option<Vec<f64>>>,
    pub(in crate::faults) mark: Option<Fingerprint>,
    /// Takes a time, and returns the time of which the points of the walls tell.
    pub(in crate::faults) points: Box<dyn Fn(f64) -> f64>,
    /// True if the mark depends on the origin.
    pub(in crate::faults) is_marked_anew: bool,
}

impl Altered {
    pub(in crate::faults) fn new(honest: impl Boundary + 'static) -> Self {
        Self {
            honest: Box::new(honest),
            since: 0.0,
            origin: Box::new(|_, origin| origin),
            domain: Box::new(|_, domain| domain),
            interior: Box::new(|domain| domain),
            walls: Box::new(|_, count| count),
            may_touch: Box::new(|honest, region, radius| honest.may_touch(region, radius)),
            touch: Box::new(|honest, flight, until| honest.first_touch(flight, until)),
            surface: Box::new(|_, _, _| ()),
            overlap: Box::new(|honest, probe| honest.overlap(probe)),
            area: Box::new(|area, _, _| area),
            react: Box::new(|honest, impact| honest.react(impact)),
            may_meet: Box::new(|_, asked| asked.answer),
            state: Box::new(|state| state),
            restored: Box::new(|state| Some(state.to_vec())),
            mark: None,
            points: Box::new(|time| time),
            is_marked_anew: false,
        }
    }
}

impl Boundary for Altered {
    fn domain(&self) -> Domain {
        (self.domain)(self.since, self.honest.domain())
    }

    fn interior(&self) -> Domain {
        (self.interior)(self.honest.interior())
    }

    fn wall_count(&self) -> usize {
        (self.walls)(self.since, self.honest.wall_count())
    }

    fn wall_name(&self, wall: usize) -> Cow<'_, str> {
        self.honest.wall_name(wall)
    }

    fn wall_point(&self, wall: usize, time: f64) -> Option<DVec2> {
        self.honest.wall_point(wall, (self.points)(time))
    }

    fn set_time_origin(&mut self, origin: f64) {
        let passed = (self.origin)(self.since, origin);
        self.since = origin;
        self.honest.set_time_origin(passed);
    }

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        (self.may_touch)(&*self.honest, region, radius)
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        (self.touch)(&*self.honest, flight, until)
    }

    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        let mut surface = self.honest.surface(wall, position, time);
        (self.surface)(&mut surface, position, time);
        surface
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        (self.overlap)(&*self.honest, probe)
    }

    fn wall_lines(&self, time: f64) -> Vec<Vec<DVec2>> {
        self.honest.wall_lines(time)
    }

    fn tight_fit(&self, radius: f64) -> Option<usize> {
        self.honest.tight_fit(radius)
    }

    fn area(&self, region: &Region, radius: f64, time: f64) -> Option<f64> {
        (self.area)(self.honest.area(region, radius, time), region, radius)
    }

    fn react(&mut self, impact: &Impact) -> Reaction {
        (self.react)(&mut *self.honest, impact)
    }

    fn may_meet(&self, wall: usize, region: &Region, radius: f64, until: f64) -> bool {
        let answer = self.honest.may_meet(wall, region, radius, until);
        (self.may_meet)(&*self.honest, &Asked { wall, region, radius, until, answer })
    }

    fn state(&self) -> Vec<f64> {
        (self.state)(self.honest.state())
    }

    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        (self.restored)(state).map_or(Ok(()), |state| self.honest.set_state(&state))
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.mark.map(|mark| if self.is_marked_anew { mark.number(self.since) } else { mark })
    }
}
