//! Values that follow from a rule, and cost no memory, however many there are.

use granular_edmd::ParameterError;
use granular_edmd::quantity::{accept, finite, positive};

/// Largest number of values that follow from a rule: doubles do not count larger numbers exactly.
const MOST: f64 = 9_007_199_254_740_992.0;

/// Fraction of a step by which the last step may miss the end. It allows for the rounding of decimal
/// fractions, since neither 0.1 nor 1/3 is a double.
const ROUNDING: f64 = 1e-9;

/// Increasing values that follow from a rule, in place of a list in a plan:
/// `{ from = 0.0, to = 1.0, step = 0.1 }` for equal steps, `{ from = 1e-3, to = 1.0, log = 31 }` for 31
/// values in equal ratios.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub(crate) struct Steps {
    from: f64,
    to: f64,
    /// The difference of neighbors, or `None` for equal ratios.
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<f64>,
    /// The number of values in equal ratios.
    #[serde(skip_serializing_if = "Option::is_none")]
    log: Option<usize>,
    #[serde(skip)]
    count: usize,
}

crate::gate::from_file! {
    Steps { from: f64, to: f64, step: Option<f64>, log: Option<usize> } => match (step, log) {
        (Some(step), None) => Self::linear(from, to, step),
        (None, Some(count)) => Self::logarithmic(from, to, count),
        (step, _) => {
            let given = if step.is_some() { 2.0 } else { 0.0 };
            Err(ParameterError::new("number of `step` and `log` beside `from` and `to`", "1", given))
        }
    }, ParameterError
}

impl Steps {
    /// Creates values in equal steps from `from` on. The last value is `to` if a whole number of steps
    /// reaches it.
    ///
    /// # Errors
    /// If a number is not finite, the step is not positive or below the rounding of the values, or `to` is
    /// below `from`.
    fn linear(from: f64, to: f64, step: f64) -> Result<Self, ParameterError> {
        finite("first value", from)?;
        finite("last value", to)?;
        positive("step", step)?;
        accept(to >= from, "last value", "at least the first one", to)?;
        let largest = from.abs().max(to.abs());
        accept(largest.next_up() - largest <= step, "step", "above the rounding of the values", step)?;
        let steps = libm::floor((to - from) / step + ROUNDING);
        accept(steps < MOST, "number of steps", "below 2^53", steps)?;
        Ok(Self { from, to, step: Some(step), log: None, count: steps as usize + 1 })
    }

    /// Creates `count` values in equal ratios, the first and the last included.
    ///
    /// # Errors
    /// If the first value is not positive, the last one is not finite or not above the first, their ratio is
    /// not finite, or there are fewer than two, or too many, so that neighbors would be equal.
    fn logarithmic(from: f64, to: f64, count: usize) -> Result<Self, ParameterError> {
        positive("first value", from)?;
        positive("last value", to)?;
        accept(to > from, "last value", "above the first one", to)?;
        let ratio = to / from;
        accept(ratio.is_finite(), "last value over the first one", "finite", ratio)?;
        accept(count >= 2, "number of values", "at least 2", count as f64)?;
        let is_resolved = libm::log(ratio) / (count - 1) as f64 >= 4.0 * f64::EPSILON;
        accept(is_resolved, "number of values", "so small that neighbors differ", count as f64)?;
        Ok(Self { from, to, step: None, log: Some(count), count })
    }

    /// Returns the number of values.
    pub(super) const fn count(&self) -> usize {
        self.count
    }

    /// Returns the value of an index below the number of values.
    ///
    /// Each value follows from its index, not from the one before, so errors do not add up. Equal steps give
    /// the decimal fractions that a reader of the plan expects.
    pub(super) fn value(&self, index: usize) -> f64 {
        match self.step {
            Some(step) => self.decimal(index, step),
            None if index + 1 == self.count => self.to,
            None => {
                let share = index as f64 / (self.count - 1) as f64;
                self.from * libm::pow(self.to / self.from, share)
            }
        }
    }
    /// Returns a value in equal steps: 0.07 and not 0.06999999999999999, if the first value and the step are
    /// decimal fractions, too.
    fn decimal(&self, index: usize, step: f64) -> f64 {
        let value = self.from + index as f64 * step;
        let is_close = |near: &f64| (near - value).abs() <= ROUNDING * step;
        if index == 0 || (index + 1 == self.count && is_close(&self.to)) {
            return if index == 0 { self.from } else { self.to };
        }
        let largest = self.from.abs().max(self.to.abs());
        let places = (14.0 - libm::floor(libm::log10(largest))).clamp(0.0, 300.0) as usize;
        let rounded = |number: f64| format!("{number:.places$}").parse::<f64>().unwrap_or(number);
        let are_decimal = [self.from, step].iter().all(|&number| rounded(number) == number);
        let near = Some(rounded(value)).filter(|near| are_decimal && is_close(near));
        // The sum with 0 turns -0 into 0.
        near.unwrap_or(value) + 0.0
    }
}
