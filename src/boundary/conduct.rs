//! Responses of walls in owned form.

use std::fmt;
use std::sync::Arc;

use super::{Response, Thermal};
use crate::Fingerprint;
use crate::collision::CollisionRule;

/// The response of a wall to a touch, as the wall keeps it. [`Response`] borrows it.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub(super) enum Conduct {
    #[default]
    Shared,
    Rule(OwnRule),
    Thermal(Thermal),
}

impl Conduct {
    pub(super) fn rule(rule: impl CollisionRule + Send + Sync + 'static) -> Self {
        Self::Rule(OwnRule::new(rule))
    }

    #[inline]
    pub(super) fn response(&self) -> Response<'_> {
        match self {
            Self::Shared => Response::Shared,
            Self::Rule(own) => Response::Rule(&*own.rule),
            Self::Thermal(thermal) => Response::Thermal(*thermal),
        }
    }

    pub(super) fn fingerprint(&self) -> Option<Fingerprint> {
        Some(match self {
            Self::Shared => Fingerprint::of("Shared"),
            Self::Rule(own) => Fingerprint::of("Rule").part(own.rule.fingerprint()?),
            Self::Thermal(thermal) => thermal.fingerprint(),
        })
    }
}

/// A rule of any type.
///
/// The rules in `Known` are recognized, so they can be written to files and read back. A rule of your own
/// cannot.
#[derive(Clone)]
pub(super) struct OwnRule {
    rule: Arc<dyn CollisionRule + Send + Sync>,
    #[cfg(feature = "serde")]
    known: Option<file::Known>,
}

impl OwnRule {
    fn new<R: CollisionRule + Send + Sync + 'static>(rule: R) -> Self {
        #[cfg(feature = "serde")]
        let known = file::Known::of(&rule);
        Self {
            rule: Arc::new(rule),
            #[cfg(feature = "serde")]
            known,
        }
    }
}

impl fmt::Debug for OwnRule {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("..")
    }
}

/// Rules in files.
#[cfg(feature = "serde")]
mod file {
    use std::any::Any;
    use std::sync::Arc;

    use serde::ser::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::OwnRule;
    use crate::Fingerprint;
    use crate::collision::{
        CollisionRule, Contact, ContactDuration, Elastic, ElasticBelow, Frictional, Impulse, LeastRebound,
        Rough, Smooth, SpeedDependent,
    };

    /// A rule of the crate, without a remedy around it.
    #[derive(Debug, Clone, Copy, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub(super) enum Plain {
        Elastic(Elastic),
        Smooth(Smooth),
        Rough(Rough),
        Frictional(Frictional),
        SpeedDependent(SpeedDependent),
    }

    impl Plain {
        fn rule(&self) -> &dyn CollisionRule {
            match self {
                Self::Elastic(rule) => rule,
                Self::Smooth(rule) => rule,
                Self::Rough(rule) => rule,
                Self::Frictional(rule) => rule,
                Self::SpeedDependent(rule) => rule,
            }
        }
    }

    impl CollisionRule for Plain {
        fn impulse(&self, contact: &Contact) -> Impulse {
            self.rule().impulse(contact)
        }

        fn explain(&self, contact: &Contact) -> Option<String> {
            self.rule().explain(contact)
        }

        fn fingerprint(&self) -> Option<Fingerprint> {
            self.rule().fingerprint()
        }
    }

    /// A rule of the crate, alone or within a remedy.
    #[derive(Debug, Clone, Copy, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case", rename = "Rule")]
    pub(super) enum Known {
        Plain(Plain),
        ContactDuration(ContactDuration<Plain>),
        ElasticBelow(ElasticBelow<Plain>),
        LeastRebound(LeastRebound<Plain>),
    }

    impl Known {
        pub(super) fn of(rule: &dyn Any) -> Option<Self> {
            Self::with(rule, Plain::Elastic)
                .or_else(|| Self::with(rule, Plain::Smooth))
                .or_else(|| Self::with(rule, Plain::Rough))
                .or_else(|| Self::with(rule, Plain::Frictional))
                .or_else(|| Self::with(rule, Plain::SpeedDependent))
        }

        /// Recognizes a rule of type `R`, alone or within a remedy.
        fn with<R: Copy + 'static>(rule: &dyn Any, plain: fn(R) -> Plain) -> Option<Self> {
            if let Some(rule) = rule.downcast_ref::<R>() {
                Some(Self::Plain(plain(*rule)))
            } else if let Some(remedy) = rule.downcast_ref::<ContactDuration<R>>() {
                Some(Self::ContactDuration(remedy.around(plain(*remedy.rule()))))
            } else if let Some(remedy) = rule.downcast_ref::<ElasticBelow<R>>() {
                Some(Self::ElasticBelow(remedy.around(plain(*remedy.rule()))))
            } else {
                let remedy = rule.downcast_ref::<LeastRebound<R>>()?;
                Some(Self::LeastRebound(remedy.around(plain(*remedy.rule()))))
            }
        }

        fn owned(self) -> OwnRule {
            let rule: Arc<dyn CollisionRule + Send + Sync> = match self {
                Self::Plain(rule) => Arc::new(rule),
                Self::ContactDuration(rule) => Arc::new(rule),
                Self::ElasticBelow(rule) => Arc::new(rule),
                Self::LeastRebound(rule) => Arc::new(rule),
            };
            OwnRule { rule, known: Some(self) }
        }
    }

    impl Serialize for OwnRule {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let own = "only the rules of granular-edmd can be serialized, alone or in one remedy for rest";
            self.known.ok_or_else(|| S::Error::custom(own))?.serialize(serializer)
        }
    }

    impl<'de> Deserialize<'de> for OwnRule {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            Known::deserialize(deserializer).map(Known::owned)
        }
    }
}
