//! Areas in which the centers of disks are free, as integrals over horizontal lines.
//!
//! A horizontal line crosses the curves at which a center may change between free and occupied: the surfaces
//! of bricks, moved outward by the radius. Between two crossings, a center is free everywhere or nowhere.
//! Between the heights at which curves end, turn or cross, the free length of a line is a smooth function of
//! its height, except for square roots at these heights, which a substitution removes. Gaussian quadrature is
//! then exact to rounding on most pieces; the other pieces are halved.

use glam::DVec2;

use super::Region;

/// Error of the area of a piece, relative to the area of the region, below which the piece is not halved
/// further.
const TOLERANCE: f64 = 1e-12;

/// Largest number of times that a piece is halved. A jump at an unknown height is then lost in rounding.
const MOST_HALVINGS: u32 = 44;

/// Number of parts in which a line between two crossings is examined if some curves may be unknown. Narrower
/// features are lost.
const LOOKS: u32 = 16;

/// Distance of the first and the last examined point from the ends of their interval, relative to its length.
const NEAR_END: f64 = 1e-8;

/// Nodes and weights of the ten-point Gauss–Legendre rule on [-1, 1]: the positive half.
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// A curve that may separate free positions of a center from occupied ones.
#[derive(Debug, Clone, Copy)]
pub(super) enum Curve {
    Line(DVec2, DVec2),
    Circle(DVec2, f64),
}

impl Curve {
    /// Returns the same curve with its points mapped by `to`.
    pub(super) fn moved(self, to: impl Fn(DVec2) -> DVec2) -> Self {
        match self {
            Self::Line(from, end) => Self::Line(to(from), to(end)),
            Self::Circle(center, radius) => Self::Circle(to(center), radius),
        }
    }

    /// Returns the rectangle around the curve.
    pub(super) fn bounds(&self) -> Region {
        match *self {
            Self::Line(from, to) => Region::new(from.min(to), from.max(to)),
            Self::Circle(center, radius) => Region::around(center, radius),
        }
    }

    /// Returns the positions at which a horizontal line crosses the curve.
    fn crossings(&self, height: f64) -> impl Iterator<Item = f64> + use<> {
        let none = [f64::NAN; 2];
        let places = match *self {
            // The interval is half-open, so that a line through the common end of two sides crosses only one
            // side.
            Self::Line(from, to) if (from.y > height) != (to.y > height) => {
                [from.x + (to.x - from.x) * ((height - from.y) / (to.y - from.y)), f64::NAN]
            }
            Self::Line(..) => none,
            Self::Circle(center, radius) => {
                let above = (height - center.y).abs();
                // Written as a product, the difference of squares loses no digits near the top. Beyond the
                // circle it is negative, and its root NaN.
                let half = ((radius - above) * (radius + above)).sqrt();
                [center.x - half, center.x + half]
            }
        };
        places.into_iter().filter(|place| !place.is_nan())
    }

    /// Returns the points at which two curves may cross, with NaN in place of points that do not exist.
    fn meetings(&self, other: &Self) -> [DVec2; 2] {
        match (*self, *other) {
            (Self::Line(from, to), Self::Line(start, end)) => {
                let (way, others) = (to - from, end - start);
                let share = (start - from).perp_dot(others) / way.perp_dot(others);
                [from + share * way, DVec2::NAN]
            }
            (Self::Line(from, to), Self::Circle(center, radius))
            | (Self::Circle(center, radius), Self::Line(from, to)) => {
                let way = (to - from).normalize_or_zero();
                let (along, beside) = ((center - from).dot(way), way.perp_dot(center - from).abs());
                let half = root((radius - beside) * (radius + beside) / (radius * radius)) * radius;
                [from + (along - half) * way, from + (along + half) * way]
            }
            (Self::Circle(one, first), Self::Circle(two, second)) => {
                let apart = two - one;
                let along = 0.5 + 0.5 * (first - second) * (first + second) / apart.length_squared();
                let half = root(first * first / apart.length_squared() - along * along);
                [one + along * apart + half * apart.perp(), one + along * apart - half * apart.perp()]
            }
        }
    }
}

/// Returns the square root of a number, or 0 if the number is 0 up to rounding, as where curves are tangent.
fn root(square: f64) -> f64 {
    const ROUNDING: f64 = 1e-13;
    if square.abs() < ROUNDING { 0.0 } else { square.sqrt() }
}

/// A region, with a test of whether a center in it is free.
pub(super) struct Field<'a> {
    pub(super) region: Region,
    /// The curves that may separate free positions from occupied ones.
    pub(super) curves: Vec<Curve>,
    /// True if no other curves separate them.
    pub(super) are_known: bool,
    pub(super) is_free: &'a dyn Fn(DVec2) -> bool,
}

