//! The gate for values from plans: they pass the same checks as a constructor's arguments.

/// Implements `Deserialize`: reads exactly these fields, then evaluates the expression.
///
/// A derived `Deserialize` would fill private fields with numbers that no constructor accepts.
macro_rules! from_file {
    ($name:ident { $($(#[$attribute:meta])* $field:ident: $type:ty),+ } => $checked:expr, $error:ty) => {
        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(file: D) -> Result<Self, D::Error> {
                // The mirror has the name of the type, which stands in errors of formats.
                #[derive(serde::Deserialize)]
                #[serde(deny_unknown_fields)]
                struct $name {
                    $($(#[$attribute])* $field: $type,)+
                }
                let $name { $($field),+ } = serde::Deserialize::deserialize(file)?;
                let checked = || -> Result<Self, $error> { $checked };
                checked().map_err(serde::de::Error::custom)
            }
        }
    };
}

pub(crate) use from_file;
