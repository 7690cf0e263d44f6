//! Where a condition stops to hold.

/// The last number from `inside`, where `holds` is true, towards `outside`, where it is not.
///
/// If it changes more than once in between, any of the changes is found.
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
