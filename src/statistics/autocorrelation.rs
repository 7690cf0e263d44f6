//! Autocorrelation of series in memory.

use super::{BlockedMean, Estimate, block_average};
use crate::ParameterError;
use crate::quantity::accept;

/// Returns the autocorrelation of a time series, with errors, for lags of 0 to `lags` samples.
///
/// The autocorrelation at a lag of $`k`$ samples is
///
/// ```math
/// \rho_k = \frac{\langle(x_i-\bar x)(x_{i+k}-\bar x)\rangle}{\langle(x_i-\bar x)^2\rangle},
/// ```
///
/// and its error comes from blocks of the products.
///
/// # Errors
/// If the series has no more than `lags + 1` samples, one is not finite or above 1e100 in size, or all are
/// equal: a constant has no correlation.
///
/// ```
/// use granular_edmd::statistics::autocorrelation;
/// let wave: Vec<f64> = (0..4000).map(|k| f64::from([0, 1, 0, -1][k % 4])).collect();
/// let correlation: Vec<f64> = autocorrelation(&wave, 2)?.iter().map(|lag| lag.mean()).collect();
/// assert_eq!(correlation[0], 1.0);
/// assert!(correlation[1].abs() < 1e-3 && (correlation[2] + 1.0).abs() < 1e-3);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub fn autocorrelation(samples: &[f64], lags: usize) -> Result<Vec<Estimate>, ParameterError> {
    let count = samples.len();
    let fits = count >= 2 && lags < count - 1;
    accept(fits, "number of lags", "at least two below the number of samples", lags as f64)?;
    let mean = block_average(samples)?.mean();
    let covariance = |lag: usize| -> BlockedMean {
        let pairs = samples.iter().zip(&samples[lag..]);
        pairs.map(|(first, second)| (first - mean) * (second - mean)).collect()
    };
    let variance = covariance(0).mean();
    accept(variance > 0.0, "variance of the samples", "positive: not all samples equal", variance)?;
    Ok((0..=lags).map(|lag| covariance(lag).estimate().scaled(1.0 / variance)).collect())
}
