//! Rules in files: what is written can be read, and what a constructor refuses a file cannot bring in.

use granular_edmd::Kind;
use granular_edmd::boundary::{Boundary, Container, Wall};
use granular_edmd::collision::{
    CollisionRule, ContactDuration, Elastic, ElasticBelow, Friction, Frictional, KnownRule, LeastRebound,
    RollingFriction, Rough, RulesByKind, Smooth, SpeedDependent, TangentialResponse,
};
use granular_edmd::strategies::decades;
use proptest::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::rules::config;

fn returns<T: Serialize + DeserializeOwned + PartialEq>(value: &T) -> bool {
    let text = serde_json::to_string(value).unwrap();
    serde_json::from_str::<T>(&text).unwrap() == *value
}

/// The error of reading `text` as a `T`.
fn refusal<T: DeserializeOwned>(text: &str) -> String {
    serde_json::from_str::<T>(text).err().map(|error| error.to_string()).unwrap_or_default()
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn every_rule_returns(
        normal in 0.0..=0.5,
        tangential in 0.0..=1.0,
        friction in prop_oneof![Just(0.0), decades(-9.0, 9.0), Just(f64::MAX)],
        ratio in 0.0..=1.0,
        duration in decades(-300.0, 300.0),
    ) {
        let frictional = Frictional::from_inelasticity(normal, tangential, friction)
            .and_then(|rule| rule.with_dynamic_friction(ratio * friction))
            .unwrap();
        let (smooth, rough) = (Smooth::from_inelasticity(normal).unwrap(), Rough::from_inelasticity(normal, tangential).unwrap());
        let unchanged = TangentialResponse::Unchanged;
        prop_assert!(returns(&Elastic) && returns(&smooth) && returns(&rough) && returns(&frictional));
        prop_assert!(returns(&ContactDuration::new(Elastic, duration).unwrap()));
        let friction = Friction::from_inelasticity(tangential, friction).unwrap();
        prop_assert!(returns(&friction));
        prop_assert!(returns(&ContactDuration::new(frictional, duration).unwrap()));
        let nested = ContactDuration::new(rough, duration).unwrap().with_tangential_response(unchanged);
        prop_assert!(returns(&ContactDuration::new(nested, duration).unwrap()));
        let below = ElasticBelow::new(frictional, duration).unwrap();
        prop_assert!(returns(&below) && returns(&below.with_tangential_response(unchanged)));
        prop_assert!(returns(&LeastRebound::new(frictional, duration).unwrap()));
        prop_assert!(returns(&RollingFriction::new(frictional, duration).unwrap()));
        prop_assert!(returns(&SpeedDependent::from_restitution(ratio, duration).unwrap().with_friction(friction)));
    }
}

