//! `replay` and `trajectory` of experiments that have a driving or end early: the
//! program of this test runs itself as the command line. The companion of each value writes what it sees.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Output};

use granular_edmd::Fingerprint;
use granular_edmd::observable::{Observer, SampleTimes, Snapshot, Verdict, on_collision};
use granular_edmd::prelude::*;
use granular_edmd::simulation::WhiteNoise;
use granular_edmd_files::{ExtendedXyz, Recorder};
use granular_edmd_study::{Column, Experiment, ExperimentError, Plan, Protocol, SavedDriving, Start, cli};
use serde::{Deserialize, Serialize};

/// Set for the program as a command.
const IS_COMMAND: &str = "GRANULAR_EDMD_PLAYED";

/// A gas under a plate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Gas {
    restitution: f64,
    noise: f64,
    /// Number of measured collisions after which the observer stops the value.
    stop: u64,
}

/// The number of collisions that are still to come.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Left(u64);

impl Observer for Left {
    fn on_collision(&mut self, _: &Collision) {
        self.0 -= 1;
    }
    fn verdict(&mut self) -> Verdict {
        Ok(if self.0 == 0 { std::ops::ControlFlow::Break(()) } else { std::ops::ControlFlow::Continue(()) })
    }
}

impl Experiment for Gas {
    type Rule = Smooth;
    type Boundary = Container;
    type Observer = Left;
    type Sample = f64;

    fn revision() -> Fingerprint {
        Fingerprint::of("Gas")
    }
    fn rule(&self) -> Result<Smooth, ExperimentError> {
        Ok(Smooth::from_restitution(self.restitution)?)
    }
    fn boundary(&self) -> Result<Container, ExperimentError> {
        let plate = Part::polyline([DVec2::new(2.0, 10.0), DVec2::new(10.0, 10.0)])?;
        Ok(Container::closed(12.0, 14.0)?.with_part("plate", plate)?)
    }
    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        let disks = initial::lattice(&Container::closed(12.0, 8.0)?, 30, 0.5)?;
        Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
    }
    fn observer(&self) -> Result<Left, ExperimentError> {
        Ok(Left(self.stop))
    }
    fn sample(&self, snapshot: &Snapshot<'_>, _: &mut Left) -> f64 {
        snapshot.mean(Disk::translational_energy)
    }
    fn driving(&self, seed: u64) -> Result<Option<Box<dyn SavedDriving>>, ExperimentError> {
        if self.noise == 0.0 {
            return Ok(None);
        }
        Ok(Some(Box::new(WhiteNoise::new(self.noise, SampleTimes::every(0.15)?, seed)?)))
    }
    fn companion(&self, start: &Start<'_>) -> Result<Option<Box<dyn Observer>>, ExperimentError> {
        let place = |kind: &str| start.folder.join(format!("{}.{kind}", start.value));
        let mut times = File::create_new(place("times"))?;
        let recorder = Recorder::create(place("xyz"), ExtendedXyz, SampleTimes::every(self.cycle())?)?;
        let watch = on_collision(move |it: &Collision| writeln!(times, "{}", it.time).unwrap());
        Ok(Some(Box::new((recorder, watch))))
    }
    fn columns() -> Vec<Column<Self>> {
        let all = Column::of_record("all_collisions", "1", |record| record.counters().collisions());
        vec![Column::sampled("energy", "energy", |energy| *energy), all]
    }
}

fn main() -> ExitCode {
    if std::env::var_os(IS_COMMAND).is_some() {
        let gas = Gas { restitution: 0.9, noise: 0.0, stop: u64::MAX };
        return cli::main(|| Plan::new(gas, Protocol::new(4, 8, 1)?, 1));
    }
    plain_values_are_played();
    driven_values_are_played();
    stopped_values_are_played();
    limited_values_are_played();
    values_with_a_phase_are_played();
    ExitCode::SUCCESS
}

/// A folder of one case, with a study of a ramp of two values.
struct Case(PathBuf);

