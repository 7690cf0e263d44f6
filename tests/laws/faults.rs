//! The form of a planted fault, and tools to plant one.

pub(crate) mod blind;
pub(crate) mod informed;

use std::sync::atomic::{AtomicU64, Ordering};

/// A part that breaks the contract of its trait.
pub(crate) struct Planted<T> {
    /// A sentence that says what is wrong, with the size of the fault.
    pub(crate) name: String,
    /// The faults of one family differ in size or place.
    pub(crate) family: &'static str,
    pub(crate) part: T,
}

/// A catalogue while it grows.
pub(crate) struct List<T> {
    /// The family of the next faults.
    pub(crate) family: &'static str,
    pub(crate) faults: Vec<Planted<T>>,
}

impl<T> Default for List<T> {
    fn default() -> Self {
        Self { family: "honest", faults: Vec::new() }
    }
}

impl<T> List<T> {
    /// Returns the faults that these functions plant.
    pub(crate) fn grown(plants: &[fn(&mut Self)]) -> Vec<Planted<T>> {
        let mut list = Self::default();
        for plant in plants {
            plant(&mut list);
        }
        list.faults
    }

    pub(crate) fn plant(&mut self, name: impl Into<String>, part: T) {
        self.faults.push(Planted { name: name.into(), family: self.family, part });
    }
}

/// Returns the names of faults, each after the name of its trait.
fn named<T>(part: &str, catalogue: &[Planted<T>]) -> Vec<String> {
    catalogue.iter().map(|fault| format!("{part}: {}: {}", fault.family, fault.name)).collect()
}

/// Returns 10 to the power −n.
pub(crate) fn tenth(n: i32) -> f64 {
    10_f64.powi(-n)
}

/// Returns a function that is true in one call in `n`: a state that hides from the caller.
pub(crate) fn one_in(n: u64) -> impl Fn() -> bool {
    let calls = AtomicU64::new(0);
    move || (calls.fetch_add(1, Ordering::Relaxed) + 1).is_multiple_of(n)
}
