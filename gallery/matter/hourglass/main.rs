//! An hourglass: it runs empty, and is turned over.
//!
//! The glass is one polygon. A gate shuts its neck until the grains lie still, and is then taken out; after
//! the last grain, gravity points the other way, which turns the glass over. The mean diameter of the grains
//! is 0.95 and the largest diameter 1; their mass and gravity are 1; `q = 0.1`, `κ = 0.3`.
//!
//! The flow does not depend on how many grains are left above, unlike the flow of a liquid. That is why
//! hourglasses measure time.
//!
//! Grains that lie on each other would collide ever faster. `LeastRebound` stops that: no surfaces part more
//! slowly than 0.05, so a heap trembles a little. `--compare` shows what other remedies do.
//!
//! ```text
//! cargo run --release -p gallery --bin hourglass
//! cargo run --release -p gallery --bin hourglass -- --grains 60 --neck 3.5 --compare
//! ```
//!
//! The example writes `hourglass.svg`, `hourglass.png` and `hourglass.csv`. Literature: W. A. Beverloo et
//! al., Chem. Eng. Sci. 15, 260 (1961) for the flow; `docs/rest.md` for the remedies.

mod picture;

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use granular_edmd::boundary::WallError;
use granular_edmd::collision::TangentialResponse::{Frictionless, Reversing, Unchanged};
use granular_edmd::collision::{ElasticBelow, SpeedDependent};
use granular_edmd::initial::Radii;
use granular_edmd::observable::stop_when_sampled;
use granular_edmd::prelude::*;
use granular_edmd::simulation::{BoxedRule, RunEnd, Warning};

use gallery::command_line::{self, Failure, positive, whole};
use gallery::progress::Progress;
use gallery::results::Results;

/// An hourglass that runs empty and is turned over: the number of grains above over time.
#[derive(Parser)]
struct Arguments {
    /// Number of grains; the glass grows with it.
    #[arg(long, default_value_t = 600, value_parser = whole::<100_000>)]
    grains: u64,
    /// Width of the neck, in diameters of the largest grain.
    #[arg(long, default_value_t = 4.5, value_parser = positive)]
    neck: f64,
    /// Seed of positions and velocities.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Largest number of collisions for each passage of the grains, in millions.
    #[arg(long, default_value_t = 100.0, value_parser = positive)]
    collisions: f64,
    /// Also runs the glass under each remedy for matter at rest, and prints what it costs.
    #[arg(long)]
    compare: bool,
    /// Uses at most 60 grains.
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    results: Results,
}

/// Time in which the grains come to rest above the gate, and time between two frames.
const SETTLING: f64 = 20.0;
const FRAME: f64 = 0.5;

/// Latest end of a passage, if the neck is blocked.
const END: f64 = 1000.0;

type Run = Simulation<BoxedRule, Container>;

fn main() -> ExitCode {
    command_line::main(run)
}

fn run(arguments: &Arguments) -> Result<(), Failure> {
    arguments.results.make_folder()?;
    let glass = Glass::of(arguments);
    if arguments.compare {
        compare(arguments, &glass).map_err(Failure::run)?;
    }
    let rule = friction().and_then(|rule| LeastRebound::new(rule, LEAST)).map_err(Failure::run)?;
    let ways = both_ways(arguments, &glass, Box::new(rule)).map_err(Failure::run)?;
    for (name, way) in ["first", "turned over"].into_iter().zip(&ways) {
        gallery::say!("{name}: {way}");
    }
    write(arguments, &glass, &ways).map_err(Failure::run)
}

/// Least speed at which surfaces part: far below the speed of the flow, so that the flow does not depend on
/// it.
const LEAST: f64 = 0.05;

fn friction() -> Result<Frictional, ParameterError> {
    Frictional::from_inelasticity(0.1, 0.1, 0.3)
}

/// The shape of an hourglass about the origin: two funnels at 60°, below a shoulder each.
struct Glass {
    neck: f64,
    width: f64,
    shoulder: f64,
    top: f64,
}

impl Glass {
    /// Makes the glass so large that the grains fill a funnel.
    fn of(arguments: &Arguments) -> Self {
        let slope = 3f64.sqrt();
        let neck = 0.5 * arguments.neck;
        let area = 0.88 * grains(arguments) as f64;
        let width = (area / slope + neck * neck).sqrt();
        let shoulder = slope * (width - neck);
        Self { neck, width, shoulder, top: shoulder + 0.5 * width }
    }

