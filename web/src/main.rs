//! Builds the page and serves it to this machine, or runs a plan without a browser.
//!
//! ```text
//! cargo run --release --manifest-path web/Cargo.toml                  build, and serve on a free port
//! cargo run --release --manifest-path web/Cargo.toml -- serve 8000    the same on this port
//! cargo run --release --manifest-path web/Cargo.toml -- build         build for any static server
//! cargo run --release --manifest-path web/Cargo.toml -- hash 1 0:0.03,0,0.015625,0.1,10 600
//! ```

mod serve;
mod site;

use std::process::ExitCode;

use rolls::{Failure, Plan, Run};

const USAGE: &str = "usage: rolls [serve [PORT] | build | hash SEED PLAN OSCILLATIONS [DIAMETER,DENSITY]]";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[&str]) -> Result<(), Failure> {
    match arguments {
        [] | ["serve"] => serve(0),
        ["serve", port] => serve(port.parse().map_err(|_| format!("{port} is no port"))?),
        ["build"] => site::build().map(|folder| println!("the page is in {}", folder.display())),
        ["hash", seed, plan, oscillations] => hash(seed, plan, oscillations, "rolls"),
        ["hash", seed, plan, oscillations, large] => hash(seed, plan, oscillations, large),
        _ => Err(USAGE.into()),
    }
}

fn serve(port: u16) -> Result<(), Failure> {
    let folder = site::build()?;
    serve::serve(&folder, port)
}

/// Prints the hash of the state that the page shows after so many oscillations of the same plan.
fn hash(seed: &str, plan: &str, oscillations: &str, scene: &str) -> Result<(), Failure> {
    let number = |text: &str| text.parse::<u32>().map_err(|_| format!("{text} is not in 0..2^32"));
    let (seed, plan, oscillations) = (number(seed)?, plan.parse::<Plan>()?, number(oscillations)?);
    println!("{}", Run::planned(seed.into(), scene.parse()?, &plan, oscillations.into())?);
    Ok(())
}
