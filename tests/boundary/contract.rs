//! Containers keep the contract of a boundary: walls at rest and moving, periodic sides, an open top, thermal
//! walls.

use granular_edmd::boundary::{Boundary, Container, Thermal, Wall, laws};
use granular_edmd::wall::{BiParabolic, Fixed, Sawtooth, Sinusoidal, Triangular, WallMotion};

fn closed() -> Container {
    Container::closed(8.0, 6.0).unwrap()
}

fn keeps_its_contract(mut container: Container) {
    for (seed, speed) in [(1, 0.1), (2, 1.0), (3, 10.0)] {
        assert_eq!(laws::check(&mut container, 0.5, speed, seed), Ok(()), "{container:?} {speed}");
    }
}

#[test]
fn walls_at_rest() {
    keeps_its_contract(closed());
    keeps_its_contract(Container::open(8.0).unwrap());
    keeps_its_contract(closed().with_periodic_sides().unwrap());
    keeps_its_contract(closed().with_motion(Wall::Left, Fixed).unwrap());
}

#[test]
fn thermal_walls() {
    let thermal = Thermal::new(2.0).unwrap();
    keeps_its_contract(closed().with_temperature(Wall::Floor, thermal).unwrap());
}

#[test]
fn walls_that_move() {
    let motions: [Box<dyn Fn() -> Box<dyn WallMotion + Send + Sync>>; 4] = [
        Box::new(|| Box::new(BiParabolic::new(0.2, 3.0).unwrap())),
        Box::new(|| Box::new(Sinusoidal::new(0.2, 3.0).unwrap())),
        Box::new(|| Box::new(Triangular::new(0.2, 3.0).unwrap())),
        Box::new(|| Box::new(Sawtooth::new(0.2, 3.0).unwrap())),
    ];
    for motion in motions {
        for wall in [Wall::Floor, Wall::Lid, Wall::Left, Wall::Right] {
            keeps_its_contract(closed().with_motion(wall, motion()).unwrap());
        }
        let periodic = closed().with_periodic_sides().unwrap().with_motion(Wall::Floor, motion()).unwrap();
        keeps_its_contract(periodic);
    }
}

/// The walls are a hundredth of the disk's radius, or the domain is far from the origin of places.
#[test]
fn disks_of_any_size() {
    let mut container = closed().with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0).unwrap()).unwrap();
    for radius in [1e-3, 0.1, 2.5] {
        assert_eq!(laws::check(&mut container, radius, 1.0, 7), Ok(()), "{radius}");
    }
    let boxed: &mut dyn Boundary = &mut container;
    assert_eq!(laws::check(boxed, 0.5, 1.0, 7), Ok(()), "through a trait object, too");
}
