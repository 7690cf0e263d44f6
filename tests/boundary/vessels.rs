//! Vessels keep the contract of boundaries, whatever they are built of and however they move.

use std::f64::consts::{PI, TAU};
use std::fmt::Display;

use granular_edmd::boundary::{Boundary, Brick, Container, Part, Probe, Wall, WallError, laws};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::wall::{BiParabolic, Sawtooth, Sinusoidal, Triangular, WallMotion};
use granular_edmd::{Disk, Kind, Simulation, initial};
use support::cases::few;

fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
    list.iter().copied().map(DVec2::from).collect()
}

/// An hourglass: not convex, with corners that point inward.
fn glass() -> Part {
    let right = [(8.0, 0.0), (8.0, 6.0), (5.0, 10.0), (8.0, 14.0), (8.0, 20.0)];
    let left = right.iter().rev().map(|&(x, y)| (8.0 - x, y));
    Part::polygon(right.into_iter().chain(left).map(DVec2::from)).unwrap()
}

fn triangle() -> Part {
    Part::block(points(&[(4.0, 4.0), (8.0, 4.5), (5.0, 7.0)])).unwrap()
}

/// A bowl, a thin wall, a small arc from outside, and a peg.
fn mixed() -> Part {
    Part::new([
        Brick::arc(DVec2::new(5.0, 5.0), 4.0, PI, 1.8 * PI).unwrap().two_sided(),
        Brick::segment(DVec2::new(9.0, 7.0), DVec2::new(11.0, 9.0)).unwrap().two_sided(),
        Brick::arc(DVec2::new(10.0, 3.0), 1.0, 0.0, 1.5 * PI).unwrap().reversed().two_sided(),
        Brick::circle(DVec2::new(5.0, 9.5), 0.7).unwrap().reversed(),
        Brick::point(DVec2::new(8.0, 10.0)).unwrap(),
    ])
    .unwrap()
}

fn room() -> Container {
    Container::closed(12.0, 12.0).unwrap()
}

/// Checks vessels with disks of each size; by default, every `stride`-th pair of these.
fn check<S: Display>(stride: usize, vessels: impl IntoIterator<Item = (S, Container)>) {
    let sizes = [(0, 0.5), (1, 0.3), (2, 0.05)];
    let all = vessels.into_iter().flat_map(|(name, vessel)| {
        sizes.map(|(seed, radius)| (format!("{name}, radius {radius}"), vessel.clone(), seed, radius))
    });
    for (name, mut vessel, seed, radius) in few(all, stride) {
        assert_eq!(laws::check(&mut vessel, radius, 1.0, seed), Ok(()), "{name}");
    }
}

/// A list of kinds that is empty by mistake: the part would stop nobody, not everybody.
#[test]
fn a_part_for_no_kinds_is_refused() {
    let bar = Part::polyline([(3.0, 5.0), (7.0, 5.0)].map(DVec2::from)).expect("a bar");
    let none = bar.clone().only_for([Kind::new(2)]).only_for([]);
    let vessel = Container::closed(10.0, 10.0).expect("a box");
    let refused = vessel.clone().with_part("bar", none).expect_err("a part for no kinds").to_string();
    assert!(refused.contains("number of kinds for which a part is"), "{refused}");
    assert!(vessel.with_part("bar", bar).is_ok());
}

#[test]
fn vessels_at_rest_keep_the_contract() {
    let drum = Part::drum(DVec2::new(3.0, -2.0), 5.0).unwrap();
    let wall = Part::polyline(points(&[(3.0, 2.0), (6.0, 5.0), (9.0, 2.0), (9.0, 9.0)])).unwrap();
    let line = Part::polyline(points(&[(2.0, 3.0), (502.0, 103.0)])).unwrap();
    check(
        4,
        [
            ("glass", Container::around([("glass", glass())]).unwrap()),
            ("drum", Container::around([("drum", drum)]).unwrap()),
            ("block", room().with_part("block", triangle()).unwrap()),
            ("mixed", room().with_part("mixed", mixed()).unwrap()),
            ("thin wall", room().with_part("wall", wall).unwrap()),
            ("long line", room().with_part("line", line).unwrap()),
        ],
    );
}

