//! The shape of a type in a file, found by letting the type read one.

use serde::de::value::Error;
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error as _, IntoDeserializer, MapAccess,
    SeqAccess, VariantAccess, Visitor,
};

/// Largest number of readings, far above the number of parts of which only one is seen in a reading.
const READINGS: usize = 1000;

/// Largest depth. A type that contains itself has no end.
const DEPTH: usize = 16;

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
    /// The type has not read it.
    Unknown,
    /// The type looks at the value before it decides.
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
            // What is read is of no interest, and often refused.
            let _ = T::deserialize(Reader { shape: &mut shape, depth: 0 });
        }
        shape
    }

    fn is_known(&self) -> bool {
        self.kind != Kind::Unknown && self.parts.iter().all(|(_, part)| part.is_known())
    }

    /// Sets the kind and the parts, unless an earlier reading has found them.
    fn begin(&mut self, kind: Kind, parts: &[&'static str]) {
        if self.kind == Kind::Unknown {
            *self = Self { kind, parts: parts.iter().map(|name| (*name, Self::UNKNOWN)).collect() };
        }
    }
}

/// A file that has all that the type asks for, and notes it. Parts that are known are left out.
struct Reader<'s> {
    shape: &'s mut Shape,
    depth: usize,
}

impl<'s> Reader<'s> {
    /// Returns the parts that are not known yet.
    fn unknown(self) -> impl Iterator<Item = (&'static str, Self)> {
        let depth = self.depth + 1;
        let parts = self.shape.parts.iter_mut().filter(move |(_, part)| depth < DEPTH && !part.is_known());
        parts.map(move |(name, shape)| (*name, Reader { shape, depth }))
    }
}

macro_rules! values {
    ($($method:ident: $kind:ident => $visit:ident($value:expr)),+) => {$(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
            self.shape.begin(Kind::$kind, &[]);
            visitor.$visit($value)
        }
    )+};
}

impl<'de> Deserializer<'de> for Reader<'_> {
    type Error = Error;

    values! {
        deserialize_bool: Flag => visit_bool(false),
        deserialize_i8: Integer => visit_i8(1),
        deserialize_i16: Integer => visit_i16(1),
        deserialize_i32: Integer => visit_i32(1),
        deserialize_i64: Integer => visit_i64(1),
        deserialize_u8: Integer => visit_u8(1),
        deserialize_u16: Integer => visit_u16(1),
        deserialize_u32: Integer => visit_u32(1),
        deserialize_u64: Integer => visit_u64(1),
        deserialize_f32: Number => visit_f32(1.0),
        deserialize_f64: Number => visit_f64(1.0),
        deserialize_str: Text => visit_str(""),
        deserialize_string: Text => visit_str("")
    }

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Error> {
        self.shape.begin(Kind::Any, &[]);
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

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.shape.begin(Kind::List, &[""]);
        visitor.visit_seq(Parts { rest: self.unknown(), value: None })
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.shape.begin(Kind::Table, fields);
        visitor.visit_map(Parts { rest: self.unknown(), value: None })
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.shape.begin(Kind::Choice, variants);
        visitor.visit_enum(Parts { rest: self.unknown(), value: None })
    }

    serde::forward_to_deserialize_any! {
        i128 u128 char bytes byte_buf unit unit_struct tuple tuple_struct map identifier ignored_any
    }
}

/// The parts of a value, one after the other.
struct Parts<'s, I> {
    rest: I,
    value: Option<Reader<'s>>,
}

impl<'de, 's, I: Iterator<Item = (&'static str, Reader<'s>)>> MapAccess<'de> for Parts<'s, I> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        let Some((name, value)) = self.rest.next() else { return Ok(None) };
        self.value = Some(value);
        seed.deserialize(name.into_deserializer()).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        seed.deserialize(self.value.take().ok_or_else(|| Error::custom("a value comes after its key"))?)
    }
}

impl<'de, 's, I: Iterator<Item = (&'static str, Reader<'s>)>> SeqAccess<'de> for Parts<'s, I> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        self.rest.next().map(|(_, item)| seed.deserialize(item)).transpose()
    }
}

impl<'de, 's, I: Iterator<Item = (&'static str, Reader<'s>)>> EnumAccess<'de> for Parts<'s, I> {
    type Error = Error;
    type Variant = Reader<'s>;

    fn variant_seed<V: DeserializeSeed<'de>>(mut self, seed: V) -> Result<(V::Value, Reader<'s>), Error> {
        let (name, contents) = self.rest.next().ok_or_else(|| Error::custom("all variants are known"))?;
        Ok((seed.deserialize(name.into_deserializer())?, contents))
    }
}

impl<'de> VariantAccess<'de> for Reader<'_> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        self.shape.begin(Kind::Word, &[]);
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
