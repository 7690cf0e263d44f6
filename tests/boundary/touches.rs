//! First touches of bricks against brute force: the flight is sampled finely, and the gap is that of the
//! shape, not that of the polynomial.

use std::f64::consts::{PI, TAU};

use granular_edmd::Flight;
use granular_edmd::boundary::{Boundary, Brick, Container, Part};
use granular_edmd::glam::DVec2;
use granular_edmd::wall::{BiParabolic, Sinusoidal, WallMotion};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Number of samples of a flight.
const SAMPLES: u32 = 1000;

/// Longest flight.
const LONGEST: f64 = 4.0;

/// Largest gap at a touch, and largest way between a touch and the one by brute force.
const ALLOWED: f64 = 1e-9;

/// A part in a large room, and where it is at a time: turned about the origin by an angle, then shifted.
struct Specimen {
    name: String,
    part: Part,
    vessel: Container,
    pose: Box<dyn Fn(f64) -> (f64, DVec2)>,
}

impl Specimen {
    fn new(name: &str, part: Part, moving: Part, pose: impl Fn(f64) -> (f64, DVec2) + 'static) -> Self {
        let room = Container::closed(200.0, 200.0).unwrap().shifted(DVec2::splat(-100.0)).unwrap();
        let vessel = room.with_part("part", moving).unwrap();
        Self { name: name.to_owned(), part, vessel, pose: Box::new(pose) }
    }

    /// Returns the specimen at rest and in motion.
    fn all_of(name: &str, brick: Brick) -> [Self; 5] {
        let part = Part::new([brick]).unwrap();
        let (along, wall) = (DVec2::new(0.6, 0.8), BiParabolic::new(0.3, 3.0).unwrap());
        let sine = Sinusoidal::new(0.3, 3.0).unwrap();
        let shaken = move |motion: &dyn WallMotion, time: f64| (0.0, along * motion.state(time).displacement);
        let still = || part.clone();
        [
            Self::new(name, still(), still(), |_| (0.0, DVec2::ZERO)),
            Self::new(
                &format!("{name}, bi-parabolic"),
                still(),
                still().with_motion(along, wall).unwrap(),
                move |time| shaken(&wall, time),
            ),
            Self::new(
                &format!("{name}, sinusoidal"),
                still(),
                still().with_motion(along, sine).unwrap(),
                move |time| shaken(&sine, time),
            ),
            Self::turning(&format!("{name}, turning"), &part, 0.7),
            Self::turning(&format!("{name}, turning slowly"), &part, -0.05),
        ]
    }

    fn turning(name: &str, part: &Part, angular_velocity: f64) -> Self {
        let moving = part.clone().with_rotation(DVec2::ZERO, angular_velocity).unwrap();
        Self::new(name, part.clone(), moving, move |time| (angular_velocity * time, DVec2::ZERO))
    }

    fn gap(&self, flight: &Flight, time: f64) -> f64 {
        let (angle, shift) = (self.pose)(time);
        let (sine, cosine) = libm::sincos(-angle);
        let place = DVec2::new(cosine, sine).rotate(flight.position(time) - shift);
        self.part.signed_distance(place) - flight.radius()
    }

    /// Returns the first touch by brute force.
    fn by_sampling(&self, flight: &Flight) -> Option<f64> {
        let time = |k: u32| flight.time() + LONGEST * f64::from(k) / f64::from(SAMPLES);
        let k = (1..=SAMPLES).find(|&k| self.gap(flight, time(k)) < 0.0)?;
        let (mut low, mut high) = (time(k - 1), time(k));
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.gap(flight, middle) < 0.0 { high = middle } else { low = middle }
        }
        Some(high)
    }

    /// Checks a flight. Returns the way between the two touches, and the gap at the touch.
    fn check(&self, flight: &Flight) -> Option<(f64, f64)> {
        let until = flight.time() + LONGEST;
        let found = self.vessel.first_touch(flight, until).touch().map(|touch| touch.time);
        let sampled = self.by_sampling(flight);
        let Some(found) = found else {
            assert_eq!(sampled, None, "{} misses a touch of {flight:?}", self.name);
            return None;
        };
        let gap = self.gap(flight, found).abs();
        assert!(gap <= ALLOWED, "{}: gap {gap} at {found} of {flight:?}", self.name);
        // Sampling steps over a short touch, and finds the next one or none.
        let sampled = sampled.unwrap_or(until);
        let late = found - sampled;
        assert!(late <= ALLOWED, "{}: {found} instead of {sampled} for {flight:?}", self.name);
        let is_same = -late <= LONGEST / f64::from(SAMPLES);
        let rate = (self.gap(flight, found) - self.gap(flight, found - 1e-6)) / -1e-6;
        // A grazing touch has no sharp time.
        (is_same && rate > 1e-2).then_some((late.abs() * rate, gap))
    }
}

fn specimens() -> Vec<Specimen> {
    let (center, place) = (DVec2::new(0.5, -0.3), DVec2::new(-2.0, 0.4));
    let bricks = [
        ("segment", Brick::segment(place, DVec2::new(2.0, 1.0)).unwrap().two_sided()),
        ("long segment", Brick::segment(place, DVec2::new(2e6, 1e6)).unwrap().two_sided()),
        ("circle from outside", Brick::circle(center, 1.5).unwrap().reversed()),
        ("circle from inside", Brick::circle(center, 8.0).unwrap()),
        ("arc", Brick::arc(center, 2.0, 0.3 * PI, 1.1 * PI).unwrap().two_sided()),
        ("wide arc", Brick::arc(center, 2.0, 0.3 * PI, 1.7 * PI).unwrap().two_sided()),
        ("point", Brick::point(place).unwrap()),
    ];
    bricks.into_iter().flat_map(|(name, brick)| Specimen::all_of(name, brick)).collect()
}

/// Checks this many flights of each brick, and prints the largest errors.
fn check_all(flights: usize) {
    for specimen in specimens() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
        let (mut touches, mut way, mut gap) = (0, 0.0_f64, 0.0_f64);
        for _ in 0..flights {
            let mut number = |size: f64| random.random_range(-size..size);
            let (place, velocity) =
                (DVec2::new(number(5.0), number(5.0)), DVec2::new(number(3.0), number(3.0)));
            let pull = DVec2::new(0.0, -number(1.0).max(0.0));
            let flight = Flight::new(number(TAU).abs(), place, velocity, pull, 0.3 + number(0.25));
            if specimen.gap(&flight, flight.time()) <= 0.0 {
                continue;
            }
            if let Some(error) = specimen.check(&flight) {
                (touches, way, gap) = (touches + 1, way.max(error.0), gap.max(error.1));
            }
        }
        println!("{:28} {touches:6} touches, way {way:.1e}, gap {gap:.1e}", specimen.name);
        assert!(way <= ALLOWED && touches > flights / 50, "{}: {touches}, {way:e}", specimen.name);
    }
}

#[test]
fn first_touches_are_those_of_brute_force() {
    check_all(300);
}

/// Seven bricks at rest and in three motions, thousands of flights each.
#[test]
#[ignore = "long: two minutes"]
fn first_touches_of_many_flights_are_those_of_brute_force() {
    check_all(20_000);
}
