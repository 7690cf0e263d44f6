//! Boundaries that break their contract.

pub(in crate::faults) mod altered;
pub(in crate::faults) mod bases;
mod reacting;
mod touches;

use granular_edmd::boundary::{Boundary, Domain, FirstTouch, Overlap, Probe, Region, Surface, Touch};
use granular_edmd::glam::DVec2;
use granular_edmd::wall::WallMotion;
use granular_edmd::{Fingerprint, Flight};

use crate::faults::{List, Planted, tenth};
use altered::Altered;
use bases::{
    Rotor, Sprung, board, common_area, dish, floor_motion, measured, resting, shaken, sliding, stirred,
};

/// A boundary, with a radius of disks that fit into it, and gravity.
pub(crate) struct Walled {
    pub(crate) boundary: Box<dyn Boundary>,
    pub(crate) radius: f64,
    pub(crate) gravity: f64,
}

/// The catalogue while it grows.
type Boundaries = List<Walled>;

impl Boundaries {
    fn add(&mut self, name: impl Into<String>, boundary: impl Boundary + 'static) {
        let walled = Walled { boundary: Box::new(boundary), radius: 0.5, gravity: 1.0 };
        self.plant(name, walled);
    }

    /// Adds a boundary whose surfaces are changed.
    fn add_surface<F>(&mut self, name: impl Into<String>, honest: Altered, change: F)
    where
        F: Fn(&mut Surface<'_>, DVec2, f64) + 'static,
    {
        self.add(name, Altered { surface: Box::new(change), ..honest });
    }

    fn add_touch<F>(&mut self, name: impl Into<String>, honest: Altered, touch: F)
    where
        F: Fn(&dyn Boundary, &Flight, f64) -> FirstTouch<Touch> + 'static,
    {
        self.add(name, Altered { touch: Box::new(touch), ..honest });
    }

    fn add_overlap<F>(&mut self, name: impl Into<String>, honest: Altered, overlap: F)
    where
        F: Fn(&dyn Boundary, &Probe) -> Option<Overlap> + 'static,
    {
        self.add(name, Altered { overlap: Box::new(overlap), ..honest });
    }
}

/// Returns the same boundary with this fingerprint.
pub(crate) fn marked(honest: impl Boundary + 'static, mark: Fingerprint) -> Box<dyn Boundary> {
    Box::new(Altered { mark: Some(mark), ..Altered::new(honest) })
}

/// Returns the boundaries on which faults are planted.
pub(crate) fn honest() -> Vec<Planted<Walled>> {
    let mut boundaries = Boundaries::default();
    for (name, boundary) in
        [("shaken", shaken()), ("sliding", sliding()), ("dish", dish()), ("stirred", stirred())]
    {
        boundaries.add(name, boundary);
    }
    boundaries.add("measured", measured());
    boundaries.add("board", Altered::new(board()));
    boundaries.add("sieve", bases::sieve(bases::GHOST));
    boundaries.add("sprung", Altered::new(Sprung::new()));
    boundaries.add("carriage", Altered::new(Sprung::with_ceiling()));
    boundaries.add("rotor", Altered::new(Rotor::new()));
    boundaries.faults
}

pub(crate) fn catalogue() -> Vec<Planted<Walled>> {
    let walls: [fn(&mut Boundaries); 8] =
        [velocities, origins, normals, curvatures, overlaps, areas, regions, frames];
    List::grown(&[&walls[..], &[touches::plant, touches::plant_kinds, reacting::plant]].concat())
}

fn is_floor(surface: &Surface<'_>) -> bool {
    surface.normal.y > 0.5
}

/// The velocity is that "of the wall": the rate at which its points move.
fn velocities(boundaries: &mut Boundaries) {
    boundaries.family = "velocity";
    for n in [1, 2, 3, 5, 7] {
        let (size, name) = (tenth(n), format!("the floor is faster than its geometry by 1e-{n}"));
        boundaries.add_surface(name, shaken(), move |surface, _, _| surface.velocity *= 1.0 + size);
    }
    for n in [1, 3, 5] {
        let (size, name) = (tenth(n), format!("the bar turns faster than its geometry by 1e-{n}"));
        boundaries.add_surface(name, stirred(), move |surface, _, _| surface.velocity *= 1.0 + size);
    }
    boundaries.add_surface("the floor is at rest as a surface", shaken(), |surface, _, _| {
        surface.velocity = DVec2::ZERO;
    });
    boundaries.add_surface("the velocity has the wrong sign", shaken(), |surface, _, _| {
        surface.velocity *= -1.0;
    });
    boundaries.add_surface(
        "the velocity is not a number where the floor turns",
        shaken(),
        |surface, _, _| {
            if is_floor(surface) && surface.velocity.y.abs() < 0.05 {
                surface.velocity.y = f64::NAN;
            }
        },
    );
    boundaries.add_surface("the bar forgets the velocity along itself", stirred(), |surface, _, _| {
        surface.velocity = surface.velocity.dot(surface.normal) * surface.normal;
    });
    boundaries.add_surface("the floor forgets that it slides", sliding(), |surface, _, _| {
        surface.velocity.x = 0.0;
    });
    boundaries.add_surface("the bar turns about the corner of the box", stirred(), |surface, position, _| {
        if surface.velocity != DVec2::ZERO {
            surface.velocity = 0.7 * position.perp();
        }
    });
    boundaries.add_surface(
        "the bar turns as its disk, and not as the point of touch",
        stirred(),
        |surface, position, _| {
            if surface.velocity != DVec2::ZERO {
                surface.velocity = 0.7 * (position - DVec2::new(5.0, 6.0)).perp();
            }
        },
    );
}

/// "Another origin changes only the numbers by which times are given."
fn origins(boundaries: &mut Boundaries) {
    type Pass = fn(f64, f64) -> f64;
    let motion = floor_motion();
    boundaries.family = "origin";
    boundaries.add_surface(
        "the velocity of the floor forgets the origin",
        shaken(),
        move |surface, _, time| {
            if is_floor(surface) {
                surface.velocity.y = motion.state(time).velocity;
            }
        },
    );
    boundaries.add_surface("the sliding of the floor forgets the origin", sliding(), |surface, _, time| {
        if is_floor(surface) {
            surface.velocity.x = 0.6 * (2.0 * time).cos();
        }
    });
    for n in [1, 3, 6] {
        let (size, name) = (tenth(n), format!("the origin is wrong by 1e-{n} of itself"));
        let origin = Box::new(move |_: f64, origin: f64| (1.0 + size) * origin);
        boundaries.add(name, Altered { origin, ..shaken() });
    }
    let passes: [(&str, Pass); 5] = [
        ("the origin is forgotten", |_, _| 0.0),
        ("origins add up", |last, origin| last + origin),
        ("each origin counts when the next one comes", |last, _| last),
        ("the origin is kept in single precision", |_, origin| f64::from(origin as f32)),
        ("origins below 1000 do not count", |_, origin| if origin < 1000.0 { 0.0 } else { origin }),
    ];
    for (name, pass) in passes {
        boundaries.add(name, Altered { origin: Box::new(pass), ..shaken() });
        boundaries
            .add(format!("{name}, of a bar that turns"), Altered { origin: Box::new(pass), ..stirred() });
    }
}

/// "A unit normal that points from the wall to the disk."
fn normals(boundaries: &mut Boundaries) {
    boundaries.family = "normal";
    for n in [1, 2, 3, 5, 7] {
        let turn = DVec2::from_angle(tenth(n));
        let name = format!("the normal of a dish is turned by 1e-{n}");
        boundaries
            .add_surface(name, dish(), move |surface, _, _| surface.normal = turn.rotate(surface.normal));
        let name = format!("the normal of a floor is turned by 1e-{n}");
        boundaries.add_surface(name, shaken(), move |surface, _, _| {
            if is_floor(surface) {
                surface.normal = turn.rotate(surface.normal);
            }
        });
    }
    for n in [1, 3, 6, 9] {
        let (size, name) = (tenth(n), format!("the normal is longer than 1 by 1e-{n}"));
        boundaries.add_surface(name, dish(), move |surface, _, _| surface.normal *= 1.0 + size);
    }
    boundaries.add_surface("the normal of the lid points into it", shaken(), |surface, _, _| {
        surface.normal.y = surface.normal.y.abs();
    });
    boundaries.add_surface(
        "near a corner, the floor has the normal of the side",
        shaken(),
        |surface, position, _| {
            if is_floor(surface) && position.x < 1.0 {
                surface.normal = DVec2::X;
            }
        },
    );
    boundaries.add_surface("the normal of the bar is that at time 0", stirred(), |surface, position, _| {
        let away = position - DVec2::new(5.0, 6.0);
        if away.length() < 1.6 {
            surface.normal = DVec2::new(0.0, 1_f64.copysign(away.y));
        }
    });
}

/// "Radius of the surface: infinite if it is straight, negative if it is hollow."
fn curvatures(boundaries: &mut Boundaries) {
    boundaries.family = "curvature";
    for n in [1, 3, 6] {
        let (size, name) = (tenth(n), format!("the radius of the dish is too large by 1e-{n}"));
        boundaries.add_surface(name, dish(), move |surface, _, _| surface.radius *= 1.0 + size);
    }
    let board = || Altered::new(board());
    boundaries
        .add_surface("the hollow dish has a positive radius", dish(), |surface, _, _| surface.radius *= -1.0);
    boundaries.add_surface("the peg counts as hollow", board(), |surface, _, _| surface.radius *= -1.0);
    boundaries.add_surface("the peg has its curvature as radius", board(), |surface, _, _| {
        surface.radius = 1.0 / surface.radius;
    });
    boundaries
        .add_surface("the dish counts as straight", dish(), |surface, _, _| surface.radius = f64::INFINITY);
    boundaries.add_surface("the peg has the distance of the centers as radius", board(), |surface, _, _| {
        surface.radius += 0.5;
    });
}

/// "None for a disk inside, otherwise the depth to which the disk reaches into a wall."
fn overlaps(boundaries: &mut Boundaries) {
    boundaries.family = "overlap";
    for n in [1, 3, 5, 7] {
        let (size, name) = (tenth(n), format!("an overlap is too deep by 1e-{n} of itself"));
        boundaries.add_overlap(name, dish(), move |honest, probe| {
            honest.overlap(probe).map(|found| Overlap::new(found.with, (1.0 + size) * found.depth))
        });
        let name = format!("overlaps below 1e-{n} of the radius do not count");
        boundaries.add_overlap(name, shaken(), move |honest, probe| {
            honest.overlap(probe).filter(|found| found.depth > size * probe.radius())
        });
    }
    boundaries.add_overlap("an overlap is measured at time 0", shaken(), |honest, probe| {
        honest.overlap(&probe.with_time(0.0))
    });
    boundaries.add_overlap("all disks have a radius of 1/2", dish(), |honest, probe| {
        honest.overlap(&probe.with_radius(0.5))
    });
    boundaries.add_overlap("the wall that is named is always the first", shaken(), |honest, probe| {
        honest.overlap(probe).map(|found| Overlap::new(0, found.depth))
    });
    boundaries.add_overlap("a disk inside overlaps by a negative depth", shaken(), |honest, probe| {
        Some(honest.overlap(probe).unwrap_or(Overlap::new(0, -0.1)))
    });
}

/// "The area of the places in `region` at which the center of a disk of this radius is free."
fn areas(boundaries: &mut Boundaries) {
    type Area = fn(&Region, f64) -> f64;
    let areas: [(&str, Area); 4] = [
        ("the free area is too large by a hundredth", |region, radius| 1.01 * common_area(region, radius)),
        ("the free area is that of points", |region, _| common_area(region, 0.0)),
        ("the free area reaches into the walls", |region, _| {
            (region.max.x - region.min.x) * (region.max.y - region.min.y)
        }),
        ("the free area leaves out a diameter along the walls", |region, radius| {
            common_area(region, 2.0 * radius)
        }),
    ];
    boundaries.family = "area";
    for (name, area) in areas {
        let area = Box::new(move |_: Option<f64>, region: &Region, radius: f64| Some(area(region, radius)));
        boundaries.add(name, Altered { area, ..Altered::new(resting()) });
    }
}

/// "False only for a region in which no disk can touch a wall at any time", and true for every larger one.
fn regions(boundaries: &mut Boundaries) {
    type Answer = fn(&dyn Boundary, &Region, f64) -> bool;
    let answers: [(&str, Answer); 6] = [
        ("the touch of a region is that of its middle", |honest, region, radius| {
            let middle = 0.5 * (region.min + region.max);
            honest.may_touch(&Region::new(middle, middle), radius)
        }),
        ("disks are points where it is asked for a touch", |honest, region, _| honest.may_touch(region, 0.0)),
        ("regions to the left of 0.8 are free", |honest, region, radius| {
            region.max.x > 0.8 && honest.may_touch(region, radius)
        }),
        ("regions of more than half of the width are free", |honest, region, radius| {
            region.max.x - region.min.x < 5.0 && honest.may_touch(region, radius)
        }),
        ("a region that reaches to infinity is free", |honest, region, radius| {
            let is_finite = region.min.is_finite() && region.max.is_finite();
            is_finite && honest.may_touch(region, radius)
        }),
        (
            "a region above the floor at rest, by less than its amplitude, is free",
            |honest, region, radius| {
                let is_low = region.min.y - radius > 0.02 && region.max.y < 2.0;
                let is_aside = region.min.x > radius && region.max.x < 10.0 - radius;
                !(is_low && is_aside) && honest.may_touch(region, radius)
            },
        ),
    ];
    boundaries.family = "may touch";
    for (name, answer) in answers {
        boundaries.add(name, Altered { may_touch: Box::new(answer), ..shaken() });
    }
    boundaries.add(
        "the peg is left out",
        Altered {
            may_touch: Box::new(|_, region, radius| resting().may_touch(region, radius)),
            ..Altered::new(board())
        },
    );
}

/// "Domain, interior and number of walls never change. All centers stay in the domain."
fn frames(boundaries: &mut Boundaries) {
    type Frame = fn(f64, Domain) -> Domain;
    let frames: [(&str, Frame); 4] = [
        ("the domain follows the floor", |since, mut domain| {
            domain.bottom += 0.1 * (0.3 * since).sin();
            domain
        }),
        ("the domain grows with the time", |since, mut domain| {
            domain.top += 1e-6 * since.abs();
            domain
        }),
        ("the domain is the place of the centers of disks of radius 1", |_, mut domain| {
            (domain.left, domain.right) = (domain.left + 1.0, domain.right - 1.0);
            domain
        }),
        ("the bottom of the domain is infinite", |_, mut domain| {
            domain.bottom = f64::NEG_INFINITY;
            domain
        }),
    ];
    boundaries.family = "domain";
    for (name, frame) in frames {
        boundaries.add(name, Altered { domain: Box::new(frame), ..shaken() });
    }
    let interior = Box::new(|mut interior: Domain| {
        interior.right += 2.0;
        interior
    });
    boundaries.add("the interior reaches beyond the domain", Altered { interior, ..shaken() });
    let walls = Box::new(|since: f64, count: usize| if since > 0.0 { count - 1 } else { count });
    boundaries.add("a wall is gone after the first origin", Altered { walls, ..shaken() });
    boundaries.add(
        "there is one wall fewer than there are",
        Altered { walls: Box::new(|_, count| count - 1), ..shaken() },
    );
}
