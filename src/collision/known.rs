//! Rules of any kind: closures, tables by the kinds of both partners, and the list of the rules that files
//! can hold.

use super::{
    CollisionRule, Contact, ContactDuration, Elastic, ElasticBelow, Frictional, Impulse, LeastRebound,
    RollingFriction, Rough, Smooth, SpeedDependent,
};
use crate::{Fingerprint, Kind};

/// A closure as a [`CollisionRule`]; returned by [`from_fn`].
#[derive(Debug, Clone, Copy)]
pub struct FromFn<F>(F);

/// Makes a rule from a closure.
///
/// ```
/// use granular_edmd::collision::{CollisionRule, Contact, Impulse, from_fn};
/// let sticky = from_fn(|contact: &Contact| Impulse::new(contact.normal_impulse(0.0), 0.0));
/// let contact = Contact::new(1.0, 0.0, 0.5, 0.2);
/// assert_eq!(sticky.impulse(&contact).normal(), 0.5);
/// ```
pub const fn from_fn<F: Fn(&Contact) -> Impulse>(rule: F) -> FromFn<F> {
    FromFn(rule)
}

impl<F: Fn(&Contact) -> Impulse> CollisionRule for FromFn<F> {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        (self.0)(contact)
    }
}

/// A table of rules for pairs of kinds, with one rule for all other pairs.
///
/// Other codes call such tables pair coefficients.
///
/// The order of the partners does not matter. Walls are partners, too. Their kind is [`Kind::WALL`], unless
/// they were given another one ([`Container::with_kind`](crate::boundary::Container::with_kind)). The table
/// does not apply to collisions with a wall that has its own rule. Rules of several types go into the table
/// as [`KnownRule`], which files can hold, or as [`BoxedRule`](crate::simulation::BoxedRule).
///
/// ```
/// use granular_edmd::Kind;
/// use granular_edmd::collision::{CollisionRule, Contact, Frictional, RulesByKind};
///
/// const GLASS: Kind = Kind::new(0);
/// const STEEL: Kind = Kind::new(1);
/// let rules = RulesByKind::new(Frictional::from_inelasticity(0.05, 0.05, 0.1)?)
///     .with(STEEL, STEEL, Frictional::from_inelasticity(0.02, 0.02, 0.05)?)
///     .with(STEEL, Kind::WALL, Frictional::from_inelasticity(0.0, 0.0, 0.3)?);
///
/// let contact = Contact::new(1.0, 0.0, 0.5, 0.5 / 3.0).with_kinds([Kind::WALL, STEEL]);
/// assert_eq!(rules.impulse(&contact).normal(), 1.0);
/// assert_eq!(rules.rule(GLASS, STEEL), &Frictional::from_inelasticity(0.05, 0.05, 0.1)?);
/// # Ok::<(), granular_edmd::ParameterError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct RulesByKind<R> {
    otherwise: R,
    /// The pairs with their rules, ordered by kinds. Each pair occurs once.
    pairs: Vec<PairRule<R>>,
}

/// The rule of a pair of kinds, the smaller kind first.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
struct PairRule<R> {
    kinds: [Kind; 2],
    rule: R,
}

impl<R> RulesByKind<R> {
    /// Creates a table with one rule for all pairs.
    pub const fn new(otherwise: R) -> Self {
        Self { otherwise, pairs: Vec::new() }
    }

    /// Returns the same table with this rule for a pair of kinds, in place of an earlier one.
    pub fn with(mut self, first: Kind, second: Kind, rule: R) -> Self {
        let kinds = ordered([first, second]);
        match self.place(kinds) {
            Ok(there) => self.pairs[there].rule = rule,
            Err(there) => self.pairs.insert(there, PairRule { kinds, rule }),
        }
        self
    }

    /// Returns the rule of a pair of kinds.
    #[inline]
    pub fn rule(&self, first: Kind, second: Kind) -> &R {
        self.place(ordered([first, second])).map_or(&self.otherwise, |there| &self.pairs[there].rule)
    }

    /// Returns the index of a pair in the list, or the index at which it would be inserted.
    #[inline]
    fn place(&self, kinds: [Kind; 2]) -> Result<usize, usize> {
        self.pairs.binary_search_by_key(&kinds, |pair| pair.kinds)
    }
}

#[inline]
fn ordered([first, second]: [Kind; 2]) -> [Kind; 2] {
    if second < first { [second, first] } else { [first, second] }
}

impl<R: CollisionRule> CollisionRule for RulesByKind<R> {
    #[inline]
    fn impulse(&self, contact: &Contact) -> Impulse {
        let [first, second] = contact.kinds();
        self.rule(first, second).impulse(contact)
    }

    /// Returns `None` if one of the rules has no fingerprint: two such tables could not be distinguished.
    fn fingerprint(&self) -> Option<Fingerprint> {
        let table = Fingerprint::of("RulesByKind").part(self.otherwise.fingerprint()?);
        self.pairs.iter().try_fold(table, |table, PairRule { kinds, rule }| {
            let [first, second] = kinds.map(|kind| f64::from(kind.number()));
            Some(table.number(first).number(second).part(rule.fingerprint()?))
        })
    }

    fn known(&self) -> Option<KnownRule> {
        let known = |pair: &PairRule<R>| Some(PairRule { kinds: pair.kinds, rule: pair.rule.known()? });
        let pairs = self.pairs.iter().map(known).collect::<Option<_>>()?;
        Some(Box::new(RulesByKind { otherwise: self.otherwise.known()?, pairs }).into())
    }
}

// Files may list the pairs in any order.
crate::gate::from_file! {
    RulesByKind<R> { otherwise: R, #[serde(default = "Vec::new")] pairs: Vec<PairRule<R>> } => {
        let mut table = Self::new(otherwise);
        for PairRule { kinds, rule } in pairs {
            let kinds = ordered(kinds);
            let Err(there) = table.place(kinds) else {
                let [first, second] = kinds;
                return Err(format!("two rules for the kinds {first} and {second}"));
            };
            table.pairs.insert(there, PairRule { kinds, rule });
        }
        Ok(table)
    }, String
}

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
