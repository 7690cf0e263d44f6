//! Rectangles in which the centers of disks can be, and the checks of points and directions.

use std::fmt;

use glam::DVec2;

use crate::error::Readable;
use crate::quantity::positive;
use crate::{Disk, ParameterError};

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

/// The rectangle that holds the centers of all disks.
///
/// A [`Region`] is any rectangle; only the domain has periods, on which distances between positions and
/// periodic images depend.
///
/// Its left and right sides may be periodic, and so may its lower and upper ends: a disk that leaves at one
/// of them enters at the opposite one.
///
/// ```
/// use granular_edmd::boundary::Domain;
/// use granular_edmd::glam::DVec2;
/// let domain = Domain::new(0.0, 60.0, -0.1, f64::INFINITY).with_periodic_sides();
/// assert_eq!(domain.width(), 60.0);
/// assert_eq!(domain.separation(DVec2::new(59.0, 0.0), DVec2::new(1.0, 0.0)).x, 2.0);
/// assert_eq!(domain.to_string(), "x from 0 to 60 (periodic), y from -0.1 to inf");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Domain {
    /// Left edge.
    pub left: f64,
    /// Right edge.
    pub right: f64,
    /// Lower edge.
    pub bottom: f64,
    /// Upper edge; infinite without a lid.
    #[cfg_attr(feature = "serde", serde(serialize_with = "crate::gate::if_finite"))]
    pub top: f64,
    /// True if a disk that leaves on one side enters on the other.
    pub periodic_sides: bool,
    /// True if a disk that leaves above enters below, and vice versa.
    pub periodic_ends: bool,
}

impl Domain {
    /// Creates a rectangle with walls at its sides; the top may be infinite.
    #[inline]
    pub const fn new(left: f64, right: f64, bottom: f64, top: f64) -> Self {
        Self { left, right, bottom, top, periodic_sides: false, periodic_ends: false }
    }

    /// Returns the same rectangle with periodic sides: a disk that leaves on one side enters on the other.
    #[must_use]
    pub const fn with_periodic_sides(self) -> Self {
        Self { periodic_sides: true, ..self }
    }

    /// Returns the same rectangle with periodic ends: a disk that leaves above enters below, and vice versa.
    #[must_use]
    pub const fn with_periodic_ends(self) -> Self {
        Self { periodic_ends: true, ..self }
    }

    /// Returns the rectangle as a region, without its periods.
    pub(crate) const fn region(&self) -> Region {
        Region::new(DVec2::new(self.left, self.bottom), DVec2::new(self.right, self.top))
    }

    /// Returns the width.
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    /// Returns the height; infinite without a lid.
    pub fn height(&self) -> f64 {
        self.top - self.bottom
    }

    /// Returns the horizontal and the vertical period of the rectangle; 0 where it is not periodic.
    #[inline]
    pub fn periods(&self) -> DVec2 {
        let width = if self.periodic_sides { self.width() } else { 0.0 };
        DVec2::new(width, if self.periodic_ends { self.height() } else { 0.0 })
    }

    /// Returns the displacements of the rectangle's nearest periodic images. The first displacement is zero.
    pub(crate) fn images(&self) -> impl Iterator<Item = DVec2> + use<> {
        let periods = self.periods();
        let shifts = |period: f64| [0.0, -period, period].into_iter().take(if period > 0.0 { 3 } else { 1 });
        shifts(periods.x).flat_map(move |x| shifts(periods.y).map(move |y| DVec2::new(x, y)))
    }

    /// Returns the displacements of another rectangle's periodic images near this rectangle.
    ///
    /// A disk inside the domain reaches beyond it by at most a radius. A radius is less than a quarter of a
    /// period, since the engine requires periods of more than four diameters.
    pub(crate) fn images_of(&self, &Region { min, max }: &Region) -> impl Iterator<Item = DVec2> + use<> {
        let periods = self.periods();
        let columns = numbers(periods.x, self.left - max.x, self.right - min.x);
        let rows = numbers(periods.y, self.bottom - max.y, self.top - min.y);
        columns.flat_map(move |x| rows.clone().map(move |y| DVec2::new(x, y) * periods))
    }

    /// Returns whether a point is in the rectangle, or outside by no more than `slack`.
    #[inline]
    pub fn contains(&self, place: DVec2, slack: f64) -> bool {
        place.x >= self.left - slack
            && place.x <= self.right + slack
            && place.y >= self.bottom - slack
            && place.y <= self.top + slack
    }

    /// Returns the shortest vector from `from` to `to`, across periodic sides where that is shorter.
    pub fn separation(&self, from: DVec2, to: DVec2) -> DVec2 {
        let (separation, periods) = (to - from, self.periods());
        let whole = periods * (separation / periods).round();
        separation - DVec2::select(periods.cmpgt(DVec2::ZERO), whole, DVec2::ZERO)
    }

    /// Returns a point moved into the rectangle by whole periods, in the directions in which the rectangle is
    /// periodic.
    pub fn wrapped(&self, place: DVec2) -> DVec2 {
        let (low, periods) = (DVec2::new(self.left, self.bottom), self.periods());
        let inside = low + (place - low).rem_euclid(periods);
        DVec2::select(periods.cmpgt(DVec2::ZERO), inside, place)
    }

