//! The honest boundaries on which faults are planted.

use std::borrow::Cow;
use std::f64::consts::TAU;

use granular_edmd::boundary::{
    Boundary, Brick, Container, Domain, FirstTouch, Impact, Obstacles, Overlap, Part, Probe, Reaction,
    Region, Surface, Touch, Vessel, Wall,
};
use granular_edmd::glam::DVec2;
use granular_edmd::wall::{
    AccelerationBounds, Approach, BiParabolic, Sinusoidal, WallMotion, WallState, first_touch,
};
use granular_edmd::{Disk, Flight, Kind, ParameterError};

use super::altered::Altered;

/// The kind that passes the peg of [`sieve`].
pub(in crate::faults) const GHOST: Kind = Kind::new(1);

pub(in crate::faults) fn floor_motion() -> BiParabolic {
    BiParabolic::new(0.2, 6.0).expect("an amplitude")
}

pub(in crate::faults) fn resting() -> Container {
    Container::closed(10.0, 12.0).expect("a size")
}

/// Returns the area that a region and the box at rest have in common, less a margin along the walls.
pub(in crate::faults) fn common_area(region: &Region, margin: f64) -> f64 {
    let (low, high) = (DVec2::splat(margin), DVec2::new(10.0, 12.0) - margin);
    let size = (region.max.min(high) - region.min.max(low)).max(DVec2::ZERO);
    size.x * size.y
}

/// A box at rest that knows its free area.
pub(in crate::faults) fn measured() -> Altered {
    let area = Box::new(|_: Option<f64>, region: &Region, radius: f64| Some(common_area(region, radius)));
    Altered { area, ..Altered::new(resting()) }
}

pub(in crate::faults) fn shaken() -> Altered {
    Altered::new(resting().with_motion(Wall::Floor, floor_motion()).expect("a floor"))
}

/// A box with a floor that slides to the right and back.
pub(in crate::faults) fn sliding() -> Altered {
    let motion = Sinusoidal::new(0.3, 2.0).expect("an amplitude");
    Altered::new(resting().with_sliding(Wall::Floor, motion).expect("a floor"))
}

pub(in crate::faults) fn dish() -> Altered {
    let drum = Part::drum(DVec2::splat(6.0), 6.0).expect("a radius");
    Altered::new(Vessel::around([("dish", drum)]).expect("a vessel"))
}

pub(in crate::faults) fn board() -> Obstacles<Container> {
    Obstacles::new(resting(), [Disk::new(DVec2::new(5.0, 6.0), 1.5).expect("a radius")])
}

/// A box with a bar that turns about the point (5, 6).
pub(in crate::faults) fn stirred() -> Altered {
    let bar = Part::polyline([DVec2::new(4.0, 6.0), DVec2::new(6.0, 6.0)]).expect("a bar");
    let bar = bar.with_rotation(DVec2::new(5.0, 6.0), 0.7).expect("a rotation");
    Altered::new(Vessel::new(resting()).with("bar", bar).expect("a vessel"))
}

/// A box with a peg that one kind passes.
pub(in crate::faults) fn sieve(passes: Kind) -> Altered {
    let (bare, empty) = (resting(), resting());
    Altered {
        touch: Box::new(move |board, flight, until| {
            if flight.kind() == passes {
                bare.first_touch(flight, until)
            } else {
                board.first_touch(flight, until)
            }
        }),
        overlap: Box::new(
            move |board, probe| {
                if probe.kind() == passes { empty.overlap(probe) } else { board.overlap(probe) }
            },
        ),
        ..Altered::new(board())
    }
}

/// A box with a heavy floor on a spring, which blows set in motion. The floor may carry a ceiling.
pub(in crate::faults) struct Sprung {
    container: Container,
    swing: Swing,
    origin: f64,
    /// The height of the ceiling at rest.
    ceiling: Option<f64>,
}

/// The motion of the floor: the factors of the cosine and the sine of the time.
#[derive(Clone, Copy)]
struct Swing {
    cosine: f64,
    sine: f64,
}

