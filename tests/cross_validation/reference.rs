//! Runs of the other program, and its output.

use std::error::Error;
use std::process::Command;

use crate::means::{Interval, Means};
use crate::{CONTACT_DURATION, DISKS, HEIGHT, INTERVAL, Point, SAMPLES, SETTLE, WIDTH};

/// Means over the sampled part of a run.
///
/// The program counts collisions only for each value of a friction ramp. Therefore, each interval is a value
/// of a ramp whose steps are far too small to matter.
pub(crate) fn run(program: &str, point: Point, seed: u64) -> Result<Means, Box<dyn Error>> {
    const STEP: f64 = 1e-10;
    let settling = SETTLE / INTERVAL;
    let last = point.friction + STEP * (f64::from(settling + SAMPLES) - 0.5);
    let flags = [
        ("--k0", point.friction),
        ("--k1", last),
        ("--dk", STEP),
        ("--q", point.inelasticity),
        ("--g", point.gravity),
        ("--tc", CONTACT_DURATION),
        ("--n", DISKS as f64),
        ("--lx", WIDTH),
        ("--ly", HEIGHT),
        ("--periods", f64::from(INTERVAL)),
        ("--every", f64::from(INTERVAL)),
        ("--seed", seed as f64),
    ];
    let flags = flags.iter().flat_map(|(name, value)| [(*name).to_owned(), value.to_string()]);
    let output = Command::new(program).args(flags).output().map_err(|error| format!("{program}: {error}"))?;
    let intervals = intervals(&String::from_utf8(output.stdout)?)?;
    let expected = (settling + SAMPLES) as usize;
    if intervals.len() != expected {
        return Err(format!("{} intervals instead of {expected}", intervals.len()).into());
    }
    Ok(Means::over(&intervals[settling as usize..], f64::from(INTERVAL) * std::f64::consts::TAU / 10.0))
}

/// Reads the intervals. A `pt` line has the state at the end of an interval, and the `k=` line after it has
/// the events in it.
fn intervals(output: &str) -> Result<Vec<Interval>, Box<dyn Error>> {
    let mut intervals = Vec::new();
    let mut state = Interval::default();
    for line in output.lines() {
        if line.starts_with("pt ") {
            state = read_state(line)?;
        } else if line.starts_with("k=") {
            let collisions = field(line, "coll=")?;
            let energy_change = field(line, "dE/coll=")? * collisions;
            intervals.push(Interval { collisions, energy_change, ..state });
        }
    }
    Ok(intervals)
}

/// Reads a state: `pt`, friction, index, $`\Psi_1`$, $`\Psi_2`$, height, translational and rotational energy.
fn read_state(line: &str) -> Result<Interval, Box<dyn Error>> {
    let numbers: Vec<f64> = line.split_whitespace().skip(3).map(str::parse).collect::<Result<_, _>>()?;
    let [one_roll, two_rolls, height, translational, rotational] = numbers[..] else {
        return Err(format!("not a state: {line}").into());
    };
    Ok(Interval { height, translational, rotational, one_roll, two_rolls, ..Interval::default() })
}

fn field(line: &str, name: &str) -> Result<f64, Box<dyn Error>> {
    let value = line.split_whitespace().find_map(|word| word.strip_prefix(name));
    Ok(value.ok_or_else(|| format!("no {name} in {line}"))?.parse()?)
}
