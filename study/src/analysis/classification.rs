//! The names of states, found from order parameters.

use granular_edmd::ParameterError;
use granular_edmd::observable::{ConvectionOrder, DenseLayer};
use granular_edmd::quantity::{accept, non_negative, positive};

use super::clusters::{Cluster, Clusters, distinct_clusters};
use super::states::{ConvectiveRegime, ConvectiveState};
use granular_edmd::glam::DVec2;

/// Seed of the clustering. Distinct clusters do not depend on it.
const SEED: u64 = 0;

/// Returns the standard deviation of Ψ₁ and of Ψ₂, which are velocities, in a gas at rest.
///
/// The deviation is
///
/// ```math
/// \sigma = \sqrt{\frac{T_y}{2Nm}},
/// ```
///
/// for $`N`$ disks of mass $`m`$ at the vertical temperature $`T_y = m\langle v_y^2\rangle`$. The formula
/// holds for independent velocities and for disks spread evenly over the width, where
/// $`\langle\sin^2\rangle = 1/2`$. Just below the onset of convection, the slow mode $`\Psi_1`$ fluctuates
/// more than this deviation.
///
/// # Errors
/// If the temperature is negative, the mass is not positive, either is not finite, or there are no disks.
///
/// ```
/// use granular_edmd_study::analysis::thermal_noise;
/// assert!((thermal_noise(0.3, 1.0, 1000)? - 0.01225).abs() < 1e-5);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn thermal_noise(vertical_temperature: f64, mass: f64, disks: usize) -> Result<f64, ParameterError> {
    non_negative("vertical temperature", vertical_temperature)?;
    positive("mass", mass)?;
    accept(disks > 0, "number of disks", "at least 1", 0.0)?;
    Ok((vertical_temperature / (2.0 * disks as f64 * mass)).sqrt())
}

/// The criteria by which a state gets its name.
///
/// The samples of $`(\Psi_1, \Psi_2)`$ are divided into the largest number of clusters, from 1 to 4, whose
/// pairs are all separated by more than 4 ([`Clusters::separation`]). A single cloud, of symmetric density
/// with one maximum, that k-means cuts in two gives a separation of at most $`2\sqrt3 = 3.46`$. The names
/// follow from these clusters and the [`thermal_noise`] $`\sigma`$:
///
/// 1. A run as a whole is **collapsed** if two conditions hold. First, its height profile has a compact
///    layer, of packing fraction above 0.60, on a gas of less than half this packing fraction. Second, its
///    two-roll flow has died: $`|\langle\Psi_2\rangle| < 0.03`$.
/// 2. A cluster shows **no roll** if its center is at most $`3\sigma`$ from the origin. If the height profile
///    has a compact layer, the cluster is collapsed instead: near the collapse, two rolls come and go over
///    the layer.
/// 3. A cluster shows **two rolls** if $`|\Psi_2| > 2|\Psi_1|`$: the disks rise in the middle if $`\Psi_2`$
///    is positive, and otherwise sink there.
/// 4. A cluster shows **one roll** otherwise: a clockwise one if $`\Psi_1`$ is positive, and otherwise a
///    counterclockwise one.
///
/// The bound of $`3\sigma`$ compares the center of a cluster with *single* samples of a gas at rest. A
/// fraction $`e^{-9/2}`$ of these samples, one in ninety, lies beyond the bound. Unlike an error of the mean,
/// this bound does not depend on the correlation of the samples. The rolls of the paper's system are far
/// above the bound, so its value matters only at their onset.
///
/// In two equal rolls $`\Psi_1`$ vanishes, while one roll may have any $`\Psi_2`$ (paper, section III). At
/// large gravity, $`\Psi_2`$ of one roll is a third of $`|\Psi_1|`$. At small gravity, the roll leans further
/// to one side as the loss grows, until $`|\Psi_2|`$ equals $`|\Psi_1|`$: there, a bound of 1 on their ratio
/// would name the roll two rolls. A bound of 1.5 or 3 instead of 2 hardly matters: it changes the names of
/// three or four of the 1682 states in `docs/reproduction/runs.tar.xz`.
///
/// A collapsed run keeps a weak, slow $`\Psi_2`$, whose mean settles only after thousands of oscillations.
///
/// ```
/// use granular_edmd_study::analysis::{ConvectiveRegime, StateCriteria};
/// use granular_edmd::observable::ConvectionOrder;
/// let at = ConvectionOrder::new;
/// let samples = [at(0.118, 0.045), at(-0.118, 0.045), at(0.0, 0.122), at(0.001, 0.122)];
/// let found = StateCriteria::default().classify(&samples, 0.012, None)?;
/// assert_eq!(found.regime(), ConvectiveRegime::Coexistence);
/// assert_eq!(found.weight_of_rolls(2), 0.5);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateCriteria {
    noise_multiple: f64,
    packing_fraction: f64,
    collapsed_order: f64,
    two_rolls: f64,
    least_weight: f64,
}

