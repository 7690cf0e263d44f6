//! Random vessels: polygons that are anything but regular, and arcs, pegs and thin walls, at rest and in all
//! motions. They keep the contract, and nothing gets out.

use granular_edmd::boundary::{Boundary, Brick, Container, Part, Probe, WallError, laws};
use granular_edmd::collision::{ContactDuration, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, stop_when};
use granular_edmd::simulation::RunEnd;
use granular_edmd::wall::{BiParabolic, Sinusoidal, Triangular};
use granular_edmd::{Flight, Simulation, initial};
use proptest::prelude::*;

use support::cases::config;

/// A way in which a part moves.
#[derive(Debug, Clone, Copy)]
enum Motion {
    None,
    BiParabolic,
    Triangular,
    Sinusoidal,
    Turning,
}

/// A vessel as data.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    /// Distances of the corners from the middle, at angles in equal steps and a little off.
    corners: Vec<(f64, f64)>,
    /// A thing in the middle, and its size.
    inner: (u8, f64),
    motion: Motion,
    inner_motion: Motion,
    amplitude: f64,
    frequency: f64,
    direction: f64,
    periodic: bool,
}

const MIDDLE: DVec2 = DVec2::new(5.0, -3.0);

fn unit(angle: f64) -> DVec2 {
    let (sine, cosine) = libm::sincos(angle);
    DVec2::new(cosine, sine)
}

impl Plan {
    /// Returns the corners of a polygon that the middle sees whole.
    fn polygon(&self, size: f64) -> Vec<DVec2> {
        let step = std::f64::consts::TAU / self.corners.len() as f64;
        let corner = |(k, &(distance, off)): (usize, &(f64, f64))| {
            MIDDLE + size * distance * unit(step * (k as f64 + 0.4 * off))
        };
        self.corners.iter().enumerate().map(corner).collect()
    }

    fn inner(&self) -> Result<Part, WallError> {
        let (kind, size) = self.inner;
        let at = |x: f64, y: f64| MIDDLE + size * DVec2::new(x, y);
        match kind {
            0 => Part::peg(MIDDLE, size),
            1 => Part::polyline([at(-1.0, 0.2), at(0.1, -0.3), at(0.2, 0.9)]),
            2 => Part::block([at(-1.0, -0.8), at(1.0, -0.7), at(0.1, 0.1), at(0.9, 1.0), at(-0.2, 0.4)]),
            3 => Part::new([Brick::arc(MIDDLE, size, self.direction, self.direction + 4.0)?.two_sided()]),
            _ => Part::new([Brick::arc(MIDDLE, size, self.direction, self.direction + 2.0)?.two_sided()]),
        }
    }

    fn moving(&self, part: Part, motion: Motion) -> Result<Part, WallError> {
        let (along, amplitude, frequency) = (unit(self.direction), self.amplitude, self.frequency);
        match motion {
            Motion::None => Ok(part),
            Motion::BiParabolic => part.with_motion(along, BiParabolic::new(amplitude, frequency)?),
            Motion::Triangular => part.with_motion(along, Triangular::new(amplitude, frequency)?),
            Motion::Sinusoidal => part.with_motion(along, Sinusoidal::new(amplitude, frequency)?),
            Motion::Turning => part.with_rotation(MIDDLE + amplitude * along, 0.1 * frequency),
        }
    }

    pub(crate) fn vessel(&self) -> Result<Container, WallError> {
        let inner = self.moving(self.inner()?, self.inner_motion)?;
        if self.periodic {
            // The polygon is a block that lies across the sides. There is room for a disk all around it, so
            // that it squeezes none.
            let container = Container::closed(16.0, 14.0)?.with_periodic_sides().expect("plain sides");
            let block = self.moving(Part::block(self.polygon(2.0))?, self.motion)?;
            let (block, other) =
                (block.shifted(DVec2::new(-5.0, 7.0))?, inner.shifted(DVec2::new(3.0, 10.0))?);
            return container.with_part("block", block)?.with_part("inner", other);
        }
        let outer = self.moving(Part::polygon(self.polygon(6.0))?, self.motion)?;
        Container::around([("outer", outer), ("inner", inner)])
    }
}

