//! Boundaries that break their contract where a check may not look.

mod acting;
mod floating;
mod halves;

use granular_edmd::boundary::{
    Boundary, FirstTouch, Obstacles, Overlap, Part, Probe, Region, Surface, Touch, Vessel, Wall,
};
use granular_edmd::glam::DVec2;
use granular_edmd::wall::Sinusoidal;
use granular_edmd::{Disk, Flight, Kind};

use crate::faults::blind::boundaries::Walled;
use crate::faults::blind::boundaries::altered::Altered;
use crate::faults::blind::boundaries::bases::{
    Rotor, Sprung, board, common_area, dish, measured, resting, shaken, sliding, stirred,
};
use crate::faults::{List, Planted, one_in, tenth};

type Boundaries = List<Walled>;

impl Boundaries {
    fn part(&mut self, family: &'static str, name: impl Into<String>, boundary: Altered) {
        self.family = family;
        self.plant(name, Walled { boundary: Box::new(boundary), radius: 0.5, gravity: 1.0 });
    }
}

fn sprung() -> Altered {
    Altered::new(Sprung::new())
}

fn rotor() -> Altered {
    Altered::new(Rotor::new())
}

fn pegs() -> Altered {
    Altered::new(board())
}

/// A peg around which a belt runs.
fn belt() -> Altered {
    let belt = Part::peg(DVec2::new(5.0, 6.0), 1.5).and_then(|peg| peg.with_surface_speed(0.4));
    Altered::new(Vessel::new(resting()).with("belt", belt.expect("a belt")).expect("a vessel"))
}

/// Four equal pegs that slide through a periodic box.
fn teeth() -> Altered {
    let slide = Sinusoidal::new(0.7, 2.0).expect("an amplitude");
    let empty = Vessel::new(resting().with_periodic_sides().expect("periodic sides"));
    Altered::new((0..4).fold(empty, |vessel, number| {
        let place = DVec2::new(1.0 + 2.5 * f64::from(number), 6.0);
        let peg = Part::peg(place, 0.8).and_then(|peg| peg.with_motion(DVec2::X, slide));
        vessel.with(format!("tooth {number}"), peg.expect("a peg")).expect("a vessel")
    }))
}

/// A box whose lid moves.
fn lidded() -> Altered {
    let motion = Sinusoidal::new(0.3, 4.0).expect("an amplitude");
    Altered::new(resting().with_motion(Wall::Lid, motion).expect("a lid"))
}

pub(crate) fn catalogue() -> Vec<Planted<Walled>> {
    List::grown(&[
        velocities,
        turnings,
        normals,
        radii,
        touches,
        searches,
        overlaps,
        areas,
        regions,
        origins,
        acting::plant,
        halves::plant,
        floating::plant,
    ])
}

pub(crate) fn honest() -> Vec<Planted<Walled>> {
    List::grown(&[
        |boundaries: &mut Boundaries| boundaries.plant("halves of a drum", halves::honest()),
        floating::honest,
    ])
}

fn velocities(boundaries: &mut Boundaries) {
    let surface = Box::new(|surface: &mut Surface<'_>, _, _| {
        if surface.normal.y < -0.5 {
            surface.velocity.y *= 0.999;
        }
    });
    boundaries.part("lid", "the lid is slower than its geometry by 1e-3", Altered { surface, ..lidded() });
    let surface = Box::new(|surface: &mut Surface<'_>, _, _| {
        if surface.velocity.y.abs() < 0.2 {
            surface.velocity.y = 0.0;
        }
    });
    boundaries.part("slow phase", "a slow floor counts as resting", Altered { surface, ..shaken() });
    let surface = Box::new(|surface: &mut Surface<'_>, position: DVec2, _| {
        if position.x > 9.0 {
            surface.velocity.y += 1e-4;
        }
    });
    boundaries.part(
        "near a side",
        "the floor is faster near the right side, by 1e-4",
        Altered { surface, ..shaken() },
    );
    let surface = Box::new(|surface: &mut Surface<'_>, _, time| {
        if time > 60.0 {
            surface.velocity *= 1.001;
        }
    });
    boundaries.part(
        "late offset",
        "surfaces are faster at offsets above 60",
        Altered { surface, ..shaken() },
    );
}

