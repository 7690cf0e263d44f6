//! The quantities that are compared.

/// Means over the samples of a run.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Means {
    pub(crate) height: f64,
    pub(crate) translational: f64,
    pub(crate) rotational: f64,
    /// Mean of $`|\Psi_1|`$.
    pub(crate) one_roll: f64,
    pub(crate) two_rolls: f64,
    /// Disk–disk collisions per unit of time.
    pub(crate) rate: f64,
    /// Mean energy change of these collisions.
    pub(crate) energy_change: f64,
}

/// A quantity and its name in the table.
#[derive(Clone, Copy)]
pub(crate) struct Quantity {
    pub(crate) name: &'static str,
    pub(crate) of: fn(&Means) -> f64,
}

pub(crate) const QUANTITIES: [Quantity; 7] = [
    Quantity { name: "height", of: |means| means.height },
    Quantity { name: "translational energy", of: |means| means.translational },
    Quantity { name: "rotational energy", of: |means| means.rotational },
    Quantity { name: "|Ψ1|", of: |means| means.one_roll },
    Quantity { name: "Ψ2", of: |means| means.two_rolls },
    Quantity { name: "collisions per time", of: |means| means.rate },
    Quantity { name: "energy change", of: |means| means.energy_change },
];

/// One interval: the state at its end, and the collisions in it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Interval {
    pub(crate) height: f64,
    pub(crate) translational: f64,
    pub(crate) rotational: f64,
    pub(crate) one_roll: f64,
    pub(crate) two_rolls: f64,
    pub(crate) collisions: f64,
    /// Energy change of all collisions together.
    pub(crate) energy_change: f64,
}

impl Means {
    /// The means over intervals of this length.
    pub(crate) fn over(intervals: &[Interval], length: f64) -> Self {
        let mean = |of: fn(&Interval) -> f64| intervals.iter().map(of).sum::<f64>() / intervals.len() as f64;
        Self {
            height: mean(|interval| interval.height),
            translational: mean(|interval| interval.translational),
            rotational: mean(|interval| interval.rotational),
            one_roll: mean(|interval| interval.one_roll.abs()),
            two_rolls: mean(|interval| interval.two_rolls),
            rate: mean(|interval| interval.collisions) / length,
            energy_change: mean(|interval| interval.energy_change) / mean(|interval| interval.collisions),
        }
    }
}
