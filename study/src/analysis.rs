//! Analysis: states, transitions and Table I from measured series.
//!
//! | question | answer | source |
//! |---|---|---|
//! | which convective states a run shows | [`StateCriteria::classify`] | paper, section III |
//! | where a ramp changes state, and its hysteresis | [`transitions`] | paper, Fig. 5 |
//!
//! Errors of means over correlated series come from [`statistics`](granular_edmd::statistics).
//!
//! Everything is deterministic: the same numbers and seeds give the same bits.
//!
//! ```
//! use granular_edmd_study::analysis::{ConvectiveState, StateCriteria, thermal_noise};
//! use granular_edmd::observable::ConvectionOrder;
//!
//! // A roll that turns clockwise for most of the time, and the other way for a while.
//! let order = |one_roll| ConvectionOrder::new(one_roll, 0.04);
//! let samples = [[0.12; 3].as_slice(), &[-0.12; 2], &[0.12; 3]].concat().into_iter().map(order);
//! let noise = thermal_noise(0.3, 1.0, 1000)?;
//! let found = StateCriteria::default().classify(&samples.collect::<Vec<_>>(), noise, None)?;
//! assert_eq!(found.state(), ConvectiveState::ClockwiseRoll);
//! assert_eq!(found.weight(ConvectiveState::CounterclockwiseRoll), 0.25);
//! # Ok::<(), granular_edmd::ParameterError>(())
//! ```

mod clusters;

pub use clusters::{Cluster, Clusters};

use std::fmt;

use granular_edmd::ParameterError;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{ConvectionOrder, DenseLayer};
use granular_edmd::quantity::{accept, finite, non_negative, positive};

use self::clusters::distinct_clusters;

/// The motion of the disks in one cluster of the plane of Ψ₁ and Ψ₂ (paper, section III).
///
/// ```
/// use granular_edmd_study::analysis::ConvectiveState;
/// assert_eq!(ConvectiveState::ClockwiseRoll.rolls(), Some(1));
/// assert_eq!(ConvectiveState::Collapsed.to_string(), "collapsed");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub enum ConvectiveState {
    /// A state without flow, in which heat is conducted.
    #[serde(alias = "Conductive")]
    NoRoll,
    /// A single roll that rises on the left: Ψ₁ > 0.
    ClockwiseRoll,
    /// A single roll that rises on the right: Ψ₁ < 0.
    CounterclockwiseRoll,
    /// Two rolls that rise in the middle: Ψ₂ > 0.
    TwoRollsUp,
    /// Two rolls that sink in the middle: Ψ₂ < 0.
    TwoRollsDown,
    /// A compact layer of disks that floats on a gas.
    Collapsed,
}

impl ConvectiveState {
    /// Returns the number of rolls, or `None` for the collapsed state.
    pub const fn rolls(self) -> Option<usize> {
        match self {
            Self::NoRoll => Some(0),
            Self::ClockwiseRoll | Self::CounterclockwiseRoll => Some(1),
            Self::TwoRollsUp | Self::TwoRollsDown => Some(2),
            Self::Collapsed => None,
        }
    }
}

impl fmt::Display for ConvectiveState {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::NoRoll => "no roll",
            Self::ClockwiseRoll => "one roll, clockwise",
            Self::CounterclockwiseRoll => "one roll, counterclockwise",
            Self::TwoRollsUp => "two rolls, up in the middle",
            Self::TwoRollsDown => "two rolls, down in the middle",
            Self::Collapsed => "collapsed",
        })
    }
}

/// The regions of the paper's Fig. 5, in the order of growing energy loss.
///
/// ```
/// use granular_edmd_study::analysis::ConvectiveRegime;
/// assert!(ConvectiveRegime::OneRoll < ConvectiveRegime::Coexistence);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub enum ConvectiveRegime {
    /// Region "0": no rolls.
    #[serde(alias = "Conductive")]
    NoRoll,
    /// Region "1": one roll of either sense.
    OneRoll,
    /// The region between the lines 1–2 (a) and (b), where one roll and two rolls alternate.
    Coexistence,
    /// Region "2": two rolls.
    TwoRolls,
    /// Region "Collapse".
    Collapsed,
}

impl ConvectiveRegime {
    /// All regimes, in the order of growing energy loss.
    pub const ALL: &'static [Self] =
        &[Self::NoRoll, Self::OneRoll, Self::Coexistence, Self::TwoRolls, Self::Collapsed];
}