    /// Returns the right side above the neck.
    fn right(&self) -> [DVec2; 3] {
        let Self { neck, width, shoulder, top } = *self;
        [(neck, 0.0), (width, shoulder), (width, top)].map(DVec2::from)
    }

    fn upper_half(&self) -> Result<Part, WallError> {
        let left = self.right().map(|point| DVec2::new(-point.x, point.y));
        Part::polygon(self.right().into_iter().chain(left.into_iter().rev()))
    }

    fn outline(&self) -> Vec<DVec2> {
        let right = self.right();
        let half: Vec<DVec2> =
            right.iter().skip(1).rev().map(|p| DVec2::new(p.x, -p.y)).chain(right).collect();
        half.iter().copied().chain(half.iter().rev().map(|p| DVec2::new(-p.x, p.y))).collect()
    }

    fn gate(&self) -> Result<Part, WallError> {
        Part::polyline([DVec2::new(-self.neck, 0.0), DVec2::new(self.neck, 0.0)])
    }
}

fn grains(arguments: &Arguments) -> usize {
    if arguments.quick { arguments.grains.min(60) as usize } else { arguments.grains as usize }
}

/// The grains at one time.
struct Frame {
    time: f64,
    above: usize,
    disks: Vec<Disk>,
}

/// The passage of the grains through the neck.
struct Way {
    frames: Vec<Frame>,
    ended: RunEnd,
    seconds: f64,
    collisions: u64,
}

/// Lets the grains run through the neck, and back after the glass is turned over.
fn both_ways(arguments: &Arguments, glass: &Glass, rule: BoxedRule) -> Result<[Way; 2], Box<dyn Error>> {
    let mut run = settled(arguments, glass, rule)?;
    let first = way(arguments, &mut run)?;
    run.set_gravity(-1.0)?;
    let second = way(arguments, &mut run)?;
    Ok([first, second])
}

/// Returns the glass with its grains at rest above the neck, and the gate taken out.
fn settled(arguments: &Arguments, glass: &Glass, rule: BoxedRule) -> Result<Run, Box<dyn Error>> {
    let seed = arguments.seed;
    let radii = Radii::uniform(0.45, 0.5)?.draw(grains(arguments), seed);
    let upper = Container::around([("upper half", glass.upper_half()?)])?;
    let disks = initial::packed_mix(&upper, initial::disks_from_radii(radii, 1.0)?, glass.top, seed)?;
    let disks = initial::with_maxwellian_velocities(disks, 0.01, seed)?;
    let shut = Container::around([("glass", Part::polygon(glass.outline())?), ("gate", glass.gate()?)])?;
    let mut run = Simulation::builder(rule, shut).disks(disks).gravity(1.0).build()?;
    let mut progress = Progress::of("grains that come to rest").until(SETTLING);
    if run.run(&limits(arguments, SETTLING), &mut progress)? != RunEnd::Time {
        return Err(
            format!("the grains are not at rest after {} million collisions", arguments.collisions).into()
        );
    }
    let mut open = run.boundary().clone();
    open.remove_part("gate")?;
    run.set_boundary(open)?;
    Ok(run)
}

fn limits(arguments: &Arguments, end: f64) -> Limits<'static> {
    Limits::until(end).with_most_collisions((1e6 * arguments.collisions) as u64)
}

/// Runs until no grain is above the neck.
fn way(arguments: &Arguments, run: &mut Run) -> Result<Way, Box<dyn Error>> {
    let (start, up) = (run.time(), run.gravity().downward());
    let mut frames = vec![frame(0.0, up, &run.disks())];
    let (since, before) = (Instant::now(), *run.counters());
    let times = SampleTimes::every(FRAME)?.starting_at(start + FRAME)?;
    let progress = Progress::of("grains below the neck");
    let mut empty = stop_when_sampled(times, |snapshot: &Snapshot<'_>| {
        let frame = frame(snapshot.time() - start, up, snapshot.disks());
        let (above, all) = (frame.above, frame.disks.len());
        frames.push(frame);
        progress.show((all - above) as u64, all as u64);
        above == 0
    });
    let ended = run.run(&limits(arguments, start + END), &mut empty)?;
    // Grains rest for most of the time, and meet at the least rebound: a warning for a flow only.
    let is_wanted = |warning: &Warning| !matches!(warning, Warning::MostlyLeastRebound { .. });
    gallery::output::warn(&run.warnings().into_iter().filter(is_wanted).collect::<Vec<_>>());
    let counters = run.counters().since(&before);
    let collisions = counters.disk_collisions + counters.wall_collisions;
    Ok(Way { frames, ended, seconds: since.elapsed().as_secs_f64(), collisions })
}

