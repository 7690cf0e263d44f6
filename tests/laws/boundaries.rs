//! Boundaries that break their contract.

use granular_edmd::boundary::{
    Boundary, Container, Domain, FirstTouch, Impact, Overlap, Part, Probe, Reaction, Region, Surface, Touch,
    Wall, laws,
};
use granular_edmd::glam::DVec2;
use granular_edmd::wall::{BiParabolic, Piston, Sinusoidal};
use granular_edmd::{Disk, Flight, Kind, ParameterError};

use crate::{Fault, blind, honest, informed, judge, one_in, survivor};

/// A search for the first touch of the honest boundary, changed.
type Search = dyn Fn(&dyn Boundary, &Flight, f64) -> FirstTouch<Touch>;

/// An honest boundary behind functions that change its answers. At first, they change nothing.
struct Altered {
    honest: Box<dyn Boundary>,
    /// The last origin that was given.
    since: f64,
    origin: fn(f64) -> f64,
    /// The origin, and the domain.
    domain: fn(f64, Domain) -> Domain,
    interior: fn(Domain) -> Domain,
    may_touch: fn(&dyn Boundary, &Region, f64) -> bool,
    touch: Box<Search>,
    /// The surface, the position of the disk, and the time.
    surface: fn(&mut Surface<'_>, DVec2, f64),
    overlap: fn(&dyn Boundary, &Probe) -> Option<Overlap>,
    area: fn(f64, &Region) -> f64,
    react: fn(&mut dyn Boundary, &Impact) -> Reaction,
    /// The answer, the wall and the region.
    may_meet: fn(bool, usize, &Region) -> bool,
    state: fn(Vec<f64>) -> Vec<f64>,
    restored: fn(&[f64]) -> Vec<f64>,
}

impl Altered {
    fn new(honest: impl Boundary + 'static) -> Self {
        Self {
            honest: Box::new(honest),
            since: 0.0,
            origin: |origin| origin,
            domain: |_, domain| domain,
            interior: |domain| domain,
            may_touch: |honest, region, radius| honest.may_touch(region, radius),
            touch: Box::new(|honest, flight, until| honest.first_touch(flight, until)),
            surface: |_, _, _| (),
            overlap: |honest, probe| honest.overlap(probe),
            area: |area, _| area,
            react: |honest, impact| honest.react(impact),
            may_meet: |answer, _, _| answer,
            state: |state| state,
            restored: <[f64]>::to_vec,
        }
    }

    fn surface(self, surface: fn(&mut Surface<'_>, DVec2, f64)) -> Self {
        Self { surface, ..self }
    }

    fn touch(self, touch: impl Fn(&dyn Boundary, &Flight, f64) -> FirstTouch<Touch> + 'static) -> Self {
        Self { touch: Box::new(touch), ..self }
    }

    /// Misses the touches for which the condition holds.
    fn missing(self, is_missed: impl Fn(&Flight, Touch) -> bool + 'static) -> Self {
        self.touch(move |honest, flight, until| match honest.first_touch(flight, until) {
            FirstTouch::At(touch) if is_missed(flight, touch) => FirstTouch::NONE,
            other => other,
        })
    }

    fn renamed(self, name: fn(usize) -> usize) -> Self {
        self.touch(move |honest, flight, until| {
            honest.first_touch(flight, until).map(|touch| Touch::new(touch.time, name(touch.wall)))
        })
    }

    /// Finds touches late by this share of the radius, or early if it is negative.
    fn late(self, share: f64) -> Self {
        self.touch(move |honest, flight, until| {
            let found = honest.first_touch(flight, until);
            let FirstTouch::At(touch) = found else { return found };
            let surface = honest.surface(touch.wall, flight.position(touch.time), touch.time);
            let speed = (flight.velocity(touch.time) - surface.velocity).dot(surface.normal).abs();
            let wait = share * flight.radius() / speed.max(1e-3);
            found.map(|touch| Touch::new((touch.time + wait).clamp(flight.time(), until), touch.wall))
        })
    }
}

impl Boundary for Altered {
    fn domain(&self) -> Domain {
        (self.domain)(self.since, self.honest.domain())
    }

