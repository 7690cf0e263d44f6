//! Medians and quartiles. On a busy machine, the mean of a few measurements says little.

use std::fmt;

/// The median and the quartiles of a few measurements.
///
/// ```
/// use granular_edmd::speed::Quartiles;
/// let quartiles = Quartiles::of([3.0, 1.0, 2.0, 100.0, 4.0]);
/// assert_eq!(quartiles.to_string(), "3.00 (2.00–4.00)");
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Quartiles {
    /// A quarter of the values are below this one.
    pub low: f64,
    /// Half of the values are below this one.
    pub median: f64,
    /// A quarter of the values are above this one.
    pub high: f64,
}

impl Quartiles {
    /// Computes the quartiles of these values; NaN without values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let [low, median, high] = [0.25, 0.5, 0.75].map(|share| quantile(&values, share));
        Self { low, median, high }
    }
}

/// Returns a quantile, by linear interpolation between neighbors.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = share * last as f64;
    let (before, part) = (place.floor() as usize, place.fract());
    sorted[before] + part * (sorted[(before + 1).min(last)] - sorted[before])
}

impl fmt::Display for Quartiles {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:.2} ({:.2}–{:.2})", self.median, self.low, self.high)
    }
}