fn frame(time: f64, up: f64, disks: &[Disk]) -> Frame {
    let above = disks.iter().filter(|disk| up * disk.position().y > 0.0).count();
    Frame { time, above, disks: disks.to_vec() }
}

impl Way {
    fn end(&self) -> f64 {
        self.frames.last().map_or(0.0, |frame| frame.time)
    }

    /// Returns the flow while the share of the grains above the neck falls from `from` to `to`.
    fn flow(&self, from: f64, to: f64) -> f64 {
        let all = self.frames.first().map_or(0, |frame| frame.disks.len()) as f64;
        let reached = |share: f64| self.frames.iter().find(|frame| frame.above as f64 <= share * all);
        match (reached(from), reached(to)) {
            (Some(a), Some(b)) => (a.above - b.above) as f64 / (b.time - a.time),
            _ => f64::NAN,
        }
    }
}

impl std::fmt::Display for Way {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { ended, seconds, collisions, .. } = self;
        let verdict = if *ended == RunEnd::Observer { "empty" } else { "not empty" };
        write!(formatter, "{verdict} after {:.1}; ", self.end())?;
        write!(formatter, "flow {:.1} at first, {:.1} later; ", self.flow(0.9, 0.5), self.flow(0.5, 0.1))?;
        write!(formatter, "{collisions} collisions in {seconds:.2} s")
    }
}

fn write(arguments: &Arguments, glass: &Glass, ways: &[Way; 2]) -> Result<(), Box<dyn Error>> {
    let mut table = arguments.results.table("hourglass", &["way", "time", "grains_above"])?;
    for (number, way) in (1..).zip(ways) {
        for frame in &way.frames {
            table.serialize((number, frame.time, frame.above))?;
        }
    }
    let way = |way: &Way| {
        let above: Vec<_> = way.frames.iter().map(|frame| (frame.time, frame.above)).collect();
        let (first, later) = (way.flow(0.9, 0.5), way.flow(0.5, 0.1));
        serde_json::json!({ "end": way.end(), "flow": [first, later], "above": above })
    };
    let numbers = ways.iter().map(way).collect();
    arguments.results.finish("hourglass", table, &picture::draw(arguments, glass, ways), &numbers)
}

/// Prints what the hourglass does under each remedy.
fn compare(arguments: &Arguments, glass: &Glass) -> Result<(), Box<dyn Error>> {
    for (name, rule) in remedies()? {
        match both_ways(arguments, glass, rule) {
            Ok([way, _]) => gallery::say!("{name}: {way}"),
            Err(error) => gallery::say!("{name}: {error}"),
        }
    }
    Ok(())
}

fn remedies() -> Result<Vec<(String, BoxedRule)>, Box<dyn Error>> {
    let rule = friction()?;
    let bizon =
        SpeedDependent::from_restitution(0.8, 1.0)?.with_friction(Friction::from_inelasticity(0.1, 0.3)?);
    let mut remedies: Vec<(String, BoxedRule)> =
        vec![("no remedy".into(), Box::new(rule)), ("SpeedDependent".into(), Box::new(bizon))];
    for response in [Frictionless, Reversing, Unchanged] {
        let below = ElasticBelow::new(rule, 0.1)?.with_tangential_response(response);
        remedies.push((format!("ElasticBelow 0.1, {response:?}"), Box::new(below)));
        let lasting = ContactDuration::new(rule, 0.01)?.with_tangential_response(response);
        remedies.push((format!("ContactDuration 0.01, {response:?}"), Box::new(lasting)));
    }
    remedies.push((format!("LeastRebound {LEAST}"), Box::new(LeastRebound::new(rule, LEAST)?)));
    Ok(remedies)
}