#[test]
fn vessels_with_periodic_sides_keep_the_contract() {
    let sides = Container::closed(12.0, 12.0).unwrap().with_periodic_sides().unwrap();
    let containers = [("sides", sides), ("periodic", Container::periodic(12.0, 12.0).unwrap())];
    check(
        11,
        containers.into_iter().flat_map(|(name, container)| {
            [triangle(), mixed(), triangle().shifted(DVec2::new(6.0, 6.0)).unwrap()]
                .map(|part| (name, container.clone().with_part("part", part).unwrap()))
        }),
    );
}

#[test]
fn vessels_that_move_keep_the_contract() {
    let along = DVec2::new(1.0, 0.7);
    let mut vessels = Vec::new();
    for part in [triangle(), mixed()] {
        let still = || part.clone();
        let parts = [
            still().with_motion(along, BiParabolic::new(0.4, 2.0).unwrap()),
            still().with_motion(along, Triangular::new(0.4, 2.0).unwrap()),
            still().with_motion(along, Sinusoidal::new(0.4, 2.0).unwrap()),
            still().with_motion(DVec2::Y, Sinusoidal::new(0.1, 20.0).unwrap()),
            still().with_rotation(DVec2::new(6.0, 6.0), 0.2),
            still().with_rotation(DVec2::new(6.0, 6.0), -3.0),
            still().with_rotation(DVec2::new(6.0, 6.0), 0.2).and_then(|part| part.starting_at(1e3)),
        ];
        for (number, part) in parts.into_iter().enumerate() {
            vessels.push((format!("motion {number}"), room().with_part("part", part.unwrap()).unwrap()));
        }
    }
    let drum = Part::drum(DVec2::ZERO, 5.0).unwrap();
    let swing = Sinusoidal::new(0.5, 3.0).unwrap();
    let around = [
        ("turning glass", glass().with_rotation(DVec2::new(4.0, 10.0), 0.3)),
        ("shaken glass", glass().with_motion(DVec2::Y, swing)),
        ("shaken drum", drum.clone().with_motion(DVec2::X, swing)),
        ("drum about another axis", drum.with_rotation(DVec2::new(0.5, 0.0), TAU / 10.0)),
    ];
    for (name, part) in around {
        vessels.push((name.to_owned(), Container::around([("outside", part.unwrap())]).unwrap()));
    }
    check(19, vessels);
}

/// A part that is put in late begins where it was built, whatever the time origin is and whenever it is set.
#[test]
fn a_motion_counts_from_its_start() {
    const START: f64 = 12_345.678_9;
    let place = DVec2::new(3.2, 5.1);
    let depth = |vessel: &Container, time: f64| vessel.overlap(&Probe::new(place, 0.9, time));
    for part in [
        mixed().with_rotation(DVec2::new(6.0, 6.0), 0.7).unwrap(),
        mixed().with_motion(DVec2::ONE, Sinusoidal::new(0.4, 2.0).unwrap()).unwrap(),
    ] {
        let early = room().with_part("part", part.clone()).unwrap();
        let late = part.starting_at(START).unwrap();
        for origin in [0.0, 12_288.0] {
            let mut vessel = room();
            vessel.set_time_origin(origin);
            let mut set = vessel.clone().with_part("part", late.clone()).unwrap();
            vessel.add_part("part", late.clone()).unwrap();
            for wait in [0.0, 0.3, 5.0, 20.0] {
                let (now, then) = (START - origin + wait, depth(&early, wait));
                assert_eq!(depth(&set, now).map(|overlap| overlap.with), then.map(|overlap| overlap.with));
                let off = depth(&set, now).map_or(0.0, |overlap| overlap.depth)
                    - then.map_or(0.0, |overlap| overlap.depth);
                assert!(off.abs() < 1e-11, "{origin} {wait}: {off:e}");
                assert_eq!(depth(&vessel, now), depth(&set, now));
            }
            set.set_time_origin(origin);
            assert_eq!(depth(&set, START - origin), depth(&vessel, START - origin));
        }
    }
}

