//! Observables of known states, and observers against the bare list of collisions.

use granular_edmd::boundary::{Container, Domain, Wall};
use granular_edmd::collision::{ContactDuration, Elastic, Frictional, Regime};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    CenterOfMass, Collision, CollisionCounts, Energies, EnergyChange, EnergyChangeProfile, Observable,
    Observer, OrderParameters, Partner, SampleTimes, Sampled, Series, Snapshot, Temperatures, on_collision,
    on_sample,
};
use granular_edmd::statistics::{BlockedMean, RunningMean};
use granular_edmd::{Disk, ParameterError, Simulation, initial};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// The place of the first disk is a quarter of the width from the left, that of the second the middle.
const DOMAIN: Domain = Domain::new(-1.0, 7.0, 0.0, 6.0);

fn disks() -> Result<[Disk; 2], ParameterError> {
    let light = Disk::new(DVec2::new(1.0, 1.0), 0.5)?.with_velocity(DVec2::new(1.0, 2.0))?;
    let heavy = Disk::new(DVec2::new(3.0, 5.0), 0.5)?.with_mass(3.0)?.with_velocity(DVec2::new(-1.0, 0.5))?;
    Ok([light.with_angular_velocity(4.0)?, heavy.with_angular_velocity(-2.0)?])
}

#[test]
fn two_disks_have_the_observables_of_their_formulas() -> Outcome {
    let disks = disks()?;
    let snapshot = Snapshot::new(1.5, &disks, DOMAIN, 2.0);
    assert_eq!((snapshot.time(), snapshot.gravity(), snapshot.domain()), (1.5, 2.0.into(), DOMAIN));
    let boxed: Box<dyn Observable<Value = _>> = Box::new(CenterOfMass);
    let (center, energies, temperatures) = (boxed, &Energies, Temperatures).measure(&snapshot);
    assert_eq!(center, DVec2::new(2.5, 4.0));
    assert_eq!((energies.translational, energies.rotational, energies.potential), (2.1875, 0.875, 16.0));
    assert_eq!(energies.total(), 19.0625);
    assert_eq!((temperatures.horizontal, temperatures.vertical), (2.0, 2.375));
    assert_eq!((temperatures.translational(), temperatures.rotational), (2.1875, 1.75));
    let order = OrderParameters.measure(&snapshot);
    assert!((order.one_roll - 1.0).abs() < 1e-15 && (order.two_rolls - 0.25).abs() < 1e-15, "{order:?}");
    let nobody = Snapshot::new(1.5, &[], DOMAIN, 2.0);
    assert_eq!(OrderParameters.measure(&nobody).one_roll, 0.0);
    Ok(())
}

#[test]
fn running_means_are_those_of_the_numbers() {
    let mut mean: RunningMean = [1.0, 2.0, 6.0].into_iter().collect();
    assert_eq!((mean.count(), mean.mean(), mean.sum(), mean.variance()), (3, 3.0, 9.0, 7.0));
    assert_eq!((mean.standard_deviation(), mean.standard_error()), (7_f64.sqrt(), (7.0_f64 / 3.0).sqrt()));
    mean.extend([3.0]);
    assert_eq!((mean.count(), mean.mean()), (4, 3.0));
    let one: RunningMean = [5.0].into_iter().collect();
    assert!(one.mean() == 5.0 && one.variance().is_nan() && one.standard_error().is_nan());
    let none = RunningMean::default();
    assert!(none.mean().is_nan() && none.standard_deviation().is_nan() && none.sum() == 0.0);
    let two: RunningMean = [5.0, 7.0].into_iter().collect();
    assert_eq!((two.variance(), two.standard_error()), (2.0, 1.0));
}