    fn interior(&self) -> Domain {
        (self.interior)(self.honest.interior())
    }

    fn wall_count(&self) -> usize {
        self.honest.wall_count()
    }

    fn set_time_origin(&mut self, origin: f64) {
        self.since = origin;
        self.honest.set_time_origin((self.origin)(origin));
    }

    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        (self.may_touch)(&*self.honest, region, radius)
    }

    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        (self.touch)(&*self.honest, flight, until)
    }

    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        let mut surface = self.honest.surface(wall, position, time);
        (self.surface)(&mut surface, position, time);
        surface
    }

    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        (self.overlap)(&*self.honest, probe)
    }

    fn area(&self, region: &Region, radius: f64, time: f64) -> Option<f64> {
        self.honest.area(region, radius, time).map(|area| (self.area)(area, region))
    }

    fn react(&mut self, impact: &Impact) -> Reaction {
        (self.react)(&mut *self.honest, impact)
    }

    fn may_meet(&self, wall: usize, region: &Region, radius: f64, until: f64) -> bool {
        (self.may_meet)(self.honest.may_meet(wall, region, radius, until), wall, region)
    }

    fn state(&self) -> Vec<f64> {
        (self.state)(self.honest.state())
    }

    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        self.honest.set_state(&(self.restored)(state))
    }
}

fn resting() -> Container {
    Container::closed(10.0, 12.0).expect("a size")
}

fn shaken() -> Altered {
    let motion = BiParabolic::new(0.2, 6.0).expect("an amplitude");
    Altered::new(resting().with_motion(Wall::Floor, motion).expect("a floor"))
}

/// A box with a floor that slides to the right and back.
fn sliding() -> Altered {
    let motion = Sinusoidal::new(0.3, 2.0).expect("an amplitude");
    Altered::new(resting().with_sliding(Wall::Floor, motion).expect("a floor"))
}

fn dish() -> Altered {
    let drum = Part::drum(DVec2::splat(6.0), 6.0).expect("a radius");
    Altered::new(Container::around([("dish", drum)]).expect("a drum"))
}

/// A box with a peg about the point (5, 6).
fn board() -> Altered {
    let peg = Disk::new(DVec2::new(5.0, 6.0), 1.5).expect("a radius");
    Altered::new(resting().with_pegs([peg]).expect("a peg"))
}

/// A box with a bar that turns about the point (5, 6).
fn stirred() -> Altered {
    let bar = Part::polyline([DVec2::new(4.0, 6.0), DVec2::new(6.0, 6.0)]).expect("a bar");
    let bar = bar.with_rotation(DVec2::new(5.0, 6.0), 0.7).expect("a rotation");
    Altered::new(resting().with_part("bar", bar).expect("a bar"))
}

/// A periodic box with a peg on the seam.
fn torus() -> Altered {
    let peg = Part::peg(DVec2::new(0.0, 6.0), 1.0).expect("a radius");
    let torus = Container::periodic(10.0, 12.0).expect("a size");
    Altered::new(torus.with_part("peg", peg).expect("a peg"))
}

/// A box with a heavy lid on a spring.
fn sprung() -> Altered {
    let lid = Piston::new(50.0, [-2.0, 2.0]).and_then(|lid| lid.with_spring(100.0, 0.0));
    Altered::new(resting().with_piston(Wall::Lid, lid.expect("a mass")).expect("a lid"))
}

