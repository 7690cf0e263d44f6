//! The container's promises about its walls, one by one, in exact numbers.

use std::f64::consts::TAU;

use granular_edmd::boundary::{
    Boundary, Container, Domain, FirstTouch, Overlap, Probe, Region, Thermal, Touch, Wall,
};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::wall::{Sinusoidal, Triangular};
use granular_edmd::{Flight, Kind};

const RADIUS: f64 = 0.5;
const FLOOR: usize = 0;
const LEFT: usize = 1;

fn closed() -> Container {
    Container::closed(10.0, 20.0).unwrap()
}

/// A wall that moves by this amplitude to either side, with period 1, upward from its middle at time 0.
fn moving(wall: Wall, amplitude: f64) -> Container {
    closed().with_motion(wall, Triangular::new(amplitude, TAU).unwrap()).unwrap()
}

fn region(min: (f64, f64), max: (f64, f64)) -> Region {
    Region::new(min.into(), max.into())
}

fn names(boundary: &impl Boundary) -> Vec<String> {
    (0..boundary.wall_count()).map(|wall| boundary.wall(wall, 0.0).to_string()).collect()
}

#[test]
fn walls_have_names_numbers_and_sizes() {
    let (open, periodic) = (Container::open(10.0).unwrap(), closed().with_periodic_sides().unwrap());
    assert_eq!((closed().width(), closed().height(), open.height()), (10.0, 20.0, f64::INFINITY));
    assert_eq!(names(&closed()), ["floor", "left", "right", "lid"]);
    assert_eq!(names(&open), ["floor", "left", "right"]);
    assert_eq!(names(&periodic), ["floor", "lid"]);
    assert_eq!(
        [4, usize::MAX].map(|wall| closed().wall(wall, 0.0).to_string()),
        ["wall 4".to_owned(), format!("wall {}", usize::MAX)]
    );
    let all = [Wall::Floor, Wall::Left, Wall::Right, Wall::Lid];
    assert_eq!(all.map(|wall| closed().index(wall)), [Some(0), Some(1), Some(2), Some(3)]);
    assert_eq!(all.map(|wall| periodic.index(wall)), [Some(0), None, None, Some(1)]);
    assert!(format!("{:?}", moving(Wall::Lid, 0.25)).contains("reach: (-0.25, 0.25)"));
}

#[test]
fn the_domain_reaches_as_far_as_walls_go_and_the_interior_ends_where_they_come() {
    let domain = Domain::new;
    let still = domain(0.0, 10.0, 0.0, 20.0);
    let cases = [
        (closed(), still, still),
        (closed().with_periodic_sides().unwrap(), still.with_periodic_sides(), still.with_periodic_sides()),
        (moving(Wall::Floor, 0.25), domain(0.0, 10.0, -0.25, 20.0), domain(0.0, 10.0, 0.25, 20.0)),
        (moving(Wall::Lid, 0.25), domain(0.0, 10.0, 0.0, 20.25), domain(0.0, 10.0, 0.0, 19.75)),
        (moving(Wall::Left, 0.25), domain(-0.25, 10.0, 0.0, 20.0), domain(0.25, 10.0, 0.0, 20.0)),
        (moving(Wall::Right, 0.25), domain(0.0, 10.25, 0.0, 20.0), domain(0.0, 9.75, 0.0, 20.0)),
    ];
    for (container, domain, interior) in cases {
        assert_eq!((container.domain(), container.interior()), (domain, interior));
    }
}

#[test]
fn separations_take_the_shortest_way_across_periodic_sides_only() {
    let domain = Domain::new(-1.0, 9.0, -2.0, 5.0).with_periodic_sides();
    assert_eq!((domain.width(), domain.height()), (10.0, 7.0));
    let (from, to) = (DVec2::new(8.0, 3.0), DVec2::new(0.5, 1.0));
    assert_eq!(domain.separation(from, to), DVec2::new(2.5, -2.0));
    assert_eq!(domain.separation(to, from), DVec2::new(-2.5, 2.0));
    assert_eq!(domain.separation(from, DVec2::new(7.0, 3.0)), DVec2::NEG_X);
    assert_eq!(Domain::new(-1.0, 9.0, -2.0, 5.0).separation(from, to), DVec2::new(-7.5, -2.0));
}

/// Each touching region ends where a disk in it just touches the wall. Each clear one ends a little before.
#[test]
fn regions_near_a_wall_may_touch_it_and_others_may_not() {
    let container = moving(Wall::Floor, 0.25);
    for (touching, clear) in [
        (region((4.0, 0.75), (6.0, 3.0)), region((4.0, 0.8), (6.0, 3.0))),
        (region((4.0, 6.0), (6.0, 19.5)), region((4.0, 6.0), (6.0, 19.4))),
        (region((0.5, 4.0), (6.0, 6.0)), region((0.6, 4.0), (6.0, 6.0))),
        (region((4.0, 4.0), (9.5, 6.0)), region((4.0, 4.0), (9.4, 6.0))),
    ] {
        assert!(container.may_touch(&touching, RADIUS) && !container.may_touch(&clear, RADIUS));
    }
    let endless = |bottom| region((f64::NEG_INFINITY, bottom), (f64::INFINITY, 3.0));
    let periodic = closed().with_periodic_sides().unwrap();
    assert!(periodic.may_touch(&endless(0.5), RADIUS) && !periodic.may_touch(&endless(0.6), RADIUS));
}

