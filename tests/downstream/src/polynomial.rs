//! The first time at which a polynomial is not positive and falls.

/// `$c_0 + c_1 t + c_2 t^2 + \dots$`
fn value(coefficients: &[f64], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

fn derivative(coefficients: &[f64]) -> Vec<f64> {
    coefficients.iter().enumerate().skip(1).map(|(k, c)| k as f64 * c).collect()
}

/// The zero of a polynomial that changes sign between `low` and `high`; on the side of `low`.
fn bisect(coefficients: &[f64], mut low: f64, mut high: f64) -> f64 {
    let sign = value(coefficients, low) > 0.0;
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return low;
        }
        if (value(coefficients, middle) > 0.0) == sign { low = middle } else { high = middle }
    }
}

/// `start`, `end`, and all changes of sign between them, in order.
fn marks(coefficients: &[f64], start: f64, end: f64) -> Vec<f64> {
    let mut marks = vec![start];
    if coefficients.len() > 1 {
        let turns = self::marks(&derivative(coefficients), start, end);
        let changes = turns
            .windows(2)
            .filter(|w| (value(coefficients, w[0]) > 0.0) != (value(coefficients, w[1]) > 0.0));
        marks.extend(changes.map(|w| bisect(coefficients, w[0], w[1])));
    }
    marks.push(end);
    marks
}

/// The first time in `[0, end]` at which the polynomial is not positive and falls.
pub fn first_descent(coefficients: &[f64], end: f64) -> Option<f64> {
    let slope = derivative(coefficients);
    let turns = marks(&slope, 0.0, end);
    turns.windows(2).find_map(|w| {
        let (from, to) = (w[0], w[1]);
        let falls = value(&slope, 0.5 * (from + to)) < 0.0;
        if !falls || value(coefficients, to) > 0.0 {
            None
        } else if value(coefficients, from) <= 0.0 {
            Some(from)
        } else {
            Some(bisect(coefficients, from, to))
        }
    })
}
