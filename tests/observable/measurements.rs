//! Measurements as data: written halfway and read back, they end with the bits of a run without interruption.

use granular_edmd::boundary::{Container, Part, Region, Wall};
use granular_edmd::collision::{ContactDuration, Elastic, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    Arrivals, CenterOfMass, CollisionCounts, CollisionHistograms, Energies, EnergyChange,
    EnergyChangeProfile, Fields, Grid, HeightProfile, MeanSquaredDisplacement, Observer, OrderParameters,
    PairCorrelation, SampleTimes, Sampled, Series, Stress, Temperatures, TemperaturesAboutFlow,
    TimeCorrelation, Velocities, VelocityDistribution, WallStress,
};
use granular_edmd::simulation::Checkpoint;
use granular_edmd::statistics::{BlockedMean, Estimate, Histogram, RunningMean};
use granular_edmd::wall::BiParabolic;
use granular_edmd::{ParameterError, Simulation, initial};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

type Outcome = Result<(), Box<dyn std::error::Error>>;

type Rule = ContactDuration<Frictional>;

/// All observers at once.
type Watchers = (
    Series<((OrderParameters, CenterOfMass), (Energies, Temperatures))>,
    (EnergyChange, CollisionCounts),
    Sampled<EnergyChangeProfile>,
    (Sampled<HeightProfile>, Sampled<Fields>, Sampled<VelocityDistribution>, CollisionHistograms),
    (Sampled<PairCorrelation>, MeanSquaredDisplacement, TimeCorrelation<Velocities>),
    (Stress, WallStress, Series<TemperaturesAboutFlow>),
);

const HALF: f64 = 60.1;
const END: f64 = 120.2;

fn watchers() -> Result<Watchers, ParameterError> {
    let times = SampleTimes::every(0.3)?;
    let observables = ((OrderParameters, CenterOfMass), (Energies, Temperatures));
    let region = region(DVec2::ZERO, DVec2::new(10.0, 20.0));
    let grid = Grid::new(region, 2, 2)?;
    let bulk = Region::new(DVec2::splat(2.5), DVec2::new(7.5, 17.5));
    Ok((
        Series::new(observables, times),
        (EnergyChange::default(), CollisionCounts::default()),
        Sampled::new(EnergyChangeProfile::new(0.0, 20.0, 5)?, times.starting_at(0.7)?),
        (
            Sampled::new(HeightProfile::new(0.0, 20.0, 7)?, times),
            Sampled::new(Fields::new(Grid::new(region, 3, 4)?), times),
            Sampled::new(VelocityDistribution::new(3.0, 6)?.about_flow(grid), times),
            CollisionHistograms::new(5.0, 5.0, 6)?,
        ),
        (
            Sampled::new(PairCorrelation::new(2.0, 8)?.within(bulk)?, times),
            MeanSquaredDisplacement::new(5, times)?,
            TimeCorrelation::new(Velocities, 5, times)?,
        ),
        (
            Stress::new(times).within(region)?,
            WallStress::new(times).with_wall("floor", 10.0)?,
            Series::new(TemperaturesAboutFlow::new(grid), times),
        ),
    ))
}

fn region(min: DVec2, max: DVec2) -> Region {
    Region::new(min, max)
}

fn container() -> Result<Container, Box<dyn std::error::Error>> {
    Ok(Container::closed(10.0, 20.0)?.with_motion(Wall::Floor, BiParabolic::new(0.2, 5.0)?)?)
}

fn rule() -> Result<Rule, ParameterError> {
    ContactDuration::new(Frictional::from_inelasticity(0.05, 0.05, 0.2)?, 1e-3)
}

fn simulation() -> Result<Simulation<Rule>, Box<dyn std::error::Error>> {
    let disks = initial::with_maxwellian_velocities(initial::lattice(&container()?, 40, 0.5)?, 1.0, 3)?;
    Ok(Simulation::builder(rule()?, container()?).disks(disks).gravity(0.2).build()?)
}

fn json<T: Serialize + DeserializeOwned>(value: &T) -> Result<T, Box<dyn std::error::Error>> {
    Ok(serde_json::from_str(&serde_json::to_string(value)?)?)
}

fn binary<T: Serialize + DeserializeOwned>(value: &T) -> Result<T, Box<dyn std::error::Error>> {
    Ok(postcard::from_bytes(&postcard::to_stdvec(value)?)?)
}

