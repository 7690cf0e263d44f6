//! The plain simulation with which this crate is compared. It is another program, built and run as its users
//! would do it.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::Speed;
use benches::Outcome;
use benches::state::{self, State};

/// Difference in friction between the two parts of a run of the program. The program measures each value of
/// friction separately, from the last state of the previous value, so the first one settles the state for the
/// second.
const STEP: f64 = 1e-9;

/// The other program, built.
pub(crate) struct Reference {
    program: PathBuf,
}

impl Reference {
    /// Builds the program from its folder for the processor of this machine.
    pub(crate) fn build(folder: &Path) -> Outcome<Self> {
        let target = benches::working_folder("reference")?;
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut build = Command::new(cargo);
        build.args(["build", "--release", "--quiet", "--target-dir"]).arg(&target).current_dir(folder);
        build.env_remove("CARGO_ENCODED_RUSTFLAGS").env("RUSTFLAGS", "-C target-cpu=native");
        let built = build.output().map_err(|error| format!("{}: {error}", folder.display()))?;
        if built.status.success() {
            return Ok(Self { program: target.join("release").join("reference") });
        }
        Err(format!("the reference cannot be built: {}", String::from_utf8_lossy(&built.stderr)).into())
    }

    /// Runs the program for this many oscillations to settle from its lattice, and for as many to measure.
    pub(crate) fn measure(&self, state: &State, seed: u64, oscillations: u32) -> Outcome<Speed> {
        let oscillations_text = oscillations.to_string();
        let mut run = Command::new(&self.program);
        run.args(flags(state)).args(["--seed", &seed.to_string()]);
        run.args(["--periods", &oscillations_text, "--every", &oscillations_text, "--v", "0"]);
        let output = String::from_utf8(run.output()?.stdout)?;
        let last = output.lines().last().unwrap_or_default();
        let found = field(last, "coll=").zip(field(last, "coll/s="));
        let (collisions, per_second) = found.ok_or_else(|| format!("the reference said “{last}”"))?;
        Ok(Speed { per_second, per_oscillation: collisions / f64::from(oscillations) })
    }
}

/// Returns the flags of the program for the same state.
fn flags(state: &State) -> Vec<String> {
    let State { gravity, friction, inelasticity } = *state;
    let flags = [
        ("--n", state::DISKS as f64),
        ("--lx", state::WIDTH),
        ("--ly", state::HEIGHT),
        ("--amp", state::AMPLITUDE),
        ("--tc", state::CONTACT_DURATION),
        ("--g", gravity),
        ("--q", inelasticity),
        ("--k0", friction),
        ("--k1", friction + STEP),
        ("--dk", STEP),
    ];
    flags.into_iter().flat_map(|(flag, value)| [flag.to_owned(), value.to_string()]).collect()
}

/// Returns the number after this name in a line of names and numbers.
fn field(line: &str, name: &str) -> Option<f64> {
    line.split_whitespace().find_map(|word| word.strip_prefix(name))?.parse().ok()
}
