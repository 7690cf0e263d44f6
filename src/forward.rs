//! Forwarding: a box of a part, or a reference to a part, implements the part's trait, too.

/// Implements a trait for pointers to its implementers. Each call goes to the part behind the pointer.
///
/// The list has all methods of the trait, first the methods of `&self`, then `mut` and the methods of
/// `&mut self`. If a provided method were missing here, its default would silently replace the part's method.
macro_rules! forward {
    ($trait:ident for [$($pointer:ty),+] $methods:tt) => {
        $(crate::forward::forward!(@ $trait, $pointer, $methods);)+
    };
    (@ $trait:ident, $pointer:ty, {
        $(type $output:ident;)?
        $(fn $shared:ident(&self $(, $a:ident: $at:ty)*) $(-> $ar:ty)?;)*
        $(mut $(fn $own:ident(&mut self $(, $b:ident: $bt:ty)*) $(-> $br:ty)?;)+)?
    }) => {
        impl<T: $trait + ?Sized> $trait for $pointer {
            $(type $output = T::$output;)?
            $(#[inline]
            fn $shared(&self $(, $a: $at)*) $(-> $ar)? {
                (**self).$shared($($a),*)
            })*
            $($(#[inline]
            fn $own(&mut self $(, $b: $bt)*) $(-> $br)? {
                (**self).$own($($b),*)
            })+)?
        }
    };
}

pub(crate) use forward;
