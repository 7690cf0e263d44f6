//! Disks of any sizes in rows.

use granular_edmd::boundary::{Boundary, Container, Part, Probe};
use granular_edmd::glam::DVec2;
use granular_edmd::initial::{self, PlacementError, Radii};
use granular_edmd::{Disk, Kind};

use super::{assert_apart, assert_same_disks, disks};

#[test]
fn mixtures_of_all_kinds_stand_apart_in_order() {
    let mixes = [
        Radii::uniform(0.2, 1.0).unwrap(),
        Radii::two_sizes(0.2, 2.0, 0.05).unwrap(),
        Radii::power_law(2.5, 0.1, 2.0).unwrap(),
    ];
    for radii in mixes {
        let mix = disks(radii.draw(500, 1));
        let (closed, open) = (Container::closed(40.0, 60.0).unwrap(), Container::open(40.0).unwrap());
        let periodic = Container::periodic(40.0, 60.0).unwrap();
        for container in [closed.clone(), open.clone(), closed.with_periodic_sides().unwrap(), periodic] {
            let placed = initial::placed_in_rows(&container, mix.clone()).unwrap();
            assert_same_disks(&placed, &mix);
            assert_apart(container, &placed);
        }
    }
}

/// One large disk among small ones: if each had a cell of the large one's size, a tenth of them would fit.
#[test]
fn small_disks_do_not_waste_room() {
    let mut radii = vec![0.5; 2000];
    radii[700] = 5.0;
    let container = Container::closed(60.0, 60.0).unwrap();
    let placed = initial::placed_in_rows(&container, disks(radii)).unwrap();
    assert_apart(container, &placed);
}

#[test]
fn equal_disks_stand_on_a_lattice() {
    let container = Container::open(10.0).unwrap();
    let placed = initial::placed_in_rows(&container, disks([0.5; 21])).unwrap();
    for (index, disk) in placed.iter().enumerate() {
        let site = 1.4 * DVec2::new((index % 7) as f64 + 0.5, (index / 7) as f64 + 0.5);
        assert!(disk.position().distance(site) < 1e-12, "{index}: {disk:?}");
    }
}

/// At periodic ends the last row is the neighbor of the first, so one row less fits.
#[test]
fn periodic_ends_are_full_without_a_row_at_the_top() {
    let container = Container::periodic(10.1, 10.1).unwrap();
    for placed in [
        initial::lattice(&container, 100, 0.5).unwrap(),
        initial::placed_in_rows(&container, disks([0.5; 100])).unwrap(),
    ] {
        assert_apart(container.clone(), &placed);
    }
    assert!(initial::lattice(&container, 101, 0.5).is_err());
    assert!(initial::placed_in_rows(&container, disks([0.5; 101])).is_err());
}

/// Around an intruder on the floor, and a peg in the middle, by all that place disks.
#[test]
fn obstacles_are_left_out() {
    let container = Container::closed(60.0, 150.0).unwrap();
    let intruder = Disk::new(DVec2::new(30.0, 20.0), 20.0).unwrap();
    let peg = Disk::new(DVec2::new(5.0, 50.0), 2.0).unwrap();
    let around = container.clone().with_pegs([intruder, peg]).unwrap();
    let mix = disks(Radii::uniform(0.3, 0.7).unwrap().draw(1000, 2));
    for mut placed in [
        initial::lattice(&around, 1000, 0.5).unwrap(),
        initial::scattered(&around, 1000, 0.5, 80.0, 1).unwrap(),
        initial::scattered_mix(&around, mix.clone(), 80.0, 1).unwrap(),
        initial::placed_in_rows(&around, mix).unwrap(),
    ] {
        placed.extend([intruder, peg]);
        assert_apart(container.clone(), &placed);
    }
}

#[test]
fn what_has_no_room_is_told() {
    let container = Container::closed(10.0, 10.0).unwrap();
    let placed = |radii: &[f64]| initial::placed_in_rows(&container, disks(radii.iter().copied()));
    assert_eq!(
        placed(&[0.5, 6.0]),
        Err(PlacementError::NoRoom { count: 2, placed: 1, radius: 6.0, interior: container.interior() })
    );
    assert!(matches!(placed(&[0.5; 200]), Err(PlacementError::NoRoom { count: 200, .. })));
    assert_eq!(placed(&[]), Ok(vec![]));
}

/// Walls that are there for one kind only keep disks of this kind out.
#[test]
fn disks_stand_and_are_packed_where_their_kind_may_be() {
    let kind = Kind::new(1);
    let corners = [(3.0, 2.0), (9.0, 2.0), (9.0, 7.0), (3.0, 7.0)].map(DVec2::from);
    let block = Part::block(corners).unwrap().only_for([kind]);
    let vessel = Container::closed(12.0, 14.0).unwrap().with_part("block", block).unwrap();
    let disks: Vec<Disk> = disks(vec![0.5; 40]).into_iter().map(|disk| disk.with_kind(kind)).collect();
    let placed = [
        initial::placed_in_rows(&vessel, disks.clone()).unwrap(),
        initial::scattered_mix(&vessel, disks.clone(), 14.0, 1).unwrap(),
        initial::packed_mix(&vessel, disks, 14.0, 1).unwrap(),
    ];
    for disk in placed.iter().flatten() {
        assert!(vessel.overlap(&Probe::of(disk, 0.0)).is_none(), "{disk:?}");
    }
}

/// A line that takes out centers is in the way of a packing, and is named.
#[test]
fn a_packing_names_a_sink_among_the_disks() {
    let exit = Part::polyline([(0.0, 3.0), (10.0, 3.0)].map(DVec2::from)).unwrap().absorbing_centers();
    let silo = Container::closed(10.0, 20.0).unwrap().with_part("exit", exit).unwrap();
    let refused = initial::packed_mix(&silo, disks(vec![0.5; 100]), 20.0, 1).unwrap_err();
    assert!(refused.to_string().contains("sink \"exit\""), "{refused}");
}