#[test]
fn samples_come_at_multiples_of_their_interval() -> Outcome {
    let disks = disks()?;
    let mut series = Series::new(CenterOfMass, SampleTimes::every(0.5)?.starting_at(0.25)?);
    let mut times = Vec::new();
    for (time, next) in [(0.25, 0.75), (3.0, 3.25), (3.25, 3.75), (8.0, 8.25), (16.5, 16.75), (9.0, 16.75)] {
        series.on_sample(&Snapshot::new(time, &disks, DOMAIN, 0.0));
        assert_eq!(series.next_sample(), next);
        times.push(time);
    }
    assert_eq!(series.times(), times);
    let center = DVec2::new(2.5, 4.0);
    assert!(series.iter().eq(times.iter().map(|&time| (time, &center))));
    let mut lost = Series::new(CenterOfMass, SampleTimes::every(1e-300)?.starting_at(1.0)?);
    lost.on_sample(&Snapshot::new(1.0, &disks, DOMAIN, 0.0));
    assert!(lost.next_sample().is_nan(), "the interval is lost in rounding");
    Ok(())
}

/// A run whose samples would be missing or unevenly spaced ends with an error.
#[test]
fn times_too_coarse_for_samples_are_told() -> Outcome {
    for (start, interval, fits) in
        [(1e3, 1e-18, false), (1e15, 0.01, false), (1e15, 0.3, false), (1e15, 4.0, true)]
    {
        let disk = Disk::new(DVec2::splat(3.0), 0.5)?;
        let container = Container::closed(10.0, 10.0)?;
        let mut run = Simulation::builder(Elastic, container).disks([disk]).starting_at(start).build()?;
        let mut series = Series::new(CenterOfMass, SampleTimes::every(interval)?);
        match run.run_until(start + 8.0, &mut series) {
            Ok(_) => assert!(fits && series.times() == [start + 4.0, start + 8.0], "{start} {interval}"),
            Err(error) => assert!(!fits && error.to_string().contains("lost in the rounding"), "{error}"),
        }
    }
    Ok(())
}

/// A gas with all regimes, and the records of these observers until `END`.
fn watched(mut observers: impl Observer) -> Result<Vec<Collision>, Box<dyn std::error::Error>> {
    let container = Container::closed(8.0, 8.0)?.with_rule(Wall::Left, Elastic)?;
    let rule = ContactDuration::new(Frictional::from_inelasticity(0.05, 0.05, 0.2)?, 0.05)?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&container, 25, 0.5)?, 1.0, 2)?;
    let mut collisions = Vec::new();
    let list = on_collision(|collision: &Collision| collisions.push(*collision));
    let mut simulation = Simulation::builder(rule, container).disks(disks).gravity(0.01).build()?;
    simulation.run_until(END, &mut (&mut observers, list))?;
    Ok(collisions)
}

const END: f64 = 10.0;

#[test]
fn counts_and_energy_changes_are_those_of_the_list() -> Outcome {
    let (mut counts, mut changes) = (CollisionCounts::default(), EnergyChange::default());
    let list = watched((&mut counts, &mut changes))?;
    let number = |picked: &dyn Fn(&Collision) -> bool| list.iter().filter(|c| picked(c)).count() as u64;
    for regime in [Regime::Sticking, Regime::Sliding, Regime::ContactDuration, Regime::Unspecified] {
        assert_eq!(
            counts.collisions_in_regime(regime),
            number(&|c| c.impulse.regime() == regime),
            "{regime:?}"
        );
        assert!(counts.collisions_in_regime(regime) > 10, "{regime:?}");
    }
    let mean = |picked: &dyn Fn(Partner) -> bool| -> BlockedMean {
        list.iter().filter(|c| picked(c.partner)).map(|c| c.energy_change).collect()
    };
    assert_eq!(*changes.disks(), mean(&|partner| matches!(partner, Partner::Disk(_))));
    assert_eq!(counts.disk_collisions(), changes.disks().count());
    for (wall, name) in ["floor", "left", "right", "lid", "gate"].into_iter().enumerate() {
        assert_eq!(*changes.wall(name), mean(&|partner| partner == Partner::Wall(wall)));
        assert_eq!(counts.collisions_with_wall(name), changes.wall(name).count());
        assert_eq!(counts.collisions_with_wall(name) > 10, wall < 4, "wall {wall}");
    }
    assert_eq!(counts.disk_collisions() + counts.wall_collisions(), list.len() as u64);
    Ok(())
}

