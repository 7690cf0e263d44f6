//! Plans: as data and as text, with errors by name.

use granular_edmd::boundary::Container;
use granular_edmd::collision::Elastic;
use granular_edmd::simulation::Checkpoint;
use granular_edmd::{Simulation, initial};
use granular_edmd_study::vibrated_box::{Base, VibratedBox};
use granular_edmd_study::{Axis, Control, Course, Plan, Protocol, Ramp, Scalar, Study};
use proptest::prelude::*;
use serde::{Deserialize, Serialize};

use crate::support::{AnyError, BASE, Scratch, small_box};
use support::cases::config;
use support::report::report;

const PLAN: &str = r#"
seed = 1

[experiment]
disks = 30
width = 10.0
height = 30
gravity = 0.015625
friction = 0.01
base.bi_parabolic = { amplitude = 0.1, angular_frequency = 10.0 }

[protocol]
settle = 100
samples = 10
every = 10

[ramp]
parameter = "friction"
values = [0.01, 0.02]

[[sweep]]
parameter = "inelasticity"
values = [0.0, 0.01, 0.02]
"#;

/// A custom experiment can hold the state that its runs begin with.
#[test]
fn a_checkpoint_within_toml_is_exact() -> Result<(), AnyError> {
    #[derive(Serialize, Deserialize)]
    struct Held {
        states: Vec<Checkpoint>,
        last: Option<Checkpoint>,
    }
    let walls = Container::closed(12.0, 10.0)?;
    let disks = initial::with_maxwellian_velocities(initial::lattice(&walls, 20, 0.5)?, 1.0, 3)?;
    let mut run = Simulation::builder(Elastic, walls).disks(disks).gravity(0.05).seed(2).build()?;
    run.run_until(4.0, &mut ())?;
    let state = run.checkpoint();
    let text = toml::to_string(&Held { states: vec![state.clone(); 2], last: Some(state.clone()) })?;
    let held: Held = toml::from_str(&text)?;
    assert!(held.states.len() == 2 && held.last.is_some());
    assert!(held.states.iter().chain(&held.last).all(|read| *read == state));
    Ok(())
}

#[test]
fn a_plan_is_read_as_it_is_written() -> Result<(), AnyError> {
    let plan = Plan::<VibratedBox>::from_toml(PLAN)?;
    let by_hand = Plan::new(
        VibratedBox::new(30, 10.0, BASE).with_height(30.0).with_gravity(0.015_625).with_friction(0.01),
        Protocol::new(100, 10, 10)?,
        1,
    )?
    .with_ramp(Ramp::new("friction", vec![0.01, 0.02], Course::Up)?)?
    .with_axis(Axis::new("inelasticity", [0.0, 0.01, 0.02])?)?;
    assert_eq!(plan, by_hand);
    assert_eq!(Plan::<VibratedBox>::from_toml(&plan.to_string())?, plan);
    assert_eq!((plan.ramp_count(), plan.value_count()), (3, 2));
    Ok(())
}

/// A line of a plan, the line in its place, and the text of the error.
const REFUSED: [(&str, &str, &str); 24] = [
    ("seed = 1", "seed = 1\nsede = 2", "unknown field `sede`"),
    ("disks = 30", "disks = 30\nmass = 2", "unknown field `mass`"),
    ("disks = 30", "disks = 0", "number of disks must be at least 1, but is 0"),
    ("disks = 30", "disks = 300000", "there is room for"),
    ("disks = 30\nwidth = 10.0\nheight = 30", "disks = 9000000000000000000\nwidth = 10.0", "but is 9e18"),
    ("disks = 30", "", "missing field `disks`"),
    ("width = 10.0", "width = -10.0", "width must be finite and positive, but is -10"),
    ("height = 30", "height = inf", "height must be finite and positive, but is inf"),
    (
        "gravity = 0.015625",
        "gravity = nan",
        "gravity must be finite and at most 1e60 in magnitude, but is NaN",
    ),
    (
        "friction = 0.01",
        "dynamic_friction = 1.5",
        "dynamic friction must be at most the static friction, but is 1.5",
    ),
    ("friction = 0.01", "contact_duration = 0.0", "contact duration must be finite and positive, but is 0"),
    ("amplitude = 0.1", "amplitude = 0.0", "amplitude must be finite and positive, but is 0"),
    ("amplitude = 0.1", "amplitude = 0.1, phase = 2", "unexpected keys in table: phase"),
    ("bi_parabolic", "square", "unknown variant `square`"),
    ("samples = 10", "samples = 0", "number of samples must be in 1..=2^40, but is 0"),
    ("every = 10", "every = 10\nphase = 0.0", "phase of the samples must be in (0, 1], but is 0"),
    ("values = [0.01, 0.02]", "values = [0.02, 0.01]", "friction has 0.01 after 0.02"),
    ("values = [0.0, 0.01, 0.02]", "values = [0.7]", "normal inelasticity must be in [0, 0.5], but is 0.7"),
    ("values = [0.0, 0.01, 0.02]", "values = [0.01, 0.0, 0.01]", "inelasticity takes the value 0.01 twice"),
    ("values = [0.0, 0.01, 0.02]", "values = [0, 0.0]", "inelasticity takes the value 0.0 twice"),
    (
        "values = [0.0, 0.01, 0.02]",
        "values = { from = 0.1, to = 0.10000000000000002, step = 1e-18 }",
        "step must be above the rounding of the values, but is 1e-18",
    ),
    (
        "values = [0.0, 0.01, 0.02]",
        "values = { from = 0.1, to = 0.10000000000000002, log = 9 }",
        "number of values must be so small that neighbors differ, but is 9",
    ),
    (
        "values = [0.0, 0.01, 0.02]",
        "values = { from = 1e-300, to = 1e300, log = 3 }",
        "last value over the first one must be finite, but is inf",
    ),
    ("parameter = \"inelasticity\"", "parameter = \"friction\"", "friction varies twice"),
];

