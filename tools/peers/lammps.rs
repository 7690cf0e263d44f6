//! LAMMPS as a separate program, which gets an initial state and an input file, and whose output is read when
//! it is done.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use granular_edmd::Disk;
use granular_edmd::statistics::{Estimate, block_average};

use benches::Outcome;
use benches::state::State;

/// The result of a program, and the time that it took.
pub(crate) struct Means {
    /// Seconds for an oscillation of the base.
    pub(crate) seconds: f64,
    /// Height of the center of mass, translational and rotational energy per disk.
    pub(crate) values: [Estimate; 3],
}

impl Means {
    pub(crate) fn of(seconds: f64, samples: &[[f64; 3]]) -> Outcome<Self> {
        let mean = |k: usize| block_average(&samples.iter().map(|sample| sample[k]).collect::<Vec<_>>());
        Ok(Self { seconds, values: [mean(0)?, mean(1)?, mean(2)?] })
    }
}

/// The stiffness of the disks.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Contacts {
    pub(crate) name: &'static str,
    /// Time of a contact of two disks.
    pub(crate) time: f64,
    /// Number of time steps in a contact.
    pub(crate) steps: u32,
}

/// Contacts and steps as stiff as a careful user chooses them, and contacts as soft as usual.
pub(crate) const CONTACTS: [Contacts; 2] =
    [Contacts { name: "stiff", time: 0.01, steps: 40 }, Contacts { name: "soft", time: 0.04, steps: 25 }];

/// Restitution that counts as 1, since LAMMPS cannot do without any damping.
const ELASTIC: f64 = 0.999_999_9;

/// LAMMPS at this path, with a folder for its files.
pub(crate) struct Lammps {
    pub(crate) program: PathBuf,
    pub(crate) folder: PathBuf,
}

impl Lammps {
    /// Runs from these disks until soft contacts have settled, and then measures for `oscillations`
    /// oscillations.
    pub(crate) fn measure(
        &self,
        state: &State,
        contacts: Contacts,
        start: &[Disk],
        oscillations: (u32, u32),
    ) -> Outcome<Means> {
        let (data, means, log) =
            (self.folder.join("start.data"), self.folder.join("means.txt"), self.folder.join("log.lammps"));
        fs::create_dir_all(&self.folder)?;
        fs::write(&data, data_file(start))?;
        let restitution = (1.0 - 2.0 * state.inelasticity).min(ELASTIC);
        let input = Path::new(env!("CARGO_MANIFEST_DIR")).join("peers/in.vibrated_box");
        let mut run = Command::new(&self.program);
        run.arg("-in").arg(input).args(["-screen", "none"]).arg("-log").arg(&log);
        run.args(["-var", "data"]).arg(&data).args(["-var", "means"]).arg(&means);
        let numbers = [
            ("g", state.gravity),
            ("r", restitution),
            ("mu", state.friction),
            ("tc", contacts.time),
            ("nper", f64::from(contacts.steps)),
            ("relax", f64::from(oscillations.0)),
            ("measure", f64::from(oscillations.1)),
        ];
        for (name, number) in numbers {
            run.args(["-var", name, &number.to_string()]);
        }
        let output = run.output().map_err(|error| format!("{}: {error}", self.program.display()))?;
        let said = fs::read_to_string(&log).unwrap_or_default();
        if !output.status.success() {
            let errors = String::from_utf8_lossy(&output.stderr);
            let last = said.lines().rev().find(|line| line.starts_with("ERROR")).unwrap_or_default();
            return Err(format!("LAMMPS failed: {last} {errors}\n{}", super::HOW_TO_GET_THEM).into());
        }
        let seconds = seconds_of_last_run(&said).ok_or("LAMMPS did not report its time")?;
        Means::of(seconds / f64::from(oscillations.1), &samples(&fs::read_to_string(means)?)?)
    }
}

/// Returns the disks in the form that LAMMPS reads. All have the diameter 1; the density is set by the input.
fn data_file(disks: &[Disk]) -> String {
    let mut text = format!(
        "A start\n\n{} atoms\n1 atom types\n\n-1 61 xlo xhi\n-1 151 ylo yhi\n-0.5 0.5 zlo zhi\n\nAtoms # sphere\n\n",
        disks.len()
    );
    // Writing into a text cannot fail.
    for (disk, id) in disks.iter().zip(1..) {
        let _ = writeln!(text, "{id} 1 1 1 {} {} 0", disk.position().x, disk.position().y);
    }
    text.push_str("\nVelocities\n\n");
    for (disk, id) in disks.iter().zip(1..) {
        let (velocity, spin) = (disk.velocity(), disk.angular_velocity());
        let _ = writeln!(text, "{id} {} {} 0 0 0 {spin}", velocity.x, velocity.y);
    }
    text
}

/// Returns the seconds of the last run: “Loop time of 3.2 on 1 procs for …”.
fn seconds_of_last_run(log: &str) -> Option<f64> {
    let line = log.lines().rev().find(|line| line.starts_with("Loop time of"))?;
    line.split_whitespace().nth(3)?.parse().ok()
}

/// Returns height, translational and rotational energy from lines of step and means.
fn samples(text: &str) -> Outcome<Vec<[f64; 3]>> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let sample = |line: &str| -> Outcome<[f64; 3]> {
        let numbers = line.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        let &[_, height, translation, rotation] = numbers.as_slice() else {
            return Err(format!("LAMMPS wrote “{line}”").into());
        };
        Ok([height, translation, rotation])
    };
    lines.map(sample).collect()
}