fn surfaces() -> Vec<Fault<Altered>> {
    vec![
        blind(
            "the floor is faster than its geometry by 1e-5",
            shaken().surface(|surface, _, _| surface.velocity *= 1.0 + 1e-5),
        ),
        informed(
            "the floor is faster near the right side, by 1e-4",
            shaken().surface(|surface, position, _| {
                surface.velocity.y += if position.x > 9.0 { 1e-4 } else { 0.0 };
            }),
        ),
        survivor(
            "the floor forgets that it slides",
            sliding().surface(|surface, _, _| surface.velocity.x = 0.0),
        ),
        blind(
            "the normal of a dish is turned by 1e-5",
            dish().surface(|surface, _, _| surface.normal += 1e-5 * surface.normal.perp()),
        ),
        informed(
            "the normals of a peg are those of an oval",
            board().surface(|surface, position, _| {
                if surface.radius.is_finite() {
                    surface.normal = ((position - DVec2::new(5.0, 6.0)) * DVec2::new(1.0, 1.001)).normalize();
                }
            }),
        ),
        blind(
            "the hollow dish has a positive radius",
            dish().surface(|surface, _, _| surface.radius *= -1.0),
        ),
        informed(
            "straight walls have a radius of 1000",
            shaken().surface(|surface, _, _| surface.radius = surface.radius.min(1e3)),
        ),
        blind(
            "a turning bar has no angular velocity",
            stirred().surface(|surface, _, _| surface.angular_velocity = 0.0),
        ),
        informed(
            "a sliding floor turns near its right end",
            sliding().surface(|surface, position, _| {
                surface.angular_velocity = if position.x > 9.0 { 0.01 } else { 0.0 };
            }),
        ),
        informed(
            "the kind of walls depends on the offset",
            shaken().surface(|surface, _, time| surface.kind = Kind::new((time as u16) % 2)),
        ),
    ]
}

fn touches() -> Vec<Fault<Altered>> {
    let [often, last] = [one_in(5), one_in(11)];
    vec![
        blind(
            "flights that begin at a speed of 0.9 to 1.2 touch nothing",
            shaken().missing(|flight, _| (0.9..1.2).contains(&flight.velocity(flight.time()).length())),
        ),
        informed(
            "the peg is missed by disks smaller than 0.4",
            board().missing(|flight, touch| touch.wall >= 4 && flight.radius() < 0.4),
        ),
        blind("touches are early by 1e-5 of the radius", shaken().late(-1e-5)),
        survivor("touches are early by 1e-9 of the radius", shaken().late(-1e-9)),
        informed("the two sides are exchanged", shaken().renamed(|wall| [0, 2, 1, 3][wall.min(3)])),
        blind(
            "a touch after the end of the search is reported",
            shaken().touch(|honest, flight, until| honest.first_touch(flight, until + 1.0)),
        ),
        blind(
            "a disk that overlaps and leaves touches at once",
            shaken().touch(|honest, flight, until| {
                let probe = Probe::new(flight.position(flight.time()), flight.radius(), flight.time());
                let overlap = honest.overlap(&probe.with_kind(flight.kind()));
                let touch = overlap.map(|found| FirstTouch::At(Touch::new(flight.time(), found.with)));
                touch.unwrap_or_else(|| honest.first_touch(flight, until))
            }),
        ),
        blind(
            "a search comes no further than its start",
            shaken().touch(|_, flight, _| FirstTouch::NotBefore(flight.time())),
        ),
        blind("one touch in five is missed", shaken().missing(move |_, _| often())),
        informed(
            "one touch in eleven is later by the last bit",
            shaken().touch(move |honest, flight, until| {
                let time = |time: f64| if last() { time.next_up().min(until) } else { time };
                honest.first_touch(flight, until).map(|touch| Touch::new(time(touch.time), touch.wall))
            }),
        ),
    ]
}

fn overlaps_and_areas() -> Vec<Fault<Altered>> {
    vec![
        blind(
            "an overlap is too deep by 1e-3 of itself",
            Altered {
                overlap: |honest, probe| {
                    honest.overlap(probe).map(|found| Overlap::new(found.with, 1.001 * found.depth))
                },
                ..dish()
            },
        ),
        informed(
            "kind 2 overlaps no lid",
            Altered {
                overlap: |honest, probe| {
                    honest.overlap(probe).filter(|found| probe.kind() != Kind::new(2) || found.with != 3)
                },
                ..shaken()
            },
        ),
        blind(
            "the left half of a peg on the seam is forgotten",
            Altered {
                overlap: |honest, probe| honest.overlap(probe).filter(|_| probe.position().x < 5.0),
                ..torus()
            },
        ),
        blind("the whole box is full", Altered { overlap: |_, _| Some(Overlap::new(0, 1.0)), ..shaken() }),
        blind(
            "the free area is too large by a hundredth",
            Altered { area: |area, _| 1.01 * area, ..shaken() },
        ),
        informed(
            "regions that begin left of the box have a hundredth more",
            Altered { area: |area, region| if region.min.x < 0.0 { area + 0.01 } else { area }, ..shaken() },
        ),
    ]
}

