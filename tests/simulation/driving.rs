//! Kicks at set times do not depend on how a run is cut, or on the scheduler.

use granular_edmd::boundary::Container;
use granular_edmd::collision::{Elastic, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    Energies, Observable, Observer, ObserverError, SampleTimes, Series, Snapshot, Temperatures,
};
use granular_edmd::scheduler::{EventScheduler, LinearScan};
use granular_edmd::simulation::{BuildError, Driving, Limits, Rescaling, RunEnd, RunError, WhiteNoise};
use granular_edmd::{Disk, ParameterError, Simulation, initial};

type Outcome<T = ()> = Result<T, Box<dyn std::error::Error>>;
type Run = Simulation<Frictional>;

fn rule() -> Outcome<Frictional> {
    Ok(Frictional::from_inelasticity(0.05, 0.05, 0.3)?)
}

fn container() -> Outcome<Container> {
    Ok(Container::closed(14.0, 12.0)?.with_periodic_sides()?)
}

fn gas() -> Outcome<Run> {
    let disks = initial::scattered(&container()?, 60, 0.5, 12.0, 1)?;
    Ok(Simulation::builder(rule()?, container()?).disks(disks).gravity(0.1).build()?)
}

fn noise() -> Outcome<WhiteNoise> {
    Ok(WhiteNoise::new(0.5, SampleTimes::every(0.4)?, 3)?.with_rotational_noise(0.2)?)
}

fn series() -> Outcome<Series<Temperatures>> {
    Ok(Series::new(Temperatures, SampleTimes::every(0.3)?))
}

/// Runs to `end` in pieces of some collisions.
fn in_pieces<S: EventScheduler>(
    run: &mut Simulation<Frictional, Container, S>,
    driving: &mut impl Driving,
    end: f64,
) -> Outcome {
    let limits = Limits::until(end).with_most_collisions(7);
    while run.run_driven(&limits, driving, &mut ())? != RunEnd::Time {}
    Ok(())
}

#[test]
fn a_driven_run_has_the_same_bits_in_pieces_and_under_any_scheduler() -> Outcome {
    let (mut whole, mut kicks, mut temperatures) = (gas()?, noise()?, series()?);
    whole.run_driven(&Limits::until(10.0), &mut kicks, &mut temperatures)?;
    assert_eq!(temperatures.values().len(), 33);
    let (mut cut, mut other) = (gas()?.with_scheduler(LinearScan::default()), noise()?);
    in_pieces(&mut cut, &mut other, 10.0)?;
    assert_eq!((whole.disks(), &kicks), (cut.disks(), &other));
    let (mut rescaled, mut by) = (gas()?, Rescaling::new(1.0, SampleTimes::every(0.4)?)?);
    let also = by.clone();
    rescaled.map_disks(|index, disk| {
        disk.with_velocity(f64::from(index as u32 % 7) * granular_edmd::glam::DVec2::X)
    })?;
    let mut again = rescaled.clone();
    rescaled.run_driven(&Limits::until(10.0), &mut by, &mut ())?;
    in_pieces(&mut again, &mut also.clone(), 10.0)?;
    assert_eq!(rescaled.disks(), again.disks());
    Ok(())
}

/// Notes the time and the energy at each start and end.
#[derive(Default)]
struct Ends {
    starts: Vec<(f64, f64)>,
    ends: Vec<(f64, f64)>,
}

impl Observer for Ends {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.starts.push((start.time(), Energies.measure(start).total()));
        Ok(())
    }
    fn on_end(&mut self, end: &Snapshot<'_>) {
        self.ends.push((end.time(), Energies.measure(end).total()));
    }
}

#[test]
fn an_observer_sees_the_disks_on_both_sides_of_a_kick() -> Outcome {
    let (mut run, mut kicks, mut observer) = (gas()?, noise()?, Ends::default());
    run.run_driven(&Limits::until(1.6), &mut kicks, &mut observer)?;
    let times = |all: &[(f64, f64)]| all.iter().map(|(time, _)| (10.0 * time).round()).collect::<Vec<_>>();
    assert_eq!(times(&observer.starts), [0.0, 4.0, 8.0, 12.0, 16.0]);
    assert_eq!(times(&observer.ends), [4.0, 8.0, 12.0, 16.0, 16.0]);
    let kicked = observer.ends.iter().zip(&observer.starts[1..]);
    let gained: f64 = kicked.map(|(before, after)| after.1 - before.1).sum();
    assert!((60.0 * gained - kicks.energy()).abs() < 1e-9, "{gained}, {}", kicks.energy());
    Ok(())
}