impl Case {
    /// Runs a plan that differs from the usual one in one entry.
    fn run(name: &str, from: &str, to: &str) -> Self {
        let folder =
            Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("played-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        assert!(PLAN.contains(from));
        fs::write(folder.join("plan.toml"), PLAN.replace(from, to)).unwrap();
        let case = Self(folder);
        let output = case.runs("run plan.toml --out study");
        assert!([Some(0), Some(7)].contains(&output.status.code()), "{name} {output:?}");
        case
    }

    fn runs(&self, arguments: &str) -> Output {
        let mut command = Command::new(std::env::current_exe().unwrap());
        command.env(IS_COMMAND, "").args(arguments.split(' ')).current_dir(&self.0).output().unwrap()
    }

    /// Returns the standard error of a command that ends with this code.
    fn told(&self, arguments: &str, code: i32) -> String {
        let output = self.runs(arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments} {output:?}");
        String::from_utf8(output.stderr).unwrap()
    }

    /// Returns the rows of a replay.
    fn rows(&self, arguments: &str) -> Vec<String> {
        let output = self.runs(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments} {output:?}");
        String::from_utf8(output.stdout).unwrap().lines().skip(1).map(str::to_owned).collect()
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap()
    }

    /// Returns the number of collisions of each value by the table of the study.
    fn counts(&self) -> Vec<usize> {
        let table = self.text("study/values.csv");
        let mut lines = table.lines().map(|line| line.split(','));
        let place = lines.next().unwrap().position(|name| name == "all_collisions").unwrap();
        lines.map(|mut cells| cells.nth(place).unwrap().parse().unwrap()).collect()
    }

    /// Checks that both values are played as the study ran them, and returns their rows.
    fn check(&self) -> [Vec<String>; 2] {
        let all = [0, 1].map(|value| self.rows(&format!("replay study --value {value} --from -1")));
        assert_eq!(all.each_ref().map(Vec::len), self.counts()[..], "{}", self.0.display());
        for (value, rows) in all.iter().enumerate() {
            let time = |row: &String| row.split(',').nth(1).unwrap().parse::<f64>().unwrap();
            let seen = self.text(&format!("study/{value}.times"));
            let seen: Vec<f64> = seen.lines().map(|line| line.parse().unwrap()).collect();
            assert_eq!(rows.iter().map(time).collect::<Vec<_>>(), seen, "{} {value}", self.0.display());
            // A window may end within a step.
            let window =
                self.rows(&format!("replay study --value {value} --from {} --until {}", seen[9], seen[50]));
            assert_eq!(window, rows[10..=50]);
            let recorded = self.text(&format!("study/{value}.xyz"));
            let out = format!("trajectory study --value {value} --out {value}.xyz");
            self.told(&out, 0);
            assert!(self.text(&format!("{value}.xyz")).starts_with(&recorded), "{value}");
            assert_eq!(self.rows(&format!("replay study --value {value} --last 3")), rows[rows.len() - 3..]);
        }
        assert_eq!(self.rows("replay plan.toml --from -1"), all[0]);
        all
    }

    fn frames(&self) -> usize {
        self.text("0.xyz").matches("Lattice=").count()
    }
}

impl Drop for Case {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

const PLAN: &str = r#"
seed = 1
[experiment]
restitution = 0.9
noise = 0.0
stop = 1000000000
[protocol]
settle = 4
samples = 8
every = 1
[ramp]
parameter = "restitution"
values = [0.8, 0.9]
course = "up"
"#;

fn plain_values_are_played() {
    let case = Case::run("plain", "seed = 1", "seed = 2");
    case.check();
    assert_eq!(case.frames(), 12);
}

fn driven_values_are_played() {
    let case = Case::run("driven", "noise = 0.0", "noise = 0.5");
    case.check();
    assert_eq!(case.frames(), 12);
    assert_eq!(case.told("trajectory plan.toml --cycles 13 --out more.xyz", 0), "");
    assert_eq!(case.text("more.xyz"), case.text("0.xyz"));
}

fn stopped_values_are_played() {
    let case = Case::run("stopped", "stop = 1000000000", "stop = 60");
    case.check();
}

fn limited_values_are_played() {
    let case = Case::run("limited", "every = 1", "every = 1\nmost_collisions = 150");
    case.check();
    assert_eq!(case.counts(), [150, 150]);
}

/// Samples within a step neither hide its limit nor its collisions.
fn values_with_a_phase_are_played() {
    let case = Case::run("phase", "every = 1", "every = 1\nphase = 0.35\nmost_collisions = 150");
    case.check();
    assert_eq!(case.counts(), [150, 150]);
}
