//! A custom collision rule: the slower two grains collide, the more elastic they are.
//!
//! ```text
//! cargo run --release -p granular-edmd --example own_rule
//! ```
//!
//! It takes less than a second. You learn what a rule is (a function from a contact to an impulse), and how
//! to check it. A gas of such grains cools more slowly than one of constant restitution.

use granular_edmd::Fingerprint;
use granular_edmd::collision::laws::{self, Promises};
use granular_edmd::prelude::*;

/// Restitution `1 / (1 + loss v)` of a contact that closes at the speed `v`, without friction.
struct Viscous {
    loss: f64,
}

impl CollisionRule for Viscous {
    fn impulse(&self, contact: &Contact) -> Impulse {
        // The engine handles the geometry. A rule sees the speeds, effective masses and radii of one contact.
        // For friction, `collision::Friction` takes a normal impulse and adds the tangential one.
        let restitution = 1.0 / (1.0 + self.loss * contact.closing_speed());
        Impulse::new(contact.normal_impulse(restitution), 0.0)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        // A checkpoint compares this fingerprint, so that a run resumes under the same rule.
        Some(Fingerprint::of("viscous").number(self.loss))
    }
}

/// Returns the energy of a gas under this rule at times 0, 20, 40 and so on.
fn cooling(rule: impl CollisionRule) -> anyhow::Result<Vec<f64>> {
    let container = Container::periodic(60.0, 60.0)?;
    let disks = initial::scattered(&container, 1000, 0.5, 60.0, 1)?;
    let disks = initial::without_drift(initial::with_maxwellian_velocities(disks, 1.0, 1)?)?;
    let mut simulation = Simulation::builder(rule, container).disks(disks).build()?;
    let mut series = Series::new(Energies, SampleTimes::every(20.0)?.starting_at(0.0)?);
    simulation.run_until(200.0, &mut series)?;
    Ok(series.values().iter().map(|energies| energies.translational).collect())
}

fn main() -> anyhow::Result<()> {
    let rule = Viscous { loss: 0.2 };
    // The check tries half a million contacts, mild and extreme: surfaces must part, and no energy may be
    // gained.
    laws::check(&rule, &Promises::new())?;

    let own = cooling(rule)?;
    // The restitution that the rule has at speed 1, at all speeds.
    let constant = cooling(Smooth::from_restitution(1.0 / 1.2)?)?;
    println!("time  own rule  constant restitution");
    for (step, (own, constant)) in own.iter().zip(&constant).enumerate() {
        println!("{:4} {own:9.5} {constant:21.5}", 20 * step);
    }
    Ok(())
}
