//! Boundaries that are hard to check: a drum that breathes, areas of matter, a piston that grazes its stop.

use std::f64::consts::TAU;

use granular_edmd::boundary::laws::check;
use granular_edmd::boundary::{
    Boundary, Brick, Container, Domain, FirstTouch, Overlap, Part, Probe, Region, Surface, Touch, Wall,
};
use granular_edmd::glam::DVec2;
use granular_edmd::wall::Piston;
use granular_edmd::{Flight, ParameterError};
use support::cases::few;

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// Mean radius, amplitude and angular frequency of a drum whose radius is a sine of the time.
const RADIUS: f64 = 8.0;
const AMPLITUDE: f64 = 0.5;
const FREQUENCY: f64 = 2.0;

/// A round drum with a radius that oscillates, at a phase of this origin.
#[derive(Default)]
struct Breathing {
    origin: f64,
    /// Error of the radius of curvature if the origin is late.
    error: f64,
}

impl Breathing {
    /// Returns the radius, and the speed at which it grows.
    fn rim(&self, time: f64) -> (f64, f64) {
        let (sine, cosine) = (FREQUENCY * (self.origin + time)).sin_cos();
        (RADIUS + AMPLITUDE * sine, AMPLITUDE * FREQUENCY * cosine)
    }
}

impl Boundary for Breathing {
    fn domain(&self) -> Domain {
        let edge = RADIUS + AMPLITUDE;
        Domain::new(-edge, edge, -edge, edge)
    }

    fn interior(&self) -> Domain {
        let edge = RADIUS - AMPLITUDE;
        Domain::new(-edge, edge, -edge, edge)
    }

    fn wall_count(&self) -> usize {
        1
    }

    fn set_time_origin(&mut self, origin: f64) {
        self.origin = origin % (TAU / FREQUENCY);
    }

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        region.min.abs().max(region.max.abs()).length() + radius >= RADIUS - AMPLITUDE
    }

    /// Steps by the longest time in which the squared distances cannot meet, from a bound of their second
    /// derivative.
    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        let widest = RADIUS + AMPLITUDE;
        let fastest = flight.velocity(flight.time()).length().max(flight.velocity(until).length());
        let pull = flight.acceleration().length();
        let bend = 2.0 * widest * AMPLITUDE * FREQUENCY * FREQUENCY
            + 2.0 * (fastest * fastest + 1.5 * widest * pull);
        let mut time = flight.time();
        while time <= until {
            let ((rim, growth), place) = (self.rim(time), flight.position(time));
            let free = rim - flight.radius();
            let gap = (free - place.length()) * (free + place.length());
            let rate = 2.0 * (free * growth - place.dot(flight.velocity(time)));
            if gap <= 1e-13 * widest * widest && rate < 0.0 {
                return FirstTouch::At(Touch::new(time, 0));
            }
            let gap = gap.max(0.0);
            let root = (rate * rate + 2.0 * bend * gap).sqrt();
            let step = if rate >= 0.0 { (rate + root) / bend } else { 2.0 * gap / (root - rate) };
            if time + step <= time {
                let touch = Some(Touch::new(time, 0)).filter(|_| rate < 0.0);
                return touch.into();
            }
            time += step;
        }
        None.into()
    }

    fn surface(&self, _: usize, position: DVec2, time: f64) -> Surface<'_> {
        let (normal, (rim, growth)) = (-position.normalize_or(DVec2::Y), self.rim(time));
        let late = if self.origin > 1.0 { self.error } else { 0.0 };
        Surface::new(normal, -growth * normal).with_radius(-rim * (1.0 + late))
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        let depth = probe.position().length() + probe.radius() - self.rim(probe.time()).0;
        (depth > 0.0).then_some(Overlap::new(0, depth))
    }
}

/// The radius of curvature at a phase is as exact as the phase, which another origin rounds otherwise.
#[test]
fn a_radius_of_curvature_may_change_in_time() {
    for seed in few(1..=6, 3) {
        assert_eq!(check(&mut Breathing::default(), 0.5, 1.0, seed), Ok(()), "{seed}");
    }
    // Too small an error for the depths around a touch, but more than rounding.
    let mut wrong = Breathing { error: 1e-7, ..Breathing::default() };
    assert_eq!(check(&mut wrong, 0.5, 1.0, 1).map_err(|found| found.law()), Err("time origin"));
}

/// A vessel whose area of matter is wrong by a share, and its areas of centers are not.
struct Wrong(Container, f64);

impl Boundary for Wrong {
    fn domain(&self) -> Domain {
        self.0.domain()
    }

    fn wall_count(&self) -> usize {
        self.0.wall_count()
    }

    fn set_time_origin(&mut self, origin: f64) {
        self.0.set_time_origin(origin);
    }

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.0.may_touch(region, radius)
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        self.0.first_touch(flight, until)
    }

    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        self.0.surface(wall, position, time)
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        self.0.overlap(probe)
    }

    fn area(&self, region: &Region, radius: f64, time: f64) -> Option<f64> {
        let area = self.0.area(region, radius, time)?;
        Some(if radius == 0.0 { (1.0 + self.1) * area } else { area })
    }
}

