//! The order parameters of the convection rolls.

use std::f64::consts::TAU;

use super::{Heading, Observable, Snapshot, Tabular};

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

impl Tabular for OrderParameters {
    fn headings(&self) -> Vec<Heading> {
        vec![Heading::new("one_roll", "length/time"), Heading::new("two_rolls", "length/time")]
    }

    fn add_numbers(&self, value: &ConvectionOrder, row: &mut Vec<f64>) {
        row.extend([value.one_roll, value.two_rolls]);
    }
}
