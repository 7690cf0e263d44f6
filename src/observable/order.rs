//! Order: the order parameters of convection rolls, and the hexatic order of dense layers.

use std::f64::consts::TAU;

use glam::DVec2;

use super::table::tabular;
use super::{Heading, Observable, Snapshot, Tabular};
use crate::ParameterError;
use crate::quantity::positive;

/// The order parameters Ψ1 of one convection roll and Ψ2 of two.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct ConvectionOrder {
    /// Order parameter Ψ1 of one roll, positive if the roll turns clockwise.
    pub one_roll: f64,
    /// Order parameter Ψ2 of two rolls, positive if the flow goes up in the middle.
    pub two_rolls: f64,
}

impl ConvectionOrder {
    /// Creates the order parameters of one roll and of two rolls from their values.
    pub const fn new(one_roll: f64, two_rolls: f64) -> Self {
        Self { one_roll, two_rolls }
    }
}

/// The order parameters of one and two convection rolls (paper, Eqs. (10), (11)):
///
/// ```math
/// \Psi_1 = \frac1N\sum_i v_{yi}\sin\frac{2\pi x_i}{L_x},\qquad
/// \Psi_2 = -\frac1N\sum_i v_{yi}\cos\frac{2\pi x_i}{L_x}.
/// ```
///
/// In a gas at rest, each of them fluctuates with the standard deviation $`\sqrt{T_y/2Nm}`$. A roll stands
/// out if its order parameter is larger than that. Positions are measured from the left end of the domain.
/// Both order parameters are 0 without disks.
///
/// ```
/// use granular_edmd::glam::DVec2;
/// use granular_edmd::Disk;
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::observable::{Observable, OrderParameters, Snapshot};
///
/// // Up on the left, down on the right: clockwise.
/// let up = Disk::new(DVec2::new(15.0, 5.0), 0.5)?.with_velocity(DVec2::Y)?;
/// let down = Disk::new(DVec2::new(45.0, 5.0), 0.5)?.with_velocity(-DVec2::Y)?;
/// let domain = Domain::new(0.0, 60.0, 0.0, 150.0);
/// let disks = [up, down];
/// let order = OrderParameters.measure(&Snapshot::new(0.0, &disks, domain, 0.0));
/// assert!((order.one_roll - 1.0).abs() < 1e-12 && order.two_rolls.abs() < 1e-12);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, Copy, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OrderParameters;

impl Observable for OrderParameters {
    type Value = ConvectionOrder;

    fn measure(&self, snapshot: &Snapshot<'_>) -> ConvectionOrder {
        let domain = snapshot.domain();
        let mut order = ConvectionOrder::default();
        for disk in snapshot.disks() {
            let (sine, cosine) = libm::sincos(TAU * (disk.position().x - domain.left) / domain.width());
            order.one_roll += disk.velocity().y * sine;
            order.two_rolls -= disk.velocity().y * cosine;
        }
        let count = snapshot.disks().len().max(1) as f64;
        ConvectionOrder { one_roll: order.one_roll / count, two_rolls: order.two_rolls / count }
    }
}

tabular! { OrderParameters, order => {
    "one_roll" ["length/time"]: order.one_roll,
    "two_rolls" ["length/time"]: order.two_rolls,
}}

/// The hexatic order of a snapshot, and the number of neighbors.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Hexatic {
    /// Local order, the mean of |ψ6| over the disks: 1 in a triangular lattice of any orientation.
    pub local: f64,
    /// Global order, the magnitude of the mean of ψ6: 1 in a single crystal.
    pub global: f64,
    /// Coordination number, the mean number of neighbors.
    pub coordination: f64,
}

/// The hexatic order of the disks (Nelson and Halperin 1979), from the directions to the $`n_j`$ neighbors
/// of each disk:
///
/// ```math
/// \psi_6(j) = \frac1{n_j}\sum_k e^{6i\theta_{jk}} .
/// ```
///
/// Two disks are neighbors if the distance between their centers is within the range. A disk without
/// neighbors has no order, ψ6 = 0; disks at walls have neighbors on one side. All values are NaN without
/// disks, and if the range is above half of a period of the domain.
///
/// ```
/// use granular_edmd::observable::HexaticOrder;
/// use granular_edmd::prelude::*;
///
/// // A triangular lattice of lattice constant 1.25, periodic in both directions.
/// let (distance, row) = (1.25, 1.25 * 0.75_f64.sqrt());
/// let place = |k: u32| DVec2::new(f64::from(k % 8) + 0.5 * f64::from(k / 8 % 2), f64::from(k / 8));
/// let disk = |k: u32| Disk::new(place(k) * DVec2::new(distance, row), 0.5);
/// let disks = (0..64).map(disk).collect::<Result<Vec<_>, _>>()?;
/// let container = Container::periodic(8.0 * distance, 8.0 * row)?;
/// let run = Simulation::builder(Elastic, container).disks(disks).build()?;
/// let order = run.measure(&HexaticOrder::new(1.5)?);
/// assert!((order.global - 1.0).abs() < 1e-9 && order.coordination == 6.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct HexaticOrder {
    range: f64,
}

impl HexaticOrder {
    /// Creates an observable for which disks are neighbors if the distance between their centers is at most
    /// `range`.
    ///
    /// # Errors
    /// If the range is not finite and positive.
    pub fn new(range: f64) -> Result<Self, ParameterError> {
        Ok(Self { range: positive("range of the neighbors", range)? })
    }
}

impl Observable for HexaticOrder {
    type Value = Hexatic;

    fn measure(&self, snapshot: &Snapshot<'_>) -> Hexatic {
        let Ok(neighbors) = snapshot.neighbors(self.range) else {
            return Hexatic { local: f64::NAN, global: f64::NAN, coordination: f64::NAN };
        };
        let (mut local, mut global, mut pairs) = (0.0, DVec2::ZERO, 0.0);
        for disk in 0..snapshot.len() {
            let powers = neighbors.of(disk).map(|other| sixth_power(other.separation.normalize_or_zero()));
            let (sum, count) = powers.fold((DVec2::ZERO, 0.0), |(sum, count), one| (sum + one, count + 1.0));
            let order = sum / f64::max(count, 1.0);
            local += order.length();
            global += order;
            pairs += count;
        }
        let disks = snapshot.len() as f64;
        Hexatic { local: local / disks, global: global.length() / disks, coordination: pairs / disks }
    }
}

/// Returns the sixth power of a complex number.
fn sixth_power(z: DVec2) -> DVec2 {
    let square = z.rotate(z);
    square.rotate(square).rotate(square)
}

tabular! { HexaticOrder, order => {
    "local_hexatic_order" ["1"]: order.local,
    "global_hexatic_order" ["1"]: order.global,
    "coordination" ["1"]: order.coordination,
}}

crate::gate::from_file! {
    HexaticOrder { range: f64 } => Self::new(range)
}
