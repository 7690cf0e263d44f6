//! Dense packings at random.

use std::f64::consts::PI;

use granular_edmd::boundary::{Boundary, Container, Wall};
use granular_edmd::glam::DVec2;
use granular_edmd::initial::{self, PlacementError, Radii};
use granular_edmd::wall::{BiParabolic, Piston};
use granular_edmd::{Disk, Kind};

use super::{assert_apart, assert_same_disks, disks};

fn area(disks: &[Disk]) -> f64 {
    disks.iter().map(|disk| PI * disk.radius() * disk.radius()).sum()
}

/// Two sizes, 1 : 1.4, half and half.
fn two_sizes(count: usize) -> Vec<Disk> {
    disks(Radii::two_sizes(0.5, 0.7, 0.5).unwrap().draw(count, 1))
}

/// Between walls and without walls, up to the fraction of a dense fluid and beyond.
#[test]
fn fractions_are_reached() {
    for (mix, fraction) in [(disks([0.5; 400]), 0.70), (disks([0.5; 400]), 0.80), (two_sizes(400), 0.80)] {
        let width = (area(&mix) / fraction).sqrt();
        let closed = Container::closed(width, width).unwrap();
        let periodic = Container::periodic(width, width).unwrap();
        for container in [closed.clone(), closed.with_periodic_sides().unwrap(), periodic] {
            let packed = initial::packed_mix(&container, mix.clone(), width, 7).unwrap();
            assert_same_disks(&packed, &mix);
            assert_apart(container, &packed);
        }
    }
}

/// In an open container the lid is where the caller puts it. A base that moves keeps its room.
#[test]
fn an_open_container_is_filled_up_to_a_height() {
    let base = BiParabolic::new(0.1, 10.0).unwrap();
    let container = Container::open(15.0).unwrap().with_motion(Wall::Floor, base).unwrap();
    let mix = two_sizes(250);
    let height = 0.1 + area(&mix) / (0.78 * 15.0);
    let packed = initial::packed_mix(&container, mix, height, 3).unwrap();
    assert!(packed.iter().all(|disk| disk.position().y + disk.radius() <= height));
    assert!(packed.iter().all(|disk| disk.position().y - disk.radius() >= 0.1));
    assert_apart(container, &packed);
}

/// A lid below periodic ends makes an end of them: nothing reaches through the floor.
#[test]
fn periodic_ends_have_an_end_below_a_lid() {
    let container = Container::periodic(10.0, 30.0).unwrap();
    let mix = two_sizes(100);
    let height = area(&mix) / (0.75 * 10.0);
    let packed = initial::packed_mix(&container, mix, height, 3).unwrap();
    assert!(packed.iter().all(|disk| disk.position().y >= disk.radius()));
    assert!(packed.iter().all(|disk| disk.position().y + disk.radius() <= height));
    assert_apart(container, &packed);
}

#[test]
fn a_seed_decides_every_bit() {
    let container = Container::closed(12.0, 12.0).unwrap();
    let packed = |seed| initial::packed_mix(&container, two_sizes(96), 12.0, seed).unwrap();
    assert_eq!(packed(1), packed(1));
    assert_ne!(packed(1), packed(2));
}

/// The dynamics in between must not leak into what the caller gets back.
#[test]
fn disks_keep_what_they_are() {
    let disk = |index: usize| {
        let radius = [0.3, 0.5, 0.9][index % 3];
        let disk = Disk::new(DVec2::ZERO, radius).unwrap().with_mass(1.0 + index as f64).unwrap();
        disk.with_velocity(DVec2::new(0.1, index as f64)).unwrap().with_kind(Kind::new(index as u16))
    };
    let given: Vec<Disk> = (0..60).map(disk).collect();
    let width = (area(&given) / 0.75).sqrt();
    let container = Container::closed(width, width).unwrap();
    let packed = initial::packed_mix(&container, given.clone(), width, 1).unwrap();
    assert_same_disks(&packed, &given);
    assert_apart(container, &packed);
}

/// The intruder is an obstacle while the others are packed, and one of the disks afterwards.
#[test]
fn an_intruder_stays_where_it_is() {
    let container = Container::closed(20.0, 20.0).unwrap();
    let intruder = Disk::new(DVec2::new(7.0, 4.0), 4.0).unwrap();
    let count = (0.8 * (400.0 - area(&[intruder])) / area(&disks([0.5]))) as usize;
    let around = container.clone().with_pegs([intruder]).unwrap();
    let mut packed = initial::packed_mix(&around, disks(vec![0.5; count]), 20.0, 1).unwrap();
    packed.push(intruder);
    assert_apart(container, &packed);
}

/// A piston that falls would reach the disks while they are packed.
#[test]
fn pistons_that_move_are_added_afterwards() {
    let piston = Piston::new(2.0, [0.0, 25.0]).unwrap().with_start(10.0, 0.0).unwrap();
    let packed = |piston: Piston| {
        let container = Container::closed(16.0, 40.0).unwrap().with_piston(Wall::Lid, piston).unwrap();
        initial::packed_mix(&container, disks(vec![0.5; 400]), 40.0, 1)
    };
    assert_eq!(packed(piston).unwrap().len(), 400);
    let error = packed(piston.with_force(40.0).unwrap()).unwrap_err().to_string();
    let expected = "displacement of the wall \"lid\" in a unit of time must be 0 while disks are packed (add the piston \
                    afterwards), but is 10";
    assert_eq!(error, expected);
}