/// Runs from time 0 to the end. Halfway, observers and state go through `through`.
fn measured(
    through: impl Fn(Watchers) -> Result<Watchers, Box<dyn std::error::Error>>,
) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
    let mut run = simulation()?;
    let mut watchers = watchers()?;
    watchers.on_start(&run.snapshot()).unwrap();
    run.run_until(HALF, &mut watchers)?;
    let mut watchers = through(watchers)?;
    let mut run = Simulation::resume(&run.checkpoint(), rule()?, container()?).build()?;
    run.run_until(END, &mut watchers)?;
    assert_eq!(watchers.0.values().len(), 400);
    assert!(watchers.1.0.disks().count() > 500 && watchers.1.0.wall("floor").count() > 50);
    Ok(postcard::to_stdvec(&watchers)?)
}

#[test]
fn a_measurement_goes_on_with_the_same_bits() -> Outcome {
    let whole = measured(Ok)?;
    assert_eq!(measured(|watchers| json(&watchers))?, whole);
    assert_eq!(measured(|watchers| binary(&watchers))?, whole);
    // The same holds in a single run. It differs at most by the rounding of the time to which the first half
    // ran.
    let mut run = simulation()?;
    let mut uncut = watchers()?;
    uncut.on_start(&run.snapshot()).unwrap();
    run.run_until(END, &mut uncut)?;
    assert_eq!(postcard::to_stdvec(&uncut)?, whole);
    Ok(())
}

/// A type that leaves out what is empty, and cannot be read back.
#[derive(Serialize, serde::Deserialize)]
struct Careless {
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<u64>,
    second: u64,
}

/// State and observers come from one file with every bit, and a file of other observers is refused.
#[test]
fn a_checkpoint_keeps_its_observers() -> Outcome {
    let file = std::env::temp_dir().join(format!("granular-edmd-observers-{}", std::process::id()));
    let kept = measured(|watchers| {
        simulation()?.checkpoint().write_with(&watchers, &file)?;
        Ok(Checkpoint::read_with(&file)?.1)
    });
    assert_eq!(kept?, measured(Ok)?);
    let refused = Checkpoint::read_with::<(u64, f64)>(&file).unwrap_err();
    assert!(refused.to_string().contains(&file.display().to_string()), "{refused}");
    assert!(Checkpoint::read(&file).is_err(), "a file of two is not a checkpoint alone");
    let whole = std::fs::read(&file)?;
    std::fs::write(&file, &whole[..whole.len() - 1])?;
    assert!(Checkpoint::read_with::<Watchers>(&file).is_err());

    // An empty box has no center of mass: NaN is kept, as numbers are that a text would round.
    let numbers = [f64::NAN, f64::INFINITY, -0.0, 0.1 + 0.2, 10.047_299_310_911_127];
    simulation()?.checkpoint().write_with(&numbers, &file)?;
    let (checkpoint, read) = Checkpoint::read_with::<[f64; 5]>(&file)?;
    assert_eq!(read.map(f64::to_bits), numbers.map(f64::to_bits));
    assert_eq!(checkpoint, simulation()?.checkpoint());

    let careless = Careless { first: None, second: 1 };
    assert!(simulation()?.checkpoint().write_with(&careless, &file).is_err());
    Ok(std::fs::remove_file(&file)?)
}

#[test]
fn means_and_estimates_survive_files() -> Outcome {
    for count in [0_u32, 1, 2, 3, 100, 1023] {
        let series = || (0..count).map(|k| f64::from(k * k % 17) / 7.0);
        let (running, blocked) = (series().collect::<RunningMean>(), series().collect::<BlockedMean>());
        assert_eq!((json(&running)?, json(&blocked)?), (running, blocked.clone()));
        assert_eq!((binary(&running)?, binary(&blocked)?), (running, blocked.clone()));
        for estimate in [running.estimate(), blocked.estimate()] {
            // NaN is not equal to itself, so the values are compared as text.
            assert_eq!(format!("{:?}", json(&estimate)?), format!("{estimate:?}"));
            assert_eq!(format!("{:?}", binary(&estimate)?), format!("{estimate:?}"));
        }
        // There are as many levels as the count has binary digits.
        let levels = serde_json::to_value(&blocked)?.as_array().map(Vec::len);
        assert_eq!(levels, Some((u32::BITS - count.leading_zeros()) as usize));
    }
    Ok(())
}

/// A value with one number of it changed, at a JSON pointer.
fn forged(value: &impl Serialize, at: &str, number: Value) -> Value {
    let mut value = serde_json::to_value(value).unwrap();
    *value.pointer_mut(at).unwrap_or_else(|| panic!("{at}")) = number;
    value
}

fn refused<T: DeserializeOwned>(value: Value) -> bool {
    serde_json::from_value::<T>(value).is_err()
}

