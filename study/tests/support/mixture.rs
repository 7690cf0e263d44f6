//! An experiment as a user writes it: a mixture of disks under a rule of its own, with samples of variable
//! length.

use granular_edmd::boundary::Container;
use granular_edmd::collision::{CollisionRule, Contact, Impulse};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{CollisionCounts, Snapshot};
use granular_edmd::{Disk, Fingerprint, Gravity, initial, quantity};
use granular_edmd_study::{Column, Experiment, ExperimentError, Record, Table};
use serde::{Deserialize, Serialize};

/// A rule that loses more at higher speeds. It has no fingerprint, like a closure.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sticky {
    pub(crate) loss: f64,
}

impl CollisionRule for Sticky {
    fn impulse(&self, contact: &Contact) -> Impulse {
        let restitution = 1.0 / (1.0 + self.loss * contact.closing_speed());
        Impulse::new(contact.normal_impulse(restitution), 0.0)
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Mixture {
    loss: f64,
    pub(crate) disks: Counts,
    /// Strength of the drive, with gravity: the cycle follows from both.
    pub(crate) weight: f64,
    #[serde(default)]
    pub(crate) note: Option<String>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Counts {
    small: usize,
    pub(crate) large: usize,
}

/// The heights of the large disks that are above the small ones: a list of any length.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Risen {
    pub(crate) heights: Vec<f64>,
    pub(crate) angular_momentum: f64,
    pub(crate) collisions: u64,
}

impl Experiment for Mixture {
    type Rule = Sticky;
    type Boundary = Container;
    type Observer = CollisionCounts;
    type Sample = Risen;

    fn rule(&self) -> Result<Sticky, ExperimentError> {
        Ok(Sticky { loss: quantity::non_negative("loss", self.loss)? })
    }

    fn boundary(&self) -> Result<Container, ExperimentError> {
        Ok(Container::closed(12.0, 12.0)?)
    }

    fn disks(&self, seed: u64) -> Result<Vec<Disk>, ExperimentError> {
        // A mistyped number must not take all memory before the box is found too small for it.
        let most = self.disks.small.max(self.disks.large);
        quantity::accept(most <= 10_000, "number of disks", "at most 10000", most as f64)?;
        let (small, large) = (Disk::new(DVec2::ZERO, 0.3)?, Disk::new(DVec2::ZERO, 0.6)?);
        let disks = vec![small; self.disks.small].into_iter().chain(vec![large; self.disks.large]);
        let disks = initial::scattered_mix(&self.boundary()?, disks.collect::<Vec<_>>(), 12.0, seed)?;
        Ok(initial::with_maxwellian_velocities(disks, 1.0, seed)?)
    }

    fn revision() -> Fingerprint {
        Fingerprint::of("Mixture")
    }

    fn gravity(&self) -> Gravity {
        self.weight.into()
    }

    fn cycle(&self) -> f64 {
        1.0 / (1.0 + self.weight)
    }

    fn observer(&self) -> Result<CollisionCounts, ExperimentError> {
        Ok(CollisionCounts::default())
    }

    fn sample(&self, snapshot: &Snapshot<'_>, observer: &mut CollisionCounts) -> Risen {
        let middle = snapshot.mean(|disk| disk.position().y);
        let large = snapshot.disks().iter().filter(|disk| disk.radius() > 0.5);
        let heights = large.map(|disk| disk.position().y).filter(|height| *height > middle).collect();
        let spin = |disk: &Disk| disk.mass() * disk.position().perp_dot(disk.velocity());
        let counts = std::mem::take(observer);
        Risen { heights, angular_momentum: snapshot.mean(spin), collisions: counts.disk_collisions() }
    }

    fn columns() -> Vec<Column<Self>> {
        vec![
            Column::sampled("risen", "1", |sample: &Risen| sample.heights.len()),
            Column::sampled("angular_momentum", "mass diameter velocity", |sample: &Risen| {
                sample.angular_momentum
            }),
            Column::of_sample("collisions", "1", |sample: &Risen| sample.collisions),
            Column::of_record("overlap", "diameter", |record| record.counters().max_overlap),
        ]
    }

    /// The state is heavy or light, which is known beforehand, so that a test knows the transition.
    fn state(record: &Record<Self>) -> Option<String> {
        Some(if record.experiment().weight > 0.137 { "heavy" } else { "light" }.to_owned())
    }

    fn tables() -> Vec<Table<Self>> {
        vec![Table::new("heights", [("sample", "1"), ("height", "diameter")], |record| {
            let heights = |(index, sample): (usize, &Risen)| -> Vec<Vec<f64>> {
                sample.heights.iter().map(|height| vec![index as f64, *height]).collect()
            };
            record.samples().iter().enumerate().flat_map(heights).collect()
        })]
    }
}

pub(crate) fn mixture() -> Mixture {
    Mixture { loss: 0.05, disks: Counts { small: 12, large: 4 }, weight: 0.1, note: None }
}