fn motion() -> impl Strategy<Value = Motion> {
    prop_oneof![
        Just(Motion::None),
        Just(Motion::BiParabolic),
        Just(Motion::Triangular),
        Just(Motion::Sinusoidal),
        Just(Motion::Turning)
    ]
}

pub(crate) fn plan() -> impl Strategy<Value = Plan> {
    let corners = prop::collection::vec((0.55..1.0f64, -1.0..1.0f64), 3..14);
    let numbers = (0.01..0.3f64, 0.3..8.0f64, 0.0..6.0f64);
    (corners, (0u8..5, 0.2..1.0f64), motion(), motion(), numbers, any::<bool>()).prop_map(
        |(corners, inner, motion, inner_motion, (amplitude, frequency, direction), periodic)| Plan {
            corners,
            inner,
            motion,
            inner_motion,
            amplitude,
            frequency,
            direction,
            periodic,
        },
    )
}

/// Checks that a vessel keeps the contract. A vessel without room for a disk, or whose corners lie so that
/// sides cross, proves nothing.
fn keeps_the_contract(plan: &Plan, radius: f64, seed: u64) -> Result<(), TestCaseError> {
    let mut vessel = match plan.vessel() {
        Err(WallError::Crossing { .. }) => return Err(TestCaseError::reject("sides cross")),
        vessel => vessel.map_err(|error| TestCaseError::fail(error.to_string()))?,
    };
    match laws::check(&mut vessel, radius, 1.0, seed) {
        Err(violation) if violation.law() == "room" => Err(TestCaseError::reject("there is no room")),
        outcome => {
            prop_assert_eq!(outcome, Ok(()));
            Ok(())
        }
    }
}

/// Lets disks fly in a vessel for a while. They stay inside.
fn nothing_gets_out(plan: &Plan, radius: f64, seed: u64) -> Result<(), TestCaseError> {
    let Ok(vessel) = plan.vessel() else { return Err(TestCaseError::reject("sides cross")) };
    let Ok(disks) = initial::scattered(&vessel, 12, radius, 20.0, seed) else {
        return Err(TestCaseError::reject("there is no room"));
    };
    let fail = |error: &dyn std::error::Error| TestCaseError::fail(error.to_string());
    let disks = initial::with_maxwellian_velocities(disks, 1.0, seed).map_err(|error| fail(&error))?;
    let rule =
        Frictional::from_inelasticity(0.02, 0.02, 0.3).and_then(|rule| ContactDuration::new(rule, 1e-2));
    let rule = rule.map_err(|error| fail(&error))?;
    let mut run = Simulation::builder(rule, vessel.clone()).disks(disks).gravity(0.2).build();
    let run = run.as_mut().map_err(|error| fail(error))?;
    // A disk that moving parts squeeze rattles between them ever faster, without an end. It must not get out.
    let mut squeezed = stop_when(|collision: &Collision| collision.contact.closing_speed() > 1e3);
    for time in 1..=20 {
        let end = run.run_until(f64::from(time), &mut squeezed).map_err(|error| fail(&error))?;
        for disk in run.disks() {
            let overlap = vessel.overlap(&Probe::new(disk.position(), 0.0, run.time()));
            prop_assert!(overlap.is_none(), "{:?} at {} is out: {:?}", disk, time, overlap);
        }
        prop_assert!(run.counters().max_wall_overlap < 1e-9, "{:?}", run.counters());
        if end == RunEnd::Observer {
            break;
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: 100_000, ..config(3) })]

    #[test]
    fn random_vessels_keep_the_contract(plan in plan(), radius in 0.1..0.5f64, seed in any::<u64>()) {
        keeps_the_contract(&plan, radius, seed)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { max_global_rejects: 100_000, ..config(6) })]

    #[test]
    fn nothing_gets_out_of_random_vessels(plan in plan(), radius in 0.1..0.3f64, seed in any::<u64>()) {
        nothing_gets_out(&plan, radius, seed)?;
    }
}

