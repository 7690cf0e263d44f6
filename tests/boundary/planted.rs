//! Faults planted in a container: the check names each.

use granular_edmd::boundary::laws::check;
use granular_edmd::boundary::{
    Boundary, Container, Domain, FirstTouch, Overlap, Probe, Region, Surface, Touch, Wall,
};
use granular_edmd::glam::DVec2;
use granular_edmd::wall::Sinusoidal;
use granular_edmd::{Flight, Violation};

/// A way to spoil a container.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    None,
    /// The floor is not found between these places.
    Hole,
    /// The hole is unknown to `overlap`, too.
    OpenHole,
    LateTouch,
    EarlyTouch,
    TouchInThePast,
    TouchAfterTheEnd,
    TouchNaN,
    WallTooLarge,
    TouchWhileLeaving,
    MissesWhatItTouches,
    StandsStill,
    BlindRegions,
    BlindEndlessRegions,
    BlindLargeDisks,
    DriftingDomain,
    DomainNaN,
    DomainTooSmall,
    InteriorOutside,
    MoreWalls,
    OutwardNormal,
    SlantedNormal,
    LongNormal,
    VelocityNaN,
    IgnoresTheOrigin,
    Full,
}

struct Spoilt {
    container: Container,
    fault: Fault,
    origin: f64,
}

fn spoilt(fault: Fault) -> Spoilt {
    let motion = Sinusoidal::new(0.2, 3.0).unwrap();
    let container = Container::closed(8.0, 6.0).unwrap().with_motion(Wall::Floor, motion).unwrap();
    Spoilt { container, fault, origin: 0.0 }
}

fn is_over_hole(position: DVec2) -> bool {
    (3.0..5.0).contains(&position.x)
}

impl Boundary for Spoilt {
    fn domain(&self) -> Domain {
        let domain = self.container.domain();
        match self.fault {
            Fault::DriftingDomain => {
                Domain::new(-1e-3 * self.origin, domain.right, domain.bottom, domain.top)
            }
            Fault::DomainNaN => Domain::new(0.0, f64::NAN, 0.0, 6.0),
            Fault::DomainTooSmall => Domain::new(0.0, 8.0, 0.9, 6.0),
            _ => domain,
        }
    }

    fn interior(&self) -> Domain {
        match self.fault {
            Fault::InteriorOutside => Domain::new(-1.0, 8.0, 0.0, 6.0),
            Fault::DomainTooSmall => self.domain(),
            _ => self.container.interior(),
        }
    }

    fn wall_count(&self) -> usize {
        self.container.wall_count() + usize::from(self.fault == Fault::MoreWalls && self.origin > 0.0)
    }

    fn set_time_origin(&mut self, origin: f64) {
        self.origin = origin;
        if self.fault != Fault::IgnoresTheOrigin {
            self.container.set_time_origin(origin);
        }
    }

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        let is_endless = !region.min.is_finite() || !region.max.is_finite();
        match self.fault {
            Fault::BlindRegions => region.min.y > 3.0,
            Fault::BlindEndlessRegions => !is_endless && self.container.may_touch(region, radius),
            Fault::BlindLargeDisks => radius < 0.6 && self.container.may_touch(region, radius),
            _ => self.container.may_touch(region, radius),
        }
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let touch = self.container.first_touch(flight, until).touch();
        let start = flight.time();
        let is_at_wall =
            self.container.overlap(&Probe::new(flight.position(start), 1.000_001 * flight.radius(), start));
        if self.fault == Fault::StandsStill {
            return FirstTouch::NotBefore(start);
        }
        let touch = match self.fault {
            Fault::Hole | Fault::OpenHole => {
                touch.filter(|touch| touch.wall != 0 || !is_over_hole(flight.position(touch.time)))
            }
            Fault::LateTouch => touch.map(|touch| Touch::new((touch.time + 0.01).min(until), touch.wall)),
            Fault::EarlyTouch => touch.map(|touch| Touch::new(0.5 * (start + touch.time), touch.wall)),
            Fault::TouchInThePast => touch.map(|touch| Touch::new(start - 1e-9, touch.wall)),
            Fault::TouchAfterTheEnd => Some(Touch::new(until + 1.0, 0)),
            Fault::TouchNaN => Some(Touch::new(f64::NAN, 0)),
            Fault::WallTooLarge => touch.map(|touch| Touch::new(touch.time, 4 + touch.wall)),
            Fault::TouchWhileLeaving => {
                is_at_wall.map(|overlap| Touch::new(start, overlap.with)).filter(|_| start <= until).or(touch)
            }
            Fault::MissesWhatItTouches => touch.filter(|touch| touch.time > start + 1e-6),
            _ => touch,
        };
        touch.into()
    }

    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        let Surface { normal, velocity, response, .. } = self.container.surface(wall, position, time);
        let (normal, velocity) = match self.fault {
            Fault::OutwardNormal => (-normal, velocity),
            Fault::SlantedNormal => (DVec2::new(0.6, 0.8).rotate(normal), velocity),
            Fault::LongNormal => (1.001 * normal, velocity),
            Fault::VelocityNaN => (normal, DVec2::splat(f64::NAN)),
            _ => (normal, velocity),
        };
        Surface::new(normal, velocity).with_response(response)
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        match self.fault {
            Fault::OpenHole if is_over_hole(probe.position()) => {
                self.container.overlap(probe).filter(|overlap| overlap.with != 0)
            }
            Fault::Full => Some(Overlap::new(0, 1.0)),
            _ => self.container.overlap(probe),
        }
    }
}