fn frames() -> Vec<Fault<Altered>> {
    vec![
        blind(
            "a region is touched where its middle is",
            Altered {
                may_touch: |honest, region, radius| {
                    let middle = 0.5 * (region.min + region.max);
                    honest.may_touch(&Region::new(middle, middle), radius)
                },
                ..shaken()
            },
        ),
        informed(
            "a region that reaches to infinity is free",
            Altered {
                may_touch: |honest, region, radius| {
                    region.min.is_finite() && region.max.is_finite() && honest.may_touch(region, radius)
                },
                ..shaken()
            },
        ),
        blind(
            "the domain follows the floor",
            Altered {
                domain: |since, domain| {
                    Domain::new(domain.left, domain.right, 0.1 * (0.3 * since).sin(), domain.top)
                },
                ..shaken()
            },
        ),
        blind(
            "the domain leaves out the centers of small disks",
            Altered {
                domain: |_, domain| Domain::new(1.0, 9.0, domain.bottom, domain.top),
                interior: |inside| Domain::new(1.0, 9.0, inside.bottom, inside.top),
                ..shaken()
            },
        ),
        blind(
            "the interior reaches beyond the domain",
            Altered {
                interior: |inside| Domain::new(inside.left, inside.right + 2.0, inside.bottom, inside.top),
                ..shaken()
            },
        ),
        blind("the origin is forgotten", Altered { origin: |_| 0.0, ..shaken() }),
    ]
}

fn reactions() -> Vec<Fault<Altered>> {
    vec![
        blind(
            "the lid takes an impulse that is too large by 1e-6",
            Altered {
                react: |honest, impact| {
                    let more = (1.0 + 1e-6) * impact.impulse;
                    honest.react(&Impact::new(impact.wall, more, impact.point, impact.time))
                },
                ..sprung()
            },
        ),
        informed(
            "the lid jumps at each blow",
            Altered {
                react: |honest, impact| {
                    let reaction = honest.react(impact);
                    let mut state = honest.state();
                    state[1] += if reaction == Reaction::Moved { 1e-3 } else { 0.0 };
                    honest.set_state(&state).expect("a state");
                    reaction
                },
                ..sprung()
            },
        ),
        blind(
            "the lid reacts, but its surface has an infinite mass",
            sprung().surface(|surface, _, _| surface.mass = f64::INFINITY),
        ),
        blind("the lid meets nobody after a blow", Altered { may_meet: |_, _, _| false, ..sprung() }),
        informed(
            "the lid meets only what is above its place at rest",
            Altered {
                may_meet: |answer, wall, region| answer && (wall != 3 || region.max.y > 11.4),
                ..sprung()
            },
        ),
        blind(
            "the state is in single precision",
            Altered {
                state: |state| state.iter().map(|&number| f64::from(number as f32)).collect(),
                ..sprung()
            },
        ),
        informed(
            "a state that is too long is accepted",
            Altered { restored: |state| state.iter().take(3).copied().collect(), ..sprung() },
        ),
        honest("shaken", shaken()),
        honest("sliding", sliding()),
        honest("dish", dish()),
        honest("stirred", stirred()),
        honest("board", board()),
        honest("torus", torus()),
        honest("sprung", sprung()),
    ]
}

/// A violation names the law, the numbers and the flight that show it.
#[test]
fn violations_name_their_numbers() {
    let violation =
        laws::check(&mut shaken().renamed(|wall| wall + 4), 0.5, 1.0, 1).expect_err("a violation");
    let text = violation.to_string();
    assert!(text.starts_with("boundary, law \"touched wall\": wall "), "{text}");
    assert!(text.contains("but there are 4, on Flight"), "{text}");
}

#[test]
fn the_check_of_boundaries_finds_planted_faults() {
    let all = [surfaces(), touches(), overlaps_and_areas(), frames(), reactions()];
    judge("boundary", all.into_iter().flatten().collect(), |mut boundary: Altered| {
        (1..=3).try_for_each(|seed| laws::check(&mut boundary, 0.5, 1.0, seed))
    });
}