/// Checks that a wall with this rule comes back from a file with a rule of the same name and numbers.
fn walls_return(rule: impl CollisionRule + Send + Sync + 'static) -> &'static str {
    let name = std::any::type_name_of_val(&rule);
    let wall = Container::closed(9.0, 9.0).unwrap().with_rule(Wall::Left, rule).unwrap();
    let text = serde_json::to_string(&wall).unwrap_or_else(|error| panic!("{name}: {error}"));
    let back: Container = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
    assert_eq!(serde_json::to_string(&back).unwrap(), text);
    assert!(back.fingerprint().is_some());
    assert_eq!(back.fingerprint(), wall.fingerprint(), "{text}");
    let bytes = postcard::to_allocvec(&wall).unwrap();
    let back: Container = postcard::from_bytes(&bytes).unwrap();
    assert_eq!(back.fingerprint(), wall.fingerprint(), "{text}");
    name
}

/// Every rule in the folder of rules goes to a file and back, alone, boxed, and within remedies and tables in
/// any order.
#[test]
fn every_rule_of_the_crate_returns_on_a_wall() {
    let frictional = Frictional::from_restitution(0.9, 0.2, 0.5).unwrap().with_dynamic_friction(0.1).unwrap();
    let bizon = SpeedDependent::from_restitution(0.7, 2.0).unwrap();
    let lasting = ContactDuration::new(frictional, 1e-3).unwrap();
    let below = ElasticBelow::new(lasting, 0.1).unwrap();
    let table = RulesByKind::new(below).with(Kind::new(1), Kind::WALL, below);
    let boxed: Box<dyn CollisionRule + Send + Sync> = Box::new(bizon);
    let mixed = RulesByKind::new(KnownRule::from(Elastic)).with(Kind::WALL, Kind::WALL, bizon.into());
    let returned = [
        walls_return(Elastic),
        walls_return(Smooth::from_restitution(0.9).unwrap()),
        walls_return(Rough::from_restitution(0.9, 0.3).unwrap()),
        walls_return(frictional),
        walls_return(bizon.with_friction(Friction::from_restitution(0.5, 0.3).unwrap())),
        walls_return(lasting.with_tangential_response(TangentialResponse::Reversing)),
        walls_return(below),
        walls_return(LeastRebound::new(table.clone(), 0.2).unwrap()),
        walls_return(RollingFriction::new(frictional, 0.1).unwrap()),
        walls_return(table),
        walls_return(ContactDuration::new(boxed, 1.0).unwrap()),
        walls_return(mixed.known().unwrap()),
        walls_return(mixed),
    ];
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../src/collision");
    for file in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let text = if file.is_file() { std::fs::read_to_string(&file).unwrap() } else { String::new() };
        let rules = text.lines().filter(|line| line.starts_with("impl"));
        for (_, rule) in rules.filter_map(|line| line.split_once("CollisionRule for ")) {
            let name = rule.split(|letter: char| !letter.is_alphanumeric()).next().unwrap();
            let is_known = returned.iter().any(|returned| {
                returned.split('<').next().is_some_and(|path| path.ends_with(&format!("::{name}")))
            });
            assert!(is_known || name == "FromFn", "{name} is not in the list of src/collision/known.rs");
        }
    }
}

