//! A sled: a floor that disks drag along and a face that stands on it, two walls of one body.

use granular_edmd::boundary::{
    Boundary, Domain, FirstTouch, Impact, Overlap, Probe, Reaction, Region, Surface, Touch, laws,
};
use granular_edmd::collision::Rough;
use granular_edmd::glam::DVec2;
use granular_edmd::roots::first_descent;
use granular_edmd::{Disk, Flight, ParameterError, Simulation};

const SIZE: f64 = 20.0;
const MASS: f64 = 1.0;

/// The position and the velocity of the face at the origin, and the time of the last impact.
#[derive(Debug, Clone)]
struct Sled {
    face: f64,
    velocity: f64,
    since: f64,
    origin: f64,
}

const FLOOR: usize = 0;
const FACE: usize = 1;
const LID: usize = 2;
const SIDE: usize = 3;

impl Sled {
    fn new(face: f64, velocity: f64) -> Self {
        Self { face, velocity, since: 0.0, origin: 0.0 }
    }

    fn at(&self, time: f64) -> f64 {
        self.face + self.velocity * time
    }

    fn gaps(&self, place: DVec2, time: f64) -> [f64; 4] {
        [place.y, place.x - self.at(time), SIZE - place.y, SIZE - place.x]
    }
}

impl Boundary for Sled {
    fn domain(&self) -> Domain {
        Domain::new(-SIZE, SIZE, 0.0, SIZE)
    }
    fn wall_count(&self) -> usize {
        4
    }
    fn set_time_origin(&mut self, origin: f64) {
        let shift = origin - self.origin;
        *self = Self { face: self.at(shift), velocity: self.velocity, since: self.since - shift, origin };
    }
    fn may_touch(&self, _: &Region, _: f64) -> bool {
        true
    }
    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let (start, pull) = (flight.time(), flight.acceleration());
        let (place, velocity) = (flight.position(start), flight.velocity(start));
        let against = velocity.x - self.velocity;
        let speeds =
            [(velocity.y, pull.y), (against, pull.x), (-velocity.y, -pull.y), (-velocity.x, -pull.x)];
        let touch = |(wall, (gap, (speed, pull))): (usize, (f64, (f64, f64)))| {
            let time = start + first_descent(gap - flight.radius(), speed, pull)?;
            (time <= until).then(|| Touch::new(time, wall))
        };
        let touches = self.gaps(place, start).into_iter().zip(speeds).enumerate().filter_map(touch);
        touches.min_by(|one, other| one.time.total_cmp(&other.time)).into()
    }
    fn surface(&self, wall: usize, _: DVec2, _: f64) -> Surface<'_> {
        let velocity = DVec2::new(self.velocity, 0.0);
        match wall {
            FLOOR => Surface::new(DVec2::Y, velocity).with_tangential_mass(MASS),
            FACE => Surface::new(DVec2::X, velocity).with_mass(MASS),
            LID => Surface::new(DVec2::NEG_Y, DVec2::ZERO),
            _ => Surface::new(DVec2::NEG_X, DVec2::ZERO),
        }
    }
    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let gaps = self.gaps(probe.position(), probe.time()).into_iter().enumerate();
        let (wall, gap) = gaps.min_by(|(_, one), (_, other)| one.total_cmp(other))?;
        (gap < probe.radius()).then(|| Overlap::new(wall, probe.radius() - gap))
    }
    fn react(&mut self, impact: &Impact) -> Reaction {
        if impact.wall >= LID {
            return Reaction::None;
        }
        let place = self.at(impact.time);
        self.velocity += impact.impulse.x / MASS;
        self.face = place - self.velocity * impact.time;
        self.since = impact.time;
        Reaction::Moved
    }
    /// Only the motion after the impact counts.
    fn may_meet(&self, wall: usize, region: &Region, radius: f64, until: f64) -> bool {
        match wall {
            LID => region.max.y + radius >= SIZE,
            SIDE => region.max.x + radius >= SIZE,
            _ => {
                let farthest = self.at(self.since.max(0.0)).max(self.at(until));
                region.min.y <= radius || region.min.x - radius <= farthest
            }
        }
    }
    fn state(&self) -> Vec<f64> {
        vec![self.face, self.velocity, self.since]
    }
    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        let &[face, velocity, since] = state else {
            return Err(ParameterError::new("state of the sled", "three numbers", state.len() as f64));
        };
        *self = Self { face, velocity, since, ..*self };
        Ok(())
    }
}

/// A spinning disk lands on the floor and turns the sled around, while another disk waits before the face:
/// the touch that was predicted for it does not come.
#[test]
fn a_body_that_turns_around_leaves_the_touches_of_its_other_walls() -> Result<(), Box<dyn std::error::Error>>
{
    // Slow, so that no flight of the check is long enough for the sled to leave the box.
    laws::check(&mut Sled::new(0.0, 1e-3), 0.5, 0.1, 3)?;
    let waiting = Disk::new(DVec2::new(4.0, 15.0), 0.5)?;
    let landing = Disk::new(DVec2::new(15.0, 1.5), 0.5)?.with_mass(10.0)?;
    let landing = landing.with_velocity(DVec2::new(-2.0, -1.0))?;
    let run = Simulation::builder(Rough::from_inelasticity(0.0, 0.0)?, Sled::new(0.0, 0.5));
    let mut run = run.disks([waiting, landing]).build()?;
    run.run_until(9.0, &mut ())?;
    assert!(run.boundary().velocity < 0.0, "the sled moves at {}", run.boundary().velocity);
    assert_eq!(run.disks()[0].position(), waiting.position());
    Ok(())
}
