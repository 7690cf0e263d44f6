//! Containers keep the contract of a boundary: walls at rest and moving, periodic sides, an open top, thermal
//! walls.

use granular_edmd::boundary::{Boundary, Container, Thermal, Wall, laws};
use granular_edmd::wall::{BiParabolic, Fixed, Sawtooth, Sinusoidal, Triangular, WallMotion};
use support::cases::few;

fn closed() -> Container {
    Container::closed(8.0, 6.0).unwrap()
}

/// Checks containers, by default most of them, each with disks of another speed.
fn keep_the_contract(containers: &[Container]) {
    let speeds = [(1, 0.1), (2, 1.0), (3, 10.0)];
    let all = containers.iter().flat_map(|container| speeds.map(|trial| (container.clone(), trial)));
    for (mut container, (seed, speed)) in few(all, 4) {
        assert_eq!(laws::check(&mut container, 0.5, speed, seed), Ok(()), "{container:?} {speed}");
    }
}

#[test]
fn walls_at_rest() {
    keep_the_contract(&[
        closed(),
        Container::open(8.0).unwrap(),
        closed().with_periodic_sides().unwrap(),
        closed().with_motion(Wall::Left, Fixed).unwrap(),
    ]);
}

#[test]
fn thermal_walls() {
    let thermal = Thermal::new(2.0).unwrap();
    keep_the_contract(&[closed().with_temperature(Wall::Floor, thermal).unwrap()]);
}

#[test]
fn walls_that_move() {
    let motions: [Box<dyn Fn() -> Box<dyn WallMotion + Send + Sync>>; 4] = [
        Box::new(|| Box::new(BiParabolic::new(0.2, 3.0).unwrap())),
        Box::new(|| Box::new(Sinusoidal::new(0.2, 3.0).unwrap())),
        Box::new(|| Box::new(Triangular::new(0.2, 3.0).unwrap())),
        Box::new(|| Box::new(Sawtooth::new(0.2, 3.0).unwrap())),
    ];
    let mut containers = Vec::new();
    for motion in motions {
        for wall in [Wall::Floor, Wall::Lid, Wall::Left, Wall::Right] {
            containers.push(closed().with_motion(wall, motion()).unwrap());
        }
        let periodic = closed().with_periodic_sides().unwrap().with_motion(Wall::Floor, motion()).unwrap();
        containers.push(periodic);
    }
    keep_the_contract(&containers);
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
