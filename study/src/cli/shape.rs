//! The shape that a type has in a file, found by letting the type read a file.

use serde::de::value::{Error, MapDeserializer, SeqDeserializer};
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error as _, IntoDeserializer, VariantAccess,
    Visitor,
};

/// Largest number of readings. It is far above the number of variants and options, of which a reading shows
/// only one.
const READINGS: usize = 1000;

/// Largest depth. The shape of a recursive type would have infinite depth.
const DEPTH: usize = 8;

/// The keys that a type accepts, with the kinds of their values.
#[derive(Debug)]
pub(super) struct Shape {
    pub(super) kind: Kind,
    /// The fields of a table, the variants of a choice, or the one item of a list.
    pub(super) parts: Vec<(&'static str, Self)>,
}

/// The kind of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// The type has not read the value.
    Unknown,
    /// The type examines the value before it decides what to read.
    Any,
    /// A variant without contents.
    Word,
    Flag,
    Integer,
    Number,
    Text,
    List,
    Table,
    /// One of several variants.
    Choice,
}

impl Shape {
    const UNKNOWN: Self = Self { kind: Kind::Unknown, parts: Vec::new() };

    /// Returns the shape of a type.
    pub(super) fn of<T: DeserializeOwned>() -> Self {
        let mut shape = Self::UNKNOWN;
        for _ in 0..READINGS {
            if shape.is_known() {
                break;
            }
            // Only the shape counts: the value is not used, and the type often refuses it.
            let _ = T::deserialize(Reader { shape: &mut shape, depth: 0 });
        }
        shape
    }

    /// Returns whether the type has a key of this full name, with dots, or examines values before it decides.
    pub(super) fn has(&self, name: &str) -> bool {
        let (first, rest) = name.split_once('.').map_or((name, None), |(first, rest)| (first, Some(rest)));
        match self.kind {
            Kind::Unknown | Kind::Any => true,
            Kind::List => self.parts.iter().any(|(_, item)| item.has(name)),
            _ => self
                .parts
                .iter()
                .any(|(part, shape)| *part == first && rest.is_none_or(|rest| shape.has(rest))),
        }
    }

    fn is_known(&self) -> bool {
        self.kind != Kind::Unknown && self.parts.iter().all(|(_, part)| part.is_known())
    }
}

/// A made-up file, which has whatever the type asks for, and records each request. Parts that are known
/// already are left out.
struct Reader<'s> {
    shape: &'s mut Shape,
    depth: usize,
}

impl Reader<'_> {
    /// Sets the kind and the parts, unless an earlier reading has found them.
    fn begin(&mut self, kind: Kind, parts: &[&'static str]) {
        let (kind, parts) = if self.depth < DEPTH { (kind, parts) } else { (Kind::Any, [].as_slice()) };
        if self.shape.kind == Kind::Unknown {
            *self.shape = Shape { kind, parts: parts.iter().map(|name| (*name, Shape::UNKNOWN)).collect() };
        }
    }

    /// Returns the parts that are not known yet.
    fn unknown(self) -> impl Iterator<Item = (&'static str, Self)> {
        let depth = self.depth + 1;
        let parts = self.shape.parts.iter_mut().filter(|(_, part)| !part.is_known());
        parts.map(move |(name, shape)| (*name, Reader { shape, depth }))
    }
}

/// Implements the methods for values without parts.
macro_rules! values {
    ($($kind:ident => $visit:ident($value:expr): $($method:ident)+;)+) => {$($(
        fn $method<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Error> {
            self.begin(Kind::$kind, &[]);
            visitor.$visit($value)
        }
    )+)+};
}

impl<'de> Deserializer<'de> for Reader<'_> {
    type Error = Error;

    values! {
        Flag => visit_bool(false): deserialize_bool;
        Integer => visit_u64(1): deserialize_i8 deserialize_i16 deserialize_i32 deserialize_i64
            deserialize_u8 deserialize_u16 deserialize_u32 deserialize_u64;
        Number => visit_f64(1.0): deserialize_f32 deserialize_f64;
        Text => visit_str(""): deserialize_str deserialize_string;
    }

    fn deserialize_any<V: Visitor<'de>>(mut self, _: V) -> Result<V::Value, Error> {
        self.begin(Kind::Any, &[]);
        Err(Error::custom("the type decides by the value"))
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Error> {
        self.begin(Kind::List, &[""]);
        visitor.visit_seq(SeqDeserializer::new(self.unknown().map(|(_, item)| item)))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        mut self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.begin(Kind::Table, fields);
        visitor.visit_map(MapDeserializer::new(self.unknown()))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        mut self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.begin(Kind::Choice, variants);
        visitor.visit_enum(Variant(self.unknown().next()))
    }

    serde::forward_to_deserialize_any! {
        i128 u128 char bytes byte_buf unit unit_struct tuple tuple_struct map identifier ignored_any
    }
}

impl IntoDeserializer<'_, Error> for Reader<'_> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

/// A variant with its contents; `None` at the largest depth.
struct Variant<'s>(Option<(&'static str, Reader<'s>)>);

impl<'de, 's> EnumAccess<'de> for Variant<'s> {
    type Error = Error;
    type Variant = Reader<'s>;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Reader<'s>), Error> {
        let (name, contents) = self.0.ok_or_else(|| Error::custom("the type is too deep"))?;
        Ok((seed.deserialize(name.into_deserializer())?, contents))
    }
}

impl<'de> VariantAccess<'de> for Reader<'_> {
    type Error = Error;

    fn unit_variant(mut self) -> Result<(), Error> {
        self.begin(Kind::Word, &[]);
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Error> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_any(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.deserialize_struct("", fields, visitor)
    }
}