/// A file cannot fill the stack with rules within rules.
#[test]
fn rules_within_rules_are_bounded() {
    let mut bytes = vec![5_u8; 1_000_000];
    bytes.push(0);
    let error = postcard::from_bytes::<KnownRule>(&bytes).unwrap_err();
    assert_eq!(error, postcard::Error::SerdeDeCustom);
    let nested = |depth: usize| {
        let rule = r#"{"least_rebound":{"rule":"#.repeat(depth) + r#"{"elastic":{}}"#;
        serde_json::from_str::<KnownRule>(&(rule + &r#","speed":1}}"#.repeat(depth)))
    };
    assert!(nested(15).unwrap().fingerprint().is_some());
    assert!(nested(16).unwrap_err().to_string().contains("more than 16 rules within each other"));
}

#[test]
fn the_names_in_a_file_are_stable() {
    let rule = ContactDuration::new(Frictional::from_inelasticity(0.25, 0.25, 0.5).unwrap(), 0.125).unwrap();
    let text = concat!(
        r#"{"rule":{"normal_inelasticity":0.25,"friction":"#,
        r#"{"tangential_inelasticity":0.25,"static_friction":0.5,"dynamic_friction":0.5}},"duration":0.125,"#,
        r#""tangential_response":"Frictionless"}"#
    );
    assert_eq!(serde_json::to_string(&rule).unwrap(), text);
    let friction = r#"{"tangential_inelasticity":0.25,"static_friction":0.5,"dynamic_friction":0.5}"#;
    assert_eq!(serde_json::to_string(&Friction::from_inelasticity(0.25, 0.5).unwrap()).unwrap(), friction);
    let below = ElasticBelow::new(Elastic, 0.125).unwrap();
    let text_below = r#"{"rule":{},"speed":0.125,"tangential_response":"Frictionless"}"#;
    assert_eq!(serde_json::to_string(&below).unwrap(), text_below);
    let rebound = LeastRebound::new(Elastic, 0.125).unwrap();
    assert_eq!(serde_json::to_string(&rebound).unwrap(), r#"{"rule":{},"speed":0.125}"#);
    let bizon = SpeedDependent::from_restitution(0.5, 2.0)
        .unwrap()
        .with_friction(Friction::from_inelasticity(0.25, 0.5).unwrap());
    let text_bizon = format!(r#"{{"least_restitution":0.5,"speed":2.0,"friction":{friction}}}"#);
    assert_eq!(serde_json::to_string(&bizon).unwrap(), text_bizon);
    let short = text.replace(r#","tangential_response":"Frictionless""#, "");
    assert_eq!(serde_json::from_str::<ContactDuration<Frictional>>(&short).unwrap(), rule);
}

#[test]
fn a_file_passes_the_constructors() {
    let smooth = r#"{"normal_inelasticity":0.7}"#;
    assert!(refusal::<Smooth>(smooth).contains(&Smooth::from_inelasticity(0.7).unwrap_err().to_string()));
    let rough = r#"{"normal_inelasticity":0.1,"tangential_inelasticity":-0.5}"#;
    assert!(refusal::<Rough>(rough).contains(&Rough::from_inelasticity(0.1, -0.5).unwrap_err().to_string()));
    let friction = r#"{"tangential_inelasticity":0,"static_friction":0.1,"dynamic_friction":0.2}"#;
    let error = Friction::from_inelasticity(0.0, 0.1)
        .and_then(|friction| friction.with_dynamic_friction(0.2))
        .unwrap_err();
    let frictional = format!(r#"{{"normal_inelasticity":0,"friction":{friction}}}"#);
    assert!(refusal::<Frictional>(&frictional).contains(&error.to_string()));
    assert!(refusal::<Friction>(friction).contains(&error.to_string()));
    let model = r#"{"rule":{},"duration":0}"#;
    let error = ContactDuration::new(Elastic, 0.0).unwrap_err();
    assert!(refusal::<ContactDuration<Elastic>>(model).contains(&error.to_string()));
    let below = r#"{"rule":{},"speed":-1}"#;
    let error = ElasticBelow::new(Elastic, -1.0).unwrap_err();
    assert!(refusal::<ElasticBelow<Elastic>>(below).contains(&error.to_string()));
    let error = LeastRebound::new(Elastic, -1.0).unwrap_err();
    assert!(refusal::<LeastRebound<Elastic>>(below).contains(&error.to_string()));
    let inner = format!(r#"{{"rule":{smooth},"duration":1}}"#);
    assert!(
        refusal::<ContactDuration<Smooth>>(&inner)
            .contains("normal inelasticity must be in [0, 0.5], but is 0.7")
    );
}

#[test]
fn unknown_missing_and_unreadable_fields_are_refused() {
    assert!(
        refusal::<Smooth>(r#"{"normal_inelasticity":0.1,"colour":1}"#).contains("unknown field `colour`")
    );
    assert!(
        refusal::<Rough>(r#"{"normal_inelasticity":0.1}"#)
            .contains("missing field `tangential_inelasticity`")
    );
    assert!(refusal::<Smooth>(r#"{"normal_inelasticity":null}"#).contains("null"));
    assert!(refusal::<Smooth>(r#"{"normal_inelasticity":1e999}"#).contains("out of range"));
    let frictional = concat!(
        r#"{"normal_inelasticity":0,"friction":{"tangential_inelasticity":0,"static_friction":0,"#,
        r#""dynamic_friction":0},"restitution":1}"#
    );
    assert!(refusal::<Frictional>(frictional).contains("unknown field `restitution`"));
    let model = r#"{"rule":{},"duration":1,"response":0}"#;
    assert!(refusal::<ContactDuration<Elastic>>(model).contains("unknown field `response`"));
    let below = r#"{"rule":{},"speed":1,"response":0}"#;
    assert!(refusal::<ElasticBelow<Elastic>>(below).contains("unknown field `response`"));
    let bizon = r#"{"least_restitution":0.5,"speed":1,"exponent":0.75}"#;
    assert!(refusal::<SpeedDependent>(bizon).contains("unknown field `exponent`"));
    let response = r#"{"rule":{},"duration":1,"tangential_response":"Sticky"}"#;
    assert!(refusal::<ContactDuration<Elastic>>(response).contains("unknown variant `Sticky`"));
}
