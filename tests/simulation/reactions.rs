//! Walls with a mass that do not take what disks give them: each run ends at the first such blow.

use granular_edmd::boundary::{
    Boundary, Container, Domain, FirstTouch, Impact, Overlap, Probe, Reaction, Region, Response, Surface,
    Touch, Wall, laws,
};
use granular_edmd::collision::{Elastic, Rough};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{Collision, Partner, on_collision};
use granular_edmd::simulation::{BoundaryFault, RunError};
use granular_edmd::wall::Piston;
use granular_edmd::{Disk, Flight, ParameterError, Simulation, initial};
use support::cases::few;

/// The mass of the piston.
const MASS: f64 = 4.0;

/// Index of the right side of a closed container.
const RIGHT: usize = 2;

/// Index of its lid.
const LID: usize = 3;

type Answer = fn(&mut Container, &Impact) -> Reaction;

/// The surface that the piston shows, given its own.
type Look = fn(Surface<'_>) -> Surface<'_>;

/// A box with a piston for its right side, which takes impacts in its own way.
struct Deaf {
    honest: Container,
    answer: Answer,
    look: Look,
    has_state: bool,
}

impl Deaf {
    fn new(velocity: f64, answer: Answer) -> Self {
        let piston = Piston::new(MASS, [-50.0, 5.0]).unwrap().with_start(0.0, velocity).unwrap();
        let honest = Container::closed(12.0, 10.0).unwrap().with_piston(Wall::Right, piston).unwrap();
        Self { honest, answer, look: plain, has_state: true }
    }
}

impl Boundary for Deaf {
    fn domain(&self) -> Domain {
        self.honest.domain()
    }
    fn interior(&self) -> Domain {
        self.honest.interior()
    }
    fn wall_count(&self) -> usize {
        self.honest.wall_count()
    }
    fn set_time_origin(&mut self, origin: f64) {
        self.honest.set_time_origin(origin);
    }
    fn may_touch(&self, region: &Region, radius: f64) -> bool {
        self.honest.may_touch(region, radius)
    }
    fn first_touch(&self, flight: &Flight, until: f64) -> FirstTouch<Touch> {
        self.honest.first_touch(flight, until)
    }
    fn surface(&self, wall: usize, position: DVec2, time: f64) -> Surface<'_> {
        let surface = self.honest.surface(wall, position, time);
        if wall == RIGHT { (self.look)(surface) } else { surface }
    }
    fn overlap(&self, probe: &Probe) -> Option<Overlap> {
        self.honest.overlap(probe)
    }
    fn react(&mut self, impact: &Impact) -> Reaction {
        (self.answer)(&mut self.honest, impact)
    }
    fn may_meet(&self, wall: usize, region: &Region, radius: f64, until: f64) -> bool {
        self.honest.may_meet(wall, region, radius, until)
    }
    fn state(&self) -> Vec<f64> {
        if self.has_state { self.honest.state() } else { Vec::new() }
    }
    fn set_state(&mut self, state: &[f64]) -> Result<(), ParameterError> {
        self.honest.set_state(state)
    }
}

