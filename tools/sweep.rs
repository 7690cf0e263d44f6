//! The gain in speed of a sweep of independent runs on more threads.
//!
//! ```sh
//! RUSTFLAGS="-C target-cpu=native" cargo run --release -p tools --bin sweep --features studies
//! ```
//!
//! A study of 24 runs is done alternately on one thread and on more, `ROUNDS` times. The same is done with a
//! loop of plain arithmetic that touches no memory. The gain of the loop is all that the machine can give at
//! the time, and the quotient of the two gains is the share of it that the study reaches. On a machine with
//! other work, even this quotient says little. In that case, look at the processor time, which is the same on
//! more threads as on one, as long as the runs do not disturb each other.

use std::hint::black_box;
use std::process::ExitCode;
use std::thread::available_parallelism;
use std::time::Instant;

use benches::Outcome;
use benches::ask;
use benches::state::{AMPLITUDE, ANGULAR_FREQUENCY, CONTACT_DURATION, DILUTE, DISKS, HEIGHT, WIDTH};
use granular_edmd::speed::Quartiles;
use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{Axis, Control, Plan, PlanError, Protocol, Study};
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Number of runs of a study, so large that no thread waits long for the last run.
const RUNS: u32 = 24;

/// Seconds of the study and of the arithmetic on `threads` threads, by the wall clock and on all processors
/// together.
struct Times {
    threads: usize,
    pool: ThreadPool,
    study: Vec<f64>,
    processors: Vec<f64>,
    arithmetic: Vec<f64>,
}

fn main() -> ExitCode {
    benches::report(run())
}

fn run() -> Outcome<()> {
    let (rounds, cycles) =
        if ask::is_test() { (1, 20) } else { (u64::from(ask::number("ROUNDS", 7)?), 2000) };
    benches::print_circumstances();
    let plan = plan(cycles)?;
    let mut times = threads().into_iter().map(Times::on).collect::<Outcome<Vec<_>>>()?;
    for _ in 0..rounds {
        for times in &mut times {
            let before = seconds_on_processors();
            times.study.push(times.pool.install(|| study(&plan))?);
            times.processors.push(seconds_on_processors() - before);
            times.arithmetic.push(times.pool.install(|| arithmetic(cycles)));
        }
    }
    print(&times, rounds);
    Ok(())
}

/// Returns the seconds that the threads of this process have had on processors; NaN if that is not known.
fn seconds_on_processors() -> f64 {
    let nanoseconds = |task: std::io::Result<std::fs::DirEntry>| -> Option<f64> {
        let text = std::fs::read_to_string(task.ok()?.path().join("schedstat")).ok()?;
        text.split_whitespace().next()?.parse().ok()
    };
    let tasks = std::fs::read_dir("/proc/self/task");
    tasks.map_or(f64::NAN, |tasks| 1e-9 * tasks.filter_map(nanoseconds).sum::<f64>())
}

/// Returns the numbers of threads: one, two, and as many as the machine has.
fn threads() -> Vec<usize> {
    let all = available_parallelism().map_or(1, usize::from);
    let mut threads = vec![1, 2, all.max(1)];
    threads.sort_unstable();
    threads.dedup();
    threads
}

impl Times {
    fn on(threads: usize) -> Outcome<Self> {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build()?;
        Ok(Self { threads, pool, study: Vec::new(), processors: Vec::new(), arithmetic: Vec::new() })
    }
}

/// Returns a plan of runs that take equally long, since they hardly differ in friction.
fn plan(cycles: u64) -> Result<Plan<VibratedBox>, PlanError> {
    let base = Base::BiParabolic { amplitude: AMPLITUDE, angular_frequency: ANGULAR_FREQUENCY };
    let experiment = VibratedBox::new(DISKS, WIDTH, base)
        .with_height(HEIGHT)
        .with_gravity(DILUTE.gravity)
        .with_inelasticity(DILUTE.inelasticity)
        .with_contact_duration(CONTACT_DURATION);
    let frictions = (0..RUNS).map(|run| DILUTE.friction + 1e-9 * f64::from(run));
    let protocol = Protocol::new(cycles / 2, cycles / 20, 10)?;
    Plan::new(experiment, protocol, 1)?.with_axis(Axis::new("friction", frictions)?)
}

/// Returns the seconds for the whole study, including its files.
fn study(plan: &Plan<VibratedBox>) -> Outcome<f64> {
    let folder = benches::working_folder(&format!("sweep-{}", std::process::id()))?;
    let study = Study::create(&folder, plan)?;
    let start = Instant::now();
    let summary = study.run(&Control::default())?;
    let seconds = start.elapsed().as_secs_f64();
    std::fs::remove_dir_all(&folder)?;
    if summary.is_complete() { Ok(seconds) } else { Err("a run of the study failed".into()) }
}

/// Returns the seconds for as many loops of arithmetic as there are runs, of about the same length.
fn arithmetic(cycles: u64) -> f64 {
    let start = Instant::now();
    (0..RUNS).into_par_iter().with_max_len(1).for_each(|run| {
        let loops = 100_000 * cycles;
        black_box(
            (0..loops).fold(u64::from(run), |sum, step| sum.rotate_left(5).wrapping_mul(0x9E37_79B9) ^ step),
        );
    });
    start.elapsed().as_secs_f64()
}

fn print(times: &[Times], rounds: u64) {
    println!(
        "Medians (and quartiles) of {rounds} rounds. Load of the machine at the end: {}.",
        benches::load()
    );
    println!();
    println!(
        "| threads | study: seconds | times as fast | arithmetic: times as fast | quotient | processor time |"
    );
    println!("|---|---|---|---|---|---|");
    let one = &times[0];
    for many in times {
        let seconds = Quartiles::of(many.study.iter().copied());
        let (study, arithmetic) =
            (ratios(&one.study, &many.study), ratios(&one.arithmetic, &many.arithmetic));
        let quotient = Quartiles::of(study.iter().zip(&arithmetic).map(|(study, plain)| study / plain));
        let (study, arithmetic) = (Quartiles::of(study), Quartiles::of(arithmetic));
        let more = Quartiles::of(ratios(&many.processors, &one.processors));
        println!("| {} | {seconds} | {study} | {arithmetic} | {quotient} | × {more} |", many.threads);
    }
}

/// Returns the ratios of two lists of numbers, round by round.
fn ratios(above: &[f64], below: &[f64]) -> Vec<f64> {
    above.iter().zip(below).map(|(above, below)| above / below).collect()
}