#[test]
fn plans_with_errors_are_refused_by_name() {
    for (line, instead, expected) in REFUSED {
        assert!(PLAN.contains(line));
        let error = report(&Plan::<VibratedBox>::from_toml(&PLAN.replacen(line, instead, 1)).unwrap_err());
        assert!(error.contains(expected), "{instead}: {error}");
    }
    let ramps = [
        ("friction", "width", "width cannot be ramped"),
        ("friction", "temperature", "there is no parameter `temperature`"),
        ("values = [0.01, 0.02]", "values = []", "friction has no values"),
        ("values = [0.01, 0.02]", "values = [0.01, inf]", "friction has a value that is not finite: inf"),
        (
            "values = [0.01, 0.02]",
            "values = [-1.0]",
            "static friction must be finite and not negative, but is -1",
        ),
    ];
    for (word, instead, expected) in ramps {
        let (head, tail) = PLAN.split_once("[ramp]").unwrap();
        let text = format!("{head}[ramp]{}", tail.replacen(word, instead, 1));
        let error = report(&Plan::<VibratedBox>::from_toml(&text).unwrap_err());
        assert!(error.contains(expected), "{instead}: {error}");
    }
}

/// A rule stands for a list, and the file keeps the rule.
#[test]
fn values_by_rule_are_values() -> Result<(), AnyError> {
    let (head, _) = PLAN.split_once("[ramp]").ok_or("no ramp")?;
    let rules = r#"
        [ramp]
        parameter = "friction"
        values = { from = 0.1, to = 0.4, step = 0.1 }
        [[sweep]]
        parameter = "gravity"
        values = { from = 0.01, to = 1.0, log = 3 }
        [[sweep]]
        parameter = "disks"
        values = { from = 10, to = 30, step = 10 }
    "#;
    let plan = Plan::<VibratedBox>::from_toml(&format!("{head}{rules}"))?;
    assert_eq!((plan.ramp_count(), plan.value_count()), (9, 4));
    assert_eq!(
        plan.parameters(4, 1),
        [("gravity", 0.1.into()), ("disks", 20.into()), ("friction", 0.2.into())]
    );
    assert_eq!((plan.experiment(8, 3)?.gravity, plan.experiment(8, 3)?.disks), (1.0, 30));
    assert_eq!(Plan::from_toml(&plan.to_toml()?)?, plan);
    assert!(plan.to_toml()?.contains("log = 3"), "{plan}");
    for (from, to, expected) in [
        ("to = 0.4", "to = -0.4", "last value must be at least the first one, but is -0.4"),
        ("step = 0.1", "step = 0.0", "step must be finite and positive, but is 0"),
        ("log = 3", "log = 1", "number of values must be at least 2, but is 1"),
        (
            "log = 3",
            "log = 3, step = 1",
            "number of `step` and `log` beside `from` and `to` must be 1, but is 2",
        ),
    ] {
        let text = format!("{head}{}", rules.replace(from, to));
        let error = report(&Plan::<VibratedBox>::from_toml(&text).unwrap_err());
        assert!(error.contains(expected), "{to}: {error}");
    }
    Ok(())
}

