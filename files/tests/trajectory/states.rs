//! The systems whose files are tested.

use granular_edmd::boundary::{Boundary, Container, Domain, Wall};
use granular_edmd::collision::Frictional;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::Snapshot;
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Disk, Kind, Simulation, initial};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// A vibrated box without a lid and with periodic sides, with disks of two kinds, sizes and masses.
pub(crate) fn mixture() -> Simulation<Frictional> {
    let base = BiParabolic::new(0.1, 10.0).unwrap();
    let container =
        Container::open(15.0).unwrap().with_periodic_sides().unwrap().with_motion(Wall::Floor, base).unwrap();
    let disks = initial::lattice(&container, 40, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 2.0, 5).unwrap();
    let disks = disks.into_iter().enumerate().map(|(index, disk)| {
        if index % 3 > 0 {
            return disk;
        }
        let place = disk.position();
        let small = Disk::new(place, 0.3).unwrap().with_velocity(disk.velocity()).unwrap();
        small.with_mass(0.1).unwrap().with_inertia_factor(1.0).unwrap().with_kind(Kind::new(7))
    });
    let rule = Frictional::from_inelasticity(0.02, 0.02, 0.2).unwrap();
    Simulation::builder(rule, container).disks(disks).gravity(0.3).build().unwrap()
}

/// A box of any sort, whose number decides which ends are periodic or open.
pub(crate) fn domain(sort: usize) -> Domain {
    match sort % 4 {
        0 => Container::closed(30.0, 40.0).unwrap().domain(),
        1 => Container::open(30.0).unwrap().with_periodic_sides().unwrap().domain(),
        2 => Container::periodic(30.0, 40.0).unwrap().shifted(DVec2::new(-7.1, 1.0 / 3.0)).unwrap().domain(),
        _ => Container::closed(30.0, 40.0).unwrap().with_periodic_ends().unwrap().domain(),
    }
}

/// Disks at random in a box, with numbers of all magnitudes and both signs of zero.
pub(crate) fn random_disks(seed: u64, domain: &Domain) -> Vec<Disk> {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut disks = Vec::new();
    for index in 0..100_i32 {
        let cell = DVec2::new(f64::from(index % 10), f64::from(index / 10));
        let jitter = DVec2::new(generator.random::<f64>(), generator.random::<f64>());
        let place = DVec2::new(domain.left, domain.bottom) + 3.0 * cell + 0.5 + jitter;
        let mut any = || {
            let number = generator.random_range(-1.0..1.0) * 10_f64.powi(generator.random_range(-320..60));
            if generator.random_bool(0.1) { -0.0 } else { number }
        };
        let disk = Disk::new(place, 0.1 + 0.4 * any().abs().min(1.0)).unwrap();
        let disk = disk.with_velocity(DVec2::new(any(), any())).unwrap().with_angle(any()).unwrap();
        let disk =
            disk.with_angular_velocity(any()).unwrap().with_mass(any().abs().clamp(1e-30, 1e30)).unwrap();
        let disk = disk.with_inertia_factor(generator.random_range(1e-6..1.0)).unwrap();
        let id = 3 * index.unsigned_abs() + 1;
        let disk = disk.with_id(id.into()).unwrap();
        disks.push(disk.with_kind(Kind::new((index % 5) as u16)).with_image([index, -3 * index]));
    }
    disks
}

/// Runs a test with snapshots of boxes of all sorts, with a hundred disks and without any.
pub(crate) fn for_each_snapshot(mut test: impl FnMut(&Snapshot<'_>)) {
    for sort in 0..12 {
        let domain = domain(sort);
        let disks = random_disks(sort as u64, &domain);
        let disks = if sort < 8 { disks.as_slice() } else { &[] };
        test(&Snapshot::new(0.1 * sort as f64 + 1e-9, disks, domain, 0.1));
    }
}

/// Checks that two lists of disks are the same, to the bit, since `==` does not distinguish the two zeros.
#[track_caller]
pub(crate) fn assert_same_bits(read: &[Disk], written: &[Disk]) {
    let bits = |disk: &Disk| {
        let (position, velocity) = (disk.position(), disk.velocity());
        let motion = [position.x, position.y, velocity.x, velocity.y, disk.angle(), disk.angular_velocity()];
        let body = [disk.radius(), disk.mass(), disk.inertia_factor()];
        (
            [motion.as_slice(), &body].concat().iter().map(|n| n.to_bits()).collect::<Vec<_>>(),
            disk.kind(),
            disk.image(),
        )
    };
    assert_eq!(read.len(), written.len());
    for (read, written) in read.iter().zip(written) {
        assert_eq!(bits(read), bits(written), "{read:?} {written:?}");
    }
}
