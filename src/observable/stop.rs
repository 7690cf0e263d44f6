//! Closures as observers that stop a run.

use std::ops::ControlFlow;

use super::{Collision, Observer, ObserverError, SampleTimes, Snapshot, Verdict};

/// A closure that stops a run at a collision; made by [`stop_when`].
#[derive(Debug, Clone)]
pub struct StopWhen<F> {
    condition: F,
    holds: bool,
}

/// Makes an observer that stops a run at the first collision for which the closure returns true.
///
/// A later run with the same observer stops at the next collision that meets the condition.
///
/// ```
/// use granular_edmd::collision::{Contact, Impulse};
/// use granular_edmd::observable::{Collision, Observer, Partner, stop_when};
///
/// let mut observer = stop_when(|collision: &Collision| collision.impulse.normal() > 1.0);
/// let contact = Contact::new(2.0, 0.0, 0.5, 0.5 / 3.0);
/// observer.on_collision(&Collision::new(0.5, 0, Partner::Disk(1), contact, Impulse::new(1.0, 0.0)));
/// assert!(observer.verdict()?.is_continue());
/// observer.on_collision(&Collision::new(0.7, 0, Partner::Disk(1), contact, Impulse::new(1.5, 0.0)));
/// assert!(observer.verdict()?.is_break());
/// # Ok::<(), granular_edmd::observable::ObserverError>(())
/// ```
pub const fn stop_when<F: FnMut(&Collision) -> bool>(condition: F) -> StopWhen<F> {
    StopWhen { condition, holds: false }
}

impl<F: FnMut(&Collision) -> bool> Observer for StopWhen<F> {
    fn on_start(&mut self, _: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.holds = false;
        Ok(())
    }

    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        self.holds |= (self.condition)(collision);
    }

    #[inline]
    fn verdict(&mut self) -> Verdict {
        Ok(stop_if(self.holds))
    }
}

/// A closure that stops a run at a sample; made by [`stop_when_sampled`].
#[derive(Debug, Clone)]
pub struct StopWhenSampled<F> {
    times: SampleTimes,
    condition: F,
    holds: bool,
}

/// Makes an observer that stops a run at the first of these times at which the closure returns true.
///
/// A later run with the same observer stops at the next sample that meets the condition.
///
/// ```
/// use granular_edmd::observable::{CenterOfMass, Observable, Observer, SampleTimes, Snapshot};
/// use granular_edmd::observable::stop_when_sampled;
///
/// // Until the center of mass has risen to 10.
/// let risen = |snapshot: &Snapshot<'_>| CenterOfMass.measure(snapshot).y > 10.0;
/// let observer = stop_when_sampled(SampleTimes::every(1.0)?, risen);
/// assert_eq!(observer.next_sample(), 1.0);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
pub const fn stop_when_sampled<F>(times: SampleTimes, condition: F) -> StopWhenSampled<F>
where
    F: FnMut(&Snapshot<'_>) -> bool,
{
    StopWhenSampled { times, condition, holds: false }
}

impl<F: FnMut(&Snapshot<'_>) -> bool> Observer for StopWhenSampled<F> {
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
        self.holds = false;
        self.times.start_at(start.time());
        Ok(())
    }

    fn next_sample(&self) -> f64 {
        self.times.upcoming()
    }

    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.holds |= (self.condition)(snapshot);
        self.times.advance_past(snapshot.time());
    }

    #[inline]
    fn verdict(&mut self) -> Verdict {
        Ok(stop_if(self.holds))
    }
}

const fn stop_if(holds: bool) -> ControlFlow<()> {
    if holds { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}
