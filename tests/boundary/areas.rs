//! The free areas of boundaries, against closed forms and against random places.

use std::f64::consts::{FRAC_PI_2, PI};

use granular_edmd::boundary::{Boundary, Brick, Container, Part, Probe, Region, Wall};
use granular_edmd::glam::DVec2;
use granular_edmd::wall::Sinusoidal;
use granular_edmd::{Disk, Kind, ParameterError};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use support::cases::few;

type Failure = Box<dyn std::error::Error>;

fn points<const N: usize>(corners: [(f64, f64); N]) -> [DVec2; N] {
    corners.map(DVec2::from)
}

fn everywhere(boundary: &impl Boundary) -> Region {
    let domain = boundary.domain();
    Region::new(DVec2::new(domain.left, domain.bottom), DVec2::new(domain.right, domain.top))
}

/// Checks the area in a region against a closed form, to rounding.
#[track_caller]
fn is(boundary: &impl Boundary, region: &Region, radius: f64, time: f64, expected: f64) {
    let area = boundary.area(region, radius, time).expect("a known area");
    let error = (area - expected).abs() / expected.max(1e-3);
    assert!(error < 1e-11, "{area} instead of {expected}: {error:e}");
}

/// Checks the whole area for matter and for disks of radius 0.5.
#[track_caller]
fn whole(boundary: &impl Boundary, of_matter: f64, of_centers: f64) {
    is(boundary, &everywhere(boundary), 0.0, 0.0, of_matter);
    is(boundary, &everywhere(boundary), 0.5, 0.0, of_centers);
}

fn square(center: DVec2, half: f64) -> Region {
    Region::new(center - half, center + half)
}

/// Checks the area against the share of random places that are free, within five deviations.
fn by_chance(boundary: &impl Boundary, region: &Region, radius: f64, time: f64) {
    const PLACES: u32 = 20_000;
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(7);
    let mut uniform = || generator.next_u64() as f64 / 2.0_f64.powi(64);
    let size = region.max - region.min;
    let free = (0..PLACES)
        .filter(|_| {
            let place = region.min + size * DVec2::new(uniform(), uniform());
            boundary.overlap(&Probe::new(place, radius, time)).is_none()
        })
        .count();
    let share = free as f64 / f64::from(PLACES);
    let area = boundary.area(region, radius, time).expect("a known area") / (size.x * size.y);
    let deviation = (share * (1.0 - share) / f64::from(PLACES)).sqrt().max(1e-5);
    assert!((area - share).abs() < 5.0 * deviation, "{area} instead of {share} ± {deviation}");
}

#[test]
fn a_container_is_a_rectangle_with_its_walls_where_they_are() -> Result<(), Failure> {
    let container = Container::closed(10.0, 20.0)?.with_motion(Wall::Floor, Sinusoidal::new(1.0, 1.0)?)?;
    whole(&container, 200.0, 9.0 * 19.0);
    let up = FRAC_PI_2;
    is(&container, &everywhere(&container), 0.0, up, 190.0);
    is(&container, &square(DVec2::new(0.0, 1.0), 1.0), 0.0, up, 1.0);
    let periodic = Container::periodic(10.0, 20.0)?;
    whole(&periodic, 200.0, 200.0);
    let open = Container::open(4.0)?;
    assert_eq!(open.area(&everywhere(&open), 0.0, 0.0), Some(f64::INFINITY));
    is(&open, &square(DVec2::new(0.0, 5.0), 2.0), 0.5, 0.0, 1.5 * 4.0);
    Ok(())
}

#[test]
fn a_drum_and_parts_of_it() -> Result<(), Failure> {
    let drum = Container::around([("drum", Part::drum(DVec2::new(1.0, -2.0), 10.0)?)])?;
    whole(&drum, PI * 100.0, PI * 9.5 * 9.5);
    // A square inside is all free, with the same bits; one outside is not.
    let inside = square(DVec2::new(2.0, -3.0), 1.3);
    let size = inside.max - inside.min;
    assert_eq!(drum.area(&inside, 0.5, 0.0), Some(size.x * size.y));
    is(&drum, &square(DVec2::new(9.5, 6.5), 1.0), 0.0, 0.0, 0.0);
    // A layer of a circle between two heights.
    let below = |h: f64| 100.0 * (FRAC_PI_2 + (h / 10.0).asin() + h / 10.0 * (1.0 - h * h / 100.0).sqrt());
    let layer = Region::new(DVec2::new(-20.0, -2.0 + 3.0), DVec2::new(20.0, -2.0 + 3.5));
    is(&drum, &layer, 0.0, 0.0, below(3.5) - below(3.0));
    // A cell that the rim cuts: the quadrant without the square of its corner.
    let quadrant = Region::new(DVec2::new(1.0, -2.0), DVec2::new(20.0, 20.0));
    is(&drum, &quadrant, 0.0, 0.0, 25.0 * PI);
    Ok(())
}