/// Returns a flight from (4, 6) at time 2.
fn flight(velocity: (f64, f64), acceleration: (f64, f64)) -> Flight {
    Flight::new(2.0, DVec2::new(4.0, 6.0), velocity.into(), acceleration.into(), RADIUS)
}

#[test]
fn a_flight_touches_the_wall_that_is_in_its_way() {
    for (velocity, name, time) in [
        ((0.0, -1.0), "floor", 2.0 + 5.5),
        ((0.0, 2.0), "lid", 2.0 + 13.5 / 2.0),
        ((-1.0, 0.0), "left", 2.0 + 3.5),
        ((1.0, 0.0), "right", 2.0 + 5.5),
        ((-1.0, -1.0), "left", 2.0 + 3.5),
        ((1.0, -2.0), "floor", 2.0 + 5.5 / 2.0),
    ] {
        let flight = flight(velocity, (0.0, 0.0));
        let wall = names(&closed()).iter().position(|wall| wall == name).unwrap();
        for until in [time, 99.0] {
            assert_eq!(
                closed().first_touch(&flight, until),
                FirstTouch::At(Touch::new(time, wall)),
                "{name}"
            );
        }
        assert_eq!(closed().first_touch(&flight, time.next_down()), FirstTouch::NONE, "{name}");
    }
    let falling = flight((0.0, 0.0), (0.0, -11.0));
    assert_eq!(closed().first_touch(&falling, 9.0), FirstTouch::At(Touch::new(3.0, FLOOR)));
    let corner = flight((-7.0, -11.0), (0.0, 0.0));
    let touch = Touch::new(2.5, FLOOR);
    assert_eq!(closed().first_touch(&corner, 9.0), FirstTouch::At(touch), "the first of equals");
}

#[test]
fn the_deepest_overlap_counts_and_touching_is_none() {
    assert_eq!(
        closed().overlap(&Probe::new(DVec2::new(0.125, 0.25), RADIUS, 0.0)),
        Some(Overlap::new(LEFT, 0.375))
    );
    assert_eq!(
        closed().overlap(&Probe::new(DVec2::new(0.25, 0.125), RADIUS, 0.0)),
        Some(Overlap::new(FLOOR, 0.375))
    );
    assert_eq!(
        closed().overlap(&Probe::new(DVec2::new(9.75, 19.875), RADIUS, 0.0)),
        Some(Overlap::new(3, 0.375))
    );
    assert_eq!(closed().overlap(&Probe::new(DVec2::new(0.5, 19.5), RADIUS, 0.0)), None);
}

#[test]
fn surfaces_point_inward_and_say_what_they_do() {
    let container = closed()
        .with_rule(Wall::Left, Elastic)
        .and_then(|container| container.with_temperature(Wall::Right, Thermal::new(2.0).unwrap().with_slip()))
        .unwrap();
    for (wall, (normal, response)) in [
        (DVec2::Y, "Shared"),
        (DVec2::X, "Rule(..)"),
        (DVec2::NEG_X, "Thermal(Thermal { temperature: 2.0, slip: true })"),
        (DVec2::NEG_Y, "Shared"),
    ]
    .into_iter()
    .enumerate()
    {
        let surface = container.surface(wall, DVec2::ZERO, 0.0);
        assert_eq!((surface.normal, surface.velocity), (normal, DVec2::ZERO));
        assert_eq!(format!("{:?}", surface.response), response);
    }
    let thermal = Thermal::new(2.0).unwrap();
    assert_eq!((thermal.temperature(), thermal.slip(), thermal.with_slip().slip()), (2.0, false, true));
}

/// Returns everything that a boundary answers about times soon after this origin.
fn said(mut boundary: impl Boundary, origin: f64) -> String {
    boundary.set_time_origin(origin);
    let falling = Flight::new(0.25, DVec2::new(5.0, 2.0), DVec2::NEG_Y, DVec2::NEG_Y, RADIUS);
    let states = [0.25, 0.375].map(|time| {
        let surface = boundary.surface(FLOOR, DVec2::ZERO, time);
        (surface.normal, surface.velocity, boundary.overlap(&Probe::new(DVec2::new(5.0, 0.5), RADIUS, time)))
    });
    let near = [0.5, 9.0].map(|bottom| boundary.may_touch(&region((4.0, bottom), (6.0, 10.0)), RADIUS));
    let rectangles = (boundary.domain(), boundary.interior());
    format!(
        "{:?}",
        (
            states,
            boundary.first_touch(&falling, 9.0),
            near,
            rectangles,
            names(&boundary),
            boundary.fingerprint()
        )
    )
}

