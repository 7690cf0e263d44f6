//! The folder with the page: the files of `page/`, the library as WebAssembly, and the states of Fig. 5.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use rolls::Failure;

const TARGET: &str = "wasm32-unknown-unknown";

/// Gravities at which the states of Fig. 5 are recorded.
const GRAVITIES: [&str; 2] = ["0.015625", "0.002025"];

/// Builds the folder, and returns where it is.
pub(crate) fn build() -> Result<PathBuf, Failure> {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let target = package.join("target");
    compile(package, &target)?;
    let site = target.join("site");
    fs::create_dir_all(&site)?;
    for file in fs::read_dir(package.join("page"))? {
        let file = file?;
        fs::copy(file.path(), site.join(file.file_name()))?;
    }
    fs::copy(target.join(TARGET).join("release/rolls.wasm"), site.join("rolls.wasm"))?;
    for gravity in GRAVITIES {
        let points = format!("../docs/reproduction/fig5_phase_diagram-{gravity}/points.csv");
        let states = states(&fs::read_to_string(package.join(points))?)?;
        fs::write(site.join(format!("states-{gravity}.csv")), states)?;
    }
    Ok(site)
}

/// Returns friction, inelasticity and state of the runs on the way up: a tenth of the table.
fn states(points: &str) -> Result<String, Failure> {
    let mut states = vec!["friction,inelasticity,state".to_owned()];
    for line in points.lines().skip(1) {
        let columns: Vec<&str> = line.split(',').collect();
        let [_, friction, inelasticity, leg, state, ..] = columns[..] else {
            return Err(format!("not a point of Fig. 5: {line}").into());
        };
        if leg == "up" {
            states.push(format!("{friction},{inelasticity},{state}"));
        }
    }
    Ok(states.join("\n"))
}

fn compile(package: &Path, target: &Path) -> Result<(), Failure> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let built = Command::new(cargo)
        .args(["build", "--release", "--lib", "--target", TARGET, "--target-dir"])
        .arg(target)
        .arg("--manifest-path")
        .arg(package.join("Cargo.toml"))
        .status()?;
    let advice =
        format!("the library did not build as WebAssembly; is the target there? rustup target add {TARGET}");
    if built.success() { Ok(()) } else { Err(advice.into()) }
}
