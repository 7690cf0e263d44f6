//! The programs that are compared, each in a separate process: this one, built once for any processor of this
//! architecture and once for the processor at hand, and the plain simulation.

use std::path::PathBuf;
use std::process::Command;

use super::{Speed, ours};
use benches::Outcome;
use benches::state::State;

/// The variable that asks for one measurement: the numbers of the state, the seed and the oscillations.
const ONE: &str = "ONE_MEASUREMENT";

/// A program, built.
pub(crate) struct Built {
    program: PathBuf,
}

impl Built {
    /// Builds a program of this package with these compiler flags, in a folder of this name.
    pub(crate) fn new(name: &str, flags: &str, folder: &str) -> Outcome<Self> {
        let target = benches::working_folder(folder)?;
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut build = Command::new(cargo);
        build.args(["build", "--release", "--quiet", "--bin", name, "--target-dir"]).arg(&target);
        build.current_dir(env!("CARGO_MANIFEST_DIR"));
        build.env_remove("CARGO_ENCODED_RUSTFLAGS").env("RUSTFLAGS", flags);
        let built = build.output()?;
        if !built.status.success() {
            return Err(format!("no build: {}", String::from_utf8_lossy(&built.stderr)).into());
        }
        Ok(Self { program: target.join("release").join(name) })
    }

    /// Measures as [`ours`] does, but in another process.
    pub(crate) fn measure(&self, state: &State, seed: u64, oscillations: u32) -> Outcome<Speed> {
        let State { gravity, friction, inelasticity } = state;
        let asked = format!("{gravity} {friction} {inelasticity} {seed} {oscillations}");
        // The plain simulation takes arguments; this program has none.
        let output = Command::new(&self.program).env(ONE, &asked).args(asked.split(' ')).output()?;
        let said = String::from_utf8(output.stdout)?;
        let numbers = said.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>();
        match numbers.as_deref() {
            Ok(&[per_second, per_oscillation]) => Ok(Speed { per_second, per_oscillation }),
            _ => Err(format!("the bench in its own process said “{said}”").into()),
        }
    }
}

/// Does the one measurement that this process is asked for; returns `None` if it is not asked for one.
pub(crate) fn asked_for() -> Option<Outcome<()>> {
    std::env::var(ONE).ok().map(|asked| answer(&asked))
}

fn answer(asked: &str) -> Outcome<()> {
    let numbers = asked.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>()?;
    let &[gravity, friction, inelasticity, seed, oscillations] = numbers.as_slice() else {
        return Err(format!("{ONE} needs five numbers, not “{asked}”").into());
    };
    let state = State { gravity, friction, inelasticity };
    let Speed { per_second, per_oscillation } = ours(&state, seed as u64, oscillations as u32)?;
    println!("{per_second} {per_oscillation}");
    Ok(())
}