#[test]
fn a_motion_that_jumps_is_refused_where_it_would_jump_into_disks() {
    let saw = || Sawtooth::new(0.2, 3.0).unwrap();
    assert!(triangle().with_motion(DVec2::Y, saw()).is_err());
    assert!(triangle().with_motion(DVec2::Y, Triangular::new(0.2, 3.0).unwrap()).is_ok());
}

/// Outlines lie on the parts at every time, whatever the time origin is.
/// Returns the lines along the bricks at a time offset.
fn lines(vessel: &Container, time: f64) -> Vec<Vec<DVec2>> {
    let lines = (0..vessel.wall_count()).map(|wall| vessel.wall(wall, time).line());
    lines.filter(|line| !line.is_empty()).collect()
}

#[test]
fn outlines_lie_on_the_parts() {
    for part in [
        mixed(),
        mixed().with_rotation(DVec2::new(6.0, 6.0), 0.7).unwrap().starting_at(3.0).unwrap(),
        mixed().with_motion(DVec2::ONE, Sinusoidal::new(0.4, 2.0).unwrap()).unwrap(),
    ] {
        let mut vessel = room().with_part("part", part).unwrap();
        for origin in [0.0, 1024.0] {
            vessel.set_time_origin(origin);
            for time in [1024.0, 1030.5] {
                let lines = lines(&vessel, time - origin);
                assert!(lines.len() > 3 && lines.iter().all(|line| line.len() > 1));
                for place in lines.iter().flatten() {
                    // Inside the room, no other wall is nearer.
                    let inside =
                        place.cmpgt(DVec2::splat(1e-3)).all() && place.cmplt(DVec2::splat(11.999)).all();
                    let depth = vessel
                        .overlap(&Probe::new(*place, 1e-3, time - origin))
                        .map_or(0.0, |overlap| overlap.depth);
                    assert!(!inside || (depth - 1e-3).abs() < 1e-10, "{place} at {time}: {depth}");
                }
            }
        }
    }
}

/// Bricks and corners are numbered as the points are, whichever way these go round.
#[test]
fn bricks_count_as_points_do() {
    let points = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (-1.0, 5.0)].map(DVec2::from);
    let backward = [points[0], points[3], points[2], points[1]];
    for points in [points, backward] {
        for part in [Part::polygon(points).unwrap(), Part::block(points).unwrap()] {
            for (side, brick) in part.bricks().iter().enumerate() {
                let middle = 0.5 * (points[side] + points[(side + 1) % 4]);
                assert!(brick.signed_distance(middle).abs() < 1e-12, "side {side}");
            }
        }
    }
}

#[test]
fn walls_have_the_names_of_their_parts() {
    let mut vessel = room().with_part("mixed", mixed()).unwrap().with_part("block", triangle()).unwrap();
    let walls = vessel.walls_of("mixed").unwrap();
    assert_eq!(walls.start, 4);
    assert_eq!(vessel.wall(4, 0.0).to_string(), "mixed, brick 0");
    assert_eq!(vessel.wall(walls.end - 1, 0.0).to_string(), "mixed, corner 5");
    assert_eq!(vessel.wall(walls.end, 0.0).to_string(), "block, brick 0");
    vessel.remove_part("mixed").unwrap();
    assert_eq!(vessel.walls_of("block"), Some(4..10));
    assert_eq!(vessel.wall(10, 0.0).to_string(), "wall 10");
    assert_eq!(vessel.part_names().collect::<Vec<_>>(), ["block"]);
}