impl fmt::Display for ConvectiveRegime {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::NoRoll => "no roll",
            Self::OneRoll => "one roll",
            Self::Coexistence => "coexistence of one roll and two",
            Self::TwoRolls => "two rolls",
            Self::Collapsed => "collapsed",
        })
    }
}

/// The lines of the paper's Fig. 5 and the rows of its Table I.
///
/// ```
/// use granular_edmd_study::analysis::TransitionLine;
/// assert_eq!(TransitionLine::ALL.map(|line| line.to_string()), ["0-1", "1-2(a)", "1-2(b)", "2-collapse"]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
pub enum TransitionLine {
    /// Line "0-1": the first roll appears.
    ZeroOne,
    /// Line "1-2(a)": the coexistence of one roll and two rolls begins.
    OneTwoBeginning,
    /// Line "1-2(b)": the coexistence ends.
    OneTwoEnd,
    /// Line "2-collapse".
    TwoCollapse,
}

impl TransitionLine {
    /// All lines, in the order of growing energy loss.
    pub const ALL: [Self; 4] = [Self::ZeroOne, Self::OneTwoBeginning, Self::OneTwoEnd, Self::TwoCollapse];

    /// Returns the first regime beyond the line.
    const fn beyond(self) -> ConvectiveRegime {
        match self {
            Self::ZeroOne => ConvectiveRegime::OneRoll,
            Self::OneTwoBeginning => ConvectiveRegime::Coexistence,
            Self::OneTwoEnd => ConvectiveRegime::TwoRolls,
            Self::TwoCollapse => ConvectiveRegime::Collapsed,
        }
    }

    /// Returns whether a control value, at which the given regimes were seen, lies beyond the line. If the
    /// regimes lie on both sides, the value is beyond line 1–2 (a) and before line 1–2 (b); for the other
    /// lines the result is `None`.
    fn side(self, seen: Seen) -> Option<bool> {
        let (least, most) = (seen.least >= self.beyond(), seen.most >= self.beyond());
        match self {
            Self::OneTwoBeginning => Some(most),
            Self::OneTwoEnd => Some(least),
            Self::ZeroOne | Self::TwoCollapse => (least == most).then_some(least),
        }
    }
}

impl fmt::Display for TransitionLine {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::ZeroOne => "0-1",
            Self::OneTwoBeginning => "1-2(a)",
            Self::OneTwoEnd => "1-2(b)",
            Self::TwoCollapse => "2-collapse",
        })
    }
}

/// A point of a transition line; made by [`transitions`].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Transition {
    /// The transition line to which the point belongs.
    pub line: TransitionLine,
    /// Midpoint of the neighboring control values on the two sides of the line.
    pub value: f64,
    /// Half the difference of these control values. The transition lies between `value - error` and
    /// `value + error`.
    pub error: f64,
    /// True if increasing the control value leads to the regime with the larger energy loss. It is false
    /// where the paper finds re-entrance.
    pub rising: bool,
}

/// The regimes seen at one control value.
#[derive(Debug, Clone, Copy)]
struct Seen {
    value: f64,
    least: ConvectiveRegime,
    most: ConvectiveRegime,
}

/// Finds the transitions along one control parameter.
///
/// The observations are the regimes seen at all values of the parameter, in any order: from ramps up, ramps
/// down, and runs with other seeds. The result is in ascending order of the values, and at equal values in
/// the order of the lines.
///
/// There is hysteresis if runs at the same control value end in different regimes. Coexistence begins (a) at
/// the first value where a run shows two rolls, or both numbers of rolls alternately, and ends (b) at the
/// last value where a run shows anything but two rolls. The other two lines have no hysteresis in the paper.
/// If runs disagree about such a line, the transition lies somewhere between the values at which the runs
/// agree, and the error of the transition covers this range. The observations of a single ramp give the
/// transitions of this ramp.
///
/// # Errors
/// If a control value is not finite.
///
/// ```
/// use granular_edmd_study::analysis::ConvectiveRegime::{OneRoll, TwoRolls};
/// use granular_edmd_study::analysis::{TransitionLine, transitions};
/// let up = [(0.050, OneRoll), (0.055, OneRoll), (0.060, OneRoll), (0.065, TwoRolls)];
/// let down = [(0.065, TwoRolls), (0.060, TwoRolls), (0.055, TwoRolls), (0.050, OneRoll)];
/// let found = transitions(up.into_iter().chain(down))?;
/// assert_eq!(found.len(), 2);
/// assert_eq!(found[0].line, TransitionLine::OneTwoBeginning);
/// assert!((found[0].value - 0.0525).abs() < 1e-12 && (found[1].value - 0.0625).abs() < 1e-12);
/// assert!((found[0].error - 0.0025).abs() < 1e-12);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn transitions(
    observations: impl IntoIterator<Item = (f64, ConvectiveRegime)>,
) -> Result<Vec<Transition>, ParameterError> {
    let seen = merge(observations)?;
    let mut found: Vec<Transition> =
        TransitionLine::ALL.into_iter().flat_map(|line| crossings(line, &seen)).collect();
    found.sort_by(|a, b| a.value.total_cmp(&b.value).then(a.line.cmp(&b.line)));
    Ok(found)
}

