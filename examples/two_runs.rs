//! Two runs that differ by the last bit of one position: when they diverge, and what stays the same.
//!
//! ```text
//! cargo run --release --example two_runs
//! ```
//!
//! It takes five seconds. You learn how to replay a run, how chaos shows, and why a result is a mean with an
//! error and not a trajectory.
//!
//! It prints when a disk is first a billionth, a thousandth and a radius away from its twin (t = 16, 49, 68),
//! when a disk first meets another partner (68), the mean |Ψ1| of both runs, and when their Ψ1 first differ
//! by more than Ψ1 fluctuates in one run (99).

use granular_edmd::prelude::*;
use granular_edmd::replay::Replay;

const DISKS: usize = 150;
const BEAT: f64 = std::f64::consts::TAU / 10.0;

fn main() -> anyhow::Result<()> {
    let container = Container::open(40.0)?.with_motion(Wall::Floor, BiParabolic::new(0.1, 10.0)?)?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&container, DISKS, 0.5)?, 0.1, 1)?;
    // The last bit of the position of a grain on the right. On the left, coordinates are so small that their
    // last bits would be lost in sums.
    let mut others = disks.clone();
    if let Some(grain) = others.iter_mut().max_by(|a, b| a.position().x.total_cmp(&b.position().x)) {
        let place = grain.position();
        *grain = grain.with_position(DVec2::new(place.x.next_down(), place.y))?;
    }

    let play = |disks: Vec<Disk>| -> anyhow::Result<_> {
        let rule = ContactDuration::new(Frictional::from_inelasticity(0.05, 0.05, 0.3)?, 1e-4)?;
        let run = Simulation::builder(rule, container.clone()).disks(disks).gravity(0.0156).build()?;
        let mut replay = Replay::new(run, BEAT)?;
        replay.run_until(200.0 * BEAT)?;
        Ok(replay)
    };
    let (first, second) = (play(disks)?, play(others)?);
    for (name, tolerance) in [("a billionth", 1e-9), ("a thousandth", 1e-3), ("a radius", 0.5)] {
        let Some(found) = first.differences(&second, tolerance)? else { continue };
        if let Some(apart) = found.apart {
            println!("t = {:6.2}: disk {} is {name} away from its twin", apart.time, apart.id);
        }
        if let (Some(other), 0.5..) = (found.partners, tolerance) {
            let time = other.collisions[0].collision.time;
            println!("t = {time:6.2}: disk {} meets another partner", other.id);
        }
    }

    // The mean roll is the same in both runs. They count as different from the first time at which their
    // rolls differ by more than the roll of one run fluctuates.
    let mut fluctuation: f64 = 0.0;
    for (name, replay) in [("first", &first), ("second", &second)] {
        let mut series = Series::new(OrderParameters, SampleTimes::every(BEAT)?);
        let mut run = replay.present().clone();
        run.run_until(1200.0 * BEAT, &mut series)?;
        println!("Ψ1 of the {name} run: {}", series.mean(|order| order.one_roll.abs())?);
        let [mean, square] = [1, 2].map(|power| series.mean(|order| order.one_roll.powi(power)));
        fluctuation = fluctuation.max((square?.mean() - mean?.mean().powi(2)).sqrt());
    }
    for time in (1..=200).map(|beat| f64::from(beat) * BEAT) {
        let (Some(one), Some(other)) = (first.at(time)?, second.at(time)?) else { break };
        let [one, other] = [one, other].map(|run| run.measure(&OrderParameters).one_roll);
        if (one - other).abs() > fluctuation {
            println!(
                "t = {time:6.2}: the rolls differ by {:.3}, more than one fluctuates",
                (one - other).abs()
            );
            break;
        }
    }
    Ok(())
}
