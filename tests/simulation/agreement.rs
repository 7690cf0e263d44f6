//! The same inputs give the same bits: under every scheduler, whoever watches, and however a run is cut.

use granular_edmd::observable::{CollisionCounts, EnergyChange, OrderParameters, SampleTimes, Series};
use granular_edmd::scheduler::{EventScheduler, LinearScan, TournamentTree};
use proptest::prelude::*;

use crate::setups::{config, history, setup};

const DURATION: f64 = 4.0;

proptest! {
    #![proptest_config(config(60))]

    #[test]
    fn schedulers_agree(setup in setup()) {
        let end = setup.start + DURATION;
        let ours = history(setup.builder().scheduler(TournamentTree::new()).build().unwrap(), end);
        let slow = history(setup.builder().scheduler(LinearScan::default()).build().unwrap(), end);
        prop_assert_eq!(&ours, &slow);
        let boxed: Box<dyn EventScheduler> = Box::new(LinearScan::default());
        prop_assert_eq!(&ours, &history(setup.builder().scheduler(boxed).build().unwrap(), end));
    }

    #[test]
    fn watching_changes_nothing(setup in setup(), interval in 0.01..0.5f64) {
        let end = setup.start + DURATION;
        let mut alone = setup.simulation();
        alone.run_until(end, &mut ()).unwrap();
        let times = SampleTimes::every(interval).unwrap().starting_at(setup.start).unwrap();
        let mut series = Series::new(OrderParameters, times);
        let mut watched = setup.simulation();
        let mut others = (EnergyChange::default(), CollisionCounts::default());
        watched.run_until(end, &mut (&mut series, &mut others.0, &mut others.1)).unwrap();
        prop_assert_eq!(alone.disks(), watched.disks());
        prop_assert_eq!(alone.counters(), watched.counters());
        let samples = (0..).map_while(|k| Some(setup.start + f64::from(k) * interval).filter(|&t| t <= end));
        prop_assert_eq!(series.times(), samples.collect::<Vec<_>>());
        prop_assert_eq!(others.1.disk_collisions(), watched.counters().disk_collisions);
        prop_assert_eq!(others.1.wall_collisions(), watched.counters().wall_collisions);
    }

    #[test]
    fn a_run_in_pieces_is_the_run(setup in setup(), cuts in prop::collection::vec(0.0..DURATION, 0..20)) {
        let end = setup.start + DURATION;
        let mut whole = setup.simulation();
        whole.run_until(end, &mut ()).unwrap();
        let mut pieces = setup.simulation();
        let mut cuts = cuts;
        cuts.sort_by(f64::total_cmp);
        for cut in cuts {
            let stop = setup.start + cut;
            pieces.run_until(stop, &mut ()).unwrap();
            pieces.run_until(stop, &mut ()).unwrap();
        }
        pieces.run_until(end, &mut ()).unwrap();
        prop_assert_eq!(whole.disks(), pieces.disks());
        prop_assert_eq!(whole.counters(), pieces.counters());
    }
}

#[cfg(feature = "serde")]
mod resumed {
    use granular_edmd::boundary::Container;
    use granular_edmd::collision::Elastic;
    use granular_edmd::scheduler::TournamentTree;
    use granular_edmd::{Simulation, initial};

    /// The disks are so many that the engine chooses the other scheduler, and looks ahead.
    #[test]
    fn many_disks_resume_to_the_same_bits() {
        let container = Container::closed(3600.0, 60.0).unwrap();
        let disks = initial::lattice(&container, 60_000, 0.5).unwrap();
        let disks = initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap();
        let mut run =
            Simulation::builder(Elastic, container.clone()).disks(disks).gravity(0.1).build().unwrap();
        run.run_until(0.2, &mut ()).unwrap();
        let saved = run.checkpoint();
        let mut same = Simulation::resume(&saved, Elastic, container.clone()).build().unwrap();
        let mut tree = Simulation::resume(&saved, Elastic, container)
            .scheduler(TournamentTree::default())
            .build()
            .unwrap();
        run.run_until(0.6, &mut ()).unwrap();
        same.run_until(0.6, &mut ()).unwrap();
        tree.run_until(0.6, &mut ()).unwrap();
        assert!(run.counters().disk_collisions > 1000, "{:?}", run.counters());
        assert_eq!(run.disks(), same.disks());
        assert_eq!(run.disks(), tree.disks());
    }
}
