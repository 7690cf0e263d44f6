//! Compositions of observers and observables.
//!
//! A composed observer passes all messages on to all its parts, but passes a sample only to the parts that
//! requested it. It fails if a part fails, with the first failure. Otherwise, it stops the run as soon as one
//! of its parts does.

use std::ops::ControlFlow;

use super::{Collision, Heading, Observable, Observer, ObserverError, Snapshot, Tabular, Verdict};
use crate::Disk;
use crate::forward::forward;

/// The observer that does nothing and costs nothing.
impl Observer for () {}

forward! { Observer for [&mut T, Box<T>] {
    fn next_sample(&self) -> f64;
    mut
    fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError>;
    fn on_collision(&mut self, collision: &Collision);
    fn on_sample(&mut self, snapshot: &Snapshot<'_>);
    fn on_insert(&mut self, disk: &Disk, time: f64);
    fn on_remove(&mut self, disk: &Disk, time: f64);
    fn on_end(&mut self, end: &Snapshot<'_>);
    fn verdict(&mut self) -> Verdict;
}}

/// Implements `Observer` for types that hold several observers, or one that may be absent.
macro_rules! compose_all {
    ($($holder:ty),+) => {
        $(impl<T: Observer> Observer for $holder {
            fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
                for observer in self.iter_mut() {
                    observer.on_start(start)?;
                }
                Ok(())
            }
            #[inline]
            fn on_collision(&mut self, collision: &Collision) {
                for observer in self.iter_mut() {
                    observer.on_collision(collision);
                }
            }
            fn next_sample(&self) -> f64 {
                self.iter().map(Observer::next_sample).fold(f64::INFINITY, earlier)
            }
            fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
                for observer in self.iter_mut() {
                    sample_if_due(observer, snapshot);
                }
            }
            fn on_insert(&mut self, disk: &Disk, time: f64) {
                for observer in self.iter_mut() {
                    observer.on_insert(disk, time);
                }
            }
            fn on_remove(&mut self, disk: &Disk, time: f64) {
                for observer in self.iter_mut() {
                    observer.on_remove(disk, time);
                }
            }
            fn on_end(&mut self, end: &Snapshot<'_>) {
                for observer in self.iter_mut() {
                    observer.on_end(end);
                }
            }
            #[inline]
            fn verdict(&mut self) -> Verdict {
                let goes_on = ControlFlow::Continue(());
                self.iter_mut().try_fold(goes_on, |before, observer| Ok(either(before, observer.verdict()?)))
            }
        })+
    };
}

compose_all!([T], Vec<T>, Option<T>);

/// Passes the snapshot to an observer that requested a sample at this time, but not to observers that wait
/// for later times.
fn sample_if_due<T: Observer>(observer: &mut T, snapshot: &Snapshot<'_>) {
    if observer.next_sample() <= snapshot.time() {
        observer.on_sample(snapshot);
    }
}

/// Returns the earlier of two times, or NaN if one of them is NaN: `f64::min` would hide a broken clock from
/// the engine.
fn earlier(first: f64, second: f64) -> f64 {
    if first < second || first.is_nan() { first } else { second }
}

/// Combines two verdicts: the result stops the run if one of the two does.
fn either(first: ControlFlow<()>, second: ControlFlow<()>) -> ControlFlow<()> {
    if first.is_break() { first } else { second }
}

// The implementations come from a macro, because a function cannot be generic over the length of a tuple.
macro_rules! compose_tuple {
    ($($name:ident $index:tt),+) => {
        impl<$($name: Observer),+> Observer for ($($name,)+) {
            fn on_start(&mut self, start: &Snapshot<'_>) -> Result<(), ObserverError> {
                $(self.$index.on_start(start)?;)+
                Ok(())
            }
            #[inline]
            fn on_collision(&mut self, collision: &Collision) {
                $(self.$index.on_collision(collision);)+
            }
            fn next_sample(&self) -> f64 {
                let next = f64::INFINITY;
                $(let next = earlier(next, self.$index.next_sample());)+
                next
            }
            fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
                $(sample_if_due(&mut self.$index, snapshot);)+
            }
            fn on_insert(&mut self, disk: &Disk, time: f64) {
                $(self.$index.on_insert(disk, time);)+
            }
            fn on_remove(&mut self, disk: &Disk, time: f64) {
                $(self.$index.on_remove(disk, time);)+
            }
            fn on_end(&mut self, end: &Snapshot<'_>) {
                $(self.$index.on_end(end);)+
            }
            #[inline]
            fn verdict(&mut self) -> Verdict {
                let verdict = ControlFlow::Continue(());
                $(let verdict = either(verdict, self.$index.verdict()?);)+
                Ok(verdict)
            }
        }

        impl<$($name: Observable),+> Observable for ($($name,)+) {
            type Value = ($($name::Value,)+);
            fn measure(&self, snapshot: &Snapshot<'_>) -> Self::Value {
                ($(self.$index.measure(snapshot),)+)
            }
        }

        impl<$($name: Tabular),+> Tabular for ($($name,)+) {
            fn headings(&self) -> Vec<Heading> {
                [$(self.$index.headings()),+].concat()
            }
            fn add_numbers(&self, value: &Self::Value, row: &mut Vec<f64>) {
                $(self.$index.add_numbers(&value.$index, row);)+
            }
        }
    };
}

compose_tuple!(A 0);
compose_tuple!(A 0, B 1);
compose_tuple!(A 0, B 1, C 2);
compose_tuple!(A 0, B 1, C 2, D 3);
compose_tuple!(A 0, B 1, C 2, D 3, E 4);
compose_tuple!(A 0, B 1, C 2, D 3, E 4, F 5);

forward! { Observable for [&T, Box<T>] {
    type Value;
    fn measure(&self, snapshot: &Snapshot<'_>) -> T::Value;
}}

forward! { Tabular for [&T, Box<T>] {
    fn headings(&self) -> Vec<Heading>;
    fn add_numbers(&self, value: &T::Value, row: &mut Vec<f64>);
}}