/// Equal ratios reach numbers of few digits: whole numbers stay whole, and decades are decades.
#[test]
fn equal_ratios_are_the_numbers_that_one_expects() -> Result<(), AnyError> {
    let (head, _) = PLAN.split_once("[ramp]").ok_or("no ramp")?;
    let plan = |parameter: &str, rule: &str| {
        let text = format!("{head}[[sweep]]\nparameter = \"{parameter}\"\nvalues = {{ {rule} }}\n");
        Plan::<VibratedBox>::from_toml(&text)
    };
    let frictions = |rule: &str| -> Result<Vec<f64>, AnyError> {
        let plan = plan("friction", rule)?;
        (0..plan.ramp_count()).map(|ramp| Ok(plan.experiment(ramp, 0)?.friction)).collect()
    };
    assert_eq!(frictions("from = 1e-3, to = 1.0, log = 4")?, [1e-3, 0.01, 0.1, 1.0]);
    let sixths = frictions("from = 1e-3, to = 1.0, log = 7")?;
    assert_eq!((sixths[2], sixths[4]), (0.01, 0.1));
    assert!((sixths[1] - 0.001 * 10_f64.sqrt()).abs() < 1e-15, "{sixths:?}");
    let close = frictions("from = 0.1, to = 0.1000000000001, log = 500")?;
    assert!(close.windows(2).all(|pair| pair[0] < pair[1]), "{close:?}");
    let many = plan("disks", "from = 1, to = 16, log = 5")?;
    let counts: Vec<_> =
        (0..5).map(|ramp| many.experiment(ramp, 0).map(|it| it.disks)).collect::<Result<_, _>>()?;
    assert_eq!(counts, [1, 2, 4, 8, 16]);
    Ok(())
}

/// Equal steps from decimal fractions are decimal fractions. Numbers that are none stay as they are.
#[test]
fn equal_steps_are_the_numbers_that_one_expects() -> Result<(), AnyError> {
    let (head, _) = PLAN.split_once("[ramp]").ok_or("no ramp")?;
    let values = |rule: &str| -> Result<Vec<f64>, AnyError> {
        let text = format!("{head}[[sweep]]\nparameter = \"gravity\"\nvalues = {rule}\n");
        let plan = Plan::<VibratedBox>::from_toml(&text)?;
        (0..plan.ramp_count()).map(|ramp| Ok(plan.experiment(ramp, 0)?.gravity)).collect()
    };
    assert_eq!(values("{ from = 0.005, to = 0.03, step = 0.005 }")?, [0.005, 0.01, 0.015, 0.02, 0.025, 0.03]);
    assert_eq!(values("{ from = 0.1, to = 0.7, step = 0.1 }")?, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]);
    let third = 0.333_333_333_333_333_3;
    assert_eq!(values("{ from = 0.3333333333333333, to = 0.6, step = 0.2 }")?, [third, third + 0.2]);
    let zero = values("{ from = -2.1, to = 0.0, step = 0.7 }")?[3];
    assert!(zero == 0.0 && zero.is_sign_positive(), "{zero}");
    Ok(())
}

/// Many values are loaded at once, by a rule or in a list: a quadratic comparison, or a look at each of them,
/// takes minutes.
#[test]
fn many_values_are_loaded_at_once() -> Result<(), AnyError> {
    let (head, _) = PLAN.split_once("[ramp]").ok_or("no ramp")?;
    let list: Vec<String> = (0..250_000).map(|value| format!("{}", f64::from(value) * 4e-6)).collect();
    for values in
        ["{ from = 0.0, to = 0.999996, step = 4e-6 }".to_owned(), format!("{list:?}").replace('"', "")]
    {
        let text = format!("{head}[[sweep]]\nparameter = \"friction\"\nvalues = {values}\n");
        let start = std::time::Instant::now();
        assert_eq!(Plan::<VibratedBox>::from_toml(&text)?.ramp_count(), 250_000);
        assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
    }
    Ok(())
}

