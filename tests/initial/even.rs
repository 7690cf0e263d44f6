//! A lattice over the whole interior.

use std::f64::consts::PI;

use granular_edmd::boundary::{Container, Part};
use granular_edmd::glam::DVec2;
use granular_edmd::initial;

use super::assert_apart;

#[test]
fn a_periodic_box_is_filled_evenly_at_any_area_fraction() {
    for (fraction, count) in [(0.01, 500), (0.1, 10_000), (0.3, 1000), (0.65, 1000), (0.77, 400)] {
        let side = (f64::from(count) * 0.25 * PI / fraction).sqrt();
        let container = Container::periodic(side, side).unwrap();
        let disks = initial::even_lattice(&container, count as usize, 0.5).unwrap();
        assert_eq!(disks.len(), count as usize);
        // A quarter of the disks is in each quarter, but for a row or a column of them. No row is in the
        // middle.
        let line = f64::from(count).sqrt() + 2.0;
        for quarter in 0..4u32 {
            let is_in = |place: DVec2| {
                u32::from(place.x > 0.49 * side) + 2 * u32::from(place.y > 0.49 * side) == quarter
            };
            let found = disks.iter().filter(|disk| is_in(disk.position())).count();
            assert!((found as f64 - 0.25 * f64::from(count)).abs() < line, "{fraction}: {found} of {count}");
        }
        if count < 2000 {
            assert_apart(container, &disks);
        }
    }
}

#[test]
fn walls_inside_are_left_free_and_what_cannot_be_is_named() {
    let vessel = Container::around([("drum", Part::drum(DVec2::ZERO, 12.0).unwrap())]).unwrap();
    let disks = initial::even_lattice(&vessel, 200, 0.5).unwrap();
    assert_eq!(disks.len(), 200);
    assert_apart(vessel, &disks);
    let error = |container: &Container| initial::even_lattice(container, 200, 0.5).unwrap_err().to_string();
    assert!(error(&Container::open(5.0).unwrap()).starts_with("top of the interior must be finite"));
    assert!(error(&Container::closed(5.0, 5.0).unwrap()).starts_with("there is room for 16 of 200 disks"));
    assert!(initial::even_lattice(&Container::open(5.0).unwrap(), 1, 0.0).is_err());
    assert!(initial::even_lattice(&Container::closed(5.0, 5.0).unwrap(), 0, 0.5).unwrap().is_empty());
}

/// A single row of disks, or a single column, is in the middle of its box.
#[test]
fn a_shallow_box_is_filled_in_the_middle() {
    for (width, height) in [(100.0, 3.2), (3.2, 100.0)] {
        let container = Container::closed(width, height).unwrap();
        let disks = initial::even_lattice(&container, 38, 0.3).unwrap();
        let across = |place: DVec2| if width > height { place.y } else { place.x };
        assert!(disks.iter().all(|disk| (across(disk.position()) - 1.6).abs() < 1e-12));
        assert_apart(container, &disks);
    }
}