/// An elastic gas under gravity keeps its energy in a vessel at rest, and stays inside.
#[test]
fn a_gas_stays_in_its_vessel() {
    let periodic = Container::periodic(12.0, 12.0).unwrap().with_part("mixed", mixed()).unwrap();
    for (vessel, gravity) in [
        (Container::around([("glass", glass())]).unwrap(), 1.0),
        (room().with_part("mixed", mixed()).unwrap().with_part("block", triangle()).unwrap(), 0.3),
        (periodic, 0.0),
    ] {
        let disks = initial::scattered(&vessel, 30, 0.3, 20.0, 1).unwrap();
        let disks = initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap();
        let energy = |disks: &[Disk]| -> f64 {
            disks.iter().map(|disk| disk.translational_energy() + gravity * disk.position().y).sum()
        };
        let mut run = Simulation::builder(Elastic, vessel.clone())
            .disks(disks.clone())
            .gravity(gravity)
            .build()
            .unwrap();
        run.run_until(200.0, &mut ()).unwrap();
        for disk in run.disks() {
            let overlap = vessel.overlap(&Probe::new(disk.position(), disk.radius(), 0.0));
            assert!(overlap.is_none_or(|overlap| overlap.depth < 1e-10), "{disk:?} {overlap:?}");
        }
        assert!((energy(&run.disks()) / energy(&disks) - 1.0).abs() < 1e-9);
        assert!(run.counters().wall_collisions > 500, "{:?}", run.counters());
        assert!(run.counters().max_wall_overlap < 1e-10, "{:?}", run.counters());
    }
}

#[cfg(feature = "serde")]
#[test]
fn vessels_come_back_from_files() {
    use granular_edmd::boundary::Thermal;
    use granular_edmd::collision::{
        CollisionRule, ElasticBelow, Frictional, LeastRebound, Smooth, SpeedDependent, from_fn,
    };

    let floor = BiParabolic::new(0.1, 10.0).unwrap();
    let container = Container::open(12.0).unwrap().with_motion(Wall::Floor, floor).unwrap();
    let container = container.with_rule(Wall::Left, Smooth::from_inelasticity(0.1).unwrap()).unwrap();
    let vessel = container
        .shifted(DVec2::new(-1.0, 2.0))
        .unwrap()
        .with_part("mixed", mixed().with_motion(DVec2::X, Sinusoidal::new(0.4, 2.0).unwrap()).unwrap())
        .unwrap()
        .with_part(
            "block",
            triangle()
                .with_rotation(DVec2::ONE, 0.1)
                .and_then(|part| part.starting_at(7.0))
                .unwrap()
                .with_rule(Frictional::from_inelasticity(0.1, 0.1, 0.3).unwrap()),
        )
        .unwrap()
        .with_part(
            "hot",
            triangle().with_temperature(Thermal::new(2.0).unwrap()).with_surface_speed(0.3).unwrap(),
        )
        .unwrap();
    let text = serde_json::to_string(&vessel).unwrap();
    let back: Container = serde_json::from_str(&text).unwrap();
    assert_eq!(serde_json::to_string(&back).unwrap(), text);
    assert_eq!(back.fingerprint().unwrap(), vessel.fingerprint().unwrap());

    let slow = |part: Part, kind: u32| match kind {
        0 => part.with_rule(
            ElasticBelow::new(Frictional::from_inelasticity(0.1, 0.1, 0.3).unwrap(), 0.1).unwrap(),
        ),
        1 => part
            .with_rule(LeastRebound::new(SpeedDependent::from_restitution(0.7, 1.0).unwrap(), 0.1).unwrap()),
        _ => part.with_rule(SpeedDependent::from_restitution(0.7, 1.0).unwrap()),
    };
    for kind in 0..3 {
        let text = serde_json::to_string(&slow(triangle(), kind)).unwrap();
        let back: Part = serde_json::from_str(&text).unwrap();
        assert_eq!(serde_json::to_string(&back).unwrap(), text);
    }

    let own = triangle().with_rule(from_fn(|contact| Elastic.impulse(contact)));
    let error = serde_json::to_string(&own).unwrap_err().to_string();
    assert_eq!(error, "only the rules of granular-edmd, and remedies and tables of these, can be serialized");
}

