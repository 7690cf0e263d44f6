//! Disks that come and go between runs.

use granular_edmd::boundary::{Boundary, Container};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::BuildError;
#[cfg(feature = "serde")]
use granular_edmd::simulation::Checkpoint;
use granular_edmd::{Disk, Kind, Simulation};
#[cfg(feature = "serde")]
use granular_edmd_files::{Reader, State};
use proptest::prelude::*;

use crate::setups::{Rule, Setup, config, elastic_gas, setup};
use support::schedulers::{SCHEDULERS, Scheduler};

type Run = Simulation<Rule, Container, Scheduler>;

/// Returns a simulation of a set-up under a scheduler.
fn run(setup: &Setup, scheduler: usize) -> Run {
    setup.builder().scheduler(SCHEDULERS[scheduler]()).build().unwrap()
}

/// Returns the same run, written to bytes and resumed under the next scheduler.
#[cfg(feature = "serde")]
fn through_bytes(run: &Run, setup: &Setup, scheduler: usize) -> Run {
    let checkpoint = Checkpoint::from_bytes(&run.checkpoint().to_bytes().unwrap()).unwrap();
    let resumption = Simulation::resume(&checkpoint, setup.rule(), setup.boundary());
    resumption.scheduler(SCHEDULERS[scheduler]()).build().unwrap()
}

/// Takes out every third disk and those above the middle, and puts some of them in again where there is room,
/// one of them smaller, faster and of another kind.
fn change(run: &mut Run) {
    let removed = run.remove(|index, disk| index % 3 == 0 || disk.position().y > 10.0).unwrap();
    for (k, disk) in removed.iter().enumerate().filter(|(k, _)| k % 2 == 0) {
        let disk = if k % 4 == 0 {
            let small = Disk::new(disk.position(), 0.3 * disk.radius()).unwrap();
            small.with_kind(Kind::new(3)).with_velocity(10.0 * disk.velocity()).unwrap()
        } else {
            *disk
        };
        let count = run.len();
        assert_eq!(run.insert([disk]).unwrap(), count..count + 1);
    }
}

#[cfg(feature = "serde")]
proptest! {
    #![proptest_config(config(40))]

    #[test]
    fn the_bits_are_those_of_every_scheduler_and_checkpoint(setup in setup(), cut in 0.0..2.0f64) {
        let (first, last) = (setup.start + cut, setup.start + 3.0);
        let mut whole = run(&setup, 0);
        whole.run_until(first, &mut ()).unwrap();
        change(&mut whole);
        whole.run_until(last, &mut ()).unwrap();
        for scheduler in 0..SCHEDULERS.len() {
            let mut cut = run(&setup, scheduler);
            cut.run_until(first, &mut ()).unwrap();
            let mut cut = through_bytes(&cut, &setup, scheduler);
            change(&mut cut);
            let mut cut = through_bytes(&cut, &setup, (scheduler + 1) % SCHEDULERS.len());
            cut.run_until(last, &mut ()).unwrap();
            prop_assert_eq!(cut.disks(), whole.disks());
            prop_assert_eq!(cut.counters(), whole.counters());
        }
    }
}

proptest! {
    #![proptest_config(config(40))]

    /// The state is that of a simulation built of the same disks, up to rounding.
    #[test]
    fn a_changed_simulation_is_that_of_its_disks(setup in setup(), cut in 0.0..2.0f64) {
        let mut changed = run(&setup, 0);
        changed.run_until(setup.start + cut, &mut ()).unwrap();
        let before = changed.disks();
        change(&mut changed);
        let now = changed.disks();
        // Those that stay are where they were.
        let stay = before.iter().enumerate().filter(|(k, disk)| k % 3 != 0 && disk.position().y <= 10.0);
        for ((_, before), now) in stay.zip(&now) {
            prop_assert!((before.position() - now.position()).length() < 1e-11);
            prop_assert!((before.velocity() - now.velocity()).length() < 1e-11);
            prop_assert_eq!((before.radius(), before.mass(), before.kind()), (now.radius(), now.mass(), now.kind()));
        }
        changed.run_until(setup.start + cut + 0.05, &mut ()).unwrap();
        let depth = changed.counters().max_overlap;
        prop_assert!(depth < 1e-8, "{depth}");
    }
}

#[test]
fn a_disk_that_does_not_fit_is_refused_and_changes_nothing() {
    let mut run = elastic_gas(20, 12.0, 12.0, 0.1);
    run.run_until(3.0, &mut ()).unwrap();
    let before = run.disks();
    let there = run.disk(4).unwrap().with_id(0).unwrap();
    let domain = run.boundary().domain();
    let at = |x: f64, y: f64| Disk::new(DVec2::new(x, y), 0.5).unwrap();
    assert!(matches!(run.insert([there]), Err(BuildError::Overlap { first: 4, second: 20, .. })));
    let outside = run.insert([at(domain.right + 5.0, 1.0)]);
    assert!(matches!(outside, Err(BuildError::Outside { disk: 20, .. })));
    let wall = run.insert([at(domain.left, 5.0)]);
    assert!(matches!(wall, Err(BuildError::OverlapsWall { disk: 20, .. })), "{wall:?}");
    assert_eq!(run.disks(), before);
    assert_eq!(run.insert([]).unwrap(), 20..20);
}