#[test]
fn polygons_blocks_and_pegs() -> Result<(), Failure> {
    let right = [(0.0, 0.0), (12.0, 0.0), (0.0, 5.0)];
    // Inset by 0.5, a right triangle of sides 5, 12, 13 with an incircle of radius 2 shrinks by 3/4.
    let triangle = Container::around([("triangle", Part::polygon(points(right))?)])?;
    whole(&triangle, 30.0, 30.0 * 0.75 * 0.75);
    // A block of 2 by 3 in the open has rounded corners for centers.
    let block = Part::block(points([(4.0, 4.0), (6.0, 4.0), (6.0, 7.0), (4.0, 7.0)]))?;
    let boxed = Container::closed(10.0, 10.0)?.with_part("block", block)?;
    whole(&boxed, 94.0, 81.0 - 6.0 - 0.5 * 10.0 - PI * 0.25);
    // A quarter of a peg in a corner; the centers lose a quarter of a ring that the walls cut off.
    let peg = Container::closed(10.0, 10.0)?.with_part("peg", Part::peg(DVec2::ZERO, 2.0)?)?;
    let cut = |r: f64, d: f64| {
        // Area of a quarter circle beyond the distance d from both axes.
        let angle = FRAC_PI_2 - 2.0 * (d / r).asin();
        0.5 * r * r * angle - d * ((r * r - d * d).sqrt() - d)
    };
    whole(&peg, 100.0 - PI, 81.0 - cut(2.5, 0.5));
    // A thin wall takes no area from matter, and a stadium from centers.
    let wall = Part::polyline(points([(3.0, 3.0), (6.0, 7.0)]))?;
    let walled = Container::closed(10.0, 10.0)?.with_part("wall", wall)?;
    whole(&walled, 100.0, 81.0 - 5.0 - PI * 0.25);
    // A line that takes centers out is in nobody's way.
    let sink = Part::polyline(points([(3.0, 3.0), (6.0, 7.0)]))?.absorbing_centers();
    whole(&Container::closed(10.0, 10.0)?.with_part("sink", sink)?, 100.0, 81.0);
    Ok(())
}

#[test]
fn parts_that_overlap_count_once() -> Result<(), Failure> {
    let one = Part::peg(DVec2::new(4.0, 5.0), 1.5)?;
    let lens = |r: f64, d: f64| 2.0 * r * r * (0.5 * d / r).acos() - 0.5 * d * (4.0 * r * r - d * d).sqrt();
    let both = |r: f64| 2.0 * PI * r * r - lens(r, 2.0);
    let other = Part::peg(DVec2::new(6.0, 5.0), 1.5)?;
    let two = Container::closed(10.0, 10.0)?.with_part("one", one.clone())?.with_part("other", other)?;
    whole(&two, 100.0 - both(1.5), 81.0 - both(2.0));
    // The same part twice.
    let twice = Container::closed(10.0, 10.0)?.with_part("one", one.clone())?.with_part("two", one)?;
    whole(&twice, 100.0 - PI * 2.25, 81.0 - PI * 4.0);
    // Two blocks side by side are one block.
    let block = |x: f64| Part::block(points([(x, 3.0), (x + 2.0, 3.0), (x + 2.0, 6.0), (x, 6.0)]));
    let blocks = Container::closed(10.0, 10.0)?.with_part("a", block(2.0)?)?.with_part("b", block(4.0)?)?;
    whole(&blocks, 88.0, 81.0 - 12.0 - 7.0 - PI * 0.25);
    Ok(())
}

#[test]
fn across_periodic_sides() -> Result<(), Failure> {
    let periodic = Container::periodic(10.0, 12.0)?;
    let peg = Part::peg(DVec2::new(9.5, 0.5), 1.5)?;
    whole(&periodic.clone().with_part("peg", peg)?, 120.0 - PI * 2.25, 120.0 - PI * 4.0);
    let disk = Disk::new(DVec2::new(9.5, 0.5), 1.5)?;
    whole(&periodic.with_pegs([disk])?, 120.0 - PI * 2.25, 120.0 - PI * 4.0);
    Ok(())
}

