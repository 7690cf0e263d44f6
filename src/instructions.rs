//! Vector instructions that a processor may have beyond those that every processor of its kind has.
//!
//! A build for any x86-64 may take two numbers at a time for granted, but most processors take four. So the hot code is compiled
//! for each of them, and [`Instructions`] says which copy runs. The arithmetic is the same in all: Rust never contracts a
//! product and a sum, so the bits do not depend on the choice. Where the build itself is for a processor with AVX2, or for another
//! architecture, there is one copy and no choice.

/// Instructions that this processor has. No other value can be made, and [`compiled_for_each`] relies on it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Instructions(Level);

#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(dead_code, reason = "not all are chosen from in all builds")]
pub(crate) enum Level {
    /// What the build takes for granted.
    Built,
    /// Four numbers at a time.
    Avx2,
    /// Four numbers at a time, and selections by masks.
    Avx512,
}

impl Instructions {
    /// The best that this processor has.
    pub(crate) fn detected() -> Self {
        [Level::Avx512, Level::Avx2].into_iter().find(|&level| has(level)).map_or(Self(Level::Built), Self)
    }

    /// All that this processor has.
    #[cfg(test)]
    pub(crate) fn all() -> Vec<Self> {
        let known = [Level::Built, Level::Avx2, Level::Avx512];
        known.into_iter().filter(|&level| level == Level::Built || has(level)).map(Self).collect()
    }

    /// Does some work with these instructions, for what is large and called rarely.
    ///
    /// `work` is `#[inline(always)]` with all that is hot in it: what is not inlined has no vector instructions.
    #[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
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
            // SAFETY: the processor has what these two are compiled for, or there would be no such value.
            Level::Avx2 => unsafe { avx2(work) },
            Level::Avx512 => unsafe { avx512(work) },
        }
    }

    /// Does some work with these instructions.
    #[cfg(not(all(target_arch = "x86_64", not(target_feature = "avx2"))))]
    pub(crate) fn run<T>(self, work: impl FnOnce() -> T) -> T {
        work()
    }

    #[inline]
    #[allow(dead_code, reason = "nobody asks where there is no choice")]
    pub(crate) fn level(self) -> Level {
        self.0
    }
}

/// Tells whether this processor has what the copy for a level is compiled for.
#[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
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

#[cfg(not(all(target_arch = "x86_64", not(target_feature = "avx2"))))]
fn has(level: Level) -> bool {
    level == Level::Built
}

/// Makes a function that runs the copy of `$body` for the instructions that are its first argument.
///
/// `$body` is `#[inline(always)]` with all that is hot in it: what is not inlined has no vector instructions. Its parameter, the
/// number of the copy, makes the copies different functions, so that what each calls is inlined as if it were the only one. A
/// macro and not a function that takes a closure, for what closures capture goes through memory: 5 % of the time of a run.
#[cfg(all(target_arch = "x86_64", not(target_feature = "avx2")))]
macro_rules! compiled_for_each {
    ($(#[$attribute:meta])* $name:ident($($argument:ident: $type:ty),*) -> $output:ty = $body:ident) => {
        #[inline]
        #[allow(unsafe_code)]
        pub(super) fn $name(instructions: Instructions, $($argument: $type),*) -> $output {
            $(#[$attribute])*
            fn built($($argument: $type),*) -> $output {
                $body::<0>($($argument),*)
            }

            #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
            fn avx2($($argument: $type),*) -> $output {
                $body::<1>($($argument),*)
            }

            #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw,avx512cd")]
            fn avx512($($argument: $type),*) -> $output {
                $body::<2>($($argument),*)
            }

            match instructions.level() {
                Level::Built => built($($argument),*),
                // SAFETY: the processor has what these two are compiled for, or there would be no such value.
                Level::Avx2 => unsafe { avx2($($argument),*) },
                Level::Avx512 => unsafe { avx512($($argument),*) },
            }
        }
    };
}

#[cfg(not(all(target_arch = "x86_64", not(target_feature = "avx2"))))]
macro_rules! compiled_for_each {
    ($(#[$attribute:meta])* $name:ident($($argument:ident: $type:ty),*) -> $output:ty = $body:ident) => {
        $(#[$attribute])*
        pub(super) fn $name(_: Instructions, $($argument: $type),*) -> $output {
            $body::<0>($($argument),*)
        }
    };
}

pub(crate) use compiled_for_each;
