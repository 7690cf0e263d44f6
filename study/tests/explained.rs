//! The command `explain` of a custom experiment: the program of this test runs itself as that command.

use std::process::{Command, ExitCode, Output};

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::observable::Snapshot;
use granular_edmd::{Disk, Fingerprint};
use granular_edmd_study::{Column, Experiment, ExperimentError, Plan, Protocol, cli};
use serde::{Deserialize, Serialize};

/// Set for the program as a command.
const IS_COMMAND: &str = "GRANULAR_EDMD_EXPLAINED";

#[derive(Clone, Serialize, Deserialize)]
struct Gas {
    width: f64,
    disks: Vec<Size>,
}

#[derive(Clone, Serialize, Deserialize)]
struct Size {
    radius: f64,
}

impl Experiment for Gas {
    type Rule = Elastic;
    type Boundary = Container;
    type Observer = ();
    type Sample = f64;

    fn meanings() -> &'static [(&'static str, &'static str)] {
        &[("width", "Width."), ("disks", "Disks."), ("disks.radius", "Radius."), ("speed", "Mean speed.")]
    }
    fn revision() -> Fingerprint {
        Fingerprint::of("Gas")
    }
    fn rule(&self) -> Result<Elastic, ExperimentError> {
        Ok(Elastic)
    }
    fn boundary(&self) -> Result<Container, ExperimentError> {
        Ok(Container::closed(self.width, 10.0)?)
    }
    fn disks(&self, _: u64) -> Result<Vec<Disk>, ExperimentError> {
        Ok(Vec::new())
    }
    fn observer(&self) -> Result<(), ExperimentError> {
        Ok(())
    }
    fn sample(&self, snapshot: &Snapshot<'_>, (): &mut ()) -> f64 {
        snapshot.mean(|disk| disk.velocity().length())
    }
    fn columns() -> Vec<Column<Self>> {
        vec![Column::sampled("speed", "length/time", |speed: &f64| *speed)]
    }
}

fn main() -> ExitCode {
    if std::env::var_os(IS_COMMAND).is_some() {
        let gas = Gas { width: 10.0, disks: Vec::new() };
        return cli::main(|| Plan::new(gas, Protocol::new(1, 1, 1)?, 1));
    }
    parameters_and_columns_are_explained();
    ExitCode::SUCCESS
}

fn explain(key: Option<&str>) -> Output {
    let program = std::env::current_exe().unwrap();
    Command::new(program).env(IS_COMMAND, "").arg("explain").args(key).output().unwrap()
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

fn parameters_and_columns_are_explained() {
    let all = explain(None);
    let told = text(&all.stdout);
    for name in ["width", "disks.radius"] {
        assert!(told.contains(&format!("\n{name}: ")), "{told}");
        assert!(explain(Some(name)).status.success(), "{name}");
        assert!(explain(Some(&format!("experiment.{name}"))).status.success(), "{name}");
    }
    assert_eq!(text(&explain(Some("speed")).stdout), "speed [length/time]: Mean speed.\n");
    let unknown = explain(Some("widht"));
    let nearest = text(&unknown.stderr);
    assert!(nearest.contains("there is no key `widht`; the nearest is `width`"), "{nearest}");
}
