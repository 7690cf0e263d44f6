//! Vector instructions that only some processors of an architecture have.
//!
//! A build for any x86-64 processor can rely only on instructions for two numbers at a time, but nearly all
//! of these processors can process four. The hot code is therefore compiled for each level, and
//! [`Instructions`] names the level that this processor has. The arithmetic is the same in all copies, since
//! Rust never fuses a product and a sum into one instruction; the bits do not depend on the level.
//!
//! The compiler finds no good vector instructions for two parts of the engine, so these parts call the
//! instructions explicitly: the tournament of the scheduler (`scheduler/tournament_tree/earliest.rs`) and
//! predictions (`simulation/prediction/vector.rs`). Each such function has a plain version of the same name
//! beside it, which runs on processors without the instructions. Builds for other architectures have only the
//! plain functions.

#[cfg(target_arch = "x86_64")]
pub(crate) mod load;

/// A level of instructions that this processor has. Values for other levels cannot be made.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Instructions(Level);

#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[allow(dead_code, reason = "some builds use only the first level")]
pub(crate) enum Level {
    /// The instructions on which the build relies.
    #[default]
    Built,
    /// AVX2: four numbers at a time.
    Avx2,
    /// AVX-512: four numbers at a time, with selections by masks.
    Avx512,
}

impl Instructions {
    /// The instructions of all processors for which the crate is built.
    pub(crate) const BUILT: Self = Self(Level::Built);

    /// Returns the best level that this processor has.
    pub(crate) fn detected() -> Self {
        [Level::Avx512, Level::Avx2].into_iter().find(|&level| has(level)).map_or(Self(Level::Built), Self)
    }

    /// Returns all levels that this processor has.
    #[cfg(test)]
    pub(crate) fn all() -> Vec<Self> {
        let known = [Level::Built, Level::Avx2, Level::Avx512];
        known.into_iter().filter(|&level| level == Level::Built || has(level)).map(Self).collect()
    }

    /// Runs a piece of work with these instructions.
    ///
    /// The work should be long, or capture at most two numbers, since more captures would go through memory.
    ///
    /// `work` and all hot functions that it calls must be `#[inline(always)]`, since other code is compiled
    /// for the level of the build.
    #[cfg(target_arch = "x86_64")]
    #[allow(unsafe_code)]
    pub(crate) fn run<T>(self, work: impl FnOnce() -> T) -> T {
        #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
        fn avx2<T>(work: impl FnOnce() -> T) -> T {
            work()
        }

        #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw,avx512cd")]
        fn avx512<T>(work: impl FnOnce() -> T) -> T {
            work()
        }

        match self.0 {
            Level::Built => work(),
            // SAFETY: only `detected` and `all` make values, and only for levels that the processor has.
            Level::Avx2 => unsafe { avx2(work) },
            Level::Avx512 => unsafe { avx512(work) },
        }
    }

    /// Runs a piece of work. The function is not inlined, so that all callers share one copy.
    #[cfg(not(target_arch = "x86_64"))]
    #[allow(clippy::unused_self, reason = "there is no choice here")]
    #[inline(never)]
    pub(crate) fn run<T>(self, work: impl FnOnce() -> T) -> T {
        work()
    }

    /// Returns the level of these instructions.
    #[inline]
    #[allow(dead_code, reason = "unused in builds with only one level")]
    pub(crate) fn level(self) -> Level {
        self.0
    }
}

/// Returns whether this processor has the instructions for which the copy of a level is compiled.
#[cfg(target_arch = "x86_64")]
fn has(level: Level) -> bool {
    use std::arch::is_x86_feature_detected as has;
    let avx2 = has!("avx2") && has!("bmi1") && has!("bmi2") && has!("lzcnt") && has!("popcnt");
    let avx512 =
        has!("avx512f") && has!("avx512vl") && has!("avx512dq") && has!("avx512bw") && has!("avx512cd");
    match level {
        Level::Built => true,
        Level::Avx2 => avx2,
        Level::Avx512 => avx2 && avx512,
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn has(level: Level) -> bool {
    level == Level::Built
}

/// Defines a function that runs one of three others, chosen by the [`Instructions`] in its first argument:
/// the function for any processor, for AVX2, or for AVX-512.
///
/// The three can be copies of a plain function for each level. This function and all hot functions that it
/// calls must then be `#[inline(always)]`, since other code is compiled for the level of the build. A
/// constant parameter, the number of the copy, makes the copies different functions. The compiler then
/// inlines the functions that a copy calls as if this copy were their only caller. A function of vector
/// instructions, or a closure that calls one, can take the place of a copy. [`Instructions::run`] would be
/// slower here, since its many captures would go through memory.
#[cfg(target_arch = "x86_64")]
macro_rules! compiled_for_each {
    (
        $(#[$attribute:meta])* $visibility:vis $name:ident $(<const $number:ident: usize>)? ($($argument:ident: $type:ty),*) -> $output:ty
            = $built:expr, $avx2:expr, $avx512:expr
    ) => {
        #[inline(always)]
        #[allow(unsafe_code, clippy::too_many_arguments)]
        $visibility fn $name$(<const $number: usize>)?(
            instructions: $crate::instructions::Instructions, $($argument: $type),*
        ) -> $output {
            $(#[$attribute])*
            fn built$(<const $number: usize>)?($($argument: $type),*) -> $output {
                $built($($argument),*)
            }

            $(#[$attribute])*
            #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
            fn avx2$(<const $number: usize>)?($($argument: $type),*) -> $output {
                $avx2($($argument),*)
            }

            $(#[$attribute])*
            #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw,avx512cd")]
            fn avx512$(<const $number: usize>)?($($argument: $type),*) -> $output {
                $avx512($($argument),*)
            }

            match instructions.level() {
                $crate::instructions::Level::Built => built($($argument),*),
                // SAFETY: as in `Instructions::run`.
                $crate::instructions::Level::Avx2 => unsafe { avx2($($argument),*) },
                $crate::instructions::Level::Avx512 => unsafe { avx512($($argument),*) },
            }
        }
    };
}

#[cfg(not(target_arch = "x86_64"))]
macro_rules! compiled_for_each {
    (
        $(#[$attribute:meta])* $visibility:vis $name:ident $(<const $number:ident: usize>)? ($($argument:ident: $type:ty),*) -> $output:ty
            = $built:expr, $avx2:expr, $avx512:expr
    ) => {
        $(#[$attribute])*
        #[allow(clippy::too_many_arguments)]
        $visibility fn $name$(<const $number: usize>)?(
            _: $crate::instructions::Instructions, $($argument: $type),*
        ) -> $output {
            $built($($argument),*)
        }
    };
}

pub(crate) use compiled_for_each;

/// Asks the processor to fetch the cache line of an element. Nothing happens if there is no such element.
///
/// In a system larger than the caches, each event touches dozens of lines that no cache holds. Waiting for
/// them one by one takes most of the time of a run. Lines that are requested some events ahead arrive in
/// time, side by side.
#[inline(always)]
#[allow(unsafe_code)]
pub(crate) fn prefetch<T>(slice: &[T], index: usize) {
    #[cfg(target_arch = "x86_64")]
    if let Some(element) = slice.get(index) {
        // SAFETY: a prefetch reads and writes nothing that the program can see, and the address belongs to a
        // live element. SSE is part of every x86-64 processor.
        unsafe {
            use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
            _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(element).cast());
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (slice, index);
}
