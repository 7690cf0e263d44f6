//! Random positions of disks of several sizes, and triangular lattices.

use granular_edmd::boundary::{Boundary, Container};
use granular_edmd::initial::{self, PlacementError};

use super::{assert_apart, assert_same_disks, disks};

#[test]
fn the_order_of_a_mix_does_not_matter() {
    let container = Container::closed(30.0, 30.0).unwrap();
    let mut mix = disks(std::iter::repeat_n(0.5, 100).chain([4.0]));
    for _ in 0..2 {
        let placed = initial::scattered_mix(&container, mix.clone(), 30.0, 1).unwrap();
        assert_same_disks(&placed, &mix);
        assert_apart(container.clone(), &placed);
        mix.reverse();
    }
}

#[test]
fn a_lack_of_room_is_told_by_size() {
    let container = Container::closed(30.0, 30.0).unwrap();
    let mix = disks(std::iter::repeat_n(0.5, 2000).chain([4.0; 3]));
    let error = initial::scattered_mix(&container, mix, 30.0, 1).unwrap_err();
    let PlacementError::NoPosition { count: 2000, placed, radius: 0.5, .. } = error else {
        panic!("{error:?}");
    };
    assert!((300..900).contains(&placed), "{placed}");
    assert!(error.to_string().contains("of 2000 disks of radius 0.5 in"), "{error}");
    assert!(error.to_string().contains("`initial::packed_mix`"), "{error}");
}

/// In the bulk, each site has six neighbors at the smallest distance.
#[test]
fn triangular_lattices_have_six_neighbors() {
    for container in [
        Container::closed(20.0, 20.0).unwrap(),
        Container::periodic(20.0, 20.3).unwrap(),
        Container::open(21.0).unwrap().with_periodic_sides().unwrap(),
    ] {
        let domain = container.domain();
        let placed = initial::triangular_lattice(&container, 300, 0.5).unwrap();
        assert_apart(container, &placed);
        let middle = placed.iter().find(|disk| disk.position().distance((10.0, 8.0).into()) < 1.0).unwrap();
        let apart = |other: &&granular_edmd::Disk| {
            let distance = domain.separation(middle.position(), other.position()).length();
            distance > 0.0 && distance < 1.5
        };
        assert_eq!(placed.iter().filter(apart).count(), 6);
    }
    // More than a square lattice holds.
    assert!(initial::lattice(&Container::closed(20.0, 20.0).unwrap(), 400, 0.5).is_err());
    assert!(initial::triangular_lattice(&Container::closed(20.0, 20.0).unwrap(), 400, 0.5).is_ok());
}