/// Numbers of every kind are refused with the value named, or make a part that answers.
#[test]
fn numbers_of_every_kind_are_refused_or_taken() {
    const NUMBERS: [f64; 12] = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        1e-300,
        5e-324,
        1e30,
        1e61,
        f64::MAX,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
    ];
    let mut taken = 0;
    for (a, b) in NUMBERS.iter().flat_map(|&a| NUMBERS.map(|b| (a, b))) {
        let point = DVec2::new(a, b);
        let parts = [
            Brick::segment(point, DVec2::ONE).and_then(|brick| Part::new([brick.two_sided()])),
            Brick::arc(DVec2::ONE, 1.0, a, b).and_then(|brick| Part::new([brick.two_sided()])),
            Part::peg(point, 1.0),
            Part::peg(DVec2::ONE, a),
            Part::polygon([DVec2::ZERO, DVec2::ONE, point]),
            triangle().shifted(point),
            triangle().rotated(point, a),
            triangle().rotated(DVec2::ONE, b),
            triangle().with_rotation(point, 1.0),
            triangle().with_rotation(DVec2::ONE, a),
            triangle().with_surface_speed(a),
            triangle().with_rotation(DVec2::ONE, 0.3).and_then(|part| part.starting_at(a)),
            triangle().with_motion(point, Sinusoidal::new(0.1, 3.0).unwrap()),
        ];
        for part in parts.into_iter().flatten() {
            let vessel = room().with_part("part", part).unwrap();
            let place = DVec2::new(2.0, 11.0);
            let flight = granular_edmd::Flight::new(0.0, place, DVec2::new(3.0, -9.0), DVec2::NEG_Y, 0.4);
            let answer = vessel.first_touch(&flight, 10.0);
            assert!(answer.time() >= 0.0 && answer.time() <= 10.0);
            assert!(answer.touch().is_none_or(|touch| touch.wall < vessel.wall_count()));
            let depth = vessel.overlap(&Probe::new(place, 0.4, 0.0)).map_or(0.0, |overlap| overlap.depth);
            assert!(!depth.is_nan());
            taken += 1;
        }
    }
    assert!(taken > 500, "{taken}");
}

/// If the box is shaken as a whole, the sides move together, and floor and lid slide with them.
#[test]
fn a_box_that_is_shaken_moves_as_one() {
    let motion = Sinusoidal::new(0.5, 3.0).unwrap();
    let floor = BiParabolic::new(0.1, 10.0).unwrap();
    let container = Container::closed(12.0, 9.0).unwrap().with_motion(Wall::Floor, floor).unwrap();
    let mut container = container.shaken_sideways(motion).unwrap();
    assert_eq!(laws::check(&mut container, 0.5, 1.0, 3), Ok(()));
    container.set_time_origin(0.0);
    for time in [0.0, 0.3, 1.7] {
        let shaken = motion.state(time);
        for wall in 0..4 {
            let velocity = container.surface(wall, DVec2::ONE, time).velocity;
            assert!((velocity.x - shaken.velocity).abs() < 1e-12, "{wall} at {time}: {velocity}");
        }
        let depth = |x: f64| {
            container.overlap(&Probe::new(DVec2::new(x, 4.0), 1.0, time)).map_or(0.0, |overlap| overlap.depth)
        };
        assert!((depth(0.0) - (1.0 + shaken.displacement)).abs() < 1e-12);
        assert!((depth(12.0) - (1.0 - shaken.displacement)).abs() < 1e-12);
        assert_eq!(container.surface(0, DVec2::ONE, time).velocity.y, floor.state(time).velocity);
    }
    let both = Container::closed(12.0, 9.0).unwrap().shaken_vertically(motion).unwrap();
    let mut both = both.shaken_sideways(floor).unwrap();
    assert_eq!(laws::check(&mut both, 0.5, 1.0, 3), Ok(()));
    both.set_time_origin(0.0);
    let velocities = [0, 1, 2, 3].map(|wall| both.surface(wall, DVec2::ONE, 0.4).velocity);
    let expected = DVec2::new(floor.state(0.4).velocity, motion.state(0.4).velocity);
    assert!(velocities.iter().all(|velocity| (*velocity - expected).length() < 1e-12), "{velocities:?}");
    assert!(Container::open(9.0).unwrap().shaken_sideways(Sawtooth::new(0.1, 3.0).unwrap()).is_err());
}

