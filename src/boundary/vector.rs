//! Points and directions of bricks and parts, and the checks of both.

use glam::DVec2;

use crate::ParameterError;
use crate::quantity::positive;

/// Returns the unit vector at this angle from the `x` axis.
pub(crate) fn direction(angle: f64) -> DVec2 {
    let (sine, cosine) = libm::sincos(angle);
    DVec2::new(cosine, sine)
}

/// Returns the unit vector in a direction of any length.
pub(super) fn unit(direction: DVec2) -> Result<DVec2, ParameterError> {
    let direction = finite_point(direction)?;
    // Dividing by the larger component first keeps squares from vanishing or overflowing.
    let larger = direction.abs().max_element();
    positive("length of a direction", larger)?;
    Ok((direction / larger).normalize())
}

/// Checks that a direction from a file has length 1 up to rounding, and returns it unchanged.
#[cfg(feature = "serde")]
pub(super) fn unit_vector(direction: DVec2) -> Result<DVec2, ParameterError> {
    let length = finite_point(direction)?.length();
    crate::quantity::accept((length - 1.0).abs() <= 1e-12, "length of a direction", "1", length)?;
    Ok(direction)
}

pub(super) fn finite_point(place: DVec2) -> Result<DVec2, ParameterError> {
    crate::disk::bounded_vector("coordinate", place)
}