fn verdict(fault: Fault) -> Violation {
    verdict_of(fault, 1)
}

fn verdict_of(fault: Fault, seed: u64) -> Violation {
    check(&mut spoilt(fault), 0.5, 1.0, seed).expect_err(&format!("{fault:?}"))
}

#[test]
fn a_sound_boundary_passes() {
    assert_eq!(check(&mut spoilt(Fault::None), 0.5, 1.0, 1), Ok(()));
}

#[test]
fn holes_are_caught() {
    assert_eq!(verdict(Fault::Hole).law(), "no missed touch");
    // A disk that falls out of the hole aside is deep in the floor beside it before it is outside.
    for seed in 1..=10 {
        let found = verdict_of(Fault::OpenHole, seed);
        let is_caught = ["inside the domain", "no missed touch"].contains(&found.law());
        assert!(is_caught, "{found}");
    }
    assert!((1..=10).any(|seed| verdict_of(Fault::OpenHole, seed).law() == "inside the domain"));
    assert_eq!(verdict(Fault::DomainTooSmall).law(), "inside the domain");
}

#[test]
fn touches_at_the_wrong_time_are_caught() {
    assert_eq!(verdict(Fault::LateTouch).law(), "no missed touch");
    assert_eq!(verdict(Fault::EarlyTouch).law(), "no early touch");
    for fault in [Fault::TouchInThePast, Fault::TouchAfterTheEnd, Fault::TouchNaN] {
        assert_eq!(verdict(fault).law(), "touch time", "{fault:?}");
    }
    assert_eq!(verdict(Fault::TouchWhileLeaving).law(), "approach");
    assert_eq!(verdict(Fault::MissesWhatItTouches).law(), "no missed touch");
    assert_eq!(verdict(Fault::StandsStill).law(), "progress");
}

#[test]
fn walls_that_there_are_not_are_caught() {
    assert_eq!(verdict(Fault::WallTooLarge).law(), "touched wall");
    assert_eq!(verdict(Fault::MoreWalls).law(), "constant walls");
}

#[test]
fn blind_regions_are_caught() {
    for fault in [Fault::BlindRegions, Fault::BlindEndlessRegions, Fault::BlindLargeDisks] {
        assert_eq!(verdict(fault).law(), "may_touch", "{fault:?}");
    }
}

#[test]
fn wrong_rectangles_are_caught() {
    assert_eq!(verdict(Fault::DriftingDomain).law(), "constant domain");
    assert_eq!(verdict(Fault::DomainNaN).law(), "domain");
    assert_eq!(verdict(Fault::InteriorOutside).law(), "interior");
    assert_eq!(verdict(Fault::Full).law(), "room");
}

#[test]
fn wrong_surfaces_are_caught() {
    assert_eq!(verdict(Fault::OutwardNormal).law(), "normal");
    assert_eq!(verdict(Fault::SlantedNormal).law(), "normal");
    assert_eq!(verdict(Fault::LongNormal).law(), "unit normal");
    assert_eq!(verdict(Fault::VelocityNaN).law(), "finite velocity");
}

#[test]
fn a_boundary_that_ignores_the_time_origin_is_caught() {
    // The floor is always where it is at time zero: the same flight finds it at the same offset, whatever the
    // origin.
    assert_eq!(verdict(Fault::IgnoresTheOrigin).law(), "time origin");
}

/// A violation names the numbers and the flight that show it.
#[test]
fn violations_name_their_numbers() {
    let text = verdict(Fault::WallTooLarge).to_string();
    assert!(
        text.starts_with("boundary, law \"touched wall\": wall ")
            && text.contains("but there are 4, on Flight"),
        "{text}"
    );
}
