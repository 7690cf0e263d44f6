//! Bisection for the number at which a condition ceases to hold.

/// Returns the last number at which `holds` is true, on the way from `inside`, where it is true, to
/// `outside`, where it is false.
///
/// If the condition changes more than once in between, the search finds one of the changes. It halves the
/// interval until no floating-point number is left inside. About two thousand halvings always suffice.
pub(super) fn boundary(inside: f64, outside: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut inside, mut outside) = (inside, outside);
    loop {
        let middle = 0.5 * (inside + outside);
        if middle == inside || middle == outside {
            return inside;
        }
        if holds(middle) { inside = middle } else { outside = middle }
    }
}
