//! Vector instructions that only some processors of an architecture have.
//!
//! A build for any x86-64 processor can rely only on instructions for two numbers at a time, but nearly all
//! of these processors can process four. The hot code is therefore compiled once for each [`Level`], and a
//! run takes the copy for the level that its processor has:
//!
//! | what is compiled for each level | how |
//! |---|---|
//! | a piece of work, with all that is inlined into it | [`Instructions::run`] |
//! | a function of several arguments, or three functions that do the same | [`compiled_for_each`] |
//!
//! The arithmetic is the same in all copies, since Rust never fuses a product and a sum into one instruction;
//! the bits do not depend on the level.
//!
//! The compiler finds no good vector instructions for two parts of the engine, so these parts call the
//! instructions explicitly: the tournament of the scheduler (`scheduler/tournament_tree/earliest.rs`) and
//! predictions (`simulation/prediction/vector.rs`). Each such function has a plain version of the same name
//! beside it, which runs on processors without the instructions. Builds for other architectures have one
//! level, and only the plain functions.

#[cfg(target_arch = "x86_64")]
pub(crate) mod load;

/// A level of instructions. The higher levels exist on x86-64 only.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) enum Level {
    /// The instructions on which the build relies.
    #[default]
    Built,
    /// AVX2: four numbers at a time.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// AVX-512: four numbers at a time, with selections by masks.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Level {
    /// All levels, the best one last.
    const ALL: &[Self] = &[
        Self::Built,
        #[cfg(target_arch = "x86_64")]
        Self::Avx2,
        #[cfg(target_arch = "x86_64")]
        Self::Avx512,
    ];

    /// Returns whether this processor has the instructions for which the copy of the level is compiled.
    /// [`Instructions::run`] and [`compiled_for_each`] have the same lists.
    fn is_here(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        use std::arch::is_x86_feature_detected as has;
        match self {
            Self::Built => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => has!("avx2") && has!("bmi1") && has!("bmi2") && has!("lzcnt") && has!("popcnt"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                let is_complete = has!("avx512f") && has!("avx512vl") && has!("avx512dq");
                Self::Avx2.is_here() && is_complete && has!("avx512bw") && has!("avx512cd")
            }
        }
    }
}

/// A level of instructions that this processor has. Since values for other levels cannot be made, code that
/// is compiled for the level may be called safely.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Instructions(Level);

impl Instructions {
    /// The instructions of all processors for which the crate is built.
    pub(crate) const BUILT: Self = Self(Level::Built);

    /// Returns the best level that this processor has.
    pub(crate) fn detected() -> Self {
        Level::ALL.iter().rev().find(|level| level.is_here()).map_or(Self::BUILT, |&level| Self(level))
    }

    /// Returns all levels that this processor has.
    #[cfg(test)]
    pub(crate) fn all() -> Vec<Self> {
        Level::ALL.iter().filter(|level| level.is_here()).map(|&level| Self(level)).collect()
    }

    /// Runs a piece of work with these instructions.
    ///
    /// The work should be long, or capture at most two numbers, since more captures would go through memory.
    ///
    /// `work` and all hot functions that it calls must be `#[inline(always)]`, since other code is compiled
    /// for the level of the build. With a single level, all callers share one copy of the work.
    #[allow(unsafe_code)]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub(crate) fn run<T>(self, work: impl FnOnce() -> T) -> T {
        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
        fn avx2<T>(work: impl FnOnce() -> T) -> T {
            work()
        }

        #[cfg(target_arch = "x86_64")]
        #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw,avx512cd")]
        fn avx512<T>(work: impl FnOnce() -> T) -> T {
            work()
        }

        match self.0 {
            Level::Built => work(),
            // SAFETY: only `detected` and `all` make values, and only for levels that the processor has.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { avx2(work) },
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { avx512(work) },
        }
    }

    /// Returns the level of these instructions.
    #[inline]
    pub(crate) fn level(self) -> Level {
        self.0
    }
}

/// Defines a function that runs one of three others, chosen by the [`Instructions`] in its first argument:
///
/// ```text
/// compiled_for_each! {
///     #[inline(never)] pub(crate) name(argument: Type) -> Output = any, avx2, avx512
/// }
/// ```
///
/// where `any` is a function for any processor, `avx2` one for AVX2, and `avx512` one for AVX-512. A function
/// of vector instructions, or a closure that calls one, can stand there; or the same plain function three
/// times, which is then compiled three times.
///
/// A plain function, and all hot functions that it calls, must be `#[inline(always)]`, since other code is
/// compiled for the level of the build. A constant parameter, the number of the copy, makes the copies
/// different functions: the compiler then inlines what a copy calls as if this copy were its only caller.
/// [`Instructions::run`] would be slower here, since its many captures would go through memory.
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

            #[cfg(target_arch = "x86_64")]
            $(#[$attribute])*
            #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
            fn avx2$(<const $number: usize>)?($($argument: $type),*) -> $output {
                $avx2($($argument),*)
            }

            #[cfg(target_arch = "x86_64")]
            $(#[$attribute])*
            #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw,avx512cd")]
            fn avx512$(<const $number: usize>)?($($argument: $type),*) -> $output {
                $avx512($($argument),*)
            }

            match instructions.level() {
                $crate::instructions::Level::Built => built($($argument),*),
                // SAFETY: as in `Instructions::run`.
                #[cfg(target_arch = "x86_64")]
                $crate::instructions::Level::Avx2 => unsafe { avx2($($argument),*) },
                #[cfg(target_arch = "x86_64")]
                $crate::instructions::Level::Avx512 => unsafe { avx512($($argument),*) },
            }
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