const FREQUENCY: f64 = 1.5;
const MASS: f64 = 50.0;
const REST: f64 = 2.0;
/// The largest amplitude: a buffer takes what is more.
const ROOM: f64 = 1.5;

impl Swing {
    fn amplitude(self) -> f64 {
        self.cosine.hypot(self.sine)
    }

    /// Returns the motion that has this place and velocity at `time`.
    fn through(time: f64, WallState { displacement, velocity, .. }: WallState) -> Self {
        let (sine, cosine) = (FREQUENCY * time).sin_cos();
        let speed = velocity / FREQUENCY;
        let swing =
            Self { cosine: displacement * cosine - speed * sine, sine: displacement * sine + speed * cosine };
        let factor = (ROOM / swing.amplitude()).min(1.0);
        Self { cosine: factor * swing.cosine, sine: factor * swing.sine }
    }
}

impl WallMotion for Swing {
    fn state(&self, phase: f64) -> WallState {
        let (sine, cosine) = (FREQUENCY * phase).sin_cos();
        let velocity = FREQUENCY * (self.sine * cosine - self.cosine * sine);
        WallState::new(self.cosine * cosine + self.sine * sine, velocity)
    }

    fn acceleration(&self, phase: f64) -> AccelerationBounds {
        let now = -FREQUENCY * FREQUENCY * self.state(phase).displacement;
        let jerk = FREQUENCY.powi(3) * self.amplitude();
        AccelerationBounds::from_jerk(phase, now, jerk, TAU / FREQUENCY / 16.0)
    }

    fn reach(&self) -> (f64, f64) {
        let amplitude = self.amplitude() * (1.0 + 1e-12);
        (-amplitude, amplitude)
    }
}

impl Sprung {
    pub(in crate::faults) fn new() -> Self {
        let swing = Swing { cosine: 0.1, sine: 0.0 };
        Self { container: resting(), swing, origin: 0.0, ceiling: None }
    }

    pub(in crate::faults) fn with_ceiling() -> Self {
        Self { ceiling: Some(9.0), ..Self::new() }
    }

    fn index(&self) -> usize {
        self.container.wall_count()
    }
}

impl Boundary for Sprung {
    fn domain(&self) -> Domain {
        self.container.domain()
    }

    fn interior(&self) -> Domain {
        let Domain { left, right, top, .. } = self.container.domain();
        Domain::new(left, right, REST + ROOM, self.ceiling.map_or(top, |ceiling| ceiling - ROOM))
    }

    fn wall_count(&self) -> usize {
        self.index() + 1 + usize::from(self.ceiling.is_some())
    }