impl Default for StateCriteria {
    fn default() -> Self {
        Self {
            noise_multiple: 3.0,
            packing_fraction: 0.60,
            collapsed_order: 0.03,
            two_rolls: 2.0,
            least_weight: 0.05,
        }
    }
}

impl StateCriteria {
    /// Sets the multiple of the thermal noise above which flow counts; 3 unless set.
    ///
    /// # Errors
    /// If the multiple is negative or not finite.
    pub fn with_noise_multiple(self, multiple: f64) -> Result<Self, ParameterError> {
        Ok(Self { noise_multiple: non_negative("multiple of the noise", multiple)?, ..self })
    }

    /// Sets the packing fraction above which a layer is compact (0.60 unless set), and the value of |⟨Ψ₂⟩|
    /// below which two-roll flow has died (0.03 unless set).
    ///
    /// The bound on $`|\langle\Psi_2\rangle|`$ is a velocity; 0.03 is meant for $`A\omega = 1`$, as in the
    /// paper ([`with_base_speed`](Self::with_base_speed)).
    ///
    /// # Errors
    /// If either is negative or not finite.
    pub fn with_collapse(self, packing_fraction: f64, order: f64) -> Result<Self, ParameterError> {
        let packing_fraction = non_negative("packing fraction", packing_fraction)?;
        Ok(Self {
            packing_fraction,
            collapsed_order: non_negative("order of a collapsed state", order)?,
            ..self
        })
    }

    /// Multiplies the bound on |⟨Ψ₂⟩| by the speed of the base, $`A\omega`$ (or $`\sqrt{T_0/m}`$ of a thermal
    /// base), in the units of the samples.
    ///
    /// # Errors
    /// If the speed is not positive or not finite.
    pub fn with_base_speed(self, speed: f64) -> Result<Self, ParameterError> {
        let collapsed_order = self.collapsed_order * positive("speed of the base", speed)?;
        Ok(Self { collapsed_order, ..self })
    }

    /// Sets the ratio |Ψ₂|/|Ψ₁| above which a cluster shows two rolls; 2 unless set.
    ///
    /// ```
    /// use granular_edmd_study::analysis::{ConvectiveRegime, StateCriteria};
    /// use granular_edmd::observable::ConvectionOrder;
    /// let lopsided = [ConvectionOrder::new(0.043, 0.048)];
    /// let regime = |criteria: StateCriteria| Ok(criteria.classify(&lopsided, 0.006, None)?.regime());
    /// assert_eq!(regime(StateCriteria::default())?, ConvectiveRegime::OneRoll);
    /// assert_eq!(regime(StateCriteria::default().with_two_rolls(1.0)?)?, ConvectiveRegime::TwoRolls);
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    ///
    /// # Errors
    /// If the ratio is not positive or not finite.
    pub fn with_two_rolls(self, ratio: f64) -> Result<Self, ParameterError> {
        Ok(Self { two_rolls: positive("ratio of two rolls to one", ratio)?, ..self })
    }

    /// Sets the smallest weight that one roll and two rolls must each have to count as coexisting; 0.05
    /// unless set.
    ///
    /// # Errors
    /// If the weight is not in `[0, 0.5]`.
    pub fn with_least_weight(self, weight: f64) -> Result<Self, ParameterError> {
        let valid = (0.0..=0.5).contains(&weight);
        Ok(Self { least_weight: accept(valid, "least weight", "in [0, 0.5]", weight)?, ..self })
    }

    /// Finds the states of these samples above the thermal noise `noise`.
    ///
    /// `layer` is the [densest layer](granular_edmd::observable::HeightProfile::densest_layer) of the height
    /// profile. Without it no state is collapsed.
    ///
    /// # Errors
    /// If there is no sample, a sample is not finite or above 1e100 in magnitude, or the noise is negative or
    /// not finite.
    pub fn classify(
        &self,
        samples: &[ConvectionOrder],
        noise: f64,
        layer: Option<DenseLayer>,
    ) -> Result<Classification, ParameterError> {
        let points: Vec<DVec2> =
            samples.iter().map(|order| DVec2::new(order.one_roll, order.two_rolls)).collect();
        let clusters = distinct_clusters(&points, noise, SEED)?;
        let compact = layer.is_some_and(|layer| self.is_compact(layer));
        let without_flow = if compact { ConvectiveState::Collapsed } else { ConvectiveState::NoRoll };
        let has_died = compact && mean_of_two_rolls(&clusters).abs() < self.collapsed_order;
        let flow = |cluster| if has_died { None } else { self.flow(cluster, noise) };
        let name = |cluster| flow(cluster).unwrap_or(without_flow);
        let states = clusters.iter().map(name).collect();
        Ok(Classification { clusters, states, least_weight: self.least_weight })
    }

