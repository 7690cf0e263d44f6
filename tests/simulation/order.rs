//! The order in which disks are listed changes their names, and nothing else.

use granular_edmd::boundary::{Container, Wall};
use granular_edmd::collision::{ContactDuration, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Partner;
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Disk, Simulation, initial};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::setups::Log;

/// Disks from tiny to large, of any masses.
fn disks(container: &Container, seed: u64) -> Vec<Disk> {
    let radius = |k: usize| [0.5, 0.02, 0.25, 0.9, 0.1][k % 5];
    let disk =
        |k| Disk::new(DVec2::ZERO, radius(k)).and_then(|d| d.with_mass(4.0 * radius(k) * radius(k))).unwrap();
    let disks = initial::scattered_mix(container, (0..24).map(disk).collect(), 14.0, seed).unwrap();
    initial::with_maxwellian_velocities(disks, 1.0, seed).unwrap()
}

fn container() -> Container {
    let base = BiParabolic::new(0.1, 10.0).unwrap();
    Container::closed(14.0, 14.0).unwrap().with_motion(Wall::Floor, base).unwrap()
}

/// The bits of a collision's time, its partners, and the bits of its impulse.
type Told = (u64, [usize; 2], u64);

/// Returns every collision by the first names of the disks, and the disks after it in their first order.
fn history(disks: &[Disk], order: &[usize], end: f64) -> (Vec<Told>, Vec<Disk>) {
    let rule = ContactDuration::new(Frictional::from_inelasticity(0.05, 0.05, 0.2).unwrap(), 1e-5).unwrap();
    let listed = order.iter().map(|&disk| disks[disk]);
    let builder = Simulation::builder(rule, container()).disks(listed).gravity(0.1);
    let mut run = builder.build().unwrap();
    let mut log = Log(Vec::new());
    run.run_until(end, &mut log).unwrap();
    let told = log.0.iter().map(|collision| {
        let names = match collision.partner {
            Partner::Disk(partner) => {
                let (one, other) = (order[collision.disk], order[partner]);
                [one.min(other), one.max(other)]
            }
            Partner::Wall(wall) => [order[collision.disk], 1000 + wall],
        };
        (collision.time.to_bits(), names, collision.energy_change.to_bits())
    });
    let mut after = disks.to_vec();
    for (listed, &disk) in run.disks().iter().zip(order) {
        after[disk] = listed.with_id(0).unwrap();
    }
    (told.collect(), after)
}

#[test]
fn the_order_of_the_list_changes_no_bit() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(8);
    for seed in 0..20 {
        let disks = disks(&container(), seed);
        let mut order: Vec<usize> = (0..disks.len()).collect();
        // The time is so short that rounding in collisions, whose partners change sides, has not grown.
        let (expected, after) = history(&disks, &order, 0.7);
        assert!(expected.len() > 5);
        for _ in 0..5 {
            for k in (1..order.len()).rev() {
                order.swap(k, random.random_range(0..=k));
            }
            let (told, disks) = history(&disks, &order, 0.7);
            let names = |told: &[(u64, [usize; 2], u64)]| told.iter().map(|told| told.1).collect::<Vec<_>>();
            assert_eq!(names(&told), names(&expected), "{seed}");
            assert_eq!(told, expected, "{seed}");
            assert_eq!(disks, after, "{seed}");
        }
    }
}
