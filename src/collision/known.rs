//! The list of the rules that can be written to files.

use super::{
    CollisionRule, Contact, ContactDuration, Elastic, ElasticBelow, Frictional, Impulse, LeastRebound,
    RollingFriction, Rough, RulesByKind, Smooth, SpeedDependent,
};
use crate::Fingerprint;

/// Makes the list: an enum with a variant for each rule, and the conversions from these rules.
macro_rules! known {
    ($($variant:ident($rule:ty)),+ $(,)?) => {
        #[derive(Debug, Clone, PartialEq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(rename_all = "snake_case", rename = "Rule"))]
        enum Known {
            $($variant($rule)),+
        }

        impl KnownRule {
            fn rule(&self) -> &dyn CollisionRule {
                match &self.0 {
                    $(Known::$variant(rule) => rule),+
                }
            }
        }

        $(impl From<$rule> for KnownRule {
            fn from(rule: $rule) -> Self {
                Self(Known::$variant(rule))
            }
        })+
    };
}

// Remedies and tables hold known rules themselves, so they nest in any order.
known! {
    Elastic(Elastic),
    Smooth(Smooth),
    Rough(Rough),
    Frictional(Frictional),
    SpeedDependent(SpeedDependent),
    ContactDuration(Box<ContactDuration<KnownRule>>),
    ElasticBelow(Box<ElasticBelow<KnownRule>>),
    LeastRebound(Box<LeastRebound<KnownRule>>),
    RollingFriction(Box<RollingFriction<KnownRule>>),
    RulesByKind(Box<RulesByKind<KnownRule>>),
}

/// Any rule of this crate, as a value that files can hold.
///
/// It represents rules of different types as one type: for a table of rules ([`RulesByKind`]), or for a rule
/// that a file names. With the feature `serde`, it is written as the name of the rule in `snake_case` with
/// its numbers. [`CollisionRule::known`] makes it from a rule.
///
/// ```
/// use granular_edmd::Kind;
/// use granular_edmd::collision::{
///     CollisionRule, ContactDuration, Elastic, Frictional, KnownRule, RulesByKind, from_fn,
/// };
///
/// let lossy = ContactDuration::new(Frictional::from_inelasticity(0.1, 0.1, 0.3)?, 1e-4)?;
/// let rules = RulesByKind::new(lossy.known().unwrap()).with(Kind::WALL, Kind::new(1), Elastic.into());
/// let known: KnownRule = rules.known().unwrap();
/// assert_eq!(known.fingerprint(), rules.fingerprint());
/// assert!(from_fn(|contact| Elastic.impulse(contact)).known().is_none(), "code is not data");
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct KnownRule(Known);

impl CollisionRule for KnownRule {
    fn impulse(&self, contact: &Contact) -> Impulse {
        self.rule().impulse(contact)
    }

    fn fingerprint(&self) -> Option<Fingerprint> {
        self.rule().fingerprint()
    }

    fn known(&self) -> Option<KnownRule> {
        Some(self.clone())
    }
}

/// Deepest nesting of rules that is read from a file. In a format that is not self-describing, a few bytes
/// can nest rules until the stack overflows.
#[cfg(feature = "serde")]
const DEEPEST: usize = 16;

#[cfg(feature = "serde")]
impl<'de> serde::Deserialize<'de> for KnownRule {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        thread_local!(static DEPTH: std::cell::Cell<usize> = const { std::cell::Cell::new(0) });
        let depth = DEPTH.get();
        if depth == DEEPEST {
            let reason = format_args!("more than {DEEPEST} rules within each other");
            return Err(serde::de::Error::custom(reason));
        }
        DEPTH.set(depth + 1);
        let known = Known::deserialize(deserializer);
        DEPTH.set(depth);
        known.map(Self)
    }
}