/// A gate that shuts on a disk is refused, and changes nothing. One that opens gives the same bits through a
/// checkpoint.
#[cfg(feature = "serde")]
#[test]
fn gates_open_and_shut_between_runs() {
    use granular_edmd::simulation::Checkpoint;

    let gate = || Part::polyline(points(&[(0.0, 6.0), (12.0, 6.0)])).unwrap();
    let shut = room().with_part("gate", gate()).unwrap();
    let disks = initial::lattice(&shut, 60, 0.5).unwrap();
    let disks: Vec<_> = disks.into_iter().filter(|disk| disk.position().y > 6.0).collect();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 1).unwrap();
    let mut run = Simulation::builder(Elastic, shut.clone()).disks(disks).gravity(0.2).build().unwrap();
    run.run_until(5.0, &mut ()).unwrap();
    assert!(run.disks().iter().all(|disk| disk.position().y > 6.49));

    let mut open = run.boundary().clone();
    open.remove_part("gate").unwrap();
    run.set_boundary(open.clone()).unwrap();
    run.run_until(9.0, &mut ()).unwrap();
    let bytes = run.checkpoint().to_bytes().unwrap();
    let checkpoint = Checkpoint::from_bytes(&bytes).unwrap();
    let mut other = Simulation::resume(&checkpoint, Elastic, open).build().unwrap();
    assert!(Simulation::resume(&checkpoint, Elastic, shut.clone()).build().is_err(), "the gate is open");

    while run.disks().iter().all(|disk| (disk.position().y - 6.0).abs() > 0.45) {
        run.run_until(run.time() + 0.125, &mut ()).unwrap();
    }
    let before = run.disks();
    let error = run.set_boundary(shut).unwrap_err().to_string();
    assert!(error.contains("gate"), "{error}");
    assert_eq!(run.disks(), before);
    run.run_until(20.0, &mut ()).unwrap();
    other.run_until(20.0, &mut ()).unwrap();
    assert_eq!(run.disks(), other.disks());
}

/// Rules get the radius of an arc, which is negative from inside. Straight walls and corners have an infinite
/// one.
#[test]
fn curved_walls_tell_their_radius() {
    let pegged = room().with_part("peg", Part::peg(DVec2::splat(6.0), 2.0).unwrap()).unwrap();
    let drum = Container::around([("drum", Part::drum(DVec2::ZERO, 5.0).unwrap())]).unwrap();
    let block = room().with_part("block", triangle()).unwrap();
    let radius = |vessel: &Container, name: &str, place: DVec2| {
        vessel.walls_of(name).unwrap().map(|wall| vessel.surface(wall, place, 0.0).radius).collect::<Vec<_>>()
    };
    assert_eq!(radius(&pegged, "peg", DVec2::new(8.5, 6.0)), [2.0]);
    assert_eq!(radius(&drum, "drum", DVec2::new(4.5, 0.0)), [-5.0]);
    assert!(radius(&block, "block", DVec2::new(4.0, 3.5)).iter().all(|&radius| radius == f64::INFINITY));
}

/// Many files end a polygon with its first point. Other equal neighbors are named.
#[test]
fn a_polygon_may_end_where_it_begins() {
    let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
    let closed: Vec<_> = square.iter().chain(&square[..1]).copied().collect();
    assert_eq!(Part::polygon(points(&closed)).unwrap().bricks().len(), 4);
    let error = Part::polygon(points(&[(0.0, 0.0), (4.0, 0.0), (4.0, 0.0), (0.0, 4.0)])).unwrap_err();
    assert_eq!(error.to_string(), "the points 1 and 2 of the polygon are equal");
}