#[test]
fn obstacles_alone_and_in_walls() -> Result<(), Failure> {
    let disk = |x: f64, y: f64, r: f64| -> Result<Disk, ParameterError> { Disk::new(DVec2::new(x, y), r) };
    let container = Container::closed(10.0, 10.0)?;
    whole(&container.clone().with_pegs([])?, 100.0, 81.0);
    let board = container.clone().with_pegs([disk(4.0, 5.0, 1.0)?, disk(7.0, 5.0, 0.5)?])?;
    whole(&board, 100.0 - 1.25 * PI, 81.0 - PI * (2.25 + 1.0));
    // Half of one lies in the floor, and another in the rim of a drum.
    whole(&container.with_pegs([disk(5.0, 0.0, 1.0)?])?, 100.0 - 0.5 * PI, {
        let segment = 2.25 * (0.5_f64 / 1.5).acos() - 0.5 * 2.0_f64.sqrt();
        81.0 - segment
    });
    let drum = Container::around([("drum", Part::drum(DVec2::ZERO, 5.0)?)])?;
    let shared = |r: f64, s: f64| {
        // The lens of a circle of radius r about the origin and one of radius s about (5, 0).
        let (d, cosine) = (5.0, |a: f64, b: f64| (25.0 + a * a - b * b) / (10.0 * a));
        let (one, two) = (cosine(r, s).acos(), cosine(s, r).acos());
        r * r * one + s * s * two - d * r * one.sin()
    };
    let in_rim = drum.with_pegs([disk(5.0, 0.0, 1.0)?])?;
    whole(&in_rim, 25.0 * PI - shared(5.0, 1.0), PI * 20.25 - shared(4.5, 1.5));
    Ok(())
}

/// A block inside an obstacle takes nothing more.
#[test]
fn a_thin_block_inside_an_obstacle_counts_once() -> Result<(), Failure> {
    let obstacle = Disk::new(DVec2::splat(10.0), 6.0)?;
    for width in [0.001, 0.03, 1.0] {
        let [low, high] = [9.3 - 0.5 * width, 9.3 + 0.5 * width];
        let block = Part::block(points([(low, 5.0), (high, 5.0), (high, 15.0), (low, 15.0)]))?;
        let vessel =
            Container::closed(20.0, 20.0)?.with_part("block", block.rotated(DVec2::splat(10.0), 0.3)?)?;
        let one = vessel.with_pegs([obstacle])?;
        is(&one, &everywhere(&one), 0.0, 0.0, 400.0 - 36.0 * PI);
    }
    Ok(())
}

/// An obstacle whose circle hardly meets the circles of small pegs has the area of one more peg.
#[test]
fn obstacles_beside_narrow_features_of_parts() -> Result<(), Failure> {
    let obstacle = Disk::new(DVec2::splat(6.0), 0.7)?;
    for away in [0.72, 0.9, 1.1, 1.3, 1.42] {
        for turn in [0.1, 1.3, 2.9, 4.4] {
            let place = obstacle.position() + away * DVec2::from_angle(turn);
            let vessel = Container::closed(13.0, 13.0)?.with_part("peg", Part::peg(place, 0.05)?)?;
            let both =
                vessel.clone().with_part("obstacle", Part::peg(obstacle.position(), obstacle.radius())?)?;
            let one = vessel.with_pegs([obstacle])?;
            for radius in [0.0, 0.05, 0.15, 0.5] {
                for region in [everywhere(&both), square(DVec2::new(6.2, 6.4), 1.1)] {
                    let [one, two] = [one.area(&region, radius, 0.0), both.area(&region, radius, 0.0)];
                    let off = one.zip(two).map_or(f64::NAN, |(one, two)| (one - two).abs());
                    assert!(off < 1e-9, "{away} {turn} {radius} {region:?}: {one:?} instead of {two:?}");
                }
            }
        }
    }
    Ok(())
}

#[test]
fn moving_parts_take_their_area_along() -> Result<(), Failure> {
    let paddle = Part::block(points([(3.0, 4.5), (7.0, 4.5), (7.0, 5.5), (3.0, 5.5)]))?;
    let paddle = paddle.with_rotation(DVec2::splat(5.0), 1.0)?;
    let drum = Part::drum(DVec2::splat(5.0), 5.0)?;
    let stirred = Container::around([("drum", drum), ("paddle", paddle)])?;
    for time in [0.0, 0.3, 1.1, 4.0] {
        is(&stirred, &everywhere(&stirred), 0.0, time, 25.0 * PI - 4.0);
        is(&stirred, &everywhere(&stirred), 0.5, time, 20.25 * PI - 4.0 - 5.0 - PI * 0.25);
    }
    let by_chance_too = square(DVec2::new(6.0, 6.0), 1.5);
    by_chance(&stirred, &by_chance_too, 0.2, 1.1);
    Ok(())
}

