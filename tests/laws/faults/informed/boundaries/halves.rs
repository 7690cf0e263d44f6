//! A free drum whose rim has two halves, and confuses them.

use granular_edmd::boundary::{
    Boundary, Brick, Domain, FirstTouch, Impact, Overlap, Probe, Reaction, Region, Surface, Touch,
};
use granular_edmd::glam::DVec2;
use granular_edmd::{Flight, Kind, ParameterError};

use super::Boundaries;
use crate::faults::blind::boundaries::Walled;

const RADIUS: f64 = 6.0;
const INERTIA: f64 = 400.0;

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    None,
    Start,
    Side,
    Swapped,
    Velocity,
    Until,
    Origin,
    Overlap,
    Alternating,
    Stuck,
    Jump,
    Lost,
}

pub(super) fn plant(boundaries: &mut Boundaries) {
    let all = [
        (Fault::Start, "names", "touches name the half where the flight begins"),
        (Fault::Side, "names", "touches name the upper and the lower half"),
        (Fault::Swapped, "names", "touches swap the halves"),
        (Fault::Velocity, "names", "touches of disks that fall swap the halves"),
        (Fault::Until, "names", "touches of searches shorter than 1 swap the halves"),
        (Fault::Origin, "names", "the halves change places at the time 500"),
        (Fault::Overlap, "names", "overlaps swap the halves"),
        (Fault::Alternating, "names", "overlaps with disks on the left name both halves in turns"),
        (Fault::Stuck, "halves", "the halves turn back at each blow"),
        (Fault::Jump, "halves", "the halves jump by 0.05 at each blow"),
        (Fault::Lost, "halves", "the state has no angle"),
    ];
    for (fault, family, name) in all {
        boundaries.family = family;
        boundaries.plant(name, drum(fault));
    }
}

/// A drum that confuses nothing.
pub(super) fn honest() -> Walled {
    drum(Fault::None)
}

fn drum(fault: Fault) -> Walled {
    let rim = Brick::circle(DVec2::ZERO, RADIUS).expect("a radius");
    let boundary = Box::new(Halves { rim, angle: 0.0, spin: 0.1, origin: 0.0, calls: 0.into(), fault });
    Walled { boundary, radius: 0.5, gravity: 1.0 }
}

struct Halves {
    rim: Brick,
    /// Angle at the origin.
    angle: f64,
    spin: f64,
    origin: f64,
    calls: std::cell::Cell<usize>,
    fault: Fault,
}

impl Halves {
    fn half(&self, place: DVec2, time: f64) -> usize {
        usize::from(place.dot(DVec2::from_angle(self.angle + self.spin * time)) < 0.0)
    }
}

impl Boundary for Halves {
    fn domain(&self) -> Domain {
        Domain::new(-RADIUS, RADIUS, -RADIUS, RADIUS)
    }

    fn wall_count(&self) -> usize {
        2
    }

    fn set_time_origin(&mut self, origin: f64) {
        self.angle += self.spin * (origin - self.origin);
        self.origin = origin;
    }

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.rim.may_touch(region, radius)
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let named = |time| {
            let (start, place) = (flight.time(), flight.position(time));
            let half = self.half(place, time);
            let is_swapped = match self.fault {
                Fault::Start => return self.half(flight.position(start), time),
                Fault::Side => return self.half(place.perp(), time),
                Fault::Swapped => true,
                Fault::Velocity => flight.velocity(time).y < 0.0,
                Fault::Until => until - start < 1.0,
                Fault::Origin => self.origin > 500.0,
                _ => false,
            };
            if is_swapped { 1 - half } else { half }
        };
        self.rim.first_touch(flight, until).map(|time| Touch::new(time, named(time))).into()
    }

    fn surface(&self, wall: usize, position: DVec2, _: f64) -> Surface<'_> {
        let normal = self.rim.normal(position);
        let surface =
            Surface::new(normal, -self.spin * RADIUS * normal.perp()).with_kind(Kind::new(wall as u16));
        surface.with_radius(-RADIUS).with_tangential_mass(INERTIA / (RADIUS * RADIUS))
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        self.calls.set(self.calls.get() + 1);
        let depth = probe.radius() - self.rim.signed_distance(probe.position());
        let half = self.half(probe.position(), probe.time());
        let half = match self.fault {
            Fault::Overlap => 1 - half,
            Fault::Origin if self.origin > 500.0 => 1 - half,
            Fault::Alternating if probe.position().x < 0.0 => self.calls.get() % 2,
            _ => half,
        };
        (depth > 0.0).then_some(Overlap::new(half, depth))
    }

    fn react(&mut self, impact: &Impact) -> Reaction {
        let spin = self.spin + (impact.point.perp_dot(impact.impulse) + impact.couple) / INERTIA;
        self.angle += match self.fault {
            Fault::Stuck => 0.0,
            Fault::Jump => (self.spin - spin) * impact.time + 0.05,
            _ => (self.spin - spin) * impact.time,
        };
        self.spin = spin;
        Reaction::Moved
    }

    fn state(&self) -> Vec<f64> {
        vec![if self.fault == Fault::Lost { 0.0 } else { self.angle }, self.spin]
    }

    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        let &[angle, spin] = state else {
            return Err(ParameterError::new("state of the drum", "two numbers", state.len() as f64));
        };
        (self.angle, self.spin) = (angle, spin);
        Ok(())
    }
}
