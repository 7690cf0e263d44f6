//! Observers and observables made of others.

use super::{Collision, Observable, Observer, Snapshot};

/// Nobody watches: costs nothing.
impl Observer for () {}

impl<T: Observer + ?Sized> Observer for &mut T {
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        (**self).on_collision(collision);
    }
    fn next_sample(&self) -> f64 {
        (**self).next_sample()
    }
    fn verdict(&mut self) -> Result<std::ops::ControlFlow<()>, crate::observable::ObserverError> {
        (**self).verdict()
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        (**self).on_sample(snapshot);
    }
}

impl<T: Observer + ?Sized> Observer for Box<T> {
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        (**self).on_collision(collision);
    }
    fn next_sample(&self) -> f64 {
        (**self).next_sample()
    }
    fn verdict(&mut self) -> Result<std::ops::ControlFlow<()>, crate::observable::ObserverError> {
        (**self).verdict()
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        (**self).on_sample(snapshot);
    }
}

impl<T: Observer> Observer for Option<T> {
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        if let Some(observer) = self {
            observer.on_collision(collision);
        }
    }
    fn next_sample(&self) -> f64 {
        self.as_ref().map_or(f64::INFINITY, Observer::next_sample)
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        if let Some(observer) = self {
            observer.on_sample(snapshot);
        }
    }
}

impl<T: Observer> Observer for [T] {
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        for observer in self {
            observer.on_collision(collision);
        }
    }
    fn next_sample(&self) -> f64 {
        self.iter().map(Observer::next_sample).fold(f64::INFINITY, f64::min)
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        for observer in self {
            sample_if_due(observer, snapshot);
        }
    }
}

impl<T: Observer> Observer for Vec<T> {
    #[inline]
    fn on_collision(&mut self, collision: &Collision) {
        self.as_mut_slice().on_collision(collision);
    }
    fn next_sample(&self) -> f64 {
        self.as_slice().next_sample()
    }
    fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
        self.as_mut_slice().on_sample(snapshot);
    }
}

/// Shows the snapshot to an observer that asked for it, not to its neighbours who wait for later times.
fn sample_if_due<T: Observer>(observer: &mut T, snapshot: &Snapshot<'_>) {
    if observer.next_sample() <= snapshot.time() {
        observer.on_sample(snapshot);
    }
}

// A function cannot be generic over the length of a tuple.
macro_rules! compose_tuple {
    ($($name:ident $index:tt),+) => {
        impl<$($name: Observer),+> Observer for ($($name,)+) {
            #[inline]
            fn on_collision(&mut self, collision: &Collision) {
                $(self.$index.on_collision(collision);)+
            }
            fn next_sample(&self) -> f64 {
                f64::INFINITY$(.min(self.$index.next_sample()))+
            }
            fn on_sample(&mut self, snapshot: &Snapshot<'_>) {
                $(sample_if_due(&mut self.$index, snapshot);)+
            }
        }

        impl<$($name: Observable),+> Observable for ($($name,)+) {
            type Value = ($($name::Value,)+);
            fn measure(&self, snapshot: &Snapshot<'_>) -> Self::Value {
                ($(self.$index.measure(snapshot),)+)
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

impl<T: Observable + ?Sized> Observable for &T {
    type Value = T::Value;
    fn measure(&self, snapshot: &Snapshot<'_>) -> T::Value {
        (**self).measure(snapshot)
    }
}

impl<T: Observable + ?Sized> Observable for Box<T> {
    type Value = T::Value;
    fn measure(&self, snapshot: &Snapshot<'_>) -> T::Value {
        (**self).measure(snapshot)
    }
}