/// A slowly turning polygon: a long step of the search looked for the touch on the wrong side of a brick.
#[test]
fn a_slowly_turning_vessel_is_touched_whenever_the_flight_begins() {
    let corners = vec![
        (0.941_328_496_838_321_1, -0.339_197_871_590_426_1),
        (0.962_435_549_598_933_7, 0.915_522_274_498_509_9),
        (0.55, 0.0),
        (0.901_685_450_508_385, 0.936_111_712_573_034_5),
        (0.636_113_067_102_341_7, -0.991_760_734_970_934_5),
        (0.55, 0.0),
        (0.747_418_814_257_169_2, 0.498_853_501_315_805_64),
    ];
    let plan = Plan {
        corners,
        inner: (3, 0.435_357_373_095_536_35),
        motion: Motion::Turning,
        inner_motion: Motion::None,
        amplitude: 0.049_997_373_080_051_984,
        frequency: 1.175_973_602_754_541_3,
        direction: 2.258_914_996_357_962_7,
        periodic: false,
    };
    assert!(keeps_the_contract(&plan, 0.142_272_785_438_535_17, 50_794_779_578_952_536).is_ok());
    // From any start and with any end, the touch is the same.
    let mut vessel = plan.vessel().unwrap();
    vessel.set_time_origin(5.716_170_656_501_686);
    let (place, velocity) = (DVec2::new(3.5668, 1.6382), DVec2::new(1.7103, -1.9976));
    let flight = Flight::new(13.1682, place, velocity, DVec2::new(0.0, -0.3092), 0.1422);
    let first = vessel.first_touch(&flight, 20.0).touch().unwrap();
    for k in 0..1000 {
        let start = 13.1682 + (first.time - 13.1682) * f64::from(k) / 1000.0;
        let later = Flight::new(
            start,
            flight.position(start),
            flight.velocity(start),
            flight.acceleration(),
            flight.radius(),
        );
        let until = first.time + 1e-6 + 0.01 * f64::from(k);
        let touch = vessel.first_touch(&later, until).touch().unwrap();
        assert!((touch.time - first.time).abs() < 1e-11 && touch.wall == first.wall, "{touch:?} {first:?}");
    }
}

/// A disk flies into a turning bowl. It is within the bowl's circle before it is beside the bowl, and the
/// search took the touch for one of the past.
#[test]
fn a_turning_bowl_is_touched_from_its_opening() {
    let corners = vec![
        (0.791_161_353_663_352_4, -0.250_387_567_220_102_14),
        (0.688_948_629_659_140_5, 0.0),
        (0.943_884_149_733_791_6, 0.372_238_541_555_549_9),
        (0.55, 0.0),
        (0.771_564_558_401_173, 0.0),
        (0.809_908_859_783_435_1, -0.342_352_048_746_931_7),
        (0.823_696_124_606_605_6, -0.979_097_763_166_771_1),
        (0.55, 0.0),
        (0.561_521_240_390_854_8, -0.473_515_704_542_890_4),
    ];
    let plan = Plan {
        corners,
        inner: (3, 0.271_952_873_884_793_1),
        motion: Motion::Triangular,
        inner_motion: Motion::Turning,
        amplitude: 0.036_308_067_099_887_42,
        frequency: 6.850_861_700_356_182,
        direction: 0.615_628_139_827_036_5,
        periodic: false,
    };
    assert!(nothing_gets_out(&plan, 0.103_722_333_383_439_45, 6_673_588_576_306_729_431).is_ok());
}
