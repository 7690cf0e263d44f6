//! Every public constructor over every kind of number: refused with an error that names the value, or fit to
//! run.

use granular_edmd::boundary::{Container, Region, Thermal, Wall};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::kinetic::{Maxwellian, MonteCarlo};
use granular_edmd::observable::{
    EnergyChangeProfile, Grid, HeightProfile, PairCorrelation, SampleTimes, WallStress,
};
use granular_edmd::statistics::Histogram;
use granular_edmd::wall::{BiParabolic, Combined, Fixed, Sawtooth, Sinusoidal, Tabulated, Triangular};
use granular_edmd::{Disk, Simulation, initial};

/// Numbers that a file or a typing error may bring.
const NUMBERS: [f64; 18] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MIN,
    -1e300,
    -1.0,
    -1e-9,
    -5e-324,
    -0.0,
    0.0,
    5e-324,
    1e-320,
    1e-30,
    0.3,
    1.0,
    1e30,
    1e300,
    f64::MAX,
];

/// A constructor of one number, by the name that its error must have, and the numbers that it takes.
type Case = (&'static str, fn(f64) -> Result<(), String>, fn(f64) -> bool);

fn told<T>(result: Result<T, impl ToString>) -> Result<(), String> {
    result.map(drop).map_err(|error| error.to_string())
}

fn positive(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

fn not_negative(value: f64) -> bool {
    value >= 0.0 && value.is_finite()
}

fn scale(value: f64) -> bool {
    (1e-30..=1e30).contains(&value)
}

fn bounded(value: f64) -> bool {
    value.abs() <= 1e60
}

fn times() -> SampleTimes {
    SampleTimes::every(1.0).unwrap()
}

fn disk() -> Disk {
    Disk::new(DVec2::new(2.0, 2.0), 0.5).unwrap()
}

fn box_of(width: f64) -> Container {
    Container::closed(width, 6.0).unwrap()
}

fn motions() -> Vec<Case> {
    let swings = |value: f64| positive(value) && positive(value * 9.0);
    // A time that has a middle between itself and 0.
    let splits = |value: f64| positive(value) && positive(0.5 * value);
    let turns = |value: f64| {
        positive(value) && positive(std::f64::consts::TAU / value) && positive(0.1 * value * value)
    };
    vec![
        ("", |value| told(BiParabolic::new(value, 3.0)), swings),
        ("", |value| told(BiParabolic::new(0.1, value)), turns),
        ("", |value| told(Sinusoidal::new(value, 3.0)), swings),
        ("", |value| told(Sinusoidal::new(0.1, value)), turns),
        ("", |value| told(Triangular::new(value, 3.0)), swings),
        ("", |value| told(Sawtooth::new(0.1, value)), turns),
        ("time of row 1", |value| told(Tabulated::new([(0.0, 0.0), (value, 0.0)])), splits),
        ("displacement of row 0", |value| told(Tabulated::from_to(value, value, 1.0)), f64::is_finite),
        ("", |value| told(Tabulated::from_to(0.0, 0.0, value)), splits),
        ("start of a motion", |value| told(Combined::new(Fixed).delayed_until(value)), f64::is_finite),
        ("factor of a motion", |value| told(Combined::new(Fixed).scaled(value)), f64::is_finite),
    ]
}

fn engine() -> Vec<Case> {
    vec![
        ("position", |value| told(Disk::new(DVec2::new(0.0, value), 0.5)), bounded),
        ("radius", |value| told(Disk::new(DVec2::ZERO, value)), scale),
        ("position", |value| told(disk().with_position(DVec2::new(value, 0.0))), bounded),
        ("velocity", |value| told(disk().with_velocity(DVec2::new(value, 0.0))), bounded),
        ("angle", |value| told(disk().with_angle(value)), f64::is_finite),
        ("angular velocity", |value| told(disk().with_angular_velocity(value)), bounded),
        ("mass", |value| told(disk().with_mass(value)), scale),
        (
            "inertia factor",
            |value| told(disk().with_inertia_factor(value)),
            |value| (1e-6..=1.0).contains(&value),
        ),
        ("width", |value| told(Container::open(value)), positive),
        ("width", |value| told(Container::closed(value, 1.0)), positive),
        ("height", |value| told(Container::closed(1.0, value)), positive),
        ("wall temperature", |value| told(Thermal::new(value)), positive),
        ("temperature", |value| told(initial::with_maxwellian_velocities(vec![], value, 1)), not_negative),
        (
            "gravity",
            |value| told(Simulation::builder(Elastic, box_of(8.0)).gravity(value).build()),
            |value| value.abs() <= 1e60,
        ),
        (
            "start time",
            |value| told(Simulation::builder(Elastic, box_of(8.0)).starting_at(value).build()),
            f64::is_finite,
        ),
    ]
}

/// A width of a bin whose inverse is a number, too.
fn resolved(value: f64) -> bool {
    positive(value) && (1.0 / value).is_finite()
}

fn watching() -> Vec<Case> {
    vec![
        ("sampling interval", |value| told(SampleTimes::every(value)), positive),
        ("first sampling time", |value| told(times().starting_at(value)), f64::is_finite),
        ("upper end of the bins", |value| told(HeightProfile::new(0.0, value, 1)), resolved),
        (
            "lower end of the bins",
            |value| told(HeightProfile::new(value, 2.0, 1)),
            |value| value.is_finite() && value < 2.0,
        ),
        ("upper end of the bins", |value| told(EnergyChangeProfile::new(0.0, value, 1)), resolved),
        ("range of the correlation", |value| told(PairCorrelation::new(value, 1)), resolved),
        ("length of a wall", |value| told(WallStress::new(times()).with_wall("floor", value)), positive),
        ("upper end of the bins", |value| told(Histogram::new(0.0, value, 1)), resolved),
        ("edge of the region", |value| told(grid(value)), |value| value > 1.0 && value.is_finite()),
        ("translational temperature", |value| told(Maxwellian::new(value)), scale),
        (
            "rotational temperature",
            |value| told(Maxwellian::new(1.0).unwrap().with_rotational_temperature(value)),
            |value| (0.0..=1e30).contains(&value),
        ),
        ("standard error", |value| told(MonteCarlo::new(1).with_standard_error(value)), positive),
    ]
}

fn grid(right: f64) -> Result<Grid, granular_edmd::ParameterError> {
    Grid::new(Region::new(DVec2::ONE, DVec2::new(right, 2.0)), 1, 1)
}

#[test]
fn each_number_is_taken_or_named() {
    for (name, construct, takes) in motions().into_iter().chain(engine()).chain(watching()) {
        for value in NUMBERS {
            match construct(value) {
                Ok(()) => assert!(takes(value), "{name} {value:e} was taken"),
                Err(error) => {
                    assert!(!takes(value), "{value:e} was refused: {error}");
                    let derived = ["area of", "peak", "period", "upper end of", "width of a bin"];
                    let said = error.rsplit(' ').next().unwrap().parse::<f64>();
                    let by_itself = error.starts_with(name)
                        && said.is_ok_and(|said| said == value || said.is_nan() && value.is_nan());
                    assert!(by_itself || derived.iter().any(|d| error.starts_with(d)), "{value}: {error}");
                }
            }
        }
    }
}

/// Does up to a hundred events of two disks, and expects an error or a run with finite numbers.
fn runs(container: &Container, gravity: f64, start: f64, speed: f64) {
    for count in 0..3 {
        let Ok(disks) = initial::lattice(container, count, 0.5) else { continue };
        let disks = disks.into_iter().map(|disk| disk.with_velocity(DVec2::new(speed, 0.3 * speed)).unwrap());
        let builder = Simulation::builder(Elastic, container.clone()).disks(disks);
        let Ok(mut run) = builder.gravity(gravity).starting_at(start).build() else { continue };
        for _ in 0..100 {
            let end = run.time() + 1.0;
            if run.step_until(end, &mut ()).is_err() {
                break;
            }
        }
        assert!(run.disks().iter().all(|disk| !disk.position().is_nan()), "{gravity} {start} {speed}");
    }
}

#[test]
fn systems_of_any_size_end_in_an_error_or_run() {
    for value in NUMBERS.into_iter().filter(|value| value.is_finite()) {
        runs(&box_of(8.0), value, 0.0, 1.0);
        runs(&box_of(8.0), 1.0, value, 1.0);
        if bounded(value) {
            runs(&box_of(8.0), 0.1, 0.0, value);
        }
        if positive(value) {
            runs(&box_of(value), 0.1, 0.0, 1.0);
            runs(&box_of(value).with_periodic_sides().unwrap(), 0.0, 0.0, 1.0);
            runs(&Container::closed(8.0, value).unwrap(), 0.1, 0.0, 1.0);
            runs(&Container::closed(value, value).unwrap(), 0.1, 0.0, 1.0);
        }
    }
}

#[test]
fn walls_of_any_motion_end_in_an_error_or_run() {
    let sine = Sinusoidal::new(0.1, 3.0).unwrap();
    for value in NUMBERS {
        let floors = [
            BiParabolic::new(value, 3.0).map(|motion| box_of(8.0).with_motion(Wall::Floor, motion)),
            BiParabolic::new(0.1, value).map(|motion| box_of(8.0).with_motion(Wall::Floor, motion)),
            Sinusoidal::new(value, 3.0).map(|motion| box_of(8.0).with_motion(Wall::Floor, motion)),
            Sinusoidal::new(0.1, value).map(|motion| box_of(8.0).with_motion(Wall::Floor, motion)),
            Sawtooth::new(0.1, value).map(|motion| box_of(8.0).with_motion(Wall::Floor, motion)),
            Tabulated::from_to(0.0, value, 3.0).map(|motion| box_of(8.0).with_motion(Wall::Floor, motion)),
            Tabulated::from_to(0.0, 0.1, value).map(|motion| box_of(8.0).with_motion(Wall::Floor, motion)),
            Combined::new(sine).scaled(value).map(|motion| box_of(8.0).with_motion(Wall::Floor, motion)),
            Thermal::new(value).map(|thermal| box_of(8.0).with_temperature(Wall::Floor, thermal)),
        ];
        floors.into_iter().flatten().for_each(|floor| runs(&floor.unwrap(), 0.1, 0.0, 1.0));
        // Where floating-point times cannot tell the pieces of a sine apart, the container says so.
        let Ok(late) = Combined::new(sine).delayed_until(value) else { continue };
        let floor = box_of(8.0).with_motion(Wall::Floor, late);
        assert!(floor.is_ok() || value.abs() > 1e9, "{value}");
        if let Ok(floor) = floor {
            runs(&floor, 0.1, 0.0, 1.0);
        }
    }
}

/// The set-up is linear, not quadratic: a million disks are set up in seconds.
#[test]
#[ignore = "seconds in release, and half a gigabyte"]
fn a_million_disks_are_set_up_in_seconds() {
    let begin = std::time::Instant::now();
    let container = Container::closed(2000.0, 2000.0).unwrap();
    let disks = initial::lattice(&container, 1_000_000, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap();
    let mut run = Simulation::builder(Elastic, container.clone()).disks(disks).build().unwrap();
    run.run_until(1e-3, &mut ()).unwrap();
    assert_eq!(initial::scattered(&container, 1_000_000, 0.5, 2000.0, 1).unwrap().len(), 1_000_000);
    let seconds = begin.elapsed().as_secs_f64();
    println!("{seconds} s");
    assert!(seconds < 60.0, "{seconds} s");
}

#[test]
fn more_disks_than_memory_holds_are_refused_at_once() {
    let open = Container::open(1e9).unwrap();
    for count in [usize::MAX, 1 << 40, (1 << 28) + 1] {
        let refused = initial::lattice(&open, count, 0.5).unwrap_err().to_string();
        assert!(refused.contains("number of disks"), "{refused}");
        let refused = initial::scattered(&open, count, 0.5, 1e9, 1).unwrap_err().to_string();
        assert!(refused.contains("number of disks"), "{refused}");
    }
}