#[test]
fn all_disks_may_go_and_others_come() {
    let mut run = elastic_gas(20, 12.0, 12.0, 0.1);
    run.run_until(3.0, &mut ()).unwrap();
    assert_eq!(run.remove(|_, _| true).unwrap().len(), 20);
    assert!(run.is_empty());
    run.run_until(4.0, &mut ()).unwrap();
    let ball = Disk::new(DVec2::new(2.0, 2.0), 0.1).unwrap().with_velocity(DVec2::X).unwrap();
    assert_eq!(run.insert([ball]).unwrap(), 0..1);
    run.run_until(4.5, &mut ()).unwrap();
    let place = run.disk(0).unwrap().position();
    assert!((place - DVec2::new(2.5, 1.9875)).length() < 1e-12, "{place}");
}

/// A disk that falls from the top each second has the flight of one that was there from the beginning.
#[test]
fn a_disk_put_in_late_falls_like_any_other() {
    let ball = |y: f64| Disk::new(DVec2::new(2.0, y), 0.5).unwrap();
    let container = Container::open(4.0).unwrap();
    let mut run = Simulation::builder(Elastic, container).disks([ball(1e3)]).gravity(1.0).build().unwrap();
    for second in 1..20 {
        run.run_until(f64::from(second), &mut ()).unwrap();
        let top = run.insert([ball(2e3).with_angular_velocity(0.5).unwrap()]).unwrap().start;
        run.run_until(f64::from(second) + 0.5, &mut ()).unwrap();
        assert!((run.disk(top).unwrap().position().y - (2e3 - 0.125)).abs() < 1e-9);
        assert_eq!(run.remove(|index, _| index == top).unwrap().len(), 1);
    }
}

/// Ids stay with their disks through removal, insertion, checkpoints and files, and none is given twice.
#[cfg(feature = "serde")]
#[test]
fn ids_stay_with_their_disks() -> Result<(), Box<dyn std::error::Error>> {
    let ids = |disks: &[Disk]| disks.iter().map(Disk::id).collect::<Vec<_>>();
    let at = |x: f64| Disk::new(DVec2::new(x, 1.0), 0.4);
    let box_of = || Container::closed(10.0, 2.0);
    let disks = (1..8).map(|x| at(f64::from(x))).collect::<Result<Vec<_>, _>>()?;
    let mut run = Simulation::builder(Elastic, box_of()?).disks(disks).build()?;
    assert_eq!(ids(&run.disks()), [1, 2, 3, 4, 5, 6, 7]);
    let gone = run.remove(|index, _| index == 1 || index == 6)?;
    assert_eq!((ids(&gone), ids(&run.disks())), (vec![2, 7], vec![1, 3, 4, 5, 6]));

    let mut run = Simulation::resume(&run.checkpoint(), Elastic, box_of()?).build()?;
    run.insert([at(7.0)?, gone[0]])?;
    assert_eq!(ids(&run.disks()), [1, 3, 4, 5, 6, 8, 2]);
    assert_eq!((run.index_of(8), run.index_of(7)), (Some(5), None));

    let copy = run.disks()[2].with_position(DVec2::new(9.0, 1.0))?;
    assert!(matches!(run.insert([copy]), Err(BuildError::SameId { id: 4, first: 2, second: 7 })));
    run.insert([copy.with_id(0)?])?;
    assert_eq!(run.disks()[7].id(), 9);

    let mut table = Vec::new();
    State::of(&run.snapshot()).write_csv(&mut table)?;
    // A table is read in its order, whatever the ids.
    let read = Reader::new().read_from(table.as_slice())?;
    assert_eq!(ids(read.disks()), [1, 3, 4, 5, 6, 8, 2, 9]);
    let mut second = Simulation::builder(Elastic, box_of()?).disks(read.into_disks()).build()?;
    second.remove(|_, _| true)?;
    second.insert([at(1.0)?])?;
    assert_eq!(second.disks()[0].id(), 10);
    assert!(at(1.0)?.with_id(u64::MAX).is_err());
    Ok(())
}

#[test]
fn ids_above_the_largest_are_not_given() {
    let at = |x: f64| Disk::new(DVec2::new(x, 1.0), 0.5).unwrap();
    let last = at(1.0).with_id((1 << 53) - 1).unwrap();
    let refused = |error: BuildError| {
        assert_eq!(
            error.to_string(),
            "largest id so far must be so small that new disks get one of at most 2^53, but is 9.007199254740991e15"
        );
    };
    let container = || Container::closed(9.0, 9.0).unwrap();
    let build = |disks: Vec<Disk>| Simulation::builder(Elastic, container()).disks(disks).build();
    refused(build(vec![last, at(3.0), at(5.0)]).unwrap_err());
    let mut run = build(vec![last]).unwrap();
    refused(run.insert([at(3.0), at(5.0)]).unwrap_err());
    run.insert([at(3.0)]).unwrap();
    assert_eq!(run.disk(1).unwrap().id(), 1 << 53);
    // The id of a disk that was removed is not given again.
    run.remove(|index, _| index == 1).unwrap();
    assert!(run.insert([at(3.0)]).is_err());
}