/// Of many values, a plan tries some. The others are refused when their turn comes, with the same error.
#[test]
fn a_value_that_was_not_tried_is_refused_in_its_turn() -> Result<(), AnyError> {
    let mut values: Vec<Scalar> = (1..=3000).map(Scalar::from).collect();
    let with = |values: &[Scalar]| {
        let plan = Plan::new(VibratedBox::new(10, 10.0, BASE), Protocol::new(1, 1, 1)?, 1)?;
        plan.with_axis(Axis::new("disks", values.to_vec())?)
    };
    values[1701] = 1.5.into();
    let scratch = Scratch::new("untried");
    let study = Study::create(&scratch.0, &with(&values)?)?;
    assert!(study.run_ramp(3, &Control::default())?.is_complete());
    let error = report(&study.run_ramp(1701, &Control::default()).unwrap_err());
    assert!(error.contains("the experiment cannot be at disks = 1.5: invalid type"), "{error}");
    // The smallest and the largest one, and the ends, are always tried.
    for (index, bad) in [(1701, -1), (1701, i64::MAX), (0, -1), (2999, -1)] {
        let mut values: Vec<Scalar> = (1..=3000).map(Scalar::from).collect();
        values[index] = bad.into();
        let error = report(&with(&values).unwrap_err());
        assert!(error.contains(&format!("at disks = {bad}")), "{error}");
    }
    Ok(())
}

/// No measured column has the name of a parameter, so each parameter can vary.
/// Only the values that are run are checked, not the parameters that a ramp replaces.
#[test]
fn parameters_that_a_ramp_replaces_are_not_checked() -> Result<(), AnyError> {
    let plan = Plan::new(small_box(), Protocol::new(0, 1, 1)?, 1)?;
    let ramp = plan.with_ramp(Ramp::new("friction", [0.1, 0.2], Course::Up)?)?.to_toml()?;
    let text = ramp.replacen("[experiment]", "[experiment]\ndynamic_friction = 0.05", 1);
    Plan::<VibratedBox>::from_toml(&text)?;
    let error = report(&Plan::<VibratedBox>::from_toml(&text.replace("0.05", "0.15")).unwrap_err());
    assert!(
        error.contains("friction = 0.1: dynamic friction must be at most the static friction"),
        "{error}"
    );
    Ok(())
}

/// Disks that fall upwards would never come back.
#[test]
fn gravity_upwards_needs_a_lid() -> Result<(), AnyError> {
    let upwards = VibratedBox::new(10, 10.0, BASE).with_gravity(-1.0);
    let protocol = Protocol::new(0, 1, 1)?;
    let error = report(&Plan::new(upwards.clone(), protocol, 1).unwrap_err());
    assert!(error.contains("gravity of a box without a lid must be not negative, but is -1"), "{error}");
    Plan::new(upwards.with_height(20.0), protocol, 1)?;
    Ok(())
}

#[test]
fn every_parameter_of_the_box_can_be_swept() -> Result<(), AnyError> {
    let (head, _) = PLAN.split_once("[ramp]").ok_or("no ramp")?;
    let numbers = "width height gravity inelasticity tangential_inelasticity friction dynamic_friction \
                   wall_inelasticity base_inelasticity base_tangential_inelasticity wall_friction \
                   contact_duration initial_temperature amplitude angular_frequency";
    let numbers = numbers.split_whitespace().map(|name| (name, "[0.001, 0.002]"));
    let fits = |(name, values)| match name {
        "width" | "height" => (name, "[40, 50]"),
        _ => (name, values),
    };
    for (name, values) in
        numbers.map(fits).chain([("disks", "[1, 2]"), ("sides", r#"["elastic", "periodic"]"#)])
    {
        let text = format!("{head}[[sweep]]\nparameter = {name:?}\nvalues = {values}\n");
        Plan::<VibratedBox>::from_toml(&text)?;
    }
    let bed = VibratedBox::new(10, 10.0, Base::Thermal { temperature: 1.0, slip: false });
    let plan = Plan::new(bed, Protocol::new(1, 1, 1)?, 1)?;
    plan.with_axis(Axis::new("temperature", [1.0])?)?.with_axis(Axis::new("slip", [true])?)?;
    Ok(())
}

proptest! {
    #![proptest_config(config(64))]

    /// Every number survives the file, to the last bit.
    #[test]
    fn plans_survive_their_file(
        seed in 0..i64::MAX as u64,
        gravity in -1e3..1e3_f64,
        friction in prop::collection::btree_set(0_u64..1 << 52, 1..6),
        course in prop::sample::select(vec![Course::Up, Course::Down, Course::UpAndDown]),
        every in 1_u64..1000,
        phase in 1e-9..=1.0_f64,
    ) {
        let values: Vec<f64> = friction.into_iter().map(|bits| bits as f64 / 7e15).collect();
        let plan = Plan::new(
            small_box().with_gravity(gravity),
            Protocol::new(3, 5, every).unwrap().with_phase(phase).unwrap(),
            seed,
        )?
        .with_ramp(Ramp::new("friction", values, course).unwrap())?;
        prop_assert_eq!(Plan::<VibratedBox>::from_toml(&plan.to_toml()?)?, plan);
    }
}