fn turnings(boundaries: &mut Boundaries) {
    type Change = fn(&mut Surface<'_>, DVec2);
    let all: [(&'static str, &str, fn() -> Altered, Change); 5] = [
        ("turning", "a turning bar has no angular velocity", stirred, |surface, _| {
            surface.angular_velocity = 0.0;
        }),
        ("turning", "a bar turns clockwise to rules", stirred, |surface, _| surface.angular_velocity *= -1.0),
        ("turning", "a bar turns faster to rules by 1e-4", stirred, |surface, _| {
            surface.angular_velocity *= 1.0001;
        }),
        ("turning", "a sliding floor turns near its right end", sliding, |surface, position| {
            surface.angular_velocity = if position.x > 9.0 { 0.01 } else { 0.0 };
        }),
        ("belt", "a belt around a peg does not turn", belt, |surface, _| surface.angular_velocity = 0.0),
    ];
    for (family, name, honest, change) in all {
        let surface = Box::new(move |surface: &mut Surface<'_>, position, _| change(surface, position));
        boundaries.part(family, name, Altered { surface, ..honest() });
    }
}

fn normals(boundaries: &mut Boundaries) {
    for n in [2, 4, 6] {
        let turn = DVec2::from_angle(tenth(n));
        let surface = Box::new(move |surface: &mut Surface<'_>, position: DVec2, _| {
            if position.x > 9.0 {
                surface.normal = turn.rotate(surface.normal);
            }
        });
        let name = format!("normals near the right end of the dish are turned by 1e-{n}");
        boundaries.part("some normals", name, Altered { surface, ..dish() });
    }
    let surface = Box::new(|surface: &mut Surface<'_>, position: DVec2, _| {
        if surface.radius.is_finite() {
            surface.normal = ((position - DVec2::new(5.0, 6.0)) * DVec2::new(1.0, 1.001)).normalize();
        }
    });
    boundaries.part("oval", "the normals of a peg are those of an oval", Altered { surface, ..pegs() });
}

fn radii(boundaries: &mut Boundaries) {
    for n in [2, 5] {
        let surface = Box::new(move |surface: &mut Surface<'_>, _, _| {
            if surface.radius.is_finite() {
                surface.radius *= 1.0 + tenth(n);
            }
        });
        boundaries.part(
            "peg radius",
            format!("the peg is larger by 1e-{n} to rules"),
            Altered { surface, ..pegs() },
        );
    }
    let small = Obstacles::new(resting(), [Disk::new(DVec2::new(5.0, 6.0), 0.2).expect("a radius")]);
    let surface = Box::new(|surface: &mut Surface<'_>, _, _| surface.radius *= 2.0);
    boundaries.part(
        "peg radius",
        "a peg smaller than the disks is twice as large to rules",
        Altered { surface, ..Altered::new(small) },
    );
    let surface = Box::new(|surface: &mut Surface<'_>, _, _| {
        if surface.radius == f64::INFINITY {
            surface.radius = 1e3;
        }
    });
    boundaries.part(
        "slight curvature",
        "straight walls have a radius of 1000",
        Altered { surface, ..shaken() },
    );
    let surface = Box::new(|surface: &mut Surface<'_>, _, _| surface.radius = 0.0);
    boundaries.part("no radius", "walls have a radius of 0", Altered { surface, ..shaken() });
}

fn touches(boundaries: &mut Boundaries) {
    type Touches = fn(&dyn Boundary, &Flight, f64) -> FirstTouch<Touch>;
    let all: [(&'static str, &str, Touches); 7] = [
        ("sideways pull", "a pull to the side is forgotten", |honest, flight, until| {
            let (start, pull) = (flight.time(), DVec2::new(0.0, flight.acceleration().y));
            let flight =
                Flight::new(start, flight.position(start), flight.velocity(start), pull, flight.radius())
                    .with_kind(flight.kind());
            honest.first_touch(&flight, until)
        }),
        ("one kind", "kind 7 touches no floor", |honest, flight, until| {
            match honest.first_touch(flight, until) {
                FirstTouch::At(touch) if flight.kind() == Kind::new(7) && touch.wall == 0 => FirstTouch::NONE,
                other => other,
            }
        }),
        ("small disks", "disks below 0.2 count as points", |honest, flight, until| {
            let start = flight.time();
            let radius = if flight.radius() < 0.2 { 1e-9 } else { flight.radius() };
            let (place, velocity) = (flight.position(start), flight.velocity(start));
            honest.first_touch(
                &Flight::new(start, place, velocity, flight.acceleration(), radius).with_kind(flight.kind()),
                until,
            )
        }),
        ("at rest", "disks slower than 1e-6 touch nothing", |honest, flight, until| {
            if flight.velocity(flight.time()).length() < 1e-6 {
                FirstTouch::NONE
            } else {
                honest.first_touch(flight, until)
            }
        }),
        ("late search", "a search later than 100 finds nothing", |honest, flight, until| {
            if flight.time() > 100.0 { FirstTouch::NONE } else { honest.first_touch(flight, until) }
        }),
        ("high side", "the right side ends at a height of 11.4", |honest, flight, until| {
            match honest.first_touch(flight, until) {
                FirstTouch::At(touch)
                    if flight.position(touch.time).x > 9.4 && flight.position(touch.time).y > 11.4 =>
                {
                    FirstTouch::NONE
                }
                other => other,
            }
        }),
        ("short search", "a search shorter than 1e-3 finds nothing", |honest, flight, until| {
            if until - flight.time() < 1e-3 { FirstTouch::NONE } else { honest.first_touch(flight, until) }
        }),
    ];
    for (family, name, touch) in all {
        boundaries.part(family, name, Altered { touch: Box::new(touch), ..shaken() });
    }
}

fn searches(boundaries: &mut Boundaries) {
    let is_due = one_in(11);
    let touch = Box::new(move |honest: &dyn Boundary, flight: &Flight, until| {
        honest.first_touch(flight, until).map(|touch| {
            Touch::new(if is_due() { touch.time.next_up().min(until) } else { touch.time }, touch.wall)
        })
    });
    boundaries.part(
        "wavering",
        "one touch in eleven is later by the last bit",
        Altered { touch, ..shaken() },
    );
    let is_due = one_in(50);
    let surface = Box::new(move |surface: &mut Surface<'_>, _, _| {
        if is_due() {
            surface.velocity.x += 0.1;
        }
    });
    boundaries.part("seldom", "one surface in fifty slides", Altered { surface, ..shaken() });
    let touch = Box::new(|honest: &dyn Boundary, flight: &Flight, until| {
        honest
            .first_touch(flight, until)
            .map(|touch| Touch::new(touch.time - 1e-9 * flight.radius(), touch.wall))
    });
    boundaries.part("rounding", "touches are early by 1e-9 of the radius", Altered { touch, ..shaken() });
}

fn overlaps(boundaries: &mut Boundaries) {
    type Overlaps = fn(&dyn Boundary, &Probe) -> Option<Overlap>;
    let all: [(&'static str, &str, Overlaps); 4] = [
        ("deep", "overlaps deeper than 0.01 are twice as deep", |honest, probe| {
            honest.overlap(probe).map(|found| {
                Overlap::new(found.with, if found.depth > 0.01 { 2.0 * found.depth } else { found.depth })
            })
        }),
        ("one kind", "kind 2 overlaps no lid", |honest, probe| {
            honest.overlap(probe).filter(|found| probe.kind() != Kind::new(2) || found.with != 1)
        }),
        ("shared name", "overlaps with the right side name the left one", |honest, probe| {
            honest
                .overlap(probe)
                .map(|found| Overlap::new(if probe.position().x > 9.0 { 1 } else { found.with }, found.depth))
        }),
        ("late", "at offsets above 80, nothing overlaps", |honest, probe| {
            honest.overlap(probe).filter(|_| probe.time() < 80.0)
        }),
    ];
    for (family, name, overlap) in all {
        boundaries.part(family, name, Altered { overlap: Box::new(overlap), ..shaken() });
    }
}

fn areas(boundaries: &mut Boundaries) {
    type Area = fn(f64, &Region, f64) -> f64;
    let all: [(&'static str, &str, Area); 5] = [
        ("narrow", "regions narrower than a ninth of the box are too large by 1e-2", |area, region, _| {
            if region.max.x - region.min.x < 1.0 { 1.01 * area } else { area }
        }),
        ("beyond", "regions that begin left of the box have a hundredth more", |area, region, _| {
            if region.min.x < 0.0 { area + 0.01 } else { area }
        }),
        ("corner", "the corners of the free area are rounded off", |area, region, radius| {
            let is_corner = region.min.x < radius && region.min.y < radius;
            if is_corner { area - 0.02 * area } else { area }
        }),
        ("small disks", "disks below 0.2 have the area of points", |area, region, radius| {
            if radius < 0.2 { common_area(region, 0.0) } else { area }
        }),
        ("scatter", "the free area is too large by 1e-4", |area, _, _| 1.0001 * area),
    ];
    for (family, name, area) in all {
        let area = Box::new(move |_: Option<f64>, region: &Region, radius: f64| {
            Some(area(common_area(region, radius), region, radius))
        });
        boundaries.part(family, name, Altered { area, ..measured() });
    }
    let hinged = Altered { points: Box::new(|_| 0.0), ..lidded() };
    boundaries.part("hinge", "the points of the walls stay while the lid moves", hinged);
    let stuck = Altered { points: Box::new(|_| 0.0), ..teeth() };
    boundaries.part("hinge", "the points of equal teeth stay while the teeth slide", stuck);
    let hasty = Altered { points: Box::new(|time| 2.9 * time), ..lidded() };
    boundaries.part("hinge", "the points of the walls come back before the lid", hasty);
}

fn regions(boundaries: &mut Boundaries) {
    type Answer = fn(&dyn Boundary, &Region, f64) -> bool;
    let all: [(&'static str, &str, Answer); 4] = [
        ("points", "a region without an area is free", |honest, region, radius| {
            (region.max - region.min).max_element() > 1e-6 && honest.may_touch(region, radius)
        }),
        ("tall", "regions that are higher than wide by ten are free", |honest, region, radius| {
            let size = region.max - region.min;
            size.y < 10.0 * size.x && honest.may_touch(region, radius)
        }),
        ("all", "the whole domain is free", |honest, region, radius| {
            (region.max.x - region.min.x) < 9.9 && honest.may_touch(region, radius)
        }),
        ("large disks", "disks above 0.7 touch nothing", |honest, region, radius| {
            radius < 0.7 && honest.may_touch(region, radius)
        }),
    ];
    for (family, name, answer) in all {
        boundaries.part(family, name, Altered { may_touch: Box::new(answer), ..shaken() });
    }
}

fn origins(boundaries: &mut Boundaries) {
    let origin = Box::new(|_, origin: f64| if origin > 1100.0 { 0.0 } else { origin });
    boundaries.part("late origin", "origins above 1100 are forgotten", Altered { origin, ..shaken() });
    let origin = Box::new(|_, origin: f64| if origin > 1e5 { 0.0 } else { origin });
    boundaries.part("very late origin", "origins above 1e5 are forgotten", Altered { origin, ..shaken() });
    let origin = Box::new(|_, origin: f64| origin + 1e-9 * origin);
    boundaries.part("slow clock", "the origin is wrong by 1e-9 of itself", Altered { origin, ..stirred() });
    let surface = Box::new(|surface: &mut Surface<'_>, _, time: f64| {
        if surface.normal.y > 0.5 {
            surface.velocity.x *= 1.0 + 1e-3 * time.sin();
        }
    });
    boundaries.part(
        "sliding",
        "the sliding of the floor depends on the offset by 1e-3",
        Altered { surface, ..sliding() },
    );
    let surface = Box::new(|surface: &mut Surface<'_>, _, time: f64| {
        surface.kind = Kind::new((time as u16) % 2);
    });
    boundaries.part("kind", "the kind of walls depends on the offset", Altered { surface, ..shaken() });
}