#[test]
fn impossible_parameters_and_lengths_are_refused() -> Outcome {
    let blocked = BlockedMean::from_iter([1.0, 2.0, 4.0, 5.0, 7.0]);
    let estimate: Estimate = blocked.estimate();
    for (at, number) in [
        ("/samples", json!(1)),
        ("/mean", json!(null)),
        ("/standard_error", json!(-1.0)),
        ("/standard_error", json!(null)),
        ("/correlated_samples", json!(-2.0)),
        ("/basis", json!("Guessed")),
    ] {
        assert!(refused::<Estimate>(forged(&estimate, at, number)), "{at}");
    }
    let times = SampleTimes::every(0.5)?.starting_at(3.0)?;
    for (at, number) in [("/interval", json!(0.0)), ("/first", json!("soon")), ("/beat", json!(-1))] {
        assert!(refused::<SampleTimes>(forged(&times, at, number)), "{at}");
    }
    let (_, _, profile, (heights, fields, ..), (pairs, displacement, _), (stress, walls, _)) = &watchers()?;
    for (at, number) in [("/bins/count", json!(4)), ("/layers", json!([]))] {
        assert!(refused::<EnergyChangeProfile>(forged(&**profile, at, number)), "{at}");
    }
    for (at, number) in [
        ("/bins/high", json!(-1.0)),
        ("/bins/high", json!(null)),
        ("/bins/count", json!(0)),
        ("/sums", json!([0.0])),
    ] {
        assert!(refused::<HeightProfile>(forged(&**heights, at, number)), "{at}");
    }
    for (at, number) in
        [("/grid/columns", json!(4)), ("/grid/rows", json!(u64::MAX)), ("/grid/region/max/0", json!(-1.0))]
    {
        assert!(refused::<Fields>(forged(&**fields, at, number)), "{at}");
    }
    for (at, number) in [("/bins/count", json!(9)), ("/pairs", json!([])), ("/region/max/0", json!(-1.0))] {
        assert!(refused::<PairCorrelation>(forged(&**pairs, at, number)), "{at}");
    }
    for (at, number) in [("/lags/means", json!([])), ("/lags/past", json!([[], [], [], [], [], [], []]))] {
        assert!(refused::<MeanSquaredDisplacement>(forged(displacement, at, number)), "{at}");
    }
    assert!(refused::<Stress>(forged(stress, "/region/max/0", json!(-1.0))));
    assert!(refused::<WallStress>(forged(walls, "/walls/values/0/1/length", json!(0.0))));
    let histogram = Histogram::new(0.0, 1.0, 2)?;
    for (at, number) in [("/counts", json!([1])), ("/counts/0", json!(u64::MAX)), ("/below", json!(-1))] {
        assert!(refused::<Histogram>(forged(&histogram, at, number)), "{at}");
    }
    Ok(())
}

/// Fails unless the measurement, read back from a file, finds its part again when the indices have changed,
/// and refuses a run without it if it needs the part.
fn finds_its_part<O: Observer + Serialize + DeserializeOwned>(mut observer: O, is_needed: bool) -> Outcome {
    let peg = |x: f64| Part::peg(DVec2::new(x, 3.0), 1.0);
    let container = || Container::closed(20.0, 20.0);
    let vessel = container()?.with_part("a", peg(4.0)?)?.with_part("b", peg(16.0)?)?;
    let swapped = container()?.with_part("b", peg(16.0)?)?.with_part("a", peg(4.0)?)?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&vessel, 40, 0.5)?, 1.0, 1)?;
    let mut run = Simulation::builder(Elastic, vessel.clone()).disks(disks).build()?;
    run.run_until(20.0, &mut observer)?;
    let read =
        || -> Result<O, serde_json::Error> { serde_json::from_value(serde_json::to_value(&observer)?) };
    let others = |walls: &Container| {
        Simulation::resume(&run.checkpoint(), Elastic, walls.clone()).with_another_boundary().build()
    };
    others(&vessel)?.run_until(30.0, &mut read()?)?;
    others(&swapped)?.run_until(30.0, &mut read()?)?;
    let refused = others(&container()?)?.run_until(30.0, &mut read()?).is_err();
    assert_eq!(refused, is_needed);
    Ok(())
}

#[test]
fn a_file_holds_the_names_of_walls() -> Outcome {
    let times = SampleTimes::every(1.0)?;
    finds_its_part(Arrivals::at(["a"], times), true)?;
    finds_its_part(CollisionCounts::default(), false)?;
    finds_its_part(CollisionHistograms::new(5.0, 5.0, 4)?.with_wall("a"), true)?;
    finds_its_part(EnergyChange::default(), false)?;
    finds_its_part(WallStress::new(times).with_wall("a", 5.0)?, true)
}