/// Measures divide by the area of matter, which no disk of the check has asked for.
#[test]
fn the_area_of_matter_is_checked() -> Outcome {
    let middle = DVec2::new(6.0, 4.0);
    let parts = [
        Part::peg(middle, 1.5)?,
        Part::block([(3.0, 2.0), (8.0, 2.5), (6.0, 5.0)].map(DVec2::from))?,
        Part::new([Brick::arc(middle, 2.0, 0.0, 3.0)?.two_sided()])?,
    ];
    for part in parts {
        let vessel = Container::closed(12.0, 9.0)?.with_part("part", part)?;
        assert_eq!(check(&mut Wrong(vessel.clone(), 0.0), 0.5, 1.0, 1), Ok(()), "{vessel:?}");
        for error in [-0.01, 1e-3, 0.1] {
            let found = check(&mut Wrong(vessel.clone(), error), 0.5, 1.0, 1);
            assert_eq!(found.map_err(|found| found.law()), Err("area"), "{error}");
        }
    }
    Ok(())
}

/// A spring that carries the lid just to its stop, where it turns. Rounding decides whether it arrives there.
#[test]
fn a_piston_may_graze_its_stop() -> Outcome {
    let grazing = |stops, start, velocity| -> Result<Piston, ParameterError> {
        Piston::new(3.0, stops)?.with_spring(1.0, 1.0)?.with_start(start, velocity)
    };
    let pistons = [
        grazing([-1.0, 5.0], 0.0, 1.0)?,
        grazing([-5.0, 3.0], 0.0, 1.0)?,
        // It loses its swing at the stop, and comes back to it.
        grazing([-0.7, 5.0], 0.0, 1.0)?,
        grazing([-0.3, 5.0], -0.3, 0.0)?,
        // The spring presses it against the stop, from which it hardly goes away.
        grazing([-5.0, 0.5], 0.5, -1e-9)?,
    ];
    for (piston, seed) in
        few(pistons.into_iter().flat_map(|piston| (1..=6).map(move |seed| (piston, seed))), 7)
    {
        let mut container = Container::closed(12.0, 9.0)?.with_piston(Wall::Lid, piston)?;
        assert_eq!(check(&mut container, 0.5, 1.0, seed), Ok(()), "{piston:?}, {seed}");
    }
    Ok(())
}

/// The same without a spring, seen from other time origins.
#[test]
fn a_thrown_piston_may_graze_its_stop() -> Outcome {
    for number in 1..=100 {
        let (pull, velocity) = (0.7, 0.3 + 0.017 * f64::from(number));
        let top = 0.5 * velocity * velocity / pull;
        let piston = Piston::new(3.0, [-90.0, top])?.with_force(-3.0 * pull)?.with_start(0.0, velocity)?;
        let mut lid = Container::closed(12.0, 9.0)?.with_piston(Wall::Lid, piston)?;
        let (turns, start) = (velocity / pull, lid.state());
        for share in [0.0, 0.1, 0.37, 0.8] {
            lid.set_time_origin(0.0);
            lid.set_state(&start)?;
            lid.set_time_origin(share * turns);
            let speed = lid.surface(3, DVec2::ONE, (2.0 - share) * turns).velocity.y;
            assert!((speed - velocity).abs() < 1e-13, "{number}, {share}: {speed} instead of {velocity}");
        }
    }
    Ok(())
}

/// A later response takes the place of an earlier one, so a block that took centers has its corners again.
#[test]
fn responses_of_a_part_replace_each_other() -> Outcome {
    let block = || Part::block([(4.0, 4.0), (6.0, 4.0), (6.0, 6.0), (4.0, 6.0)].map(DVec2::from));
    let walls = |part| Ok(Container::closed(10.0, 10.0)?.with_part("block", part)?.wall_count());
    let count = |part| -> Result<usize, Box<dyn std::error::Error>> { walls(part) };
    let (plain, centers) = (count(block()?)?, count(block()?.absorbing_centers())?);
    assert!(centers < plain);
    assert_eq!(count(block()?.absorbing_centers().absorbing())?, plain);
    assert_eq!(count(block()?.absorbing().absorbing_centers())?, centers);
    Ok(())
}

/// Nothing would move, and pegs that come later get the next names.
#[test]
fn a_container_without_walls_is_not_shaken() -> Outcome {
    let refused =
        Container::periodic(10.0, 10.0)?.shaken_vertically(granular_edmd::wall::Sinusoidal::new(0.1, 1.0)?);
    assert!(refused.is_err());
    let peg = |x: f64| granular_edmd::Disk::new(DVec2::new(x, 5.0), 0.5);
    let pegs = Container::closed(10.0, 10.0)?.with_pegs([peg(2.0)?, peg(4.0)?])?.with_pegs([peg(8.0)?])?;
    assert_eq!(pegs.part_names().collect::<Vec<_>>(), ["peg 0", "peg 1", "peg 2"]);
    Ok(())
}