/// Merges the observations into one entry for each control value, in ascending order.
fn merge(
    observations: impl IntoIterator<Item = (f64, ConvectiveRegime)>,
) -> Result<Vec<Seen>, ParameterError> {
    let check =
        |(value, regime)| Ok(Seen { value: finite("control value", value)?, least: regime, most: regime });
    let mut all = observations.into_iter().map(check).collect::<Result<Vec<_>, ParameterError>>()?;
    all.sort_by(|a, b| a.value.total_cmp(&b.value));
    // Because of hysteresis, runs at one value may end in different regimes. The value's entry keeps the
    // lowest and the highest regime.
    all.dedup_by(|next, kept| {
        let same = next.value == kept.value;
        if same {
            kept.least = kept.least.min(next.least);
            kept.most = kept.most.max(next.most);
        }
        same
    });
    Ok(all)
}

/// Returns the crossings of a line. A crossing lies between neighbors on different sides of the line, among
/// the values whose side is certain.
fn crossings(line: TransitionLine, seen: &[Seen]) -> Vec<Transition> {
    let certain: Vec<(f64, bool)> =
        seen.iter().filter_map(|&seen| Some((seen.value, line.side(seen)?))).collect();
    let across = certain.windows(2).filter(|pair| pair[0].1 != pair[1].1);
    across
        .map(|pair| Transition {
            line,
            // The values are halved before they are added, since the sum of two large values may overflow.
            value: 0.5 * pair[0].0 + 0.5 * pair[1].0,
            error: 0.5 * pair[1].0 - 0.5 * pair[0].0,
            rising: pair[1].1,
        })
        .collect()
}

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
}

impl Default for StateCriteria {
    fn default() -> Self {
        Self { noise_multiple: 3.0, packing_fraction: 0.60, collapsed_order: 0.03, two_rolls: 2.0 }
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
        let two_rolls: f64 = clusters.iter().map(|cluster| cluster.weight() * cluster.center().y).sum();
        let has_died = compact && two_rolls.abs() < self.collapsed_order;
        let flow = |cluster| if has_died { None } else { self.flow(cluster, noise) };
        let name = |cluster| flow(cluster).unwrap_or(without_flow);
        let states = clusters.iter().map(name).collect();
        Ok(Classification { clusters, states })
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

/// The smallest weight that one roll and two rolls must each have to count as coexisting.
const LEAST_WEIGHT: f64 = 0.05;

/// The clusters of a run with their names; made by [`StateCriteria::classify`].
#[derive(Debug, Clone, PartialEq)]
pub struct Classification {
    clusters: Clusters,
    states: Vec<ConvectiveState>,
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

    /// Returns the region of Fig. 5. It is coexistence if one roll and two rolls each have at least a weight
    /// of 0.05, while no roll and the collapsed state together have less. Otherwise, the largest weight
    /// decides.
    ///
    /// Near the collapse, two rolls come and go, and lean to one side in between. This is a transition from
    /// flow to no flow, not a coexistence of one roll and two rolls.
    pub fn regime(&self) -> ConvectiveRegime {
        let [none, one, two] = [0, 1, 2].map(|rolls| self.weight_of_rolls(rolls));
        let collapsed = self.weight(ConvectiveState::Collapsed);
        let least = |weight: f64| weight >= LEAST_WEIGHT;
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
