//! Closures as observers.

use super::{Collision, Observer, SampleTimes, Snapshot};

/// A closure that is told of every collision; made by [`on_collision`].
#[derive(Debug, Clone)]
pub struct OnCollision<F>(F);

/// An observer from a closure that is told of every collision.
///
/// ```
/// use granular_edmd::observable::{Collision, Observer, on_collision};
/// let mut hardest = 0.0_f64;
/// let mut observer = on_collision(|c: &Collision| hardest = hardest.max(c.impulse.normal()));
/// assert_eq!(observer.next_sample(), f64::INFINITY);
/// ```
pub const fn on_collision<F: FnMut(&Collision)>(watch: F) -> OnCollision<F> {
    OnCollision(watch)
}

impl<F: FnMut(&Collision)> Observer for OnCollision<F> {
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        (self.0)(collision);
    }
}

/// A closure that is shown samples; made by [`on_sample`].
#[derive(Debug, Clone)]
pub struct OnSample<F> {
    times: SampleTimes,
    watch: F,
}

/// An observer from a closure that is shown a snapshot at each of these times.
///
/// ```
/// use granular_edmd::observable::{Observer, SampleTimes, Snapshot, on_sample};
/// let mut observer = on_sample(SampleTimes::every(0.5)?, |s: &Snapshot<'_>| println!("{}", s.time()));
/// assert_eq!(observer.next_sample(), 0.5);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub const fn on_sample<F: FnMut(&Snapshot<'_>)>(times: SampleTimes, watch: F) -> OnSample<F> {
    OnSample { times, watch }
}

impl<F: FnMut(&Snapshot<'_>)> Observer for OnSample<F> {
    fn next_sample(&self) -> f64 {
        self.times.next()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        (self.watch)(snapshot);
        self.times.advance_past(snapshot.time());
    }
}