    fn is_compact(&self, layer: DenseLayer) -> bool {
        layer.packing_fraction > self.packing_fraction && layer.least_below < 0.5 * layer.packing_fraction
    }

    /// Returns the name of a cluster's flow, or `None` if the flow is within the noise.
    fn flow(&self, cluster: &Cluster, noise: f64) -> Option<ConvectiveState> {
        let DVec2 { x: one_roll, y: two_rolls } = cluster.center();
        if cluster.center().length() <= self.noise_multiple * noise {
            None
        } else if two_rolls.abs() > self.two_rolls * one_roll.abs() {
            Some(if two_rolls > 0.0 { ConvectiveState::TwoRollsUp } else { ConvectiveState::TwoRollsDown })
        } else if one_roll > 0.0 {
            Some(ConvectiveState::ClockwiseRoll)
        } else {
            Some(ConvectiveState::CounterclockwiseRoll)
        }
    }
}

/// Returns the mean of Ψ₂ over all samples.
fn mean_of_two_rolls(clusters: &Clusters) -> f64 {
    clusters.iter().map(|cluster| cluster.weight() * cluster.center().y).sum()
}

/// The clusters of a run with their names; made by [`StateCriteria::classify`].
#[derive(Debug, Clone, PartialEq)]
pub struct Classification {
    clusters: Clusters,
    states: Vec<ConvectiveState>,
    least_weight: f64,
}

impl Classification {
    /// Returns the clusters in the plane of Ψ₁ (x) and Ψ₂ (y).
    pub const fn clusters(&self) -> &Clusters {
        &self.clusters
    }

    /// Iterates over the clusters with their names.
    ///
    /// A name may occur twice.
    pub fn iter(&self) -> impl Iterator<Item = (ConvectiveState, &Cluster)> {
        self.states.iter().copied().zip(self.clusters.iter())
    }

    /// Returns the state with the largest weight.
    ///
    /// If several states have the same largest weight, the state of the first cluster wins.
    pub fn state(&self) -> ConvectiveState {
        let weights = self.states.iter().map(|&state| (state, self.weight(state)));
        let start = (ConvectiveState::NoRoll, 0.0);
        weights.fold(start, |best, next| if next.1 > best.1 { next } else { best }).0
    }

    /// Returns the fraction of the samples in this state.
    pub fn weight(&self, state: ConvectiveState) -> f64 {
        self.sum_weights(|of| of == state)
    }

    /// Returns the fraction of the samples with this number of rolls.
    pub fn weight_of_rolls(&self, rolls: usize) -> f64 {
        self.sum_weights(|of| of.rolls() == Some(rolls))
    }

    fn sum_weights(&self, counts: impl Fn(ConvectiveState) -> bool) -> f64 {
        self.iter().filter(|&(state, _)| counts(state)).map(|(_, cluster)| cluster.weight()).sum()
    }

    /// Returns the region of Fig. 5. It is coexistence if one roll and two rolls each have at least the
    /// [least weight](StateCriteria::with_least_weight), while no roll and the collapsed state together have
    /// less. Otherwise, the largest weight decides.
    ///
    /// Near the collapse, two rolls come and go, and lean to one side in between. This is a transition from
    /// flow to no flow, not a coexistence of one roll and two rolls.
    pub fn regime(&self) -> ConvectiveRegime {
        let [none, one, two] = [0, 1, 2].map(|rolls| self.weight_of_rolls(rolls));
        let collapsed = self.weight(ConvectiveState::Collapsed);
        let least = |weight: f64| weight > 0.0 && weight >= self.least_weight;
        if self.state() == ConvectiveState::Collapsed {
            ConvectiveRegime::Collapsed
        } else if none >= one.max(two) {
            ConvectiveRegime::NoRoll
        } else if least(one.min(two)) && !least(none + collapsed) {
            ConvectiveRegime::Coexistence
        } else if one > two {
            ConvectiveRegime::OneRoll
        } else {
            ConvectiveRegime::TwoRolls
        }
    }
}