/// The floor rises to 0.5 in the first quarter of its period, falls to -0.5 in half a period, and rises
/// again.
#[test]
fn a_moving_floor_is_where_its_motion_is_at_the_absolute_time() {
    let mut container = moving(Wall::Floor, 0.5);
    container.set_time_origin(1e9);
    let at = |time| container.overlap(&Probe::new(DVec2::new(5.0, 0.5), RADIUS, time));
    assert_eq!(
        (at(0.0), at(0.125), at(0.375)),
        (None, Some(Overlap::new(FLOOR, 0.25)), Some(Overlap::new(FLOOR, 0.25)))
    );
    let velocity = |time| container.surface(FLOOR, DVec2::ZERO, time).velocity;
    assert_eq!([0.125, 0.375].map(velocity), [DVec2::new(0.0, 2.0), DVec2::new(0.0, -2.0)]);
    let meeting = Flight::new(0.0, DVec2::new(5.0, 1.0), DVec2::new(0.0, -2.0), DVec2::ZERO, RADIUS);
    let touch = FirstTouch::At(Touch::new(0.125, FLOOR));
    assert_eq!([0.125, 9.0].map(|until| container.first_touch(&meeting, until)), [touch; 2]);
    assert_eq!(said(moving(Wall::Floor, 0.5), 1e9 + 0.1), said(moving(Wall::Floor, 0.5), (1e9 + 0.1) % 1.0));
}

#[test]
fn a_boundary_says_the_same_in_a_box_and_when_lent() {
    let container = moving(Wall::Floor, 0.5);
    let boxed: Box<dyn Boundary> = Box::new(container.clone());
    let mut lent = container.clone();
    assert_eq!(said(boxed, 0.1), said(container.clone(), 0.1));
    assert_eq!(said(&mut lent, 0.1), said(container, 0.1));
}

#[cfg(feature = "serde")]
#[test]
fn a_thermal_wall_is_read_through_the_same_gate() {
    let wall = Thermal::new(2.0).unwrap().with_slip();
    let text = serde_json::to_string(&wall).unwrap();
    assert_eq!(serde_json::from_str::<Thermal>(&text).unwrap(), wall);
    assert!(serde_json::from_str::<Thermal>(&text.replace("2.0", "-2.0")).is_err());
}

/// Text formats have no infinite numbers, so an open top is no number there.
#[cfg(feature = "serde")]
#[test]
fn a_domain_with_an_open_top_returns_from_a_file() {
    let open = Container::open(10.0).unwrap().domain();
    for domain in [open, open.with_periodic_sides(), closed().domain()] {
        let json = serde_json::to_string(&domain).unwrap();
        assert_eq!(serde_json::from_str::<Domain>(&json).unwrap(), domain, "{json}");
    }
}

/// What was set for a wall is not lost without a word when the wall is taken away.
#[test]
fn walls_with_settings_do_not_become_periodic() {
    let lost = |container: Container| container.with_periodic_sides().unwrap_err().to_string();
    let said =
        "the wall \"right\" has settings that would be lost: leave out the earlier setting or this one";
    assert_eq!(lost(closed().with_rule(Wall::Right, Elastic).unwrap()), said);
    assert_eq!(lost(closed().with_kind(Wall::Right, Kind::new(7)).unwrap()), said);
    assert_eq!(lost(closed().with_surface_speed(Wall::Right, 0.5).unwrap()), said);
    assert_eq!(lost(moving(Wall::Right, 0.25)), said);
    let hot = closed().with_temperature(Wall::Lid, Thermal::new(1.0).unwrap()).unwrap();
    assert_eq!(hot.clone().with_periodic_ends().unwrap_err().to_string(), said.replace("right", "lid"));
    // A belt in a shaken box would be one of both.
    let shake = Sinusoidal::new(0.1, 1.0).unwrap();
    let belt = closed().with_surface_speed(Wall::Right, 0.5).unwrap();
    let shaken = closed().shaken_vertically(shake).unwrap();
    let twice = [
        belt.clone().shaken_vertically(shake),
        belt.with_sliding(Wall::Right, shake),
        shaken.clone().with_surface_speed(Wall::Right, 0.5),
        moving(Wall::Right, 0.25).shaken_sideways(shake),
    ];
    assert_eq!(twice.map(|container| container.unwrap_err().to_string()), [said; 4]);
    assert!(shaken.shaken_sideways(shake).is_ok());
    // Settings of the other walls stay.
    assert_eq!(hot.with_periodic_sides().unwrap().wall_count(), 2);
    assert_eq!(moving(Wall::Right, 0.25).with_periodic_ends().unwrap().wall_count(), 2);
}
