//! The growth of time, memory and set-up with the number of disks, for each scheduler.
//!
//! ```sh
//! RUSTFLAGS="-C target-cpu=native" cargo run --release -p tools --features picture --bin scaling
//! ```
//!
//! The program runs the same physical state in boxes of the same height and growing width, with at most
//! `LARGEST` (10⁶) disks. It measures `ROUNDS` times, and reports the medians of the processor time. The
//! disks are numbered once by position, which is best for the caches, and once at random. With the feature
//! `picture`, the picture goes to `PICTURE`, or to `out/scaling.png` if that is not set, and as SVG and as a
//! table beside it. With `TABLE`, the path of such a table, nothing is measured: the picture shows the times
//! of the table.

mod measurement;
#[cfg(feature = "picture")]
mod picture;
#[cfg(feature = "picture")]
mod table;
mod tiles;

use std::process::ExitCode;

use benches::Outcome;
use benches::ask;
use benches::state::{DILUTE, DISKS};
use granular_edmd::scheduler::{BucketQueue, TournamentTree};
use granular_edmd::speed::Quartiles;
use measurement::{Measurement, asked_for, measure};
use tiles::{Numbering, Tiles};

type Measure = fn(&Tiles, usize, Numbering, u32) -> Outcome<Measurement>;

/// The schedulers that are compared.
const SCHEDULERS: [(&str, Measure); 2] =
    [("tournament tree", measure_with::<TournamentTree>), ("bucket queue", measure_with::<BucketQueue>)];

fn measure_with<S: granular_edmd::scheduler::EventScheduler + Default>(
    tiles: &Tiles,
    boxes: usize,
    numbering: Numbering,
    oscillations: u32,
) -> Outcome<Measurement> {
    measure::<S>(&DILUTE, || tiles.disks(boxes, numbering), oscillations)
}

/// A line of the table: one system, measured a few times.
pub(crate) struct Row {
    disks: usize,
    scheduler: &'static str,
    numbering: Numbering,
    measure: Measure,
    rounds: Vec<Measurement>,
}

/// The plan of the measurement: its sizes, its number of rounds, and its length.
struct Plan {
    largest: usize,
    rounds: u32,
    settle: u32,
    /// Disks times oscillations of each run. The more disks there are, the fewer oscillations.
    work: usize,
}

fn main() -> ExitCode {
    benches::report(run())
}

fn run() -> Outcome<()> {
    #[cfg(feature = "picture")]
    if let Some(table) = ask::path("TABLE") {
        return draw(&table::read(&table)?);
    }
    let plan = Plan::asked_for()?;
    let mut rows = rows(plan.largest);
    if let Some(number) = asked_for() {
        return measure_one(&plan, &rows[number]);
    }
    benches::print_circumstances();
    println!("{DILUTE}; medians of {} rounds.", plan.rounds);
    for _ in 0..plan.rounds {
        for (number, row) in rows.iter_mut().enumerate() {
            row.rounds.push(Measurement::in_new_process(number)?);
        }
    }
    print(&rows);
    if ask::is_test() { Ok(()) } else { finish(&rows) }
}

#[cfg(feature = "picture")]
fn finish(rows: &[Row]) -> Outcome<()> {
    draw(&rows.iter().map(table::Time::of).collect::<Vec<_>>())
}

#[expect(clippy::unnecessary_wraps, reason = "the form that it has with the picture")]
#[cfg(not(feature = "picture"))]
fn finish(_: &[Row]) -> Outcome<()> {
    println!("\nFor the picture, add `--features picture`.");
    Ok(())
}

/// Measures this system in the present process, and prints the numbers.
fn measure_one(plan: &Plan, row: &Row) -> Outcome<()> {
    let (boxes, oscillations) = (row.disks / DISKS, (plan.work / row.disks).max(1) as u32);
    let tiles = Tiles::settled(&DILUTE, plan.settle, boxes)?;
    println!("{}", (row.measure)(&tiles, boxes, row.numbering, oscillations)?);
    Ok(())
}

impl Plan {
    fn asked_for() -> Outcome<Self> {
        if ask::is_test() {
            return Ok(Self { largest: 10_000, rounds: 1, settle: 20, work: 50_000 });
        }
        let largest = ask::number("LARGEST", 1_000_000)?.max(1000) as usize;
        Ok(Self { largest, rounds: ask::number("ROUNDS", 3)?, settle: 2000, work: 25_000_000 })
    }
}

/// Returns rows of all sizes, from a thousand in steps of ten, with all schedulers and numberings.
fn rows(largest: usize) -> Vec<Row> {
    let sizes = std::iter::successors(Some(DISKS), |disks| Some(10 * disks));
    let mut rows = Vec::new();
    for disks in sizes.take_while(|&disks| disks <= largest) {
        for (scheduler, measure) in SCHEDULERS {
            let row = |numbering| Row { disks, scheduler, numbering, measure, rounds: Vec::new() };
            rows.extend(Numbering::ALL.map(row));
        }
    }
    rows
}

impl Row {
    fn quartiles(&self, number: fn(&Measurement) -> f64) -> Quartiles {
        Quartiles::of(self.rounds.iter().map(number))
    }

    fn nanoseconds(&self) -> Quartiles {
        self.quartiles(|round| round.nanoseconds_per_collision)
    }
}

fn print(rows: &[Row]) {
    println!();
    println!(
        "| disks | scheduler | numbered | ns per collision | million events per second | bytes per disk | set-up |"
    );
    println!("|---|---|---|---|---|---|---|");
    for row in rows {
        let Quartiles { low, median, high } = row.nanoseconds();
        let events = row.quartiles(|round| round.events_per_second).median / 1e6;
        let set_up = 1e3 * row.quartiles(|round| round.set_up_seconds).median;
        println!(
            "| {} | {} | {} | {median:.0} ({low:.0}–{high:.0}) | {events:.2} | {} | {set_up:.1} ms |",
            row.disks,
            row.scheduler,
            row.numbering.name(),
            bytes(row),
        );
    }
}

/// Returns the bytes per disk. The memory of a small system is not visible in the memory of the process.
fn bytes(row: &Row) -> String {
    let bytes = row.quartiles(|round| round.bytes_per_disk).median;
    if row.disks < 10_000 || bytes.is_nan() { "–".to_owned() } else { format!("{bytes:.0}") }
}

#[cfg(feature = "picture")]
fn draw(times: &[table::Time]) -> Outcome<()> {
    let path = ask::path("PICTURE").unwrap_or_else(|| std::path::PathBuf::from("out/scaling.png"));
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let path = path.with_extension("");
    table::write(times, &path.with_extension("csv"))?;
    picture::draw(&DILUTE.to_string(), times).write(&path)?;
    println!("\nPicture: {0}.svg and {0}.png; table: {0}.csv", path.display());
    Ok(())
}