/// A wide mixture: the largest is 40 times as large as the smallest.
#[test]
fn wide_mixtures_are_packed() {
    let mix = disks(Radii::power_law(2.0, 0.1, 4.0).unwrap().draw(400, 3));
    let width = (area(&mix) / 0.8).sqrt();
    let container = Container::closed(width, width).unwrap();
    let packed = initial::packed_mix(&container, mix, width, 5).unwrap();
    assert_apart(container, &packed);
}

/// Those that the program finds near a place are all that are near, for any mix of radii and across any side.
#[test]
fn mixtures_are_placed_apart() {
    let mix = disks(Radii::power_law(2.0, 0.1, 0.8).unwrap().draw(120, 5));
    let walled = Container::closed(12.0, 11.0).unwrap();
    let periodic = Container::periodic(12.0, 11.0).unwrap();
    for container in [walled.clone(), walled.with_periodic_sides().unwrap(), periodic] {
        for seed in 0..8 {
            let placed = initial::scattered_mix(&container, mix.clone(), 11.0, seed).unwrap();
            assert_apart(container.clone(), &placed);
        }
    }
}

/// Lengths are in any unit.
#[test]
fn scales_do_not_matter() {
    for unit in [1e-9, 1.0, 1e9] {
        let mix = disks(vec![0.5 * unit; 80]);
        let width = (area(&mix) / 0.7).sqrt();
        let container = Container::closed(width, width).unwrap();
        assert_apart(container.clone(), &initial::packed_mix(&container, mix, width, 1).unwrap());
    }
}

/// Equal disks cover 0.9069 at most. The error tells how far they came: as far as random packings do.
#[test]
fn what_jams_is_told() {
    let container = Container::closed(12.0, 12.0).unwrap();
    let count = (0.92 * 144.0 / area(&disks([0.5]))) as usize;
    let error = initial::packed_mix(&container, disks(vec![0.5; count]), 12.0, 1).unwrap_err();
    let PlacementError::Jammed { reached, wanted } = error else { panic!("{error}") };
    assert!((0.75..0.9).contains(&reached) && (wanted - 0.92).abs() < 0.01, "{reached} of {wanted}");
    assert!(error.to_string().starts_with(&format!("the disks jam at the area fraction {reached:.4}")));
}

/// Rooms in which nothing can be placed, or hardly anything.
#[test]
fn odd_rooms_are_refused_or_filled() {
    let container = Container::closed(10.0, 10.0).unwrap();
    let packed = |radius: f64, below: f64| initial::packed_mix(&container, disks([radius]), below, 1);
    for below in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(packed(0.5, below), Err(PlacementError::Parameter(_))), "{below}");
    }
    assert!(matches!(packed(0.5, 0.5), Err(PlacementError::Jammed { .. })));
    // More than the whole room is refused before anything is tried.
    assert!(matches!(packed(6.0, 10.0), Err(PlacementError::Parameter(_))));
    assert_apart(container.clone(), &packed(4.9, 10.0).unwrap());
    assert_eq!(initial::packed_mix(&container, vec![], 10.0, 1), Ok(vec![]));
    let narrow = Container::closed(4.0, 50.0).unwrap().with_periodic_sides().unwrap();
    assert!(narrow.interior().periodic_sides);
    let few = initial::packed_mix(&narrow, disks([0.45; 80]), 50.0, 1);
    assert_apart(narrow, &few.unwrap());
}

/// A height counts from where the boundary is, which may lie below zero.
#[test]
fn rooms_below_zero_are_filled() {
    let container = Container::open(10.0).unwrap().shifted(DVec2::new(3.0, -20.0)).unwrap();
    for place in [initial::packed_mix, initial::scattered_mix] {
        let placed = place(&container, disks([0.5; 40]), -12.0, 1).unwrap();
        assert!(placed.iter().all(|disk| disk.position().y <= -12.5 && disk.position().y >= -19.5));
        let error = place(&container, disks([0.5; 40]), -20.0, 1).unwrap_err().to_string();
        assert_eq!(error, "height must be finite and above the bottom of the interior, but is -20");
    }
}

/// Disks that no packing can hold are refused before any is placed, and so is a disk that is larger than
/// its room.
#[test]
fn what_has_no_room_is_refused_at_once() {
    let container = Container::closed(10.0, 10.0).unwrap();
    let disks = vec![Disk::new(DVec2::ZERO, 0.5).unwrap(); 100_000];
    let error = initial::packed_mix(&container, disks, 10.0, 1).unwrap_err().to_string();
    assert!(error.starts_with("area fraction of the disks must be less than 1"), "{error}");
    let place = |container: &Container, radius: f64, below: f64| {
        initial::scattered_mix(container, vec![Disk::new(DVec2::ZERO, radius).unwrap()], below, 1)
    };
    let periodic = Container::periodic(10.0, 10.0).unwrap();
    assert!(place(&container, 0.5, 0.9).is_err() && place(&container, 0.5, 1.0).is_ok());
    assert!(place(&periodic, 1.25, 10.0).is_err() && place(&periodic, 1.2, 10.0).is_ok());
    for seed in 0..20 {
        let disks = vec![Disk::new(DVec2::ZERO, 0.5).unwrap(); 10];
        let disks = initial::scattered_mix(&periodic, disks, 5.0, seed).unwrap();
        assert!(disks.iter().all(|disk| (0.5..=4.5).contains(&disk.position().y)));
    }
}