#[test]
fn layers_hold_the_collisions_and_disks_at_their_height() -> Outcome {
    let mut profile = Sampled::new(EnergyChangeProfile::new(1.0, 7.0, 3)?, SampleTimes::every(1.0)?);
    let (mut seen, times) = (Vec::new(), SampleTimes::every(1.0)?);
    let list =
        watched((&mut profile, on_sample(times, |s: &Snapshot<'_>| seen.extend_from_slice(s.disks()))))?;
    assert_eq!((seen.len(), profile.next_sample()), (250, END + 1.0));
    let (mut relative, mut ratio, mut collisions) = (0.0, 0.0, 0.0);
    for (layer, bottom) in profile.layers().iter().zip([1.0, 3.0, 5.0]) {
        assert_eq!(layer.height, bottom + 1.0);
        let inside = |height: f64| bottom <= height && height < bottom + 2.0;
        let here = list.iter().filter(|c| matches!(c.partner, Partner::Disk(_)) && inside(c.position.y));
        let change: BlockedMean = here.map(|c| c.energy_change).collect();
        let mean = |energy: fn(&Disk) -> f64| -> BlockedMean {
            seen.iter().filter(|disk| inside(disk.position().y)).map(energy).collect()
        };
        let temperatures = (mean(Disk::translational_energy), mean(|disk| 2.0 * disk.rotational_energy()));
        assert_eq!((&layer.energy_change, &layer.translational_temperature), (&change, &temperatures.0));
        assert_eq!(layer.rotational_temperature, temperatures.1);
        assert_eq!(layer.relative_energy_change(), Some(change.mean() / temperatures.0.mean()));
        relative += change.sum() / temperatures.0.mean();
        ratio += change.count() as f64 * temperatures.1.mean() / temperatures.0.mean();
        collisions += change.count() as f64;
    }
    assert!((profile.relative_energy_change().unwrap() * collisions / relative - 1.0).abs() < 1e-14);
    assert!((profile.rotational_ratio().unwrap() * collisions / ratio - 1.0).abs() < 1e-14);
    Ok(())
}

/// Counts its messages, and wants one sample.
#[derive(Default, Debug, PartialEq, Clone, Copy)]
struct Tally {
    wanted: Option<f64>,
    collisions: usize,
    samples: usize,
}

impl Observer for Tally {
    fn on_collision(&mut self, _: &Collision) {
        self.collisions += 1;
    }
    fn next_sample(&self) -> f64 {
        self.wanted.unwrap_or(f64::INFINITY)
    }
    fn on_sample(&mut self, _: &Snapshot<'_>) {
        self.samples += 1;
        self.wanted = None;
    }
}

#[test]
fn observers_made_of_others_pass_everything_on() -> Outcome {
    let tally = |wanted| Tally { wanted: Some(wanted), ..Tally::default() };
    let mut tallies = [1.0, 2.0, 3.0, 4.0, 1.0, 20.0].map(tally);
    let [boxed, listed, other, optional, bare, late] = &mut tallies;
    let boxed: Box<dyn Observer + '_> = Box::new(boxed);
    let composed = (boxed, vec![listed, other], Some(optional), bare, late, None::<Tally>);
    assert_eq!(composed.next_sample(), 1.0);
    assert_eq!((composed.1.next_sample(), composed.5.next_sample()), (2.0, f64::INFINITY));
    let collisions = watched(composed)?.len();
    let told = |tally: &Tally| (tally.collisions, tally.samples);
    assert_eq!(tallies.map(|tally| told(&tally)), [1, 1, 1, 1, 1, 0].map(|samples| (collisions, samples)));
    Ok(())
}
