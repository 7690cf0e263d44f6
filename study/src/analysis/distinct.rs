//! The number of clusters in a set of points.

use granular_edmd::ParameterError;
use granular_edmd::quantity::non_negative;

use super::clusters::Clusters;
use super::k_means::KMeans;
use granular_edmd::glam::DVec2;

/// Largest number of clusters to look for: one roll of either sense, and two rolls of either sense.
const MOST: usize = 4;

/// Separation above which two clusters are distinct.
const DISTINCT: f64 = 4.0;

/// Finds the distinct clusters of these points.
///
/// The result has the largest number of clusters, from 1 to 4, whose pairs are all separated by $`D > 4`$
/// ([`Clusters::separation`]).
///
/// A k-means search finds as many clusters as requested, so the number must follow from the result itself.
/// Suppose that it cuts a single cloud, of symmetric density with one maximum, in two. In each half the
/// density falls away from the cut. The mean of the half is therefore at most $`\sqrt3`$ of its standard
/// deviations away from the cut, with equality for the uniform density. A single cloud has
/// $`D \le 2\sqrt3 = 3.46`$ (a Gaussian one 2.65), so above 4 there are two clouds. Neither the width of a
/// cloud nor the correlation of its samples enters, as long as the series fills the cloud. A series of only a
/// few correlation times can look like several clouds.
///
/// `noise` is the least standard deviation of a single state, such as
/// [`thermal_noise`](super::thermal_noise). Clusters closer than four times this noise are never distinct,
/// however sharp they are.
///
/// # Errors
/// If there is no point, a coordinate is not finite or above 1e100 in magnitude, or the noise is negative or
/// not finite.
///
/// ```
/// use granular_edmd_study::analysis::distinct_clusters;
/// use granular_edmd::glam::DVec2;
/// let cloud = |x: f64| {
///     (0..50).map(move |k| DVec2::new(x + 0.01 * f64::from(k % 10), 0.01 * f64::from(k / 10)))
/// };
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
    // The search continues after the first number that fails. Three clouds in a row, cut in two, make a wide
    // cluster that is not separated from the other; cut in three, they are.
    for clusters in 2..=MOST.min(points.len()) {
        let found = KMeans::new(clusters, seed)?.fit(points)?;
        if found.separation(noise) > DISTINCT {
            distinct = found;
        }
    }
    Ok(distinct)
}
