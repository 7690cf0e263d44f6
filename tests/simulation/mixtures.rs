//! Mixtures of any sizes: no meeting is missed, and layers of cells change nothing but the speed.

use granular_edmd::boundary::{Boundary, Container, Wall};
use granular_edmd::collision::{Elastic, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::scheduler::{BucketQueue, LinearScan, TournamentTree};
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Disk, Simulation, initial};
use oracles::deepest_overlap;
use proptest::prelude::*;

use crate::setups::config;

/// Radii between 0.5 and 0.5 times `ratio`, by a law with as much area in each octave, or of two sizes.
fn radii(count: usize, ratio: f64, two_sizes: bool, seed: u64) -> Vec<f64> {
    let mut state = seed | 1;
    let mut random = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut radius = |k: usize| match two_sizes {
        true if k.is_multiple_of(40) => 0.5 * ratio,
        true => 0.5,
        false => 0.5 * (1.0 - random() * (1.0 - ratio.powi(-2))).powf(-0.5),
    };
    (0..count).map(&mut radius).collect()
}

fn container(sides: u8, width: f64) -> Container {
    let base = BiParabolic::new(0.1, 10.0).unwrap();
    match sides {
        0 => Container::closed(width, width).unwrap(),
        1 => Container::open(width).unwrap().with_motion(Wall::Floor, base).unwrap(),
        2 => Container::closed(width, width).unwrap().with_periodic_sides().unwrap(),
        _ => Container::periodic(width, width).unwrap(),
    }
}

/// Places disks at random in a box of this shape, with room for them.
fn mixture(radii: &[f64], sides: u8, filling: f64, seed: u64) -> (Container, Vec<Disk>) {
    let area: f64 = radii.iter().map(|radius| std::f64::consts::PI * radius * radius).sum();
    let largest = radii.iter().copied().fold(0.0, f64::max);
    let mut width = (area / filling).sqrt().max(8.4 * largest);
    loop {
        let container = container(sides, width);
        let disks = radii.iter().map(|&radius| {
            let disk = Disk::new(DVec2::ZERO, radius).unwrap();
            disk.with_mass(4.0 * radius * radius).unwrap()
        });
        if let Ok(disks) = initial::scattered_mix(&container, disks.collect(), width, seed) {
            return (container, initial::with_maxwellian_velocities(disks, 1.0, seed).unwrap());
        }
        width *= 1.2;
    }
}

proptest! {
    #![proptest_config(config(6))]

    #[test]
    fn no_meeting_is_missed(
        ratio in prop_oneof![Just(1.5), Just(2.0), Just(3.0), Just(10.0), Just(50.0), Just(300.0), Just(1000.0)],
        two_sizes in any::<bool>(),
        sides in 0..4_u8,
        filling in 0.02..0.5,
        gravity in prop_oneof![Just(0.0), Just(0.05)],
        seed in any::<u64>(),
    ) {
        // Disks that fly out of an open container must fall back.
        let gravity = if sides == 1 { 0.05 } else { gravity };
        let radii = radii(160, ratio, two_sizes, seed);
        let (container, disks) = mixture(&radii, sides, filling, seed);
        let builder = Simulation::builder(Elastic, container.clone()).disks(disks);
        let mut run = builder.gravity(gravity).build().unwrap();
        let mut step = 1e-3;
        for _ in 0..200 {
            run.run_until(run.time() + step, &mut ()).unwrap();
            step = if run.counters().disk_collisions < 20_000 { 1.2 * step } else { step };
            let overlap = deepest_overlap(&container.domain(), &run.disks());
            prop_assert!(overlap < 1e-9, "{overlap:e} at {}", run.time());
            // A floor that moves heats a gas that loses nothing: it gets higher and higher.
            if run.counters().disk_collisions > 30_000 || run.counters().wall_collisions > 30_000 {
                break;
            }
        }
        let counters = run.counters();
        prop_assert!(counters.disk_collisions > 100, "{counters:?}");
        prop_assert!(counters.max_overlap < 1e-8 * ratio, "{counters:?}");
        prop_assert!(counters.max_wall_overlap < 1e-8 * ratio, "{counters:?}");
    }

    #[test]
    fn schedulers_have_the_same_bits(
        ratio in prop_oneof![Just(2.0), Just(10.0), Just(50.0)],
        two_sizes in any::<bool>(),
        sides in 0..4_u8,
        seed in any::<u64>(),
    ) {
        let (container, disks) = mixture(&radii(120, ratio, two_sizes, seed), sides, 0.3, seed);
        let rule = Frictional::from_inelasticity(0.02, 0.02, 0.1).unwrap();
        let builder = || Simulation::builder(rule, container.clone()).disks(disks.clone());
        let mut tree = builder().scheduler(TournamentTree::new()).build().unwrap();
        let mut queue = builder().scheduler(BucketQueue::new()).build().unwrap();
        let mut scan = builder().scheduler(LinearScan::new()).build().unwrap();
        for _ in 0..40 {
            let end = tree.time() + 1.0;
            tree.run_until(end, &mut ()).unwrap();
            queue.run_until(end, &mut ()).unwrap();
            scan.run_until(end, &mut ()).unwrap();
            prop_assert_eq!(tree.disks(), queue.disks());
            prop_assert_eq!(tree.disks(), scan.disks());
            if tree.counters().disk_collisions > 5000 {
                break;
            }
        }
    }
}

/// A disk inside another is refused, whichever is listed first.
#[test]
fn a_disk_inside_another_is_an_overlap() {
    let disk = |x: f64, radius: f64| Disk::new(DVec2::new(x, 40.0), radius).unwrap();
    for sides in [0, 2, 3] {
        for (first, second) in [(disk(40.0, 10.0), disk(41.0, 0.5)), (disk(40.0, 10.0), disk(40.5, 10.0))] {
            for disks in [[first, second, disk(5.0, 0.01)], [second, first, disk(5.0, 0.01)]] {
                let run = Simulation::builder(Elastic, container(sides, 100.0)).disks(disks).build();
                let error = run.err().map(|error| error.to_string()).unwrap_or_default();
                assert!(
                    error.starts_with("disks 0 and 1 at (4") && error.contains(", 40) overlap by "),
                    "{error}"
                );
            }
        }
    }
}

/// A run that is resumed goes on with the same bits, of whatever sizes its disks are.
#[cfg(feature = "serde")]
#[test]
fn a_resumed_mixture_has_the_same_bits() {
    for (seed, ratio) in [(1, 2.0), (2, 10.0), (3, 50.0), (4, 1000.0)] {
        for sides in 0..3 {
            let (container, disks) = mixture(&radii(120, ratio, seed % 2 == 0, seed), sides, 0.2, seed);
            let rule = Frictional::from_inelasticity(0.02, 0.02, 0.1).unwrap();
            let builder = Simulation::builder(rule, container.clone()).disks(disks).gravity(0.02);
            let mut run = builder.build().unwrap();
            let step = 20.0;
            run.run_until(step, &mut ()).unwrap();
            let checkpoint = run.checkpoint();
            let bytes =
                granular_edmd::simulation::Checkpoint::from_bytes(&checkpoint.to_bytes().unwrap()).unwrap();
            let mut resumed =
                Simulation::<Frictional, Container>::resume(&bytes, rule, container).build().unwrap();
            assert_eq!(resumed.checkpoint(), checkpoint, "{ratio} {sides}");
            run.run_until(2.0 * step, &mut ()).unwrap();
            resumed.run_until(2.0 * step, &mut ()).unwrap();
            assert_eq!(run.checkpoint(), resumed.checkpoint(), "{ratio} {sides}");
        }
    }
}