/// A checkpoint between two kicks keeps the noise, its random numbers and its clock.
#[cfg(feature = "serde")]
#[test]
fn a_driven_run_goes_on_between_two_kicks() -> Outcome {
    use granular_edmd::simulation::Checkpoint;
    let file = std::env::temp_dir().join(format!("granular-edmd-driven-{}", std::process::id()));
    let (mut run, mut kicks, mut temperatures) = (gas()?, noise()?, series()?);
    run.run_driven(&Limits::until(5.3), &mut kicks, &mut temperatures)?;
    run.checkpoint().write_with(&(kicks.clone(), temperatures.clone()), &file)?;
    let (checkpoint, (mut later, mut also)) =
        Checkpoint::read_with::<(WhiteNoise, Series<Temperatures>)>(&file)?;
    std::fs::remove_file(&file)?;
    let mut resumed = Simulation::resume(&checkpoint, rule()?, container()?).build()?;
    run.run_driven(&Limits::until(10.0), &mut kicks, &mut temperatures)?;
    resumed.run_driven(&Limits::until(10.0), &mut later, &mut also)?;
    assert_eq!((run.disks(), kicks, temperatures.values()), (resumed.disks(), later, also.values()));
    Ok(())
}

#[test]
fn disks_that_cannot_be_changed_so_are_refused_and_stay() -> Outcome {
    let mut run = gas()?;
    run.run_until(1.0, &mut ())?;
    let (before, far) = (run.disks(), granular_edmd::glam::DVec2::new(3.0, 3.0));
    let error = run.map_disks(|_, disk| disk.with_position(far)).unwrap_err();
    assert!(matches!(error, BuildError::Overlap { .. }), "{error}");
    let error = run.map_disks(|_, disk| disk.with_angular_velocity(f64::NAN)).unwrap_err();
    assert!(error.to_string().contains("angular velocity"), "{error}");
    assert_eq!(run.disks(), before);
    // Smaller disks fit. They keep their places, ids and images.
    run.map_disks(|_, disk| Disk::new(disk.position(), 0.4)?.with_velocity(disk.velocity()))?;
    assert!(run.disks().iter().zip(&before).all(|(new, old)| new.radius() == 0.4 && new.id() == old.id()));
    let error = Rescaling::new(1.0, SampleTimes::every(1.0)?);
    run.map_disks(|_, disk| disk.with_velocity(granular_edmd::glam::DVec2::ZERO))?;
    run.set_gravity(0.0)?;
    let error = run.run_driven(&Limits::until(3.0), &mut error?, &mut ()).unwrap_err();
    assert!(matches!(error, RunError::Driving { .. }), "{error}");
    Ok(())
}

/// A driving whose clock begins anew each time.
struct Stuck(SampleTimes);
impl Driving for Stuck {
    fn times(&mut self) -> &mut SampleTimes {
        self.0 = SampleTimes::every(1.0).unwrap();
        self.0.start_at(0.0);
        &mut self.0
    }
    fn kick(&mut self, _: &mut [Disk]) -> Result<(), ParameterError> {
        Ok(())
    }
}

#[test]
fn what_a_driving_cannot_do_is_an_error() -> Outcome {
    // All velocities are equal, so what differs from their mean is rounding.
    let disks = (0..5).map(|k| Disk::new(DVec2::new(2.0 + 3.0 * f64::from(k), 2.0), 0.5));
    let disks: Vec<Disk> =
        disks.map(|disk| disk?.with_velocity(DVec2::new(0.9, 0.1))).collect::<Result<_, _>>()?;
    let run = Simulation::builder(Elastic, Container::periodic(20.0, 20.0)?).disks(disks).build()?;
    let mut by = Rescaling::new(1.0, SampleTimes::every(1.0)?)?;
    let error = run.clone().run_driven(&Limits::until(3.0), &mut by, &mut ()).unwrap_err();
    assert!(chain(&error).contains("above the rounding of velocities"), "{}", chain(&error));

    for end in [f64::NAN, f64::INFINITY] {
        let error = run.clone().run_driven(&Limits::until(end), &mut by, &mut ()).unwrap_err();
        assert!(matches!(error, RunError::End { .. }), "{error}");
    }

    let mut stuck = Stuck(SampleTimes::every(1.0)?);
    let error = run.clone().run_driven(&Limits::until(3.0), &mut stuck, &mut ()).unwrap_err();
    assert!(chain(&error).contains("after that of the last kick, but is 1"), "{}", chain(&error));
    Ok(())
}

/// Returns an error with its causes.
fn chain(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(Some(error), |error| error.source());
    causes.map(ToString::to_string).collect::<Vec<_>>().join(": ")
}
