//! How many clusters there are.

use glam::DVec2;

use super::clusters::Clusters;
use super::k_means::KMeans;
use crate::ParameterError;
use crate::quantity::non_negative;

/// Most clusters that are looked for: one roll of either sense, two rolls of either sense.
const MOST: usize = 4;

/// Separation above which two clusters are two.
const DISTINCT: f64 = 4.0;

/// As many clusters as are distinct: of `$k = 1\ldots4$`, the largest whose every pair is separated by
/// `$D > 4$` ([`Clusters::separation`]).
///
/// k-means finds as many clusters as it is asked for. Cutting a single cloud of symmetric, unimodal density in two gives
/// `$D \le 2\sqrt3 = 3.46$`: in each half the density falls away from the cut, so that its mean is at most `$\sqrt3$` of
/// its standard deviations away from it (equal for the uniform density; a Gaussian cloud has `$D = 2.65$`). Above 4,
/// there are two clouds. Neither the width of a cloud nor the correlation of its samples enters, as long as the series
/// fills the cloud: one of a few correlation times can look like several.
///
/// `noise` is the standard deviation that a single state has at least, such as
/// [`thermal_noise`](super::thermal_noise): closer than four of it, clusters are never distinct, however sharp.
///
/// # Errors
/// If there is no point, a coordinate is not finite or above 1e100 in size, or the noise is negative or not finite.
///
/// ```
/// use granular_edmd::analysis::distinct_clusters;
/// use granular_edmd::glam::DVec2;
/// let cloud = |x: f64| (0..50).map(move |k| DVec2::new(x + 0.01 * f64::from(k % 10), 0.01 * f64::from(k / 10)));
/// let one: Vec<DVec2> = cloud(0.0).collect();
/// let two: Vec<DVec2> = cloud(0.0).chain(cloud(0.3)).collect();
/// assert_eq!(distinct_clusters(&one, 0.01, 7)?.len(), 1);
/// assert_eq!(distinct_clusters(&two, 0.01, 7)?.len(), 2);
/// assert_eq!(distinct_clusters(&two, 0.1, 7)?.len(), 1);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn distinct_clusters(points: &[DVec2], noise: f64, seed: u64) -> Result<Clusters, ParameterError> {
    non_negative("noise", noise)?;
    let mut distinct = KMeans::new(1, seed)?.fit(points)?;
    for clusters in 2..=MOST.min(points.len()) {
        let found = KMeans::new(clusters, seed)?.fit(points)?;
        if found.separation(noise) > DISTINCT {
            distinct = found;
        }
    }
    Ok(distinct)
}