    /// Returns the position of a center in the domain; on the lower of two periodic edges if it is on the
    /// upper one, so that the whole domain holds each center exactly once.
    pub(crate) fn folded(&self, place: DVec2) -> DVec2 {
        let wrapped = self.wrapped(place);
        // The remainder of a small negative number may be rounded to the whole period.
        let is_beyond = wrapped.cmpge(DVec2::new(self.right, self.top)) & self.periods().cmpgt(DVec2::ZERO);
        DVec2::select(is_beyond, DVec2::new(self.left, self.bottom), wrapped)
    }

    /// Returns the unwrapped position of a disk: its position without the shifts at periodic sides and ends.
    ///
    /// Differences of unwrapped positions are displacements.
    ///
    /// ```
    /// use granular_edmd::Disk;
    /// use granular_edmd::boundary::Domain;
    /// use granular_edmd::glam::DVec2;
    /// let domain = Domain::new(0.0, 10.0, 0.0, 5.0).with_periodic_sides();
    /// let disk = Disk::new(DVec2::new(1.0, 2.0), 0.5)?.with_image([3, 0]);
    /// assert_eq!(domain.unwrapped(&disk), DVec2::new(31.0, 2.0));
    /// # Ok::<(), granular_edmd::ParameterError>(())
    /// ```
    pub fn unwrapped(&self, disk: &Disk) -> DVec2 {
        let [right, up] = disk.image();
        disk.position() + self.periods() * DVec2::new(f64::from(right), f64::from(up))
    }
}

/// Returns the whole numbers whose products with the period lie between `low` and `high`, or at most a
/// quarter of a period beyond. Callers refuse input that would give very many numbers.
fn numbers(period: f64, low: f64, high: f64) -> impl Iterator<Item = f64> + Clone {
    const MOST: f64 = 1e4;
    let (first, last) = if period > 0.0 {
        ((low / period - 0.25).ceil(), (high / period + 0.25).floor())
    } else {
        (0.0, 0.0)
    };
    let count = if first.is_finite() { (last - first + 1.0).clamp(0.0, MOST) } else { 0.0 };
    (0..count as u32).map(move |number| first + f64::from(number))
}

impl fmt::Display for Domain {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [left, right, bottom, top] = [self.left, self.right, self.bottom, self.top].map(Readable);
        let sides = if self.periodic_sides { " (periodic)" } else { "" };
        let ends = if self.periodic_ends { " (periodic)" } else { "" };
        write!(formatter, "x from {left} to {right}{sides}, y from {bottom} to {top}{ends}")
    }
}

crate::gate::from_file! {
    Domain {
        left: f64, right: f64, bottom: f64, top: Option<f64>, periodic_sides: bool, periodic_ends: bool
    } => {
        let top = top.unwrap_or(f64::INFINITY);
        Ok(Self { left, right, bottom, top, periodic_sides, periodic_ends })
    }
}

/// A rectangle, whose edges may be infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Region {
    /// Lower left corner.
    pub min: DVec2,
    /// Upper right corner.
    pub max: DVec2,
}

impl Region {
    /// Creates a rectangle from its lower left and upper right corners.
    #[inline]
    pub const fn new(min: DVec2, max: DVec2) -> Self {
        Self { min, max }
    }

    /// Returns the square of this half side about a point.
    pub(crate) fn around(place: DVec2, reach: f64) -> Self {
        Self { min: place - reach, max: place + reach }
    }

    /// Returns the smallest rectangle around all of these, with its corners exchanged if there are none.
    pub(crate) fn enclosing(regions: impl Iterator<Item = Self>) -> Self {
        let none = Self { min: DVec2::INFINITY, max: DVec2::NEG_INFINITY };
        regions.fold(none, |all, one| Self { min: all.min.min(one.min), max: all.max.max(one.max) })
    }

    /// Returns the rectangle, shifted by a vector.
    pub(crate) fn shifted(&self, by: DVec2) -> Self {
        Self { min: self.min + by, max: self.max + by }
    }

    /// Returns the rectangle with its edges moved outward by this distance.
    pub(crate) fn enlarged(&self, by: f64) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }

    /// Returns whether a point is in the rectangle. The right and the upper edges belong to the neighbors of
    /// the rectangle.
    pub(crate) fn contains(&self, place: DVec2) -> bool {
        place.cmpge(self.min).all() && place.cmplt(self.max).all()
    }

    /// Returns whether the rectangle has a point in common with another.
    pub(crate) fn meets(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Returns the intersection of the rectangle with another, which has no area if the two are disjoint.
    pub(crate) fn within(&self, other: &Self) -> Self {
        let min = self.min.max(other.min);
        Self { min, max: self.max.min(other.max).max(min) }
    }

    /// Returns the area of the rectangle.
    pub(crate) fn area(&self) -> f64 {
        (self.max.x - self.min.x) * (self.max.y - self.min.y)
    }

    /// Returns the smallest scalar product of a vector with the points of the rectangle.
    pub(crate) fn least_along(&self, vector: DVec2) -> f64 {
        let nearest = DVec2::select(vector.cmpgt(DVec2::ZERO), self.min, self.max);
        // A zero component must not be multiplied by an infinite edge: the product would not be a number.
        let along = |component: f64, edge: f64| if component == 0.0 { 0.0 } else { component * edge };
        along(vector.x, nearest.x) + along(vector.y, nearest.y)
    }
}