impl Field<'_> {
    /// Returns the free area.
    pub(super) fn area(mut self) -> f64 {
        let size = self.region.max - self.region.min;
        if !(size.x > 0.0 && size.y > 0.0) {
            return 0.0;
        }
        let region = self.region;
        self.curves.retain(|curve| curve.bounds().meets(&region));
        if self.curves.is_empty() && self.are_known {
            // A region without an upper end has no middle.
            let middle = region.min + 0.5 * size.min(DVec2::splat(1e300));
            return if (self.is_free)(middle) { region.area() } else { 0.0 };
        }
        let top = self.curves.iter().map(|curve| curve.bounds().max.y).fold(region.min.y, f64::max);
        if region.max.y.is_infinite() {
            // Above all curves, a line is free everywhere or nowhere, and so are all lines above it.
            if self.length(top + 1.0, &self.curves) > 0.0 {
                return f64::INFINITY;
            }
            self.region.max.y = top;
        }
        let heights = self.heights();
        heights.windows(2).map(|ends| self.piece(ends[0], ends[1])).sum()
    }

    /// Returns the heights between which the free length is smooth, in ascending order.
    fn heights(&self) -> Vec<f64> {
        let Region { min, max, .. } = self.region;
        let mut heights = vec![min.y, max.y];
        // The sides of the region count as curves: where a curve leaves the region, the free length has a
        // kink.
        let edges = [min.x, max.x].map(|x| Curve::Line(DVec2::new(x, min.y), DVec2::new(x, max.y)));
        let mut curves: Vec<(Region, Curve)> =
            self.curves.iter().chain(&edges).map(|curve| (curve.bounds(), *curve)).collect();
        curves.sort_by(|one, other| one.0.min.x.total_cmp(&other.0.min.x));
        for (index, (bounds, curve)) in curves.iter().enumerate() {
            heights.extend([bounds.min.y, bounds.max.y]);
            let later = curves[index + 1..].iter().take_while(|(other, _)| other.min.x <= bounds.max.x);
            for (_, other) in later.filter(|(other, _)| other.meets(bounds)) {
                heights.extend(curve.meetings(other).map(|place| place.y));
            }
        }
        heights.retain(|&height| height >= min.y && height <= max.y);
        heights.sort_by(f64::total_cmp);
        heights.dedup();
        heights
    }

    fn piece(&self, low: f64, high: f64) -> f64 {
        let reaches = |curve: &&Curve| curve.bounds().min.y < high && curve.bounds().max.y > low;
        let curves: Vec<Curve> = self.curves.iter().filter(reaches).copied().collect();
        let whole = self.quadrature(low, high, &curves);
        self.refined(low, high, &curves, whole, MOST_HALVINGS)
    }

    /// Returns the free area between two heights. `whole` is a first estimate of it.
    fn refined(&self, low: f64, high: f64, curves: &[Curve], whole: f64, halvings: u32) -> f64 {
        let middle = low + 0.5 * (high - low);
        let halves = [(low, middle), (middle, high)].map(|(low, high)| self.quadrature(low, high, curves));
        let sum = halves[0] + halves[1];
        if halvings == 0 || (sum - whole).abs() <= TOLERANCE * self.region.area() {
            return sum;
        }
        self.refined(low, middle, curves, halves[0], halvings - 1)
            + self.refined(middle, high, curves, halves[1], halvings - 1)
    }

    /// Integrates the free length by the ten-point rule. Its variable $`s`$ in [0, 1] gives the height
    /// $`3s^2 - 2s^3`$, in which square roots at both ends are smooth.
    fn quadrature(&self, low: f64, high: f64, curves: &[Curve]) -> f64 {
        let mut sum = 0.0;
        for (node, weight) in GAUSS {
            // Heights are measured from the nearer end, so that heights near the upper end lose no digits.
            let s = 0.5 * (1.0 - node);
            let from_end = (high - low) * s * s * (3.0 - 2.0 * s);
            let lengths = self.length(low + from_end, curves) + self.length(high - from_end, curves);
            sum += 0.5 * weight * 6.0 * s * (1.0 - s) * lengths;
        }
        sum * (high - low)
    }

    /// Returns the total length of the free intervals of a horizontal line.
    fn length(&self, height: f64, curves: &[Curve]) -> f64 {
        let Region { min, max, .. } = self.region;
        let mut ends: Vec<f64> = curves.iter().flat_map(|curve| curve.crossings(height)).collect();
        ends.retain(|&end| end > min.x && end < max.x);
        ends.extend([min.x, max.x]);
        ends.sort_unstable_by(f64::total_cmp);
        ends.windows(2).map(|ends| self.free_between(ends[0], ends[1], height)).sum()
    }

    /// Returns the free length between two crossings. Bisection finds the ends of free intervals at unknown
    /// curves.
    fn free_between(&self, low: f64, high: f64, height: f64) -> f64 {
        if low == high {
            return 0.0;
        }
        let is_free = |place: f64| (self.is_free)(DVec2::new(place, height));
        let places = self.look_between(low, high);
        let (mut start, mut last, mut length) = (low, places[0], 0.0);
        let mut was_free = is_free(last);
        for &place in &places[1..] {
            if is_free(place) != was_free {
                let (mut before, mut after) = (last, place);
                while after - before > 1e-15 * (high - low) && before.next_up() < after {
                    let middle = 0.5 * (before + after);
                    if is_free(middle) == was_free { before = middle } else { after = middle }
                }
                length += if was_free { after - start } else { 0.0 };
                (start, was_free) = (after, !was_free);
            }
            last = place;
        }
        length + if was_free { high - start } else { 0.0 }
    }

    /// Lists the places of a line between two crossings at which a center is examined: the middle, or several
    /// if there may be unknown curves.
    fn look_between(&self, low: f64, high: f64) -> Vec<f64> {
        if self.are_known {
            return vec![low + 0.5 * (high - low)];
        }
        let part = (high - low) / f64::from(LOOKS);
        let looks = (0..LOOKS).map(|look| low + (f64::from(look) + 0.5) * part);
        // An unknown curve that crosses a known one cuts off the end of an interval, so both ends are
        // examined.
        let first = low + NEAR_END * (high - low);
        std::iter::once(first).chain(looks).chain([high - NEAR_END * (high - low)]).collect()
    }
}
