//! Kinds and radii of the partners, as rules see them, and tables of rules by kind.

use granular_edmd::collision::{
    CollisionRule, Contact, Elastic, Frictional, Impulse, RulesByKind, Smooth, collide, collide_with_wall,
    from_fn, laws,
};
use granular_edmd::glam::DVec2;
use granular_edmd::simulation::BoxedRule;
use granular_edmd::strategies;
use granular_edmd::{Disk, Kind};
use proptest::prelude::*;

use crate::rules::config;

const GLASS: Kind = Kind::new(3);
const STEEL: Kind = Kind::new(7);

fn table() -> RulesByKind<Smooth> {
    let smooth = |inelasticity| Smooth::from_inelasticity(inelasticity).unwrap();
    RulesByKind::new(smooth(0.0)).with(STEEL, GLASS, smooth(0.1)).with(STEEL, Kind::WALL, smooth(0.2))
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn a_contact_knows_its_partners((first, second) in strategies::touching_pair()) {
        let (first, second) = (first.with_kind(GLASS), second.with_kind(STEEL));
        let contact = collide(&Elastic, &first, &second).contact;
        prop_assert_eq!(contact.kinds(), [GLASS, STEEL]);
        prop_assert_eq!(contact.radii(), [first.radius(), second.radius()]);
        let effective = 1.0 / (1.0 / first.radius() + 1.0 / second.radius());
        prop_assert!((contact.effective_radius() / effective - 1.0).abs() < 1e-15);
        let reversed = collide(&Elastic, &second, &first).contact;
        prop_assert_eq!(reversed.effective_radius(), contact.effective_radius());

        let wall = collide_with_wall(&Elastic, &first, DVec2::Y, DVec2::ZERO).contact;
        prop_assert_eq!(wall.kinds(), [GLASS, Kind::WALL]);
        prop_assert_eq!(wall.radii(), [first.radius(), f64::INFINITY]);
        prop_assert_eq!(wall.effective_radius(), first.radius());
    }

    #[test]
    fn a_table_answers_with_the_rule_of_the_pair(contact in strategies::contact()) {
        let pairs = [([STEEL, GLASS], 0.1), ([GLASS, STEEL], 0.1), ([Kind::WALL, STEEL], 0.2), ([STEEL, STEEL], 0.0)];
        for (kinds, inelasticity) in pairs {
            let contact = contact.with_kinds(kinds);
            let alone = Smooth::from_inelasticity(inelasticity).unwrap().impulse(&contact);
            prop_assert_eq!(table().impulse(&contact), alone);
        }
    }
}

#[test]
fn the_last_rule_of_a_pair_counts() {
    let later = table().with(GLASS, STEEL, Smooth::from_inelasticity(0.3).unwrap());
    assert_eq!(later.rule(STEEL, GLASS), &Smooth::from_inelasticity(0.3).unwrap());
    assert_eq!(later.rule(STEEL, Kind::WALL), &Smooth::from_inelasticity(0.2).unwrap());
    assert_eq!(later.rule(GLASS, GLASS), &Smooth::from_inelasticity(0.0).unwrap());
}

#[test]
fn a_table_keeps_the_laws_that_its_rules_keep() {
    let friction = |coefficient| Frictional::from_inelasticity(0.1, 0.1, coefficient).unwrap();
    let rules = RulesByKind::new(friction(0.3)).with(Kind::DEFAULT, Kind::new(1), friction(0.1));
    laws::check(&rules, &laws::Promises::new().with_friction(0.3)).unwrap();
    let broken = laws::check(&rules, &laws::Promises::new().with_friction(0.1)).unwrap_err();
    let pairs = ["kinds 0 and 1)", "kinds 1 and 0)"];
    assert!(!pairs.iter().any(|pair| broken.found().contains(pair)), "{broken}");
}

/// The checks reach rules that are wrong for one pair of kinds only, or for walls, or for large disks.
#[test]
fn faults_of_single_pairs_are_found() {
    let faulty: [fn(&Contact) -> bool; 4] = [
        |contact| contact.is_between(Kind::new(1), Kind::new(1)),
        |contact| contact.kinds()[1] == Kind::WALL,
        |contact| contact.effective_radius() > 1e29,
        |contact| contact.radii()[0] != contact.radii()[1] && contact.normal_mass() > 1e20,
    ];
    for is_faulty in faulty {
        let rule = from_fn(move |contact: &Contact| {
            let restitution = if is_faulty(contact) { -1.0 } else { 1.0 };
            Impulse::new(contact.normal_impulse(restitution), 0.0)
        });
        assert!(laws::check(&rule, &laws::Promises::new()).is_err());
    }
}

#[test]
fn tables_that_act_differently_have_different_fingerprints() {
    let smooth = |inelasticity| Smooth::from_inelasticity(inelasticity).unwrap();
    let plain = RulesByKind::new(smooth(0.0));
    let tables = [
        plain.clone(),
        plain.clone().with(GLASS, STEEL, smooth(0.1)),
        plain.clone().with(GLASS, GLASS, smooth(0.1)),
        plain.clone().with(GLASS, STEEL, smooth(0.2)),
        RulesByKind::new(smooth(0.1)),
    ];
    let prints: Vec<_> = tables.iter().map(|table| table.fingerprint().unwrap()).collect();
    for (k, print) in prints.iter().enumerate() {
        assert!(!prints[..k].contains(print));
    }
    assert_eq!(plain.with(STEEL, GLASS, smooth(0.1)).fingerprint(), Some(prints[1]));
    let nameless = RulesByKind::new(from_fn(|contact: &Contact| Elastic.impulse(contact)));
    assert_eq!(nameless.fingerprint(), None);
}

#[test]
fn rules_of_several_types_go_into_one_table() {
    let boxed: BoxedRule = Box::new(Elastic);
    let rules = RulesByKind::new(boxed).with(STEEL, STEEL, Box::new(Smooth::from_inelasticity(0.5).unwrap()));
    let ball = |x, velocity| {
        Disk::new(DVec2::new(x, 0.0), 0.5).unwrap().with_velocity(velocity).unwrap().with_kind(STEEL)
    };
    let after = collide(&rules, &ball(0.0, DVec2::X), &ball(1.0, -DVec2::X));
    assert_eq!(after.first.velocity(), DVec2::ZERO);
}

#[cfg(feature = "serde")]
#[test]
fn a_table_returns_from_a_file_and_a_pair_given_twice_does_not() {
    let text = serde_json::to_string(&table()).unwrap();
    assert_eq!(serde_json::from_str::<RulesByKind<Smooth>>(&text).unwrap(), table());
    let only = r#"{"otherwise":{"normal_inelasticity":0.25}}"#;
    let plain = RulesByKind::new(Smooth::from_inelasticity(0.25).unwrap());
    assert_eq!(serde_json::from_str::<RulesByKind<Smooth>>(only).unwrap(), plain);
    let pair = |kinds: &str| format!(r#"{{"kinds":{kinds},"rule":{{"normal_inelasticity":0.1}}}}"#);
    let twice = format!(
        r#"{{"otherwise":{{"normal_inelasticity":0.25}},"pairs":[{},{}]}}"#,
        pair("[1,2]"),
        pair("[2,1]")
    );
    let refused = serde_json::from_str::<RulesByKind<Smooth>>(&twice).unwrap_err().to_string();
    assert!(refused.starts_with("two rules for the kinds 1 and 2"), "{refused}");
    let outside = twice.replace("0.1", "0.9");
    assert!(serde_json::from_str::<RulesByKind<Smooth>>(&outside).is_err());
}