fn plain(own: Surface<'_>) -> Surface<'_> {
    own
}

fn sink(own: Surface<'_>) -> Surface<'_> {
    own.with_response(Response::Absorbing)
}

fn slanted(own: Surface<'_>) -> Surface<'_> {
    let along = 0.7 * own.velocity.dot(own.normal) * own.normal.perp();
    let mass = own.mass;
    Surface::new(own.normal, own.velocity + along).with_mass(mass).with_response(Response::Rule(&Elastic))
}

/// Returns a run of rough disks that keep their energy.
fn run_of(deaf: Deaf) -> Result<Simulation<Rough, Deaf>, Box<dyn std::error::Error>> {
    let disks = initial::lattice(&Container::closed(5.0, 9.0)?, 12, 0.5)?;
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 3)?;
    Ok(Simulation::builder(Rough::from_restitution(1.0, 1.0)?, deaf).disks(disks).build()?)
}

/// Returns the impact with a share of its impulse.
fn weaker(share: f64, impact: &Impact) -> Impact {
    Impact::new(impact.wall, share * impact.impulse, impact.point, impact.time)
}

#[test]
fn an_impulse_that_is_not_taken_is_named() -> Result<(), Box<dyn std::error::Error>> {
    let answers: [Answer; 6] = [
        |_, _| Reaction::None,
        |_, _| Reaction::Moved,
        |honest, impact| {
            honest.react(impact);
            Reaction::None
        },
        |honest, impact| honest.react(&weaker(-1.0, impact)),
        |honest, impact| honest.react(&weaker(1.001, impact)),
        |honest, impact| honest.react(&weaker(0.9, impact)),
    ];
    for (number, answer) in answers.into_iter().enumerate() {
        for look in [plain as Look, sink] {
            let mut run = run_of(Deaf { look, ..Deaf::new(0.3, answer) })?;
            let error = run.run_until(50.0, &mut ()).err().ok_or(format!("{number}: Ok"))?;
            let RunError::Boundary { fault: BoundaryFault::Reaction { wall, expected, found, .. }, .. } =
                error
            else {
                panic!("{number}: {error}")
            };
            assert_eq!(wall, RIGHT);
            let is_moved = expected.distance(found) < 1e-12;
            assert_eq!(is_moved, number == 2, "{number}: {expected} {found}");
            assert!(error.to_string().contains("`react` must"), "{error}");
        }
    }
    Ok(())
}

/// The run goes on from the state in which the error was noticed.
#[test]
fn the_state_is_whole_after_an_impulse_is_lost() -> Result<(), Box<dyn std::error::Error>> {
    let mut run = run_of(Deaf::new(-0.1, |_, _| Reaction::None))?;
    for blow in 0..20 {
        let before = run.time();
        let error = run.run_until(1e4, &mut ()).unwrap_err();
        assert!(matches!(error, RunError::Boundary { .. }) && run.time() > before, "{blow}: {error}");
        assert!(run.disks().iter().all(|disk| run.boundary().overlap(&probe(disk, run.time())).is_none()));
    }
    Ok(())
}

fn probe(disk: &Disk, time: f64) -> Probe {
    Probe::new(disk.position(), disk.radius() * (1.0 - 1e-9), time)
}

/// A wall at rest may be held by a stop, unless nothing that it keeps can change.
#[test]
fn a_wall_at_rest_needs_a_state() -> Result<(), Box<dyn std::error::Error>> {
    let mut kept = run_of(Deaf::new(0.0, |_, _| Reaction::None))?;
    kept.run_until(50.0, &mut ())?;
    let mut run = run_of(Deaf { has_state: false, ..Deaf::new(0.0, |_, _| Reaction::None) })?;
    let error = run.run_until(50.0, &mut ()).unwrap_err();
    assert!(matches!(error, RunError::Boundary { fault: BoundaryFault::Reaction { .. }, .. }), "{error}");
    Ok(())
}

#[test]
fn a_jump_at_an_impulse_is_named() -> Result<(), Box<dyn std::error::Error>> {
    fn jump(by: f64, honest: &mut Container, impact: &Impact) -> Reaction {
        let reaction = honest.react(impact);
        let mut state = honest.state();
        state[1] += by;
        honest.set_state(&state).unwrap();
        reaction
    }
    let jumps: [Answer; 2] =
        [|honest, impact| jump(-1e-4, honest, impact), |honest, impact| jump(1e-4, honest, impact)];
    for answer in jumps {
        let error = run_of(Deaf::new(0.3, answer))?.run_until(50.0, &mut ()).unwrap_err();
        assert!(
            matches!(error, RunError::FalseContact { partner: Partner::Wall(RIGHT), depth, .. }
            if (depth.abs() - 1e-4).abs() < 1e-8),
            "{error}"
        );
    }
    Ok(())
}

/// Pistons, as walls, as sinks, and on a guide at a slant, which moves them along their surfaces, too.
#[test]
fn pistons_that_take_impulses_are_right() -> Result<(), Box<dyn std::error::Error>> {
    let looks = [(plain as Look, true), (sink, false), (slanted, true)];
    let all = [0.3, 0.0, -0.1].into_iter().flat_map(|velocity| looks.map(|look| (velocity, look)));
    for (velocity, (look, keeps_energy)) in few(all, 4) {
        let mut deaf = Deaf { look, ..Deaf::new(velocity, Container::react) };
        let mut run = run_of(Deaf { look, ..Deaf::new(velocity, Container::react) })?;
        let before = energy(&run);
        let mut told = None;
        while run.time() < 20.0 {
            let mut seen = on_collision(|collision: &Collision| {
                told = Some(collision.velocities[1].x).filter(|_| collision.partner == Partner::Wall(RIGHT));
            });
            run.step_until(20.0, &mut seen)?;
            let error = told.take().map_or(0.0, |told| told + speed(&run));
            assert!(error.abs() < 1e-14, "{error}");
        }
        assert!(!keeps_energy || (energy(&run) / before - 1.0).abs() < 1e-12);
        laws::check(&mut deaf, 0.5, 1.0, 5)?;
    }
    Ok(())
}

/// Returns the speed of the piston along its normal.
fn speed(run: &Simulation<Rough, Deaf>) -> f64 {
    run.boundary().honest.state()[2]
}

fn energy(run: &Simulation<Rough, Deaf>) -> f64 {
    let energy = |disk: &Disk| disk.translational_energy() + disk.rotational_energy();
    run.disks().iter().map(energy).sum::<f64>() + 0.5 * MASS * speed(run) * speed(run)
}

/// A piston that is pressed on its stop does not move when a disk hits it, and collisions say so.
#[test]
fn a_stop_may_hold_a_piston() -> Result<(), Box<dyn std::error::Error>> {
    for force in [50.0, -50.0] {
        let piston = Piston::new(0.5, [0.0, 3.0])?.with_force(force)?;
        let walls = Container::closed(8.0, 9.0)?.with_piston(Wall::Lid, piston)?;
        let disks = initial::with_maxwellian_velocities(initial::lattice(&walls, 9, 0.5)?, 1.0, 3)?;
        let mut run = Simulation::builder(Elastic, walls).disks(disks).build()?;
        let (mut told, mut held) = (None, 0);
        while run.time() < 300.0 {
            let mut seen = on_collision(|collision: &Collision| {
                told = Some(collision.velocities[1]).filter(|_| collision.partner == Partner::Wall(LID));
            });
            run.step_until(300.0, &mut seen)?;
            if let Some(told) = told.take() {
                assert_eq!(Some(told), run.snapshot().wall_velocity(LID));
                held += u32::from(told == DVec2::ZERO);
            }
        }
        assert!(held > 0 || force > 0.0, "{force}");
        assert!(run.counters().wall_collisions > 100, "{force}: {:?}", run.counters());
    }
    Ok(())
}
