//! The gate for values from files: they pass the same checks as a constructor's arguments.

/// Implements `Deserialize`: reads exactly these fields, then evaluates the expression. Its error is a
/// `ParameterError` unless another type is named.
///
/// A derived `Deserialize` would fill private fields with numbers that no constructor accepts.
macro_rules! from_file {
    ($name:ident $(<$part:ident>)? { $($fields:tt)+ } => $checked:expr) => {
        crate::gate::from_file! { $name $(<$part>)? { $($fields)+ } => $checked, crate::ParameterError }
    };
    (
        $name:ident $(<$part:ident>)? { $($(#[$attribute:meta])* $field:ident: $type:ty),+ } => $checked:expr,
        $error:ty
    ) => {
        #[cfg(feature = "serde")]
        impl<'de $(, $part: serde::Deserialize<'de>)?> serde::Deserialize<'de> for $name $(<$part>)? {
            fn deserialize<D: serde::Deserializer<'de>>(file: D) -> Result<Self, D::Error> {
                // The mirror struct has the name of the type, since the errors of file formats contain this
                // name.
                #[derive(serde::Deserialize)]
                #[serde(deny_unknown_fields)]
                // The fields keep their names from the type, however similar these are.
                #[allow(clippy::struct_field_names)]
                struct $name $(<$part>)? {
                    $($(#[$attribute])* $field: $type,)+
                }
                let $name { $($field),+ }: $name $(<$part>)? = serde::Deserialize::deserialize(file)?;
                let checked = || -> Result<Self, $error> { $checked };
                checked().map_err(serde::de::Error::custom)
            }
        }
    };
}

pub(crate) use from_file;

/// Writes a number, or leaves it out if it is infinite or NaN, which not all formats can represent.
#[cfg(feature = "serde")]
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
pub(crate) fn if_finite<S: serde::Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(&Some(*number).filter(|number| number.is_finite()), serializer)
}