    fn wall_name(&self, wall: usize) -> Cow<'_, str> {
        let own = wall.checked_sub(self.index()).and_then(|own| ["sprung floor", "ceiling"].get(own));
        own.map_or_else(|| self.container.wall_name(wall), |&name| name.into())
    }

    fn wall_point(&self, wall: usize, time: f64) -> Option<DVec2> {
        (wall == self.index()).then(|| DVec2::new(5.0, REST + self.swing.state(time).displacement))
    }

    fn set_time_origin(&mut self, origin: f64) {
        self.swing = Swing::through(0.0, self.swing.state(origin - self.origin));
        self.origin = origin;
    }

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        region.min.y - radius <= REST + ROOM
            || self.ceiling.is_some_and(|ceiling| region.max.y + radius >= ceiling - ROOM)
            || self.container.may_touch(region, radius)
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let start = flight.time();
        let height = flight.position(start).y - flight.radius() - REST;
        let approach = Approach::new(start, height, flight.velocity(start).y, flight.acceleration().y);
        let touch = first_touch(&self.swing, &approach, until).map(|time| Touch::new(time, self.index()));
        let other = self.ceiling.map_or(FirstTouch::NONE, |ceiling| {
            let height = ceiling - flight.position(start).y - flight.radius();
            let approach = Approach::new(start, height, -flight.velocity(start).y, -flight.acceleration().y);
            let mirrored = Swing { cosine: -self.swing.cosine, sine: -self.swing.sine };
            first_touch(&mirrored, &approach, until).map(|time| Touch::new(time, self.index() + 1))
        });
        self.container.first_touch(flight, until).or(touch).or(other)
    }

    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        if wall < self.index() {
            return self.container.surface(wall, position, time);
        }
        let normal = if wall == self.index() { DVec2::Y } else { DVec2::NEG_Y };
        Surface::new(normal, DVec2::new(0.0, self.swing.state(time).velocity)).with_mass(MASS)
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let height = probe.position().y - self.swing.state(probe.time()).displacement;
        let below = Overlap::new(self.index(), probe.radius() - height + REST);
        let above = self
            .ceiling
            .map(|ceiling| Overlap::new(self.index() + 1, probe.radius() + height - ceiling))
            .filter(|above| above.depth > below.depth);
        let own = above.unwrap_or(below);
        let other = self.container.overlap(probe).filter(|other| other.depth > own.depth);
        other.or(Some(own).filter(|own| own.depth > 0.0))
    }

    fn react(&mut self, impact: &Impact) -> Reaction {
        if impact.wall < self.index() {
            return Reaction::None;
        }
        let mut state = self.swing.state(impact.time);
        state.velocity += impact.impulse.y / MASS;
        self.swing = Swing::through(impact.time, state);
        Reaction::Moved
    }

    fn may_meet(&self, wall: usize, region: &Region, radius: f64, until: f64) -> bool {
        if wall >= self.index() {
            let reach = self.swing.reach().1;
            let above = self.ceiling.is_some_and(|ceiling| region.max.y + radius >= ceiling - ROOM);
            return above || region.min.y - radius <= REST + reach;
        }
        self.container.may_meet(wall, region, radius, until)
    }

    fn state(&self) -> Vec<f64> {
        vec![self.swing.cosine, self.swing.sine]
    }

    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        let &[cosine, sine] = state else {
            return Err(ParameterError::new("state of the floor", "two numbers", state.len() as f64));
        };
        self.swing = Swing { cosine, sine };
        Ok(())
    }
}

/// A round drum that turns freely, with a moment of inertia.
pub(in crate::faults) struct Rotor {
    rim: Brick,
    spin: f64,
}

const RADIUS: f64 = 6.0;
const INERTIA: f64 = 400.0;

impl Rotor {
    pub(in crate::faults) fn new() -> Self {
        Self { rim: Brick::circle(DVec2::ZERO, RADIUS).expect("a radius"), spin: 0.1 }
    }
}

impl Boundary for Rotor {
    fn domain(&self) -> Domain {
        Domain::new(-RADIUS, RADIUS, -RADIUS, RADIUS)
    }

    fn wall_count(&self) -> usize {
        1
    }

    fn set_time_origin(&mut self, _: f64) {}

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.rim.may_touch(region, radius)
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        self.rim.first_touch(flight, until).map(|time| Touch::new(time, 0)).into()
    }

    fn surface(&self, _: usize, position: DVec2, _: f64) -> Surface<'_> {
        let normal = self.rim.normal(position);
        let surface = Surface::new(normal, -self.spin * RADIUS * normal.perp());
        surface.with_radius(-RADIUS).with_tangential_mass(INERTIA / (RADIUS * RADIUS))
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let depth = probe.radius() - self.rim.signed_distance(probe.position());
        (depth > 0.0).then_some(Overlap::new(0, depth))
    }

    fn react(&mut self, impact: &Impact) -> Reaction {
        self.spin += (impact.point.perp_dot(impact.impulse) + impact.couple) / INERTIA;
        Reaction::Moved
    }

    fn state(&self) -> Vec<f64> {
        vec![self.spin]
    }

    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        let &[spin] = state else {
            return Err(ParameterError::new("state of the drum", "one number", state.len() as f64));
        };
        self.spin = spin;
        Ok(())
    }
}