#[test]
fn open_lines_are_as_the_engine_sees_them() -> Result<(), Failure> {
    // A bowl, and a ramp in a corner: disks are free on one side of each.
    let bowl = Part::new([Brick::arc(DVec2::new(5.0, 5.0), 5.0, PI, 2.0 * PI)?])?;
    let bowl = Container::closed(10.0, 10.0)?.with_part("bowl", bowl)?;
    whole(&bowl, 50.0 + 12.5 * PI, 9.0 * 4.5 + 0.5 * PI * 4.5 * 4.5);
    let ramp = Part::new([Brick::segment(DVec2::new(0.0, 3.0), DVec2::new(4.0, 0.0))?])?;
    let ramp = Container::closed(10.0, 10.0)?.with_part("ramp", ramp)?;
    is(&ramp, &everywhere(&ramp), 0.0, 0.0, 94.0);
    by_chance(&ramp, &everywhere(&ramp), 0.5, 0.0);
    Ok(())
}

#[test]
fn heaps_of_parts_by_chance() -> Result<(), Failure> {
    let mut generator = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut uniform =
        |low: f64, high: f64| low + (high - low) * (generator.next_u64() as f64 / 2.0_f64.powi(64));
    for case in few(0..12, 2) {
        let container = Container::closed(10.0, 10.0)?;
        let container = if case % 3 == 0 { container.with_periodic_sides()? } else { container };
        let mut vessel = container;
        for number in 0..5 {
            let center = DVec2::new(uniform(0.0, 10.0), uniform(0.0, 10.0));
            let (size, angle) = (uniform(0.2, 1.8), uniform(0.0, 6.0));
            let corner = |k: u32| center + size * DVec2::from_angle(angle + f64::from(k) * 1.25);
            let part = match number % 3 {
                0 => Part::peg(center, size)?,
                1 => Part::block((0..5).map(corner))?,
                _ => Part::polyline((0..3).map(corner))?,
            };
            let part = if number == 1 { part.with_rotation(center + size, 0.7)? } else { part };
            vessel.add_part(format!("part {number}"), part)?;
        }
        for radius in [0.0, 0.3] {
            by_chance(&vessel, &everywhere(&vessel), radius, 0.4);
            by_chance(&vessel, &square(DVec2::new(uniform(2.0, 8.0), uniform(2.0, 8.0)), 2.0), radius, 1.7);
        }
        // Whatever is cut into layers adds up.
        let layer = |k: u32| Region::new(DVec2::new(-1.0, f64::from(k)), DVec2::new(11.0, f64::from(k + 1)));
        let layers: f64 = (0..10).filter_map(|k| vessel.area(&layer(k), 0.3, 0.4)).sum();
        is(&vessel, &everywhere(&vessel), 0.3, 0.4, layers);
    }
    Ok(())
}

/// A block that only some disks see leaves them less room than the others. A thin wall takes no area.
#[test]
fn an_inside_for_some_kinds_has_no_area_for_all() -> Result<(), Failure> {
    let corners = || points([(3.0, 2.0), (9.0, 2.0), (9.0, 7.0), (3.0, 7.0)]);
    let boxed = |part: Part| Container::closed(12.0, 9.0)?.with_part("part", part);
    let area = |vessel: &Container, radius| vessel.area(&everywhere(vessel), radius, 0.0);
    let middle = DVec2::new(6.0, 4.0);
    let back = Part::new([Brick::segment(middle, DVec2::new(9.0, 4.0))?])?;
    for part in [Part::block(corners())?, Part::polygon(corners())?, Part::peg(middle, 1.0)?, back] {
        for kind in [Kind::DEFAULT, Kind::new(1)] {
            let vessel = boxed(part.clone().only_for([kind]))?;
            assert_eq!((area(&vessel, 0.0), area(&vessel, 0.5)), (None, None), "{part:?}");
            assert_eq!(
                vessel.with_pegs([Disk::new(DVec2::ONE, 0.2)?])?.area(&square(middle, 9.0), 0.0, 0.0),
                None
            );
        }
        assert!(area(&boxed(part)?, 0.0).is_some());
    }
    // Disks may be behind a line that takes their centers.
    let sink = boxed(Part::block(corners())?.absorbing_centers().only_for([Kind::new(1)]))?;
    assert_eq!(area(&sink, 0.0), Some(108.0));
    let sieve = boxed(Part::polyline(corners())?.only_for([Kind::new(1)]))?;
    whole(&sieve, 108.0, 88.0);
    Ok(())
}
