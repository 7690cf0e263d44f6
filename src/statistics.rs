//! Statistics: means and histograms of numbers that come one by one, with errors that can be trusted.
//!
//! | question | answer |
//! |---|---|
//! | mean and variance of independent numbers | [`RunningMean`] |
//! | mean of correlated numbers with its error, without keeping the numbers | [`BlockedMean`] |
//! | the same for a series in memory | [`block_average`] |
//! | a mean, its error, and what the error rests on | [`Estimate`] |
//! | the mean of several runs together | [`Estimate::over_repeats`] |
//! | distribution of numbers over bins | [`Histogram`] |
//!
//! Collisions and samples of one run are correlated. A standard error that takes them as independent is too
//! small, often by a factor of ten. The error of such a mean must come from blocks, which also show whether
//! the run was too short.
//!
//! ```
//! use granular_edmd::statistics::BlockedMean;
//! // An uncorrelated sequence (the logistic map), each value repeated 16 times: 16 samples are worth one.
//! let chaos = std::iter::successors(Some(0.3), |x| Some(4.0 * x * (1.0 - x)));
//! let mean: BlockedMean = chaos.take(512).flat_map(|x| [x; 16]).collect();
//! let estimate = mean.estimate();
//! assert!(estimate.is_converged());
//! assert!((estimate.mean() - 0.5).abs() < 3.0 * estimate.standard_error());
//! assert!(estimate.standard_error() > 3.0 * mean.ungrouped().standard_error());
//! ```

mod estimate;
mod histogram;
mod means;

pub use estimate::Estimate;
pub(crate) use histogram::Bins;
pub use histogram::{Histogram, HistogramBin};
pub use means::{BlockedMean, RunningMean, block_average};