#[test]
fn an_unknown_part_is_answered_with_those_there_are() {
    let mut vessel = room().with_part("gate", triangle()).unwrap().with_part("bowl", mixed()).unwrap();
    let said = vessel.remove_part("gaet").unwrap_err().to_string();
    assert_eq!(said, "the container has no part \"gaet\"; its parts are \"gate\", \"bowl\"");
    let mut many = room();
    for number in 0..9 {
        many.add_part(format!("part {number}"), triangle()).unwrap();
    }
    let said = many.remove_part("gate").unwrap_err().to_string();
    assert!(said.contains("its 9 parts are \"part 0\"") && said.ends_with("\"part 7\", …"), "{said}");
}

/// A part turns and travels, in whichever order it is told so. Each call replaces an earlier one of its kind.
#[test]
fn a_part_turns_and_travels() {
    let arm = || Part::polyline([DVec2::ZERO, DVec2::new(2.0, 0.0)]).unwrap();
    let sine = |amplitude: f64| Sinusoidal::new(amplitude, 3.0).unwrap();
    let (about, up) = (DVec2::new(0.5, 0.0), DVec2::Y);
    let vessel = |part: Part| Container::around([("arm", part)]).unwrap();
    let turned = arm().with_rotation(about, 0.7).unwrap();
    let both = vessel(turned.clone().with_motion(up, sine(0.3)).unwrap());
    let other = arm().with_motion(up, sine(0.3)).unwrap().with_rotation(about, 0.7).unwrap();
    assert_eq!(both.fingerprint(), vessel(other).fingerprint());
    let again = turned.clone().with_motion(up, sine(9.0)).unwrap().with_rotation(about, 5.0).unwrap();
    let again = again.with_motion(up, sine(0.3)).unwrap().with_rotation(about, 0.7).unwrap();
    assert_eq!(both.fingerprint(), vessel(again).fingerprint());
    let still = both.part("arm").unwrap().clone().with_rotation(about, 0.0).unwrap();
    let along = vessel(arm().with_motion(up, sine(0.3)).unwrap());
    assert_eq!(vessel(still).fingerprint(), along.fingerprint());
    assert_ne!(both.fingerprint(), along.fingerprint());
    assert_ne!(both.fingerprint(), vessel(turned.clone()).fingerprint());

    // The equation of the documentation, also long after the start: the phases keep their digits.
    for time in [0.0, 1.3, 1e9] {
        let mut both = both.clone();
        both.set_time_origin(time);
        let line = lines(&both, 0.0).remove(0);
        let shift = sine(0.3).state(time % sine(0.3).period().unwrap()).displacement;
        let turn = DVec2::from_angle(0.7 * (time % (std::f64::consts::TAU / 0.7)));
        let end = about + shift * up + turn.rotate(DVec2::new(1.5, 0.0));
        assert!(line[1].distance(end) < 1e-12, "{time}: {} {end}", line[1]);
    }
    let moved = turned.with_motion(up, sine(0.3)).unwrap().rotated(DVec2::ZERO, std::f64::consts::FRAC_PI_2);
    let line = lines(&vessel(moved.unwrap().shifted(DVec2::X).unwrap()), 0.0).remove(0);
    assert!(line[1].distance(DVec2::new(1.0, 2.0)) < 1e-12);

    let saw = || Sawtooth::new(0.2, 3.0).unwrap();
    let turned = arm().with_rotation(about, 0.7).unwrap();
    assert_eq!(turned.with_motion(up, saw()).err(), Some(WallError::Jump));
    #[cfg(feature = "serde")]
    {
        let text = serde_json::to_string(&both).unwrap();
        let back: Container = serde_json::from_str(&text).unwrap();
        assert_eq!(back.fingerprint(), both.fingerprint());
        assert_eq!(serde_json::to_string(&back).unwrap(), text);
    }
}
