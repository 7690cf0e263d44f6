//! Every kind of value that is read from files, with one field too many. Each is refused by name.

use std::fmt::Debug;

use granular_edmd::analysis::Transition;
use granular_edmd::boundary::{Boundary, Brick, Container, Part, Thermal, Vessel, Wall};
use granular_edmd::collision::{
    ContactDuration, ElasticBelow, Frictional, LeastRebound, Rough, Smooth, SpeedDependent,
};
use granular_edmd::glam::DVec2;
use granular_edmd::kinetic::Maxwellian;
use granular_edmd::observable::{
    CenterOfMass, CollisionCounts, CollisionHistograms, Energies, EnergyChange, EnergyChangeProfile, Fields,
    Grid, HeightProfile, MeanSquaredDisplacement, Observer, OrderParameters, PairCorrelation, SampleTimes,
    Sampled, Series, Stress, Temperatures, TemperaturesAboutFlow, TimeCorrelation, Velocities,
    VelocityDistribution, WallStress,
};
use granular_edmd::simulation::Checkpoint;
use granular_edmd::statistics::BlockedMean;
use granular_edmd::study::vibrated_box::{Base, Measurement, Sample, VibratedBox};
use granular_edmd::study::{Axis, Course, Outcome, Plan, Protocol, Ramp};
use granular_edmd::wall::{
    BiParabolic, Delayed, Sawtooth, Scaled, Sinusoidal, Summed, Tabulated, Triangular,
};
use granular_edmd::{Disk, initial};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use crate::specimens::{checkpoint, container, done_study, plan, resume};

/// Adds a superfluous field to each object of a value, in turn.
fn with_intruders(value: &Value) -> Vec<Value> {
    match value {
        Value::Object(fields) => {
            let mut all = vec![value.clone()];
            all[0]["intruder"] = json!(1);
            for (name, field) in fields {
                all.extend(with_intruders(field).into_iter().map(|changed| {
                    let mut whole = value.clone();
                    whole[name] = changed;
                    whole
                }));
            }
            all
        }
        Value::Array(items) => {
            let changed = |(at, item)| {
                with_intruders(item).into_iter().map(move |changed| {
                    let mut whole = value.clone();
                    whole[at] = changed;
                    whole
                })
            };
            items.iter().enumerate().take(2).flat_map(changed).collect()
        }
        _ => Vec::new(),
    }
}

fn refuses<T: Serialize + DeserializeOwned + PartialEq + Debug>(sound: &T) {
    let value = serde_json::to_value(sound).unwrap();
    assert_eq!(&serde_json::from_value::<T>(value.clone()).unwrap(), sound);
    refuses_intruders::<T>(&value);
}

fn refuses_intruders<T: DeserializeOwned>(value: &Value) {
    let intruders = with_intruders(value);
    assert!(!intruders.is_empty(), "{value}");
    for changed in intruders {
        let error = serde_json::from_value::<T>(changed.clone()).err().map(|error| error.to_string());
        let error = error.unwrap_or_else(|| panic!("{changed}"));
        // A field beside the name of a choice is a second choice. A field beside the numbers of walls is not
        // a number.
        let reasons = ["intruder", "single key", "key to be a number"];
        assert!(reasons.iter().any(|reason| error.contains(reason)), "{error}: {changed}");
    }
}

#[test]
fn parameters_with_a_field_too_many_are_refused() {
    refuses(&Disk::new(DVec2::new(1.0, 2.0), 0.5).unwrap());
    refuses(&Smooth::from_inelasticity(0.1).unwrap());
    refuses(&Rough::from_inelasticity(0.1, 0.2).unwrap());
    refuses(&Frictional::from_inelasticity(0.1, 0.1, 0.2).unwrap());
    refuses(&ContactDuration::new(Frictional::from_inelasticity(0.1, 0.1, 0.2).unwrap(), 1e-3).unwrap());
    refuses(&ElasticBelow::new(Frictional::from_inelasticity(0.1, 0.1, 0.2).unwrap(), 1e-3).unwrap());
    refuses(&LeastRebound::new(Frictional::from_inelasticity(0.1, 0.1, 0.2).unwrap(), 1e-3).unwrap());
    refuses(&SpeedDependent::from_restitution(0.5, 1.0).unwrap());
    refuses(&BiParabolic::new(0.1, 3.0).unwrap());
    refuses(&Sinusoidal::new(0.1, 3.0).unwrap());
    refuses(&Triangular::new(0.1, 3.0).unwrap());
    refuses(&Sawtooth::new(0.1, 3.0).unwrap());
    refuses(&Tabulated::new([(0.0, 0.0), (1.0, 0.3)]).unwrap());
    refuses(&Thermal::new(2.0).unwrap());
    refuses(&Maxwellian::new(1.0).unwrap().with_rotational_temperature(0.5).unwrap());
}

#[test]
fn boundaries_with_a_field_too_many_are_refused() {
    let bricks = [
        Brick::segment(DVec2::ZERO, DVec2::ONE).unwrap(),
        Brick::half_line(DVec2::ZERO, DVec2::ONE).unwrap().two_sided(),
        Brick::circle(DVec2::ZERO, 2.0).unwrap().reversed(),
        Brick::arc(DVec2::ZERO, 2.0, 0.3, 1.9).unwrap(),
        Brick::point(DVec2::ONE).unwrap(),
    ];
    for brick in &bricks {
        refuses(brick);
    }
    let sine = Sinusoidal::new(0.1, 3.0).unwrap();
    let part = || Part::new(bricks).unwrap();
    let parts = [
        part().with_rule(Smooth::from_inelasticity(0.1).unwrap()),
        part().with_motion(DVec2::ONE, Sinusoidal::new(0.1, 3.0).unwrap()).unwrap(),
        part().with_rotation(DVec2::ONE, 0.3).unwrap().with_temperature(Thermal::new(2.0).unwrap()),
        part().with_rotation(DVec2::ONE, 0.3).unwrap().with_motion(DVec2::X, sine).unwrap(),
    ];
    let container =
        Container::open(10.0).unwrap().shaken_sideways(BiParabolic::new(0.1, 3.0).unwrap()).unwrap();
    let container = container.with_surface_speed(Wall::Left, 0.3).unwrap();
    let combined = Summed::new(Delayed::new(sine, 2.0).unwrap(), Scaled::new(sine, 2.0).unwrap()).unwrap();
    let container = container.with_motion(Wall::Floor, combined).unwrap();
    refuses_intruders::<Container>(&serde_json::to_value(&container).unwrap());
    for part in parts {
        refuses_intruders::<Part>(&serde_json::to_value(&part).unwrap());
        let vessel = Vessel::new(container.clone()).with("part", part).unwrap();
        refuses_intruders::<Vessel>(&serde_json::to_value(&vessel).unwrap());
    }
}

#[test]
fn what_was_measured_with_a_field_too_many_is_refused() {
    let run = resume(&checkpoint()).unwrap();
    refuses(&run.boundary().domain());
    refuses(&run.measure(&OrderParameters));
    refuses(&run.measure(&Energies));
    refuses(&run.measure(&Temperatures));
    let region = granular_edmd::boundary::Region::new(DVec2::ZERO, DVec2::ONE);
    let fields =
        Sampled::new(Fields::new(Grid::new(region, 1, 1).unwrap()), SampleTimes::every(1.0).unwrap());
    refuses(&fields.cell(0, 0).unwrap());
    let transition = json!({ "line": "ZeroOne", "value": 0.1, "error": 0.01, "rising": true });
    refuses(&serde_json::from_value::<Transition>(transition).unwrap());
}

#[test]
fn measurements_with_a_field_too_many_are_refused() {
    let mut run = resume(&checkpoint()).unwrap();
    let domain = run.boundary().domain();
    let times = SampleTimes::every(0.1).unwrap();
    let (low, high) =
        (DVec2::new(domain.left, domain.bottom), DVec2::new(domain.right, domain.top.min(10.0)));
    let region = granular_edmd::boundary::Region::new(low, high);
    let mut series = Series::new((CenterOfMass, Energies), times);
    let mut change = EnergyChange::default();
    let mut counts = CollisionCounts::default();
    let mut layers =
        Sampled::new(EnergyChangeProfile::new(0.0, 10.0, 1).unwrap(), times.starting_at(0.3).unwrap());
    let mut heights = Sampled::new(HeightProfile::new(0.0, 10.0, 2).unwrap(), times);
    let mut fields = Sampled::new(Fields::new(Grid::new(region, 1, 1).unwrap()), times);
    let grid = Grid::new(region, 2, 1).unwrap();
    let bulk = granular_edmd::boundary::Region::new(low + 2.0, high - 2.0);
    let mut pairs = Sampled::new(PairCorrelation::new(1.0, 2).unwrap().within(bulk).unwrap(), times);
    let mut displacement = MeanSquaredDisplacement::new(2, times).unwrap();
    let mut memory = TimeCorrelation::new(Velocities, 2, times).unwrap();
    let mut stress = Stress::new(times).within(region).unwrap();
    let mut walls = WallStress::new(times).with_wall(0, 10.0).unwrap();
    let mut velocities = Sampled::new(VelocityDistribution::new(3.0, 2).unwrap().about_flow(grid), times);
    let mut histograms = CollisionHistograms::new(3.0, 3.0, 2).unwrap();
    let end = run.time() + 5.0;
    let mut structure = (&mut pairs, &mut displacement, &mut memory, &mut velocities, &mut histograms);
    let mut all = (
        (&mut series, &mut change, (&mut counts, &mut layers), &mut heights, &mut fields),
        (&mut structure, &mut stress, &mut walls),
    );
    let all: &mut dyn Observer = &mut all;
    run.run_until(end, all).unwrap();
    assert!(change.disks().count() > 2);
    refuses(&times);
    refuses(&change);
    refuses(&counts);
    refuses(&layers);
    refuses(&heights);
    refuses(&fields);
    refuses(&grid);
    refuses(&TemperaturesAboutFlow::new(grid));
    refuses(&pairs);
    refuses(&displacement);
    refuses_intruders::<TimeCorrelation<Velocities>>(&serde_json::to_value(&memory).unwrap());
    refuses(&stress);
    refuses(&walls);
    refuses(&velocities);
    refuses(&histograms);
    refuses_intruders::<Series<(CenterOfMass, Energies)>>(&serde_json::to_value(&series).unwrap());
    let blocked = BlockedMean::from_iter([1.0, 2.0, 3.0]);
    refuses(&blocked);
    refuses(&blocked.ungrouped());
    refuses(&blocked.estimate());
}

#[test]
fn plans_and_records_with_a_field_too_many_are_refused() {
    refuses(&plan());
    refuses(&Ramp::new("friction", [0.1], Course::Down).unwrap());
    refuses(&Axis::new("friction", [0.1]).unwrap());
    for base in [
        Base::BiParabolic { amplitude: 0.1, angular_frequency: 1.0 },
        Base::Sinusoidal { amplitude: 0.1, angular_frequency: 1.0 },
        Base::Thermal { temperature: 1.0, slip: true },
    ] {
        let experiment = VibratedBox::new(3, 4.0, base).with_height(3.0).with_contact_duration(1e-3);
        refuses(&Plan::new(experiment, Protocol::new(2, 3, 1).unwrap(), 5).unwrap());
    }
    let (_scratch, study) = done_study("intruder", &plan());
    let record = study.record(0, 1).unwrap().unwrap();
    refuses::<Sample>(&record.samples()[0]);
    let mut measurement = serde_json::to_value(record.observer()).unwrap();
    measurement["intruder"] = json!(1);
    assert!(serde_json::from_value::<Measurement>(measurement).unwrap_err().to_string().contains("intruder"));
    refuses(&Outcome::Stopped { time: 1.0 });
    // A checkpoint is bytes in any format, so that nothing gets past its version and checksum.
    let mut state = serde_json::to_value(checkpoint()).unwrap();
    state.as_array_mut().unwrap().push(json!(1));
    let error = serde_json::from_value::<Checkpoint>(state).unwrap_err();
    assert!(error.to_string().contains("damaged"), "{error}");
}

/// The same holds in TOML, at each place of a plan.
#[test]
fn a_plan_in_toml_with_a_field_too_many_is_refused() {
    let text = plan().to_toml().unwrap();
    let lines: Vec<&str> = text.lines().collect();
    for at in 0..=lines.len() {
        let changed = [&lines[..at], &["intruder = 1"], &lines[at..]].concat().join("\n");
        let error = Plan::<VibratedBox>::from_toml(&changed).unwrap_err().to_string();
        assert!(error.contains("intruder"), "{error}");
    }
}

/// Deeply nested values are refused at once, and so is a plan that is too large.
#[test]
fn plans_that_are_too_deep_or_too_long_are_refused_at_once() {
    let text = plan().to_toml().unwrap();
    let deep = [text.as_str(), "\nsweep = ", &"[".repeat(100_000)].concat();
    assert!(Plan::<VibratedBox>::from_toml(&deep).is_err());
    let count = 1_000_001;
    let values: Vec<f64> = (0..count).map(f64::from).collect();
    let ramp = Ramp::new("gravity", values, Course::Up).unwrap();
    let error = plan().with_ramp(ramp).unwrap_err().to_string();
    assert!(error.contains("1000001"), "{error}");
    let values: Vec<f64> = (0..200_000).map(f64::from).collect();
    let ramp = Ramp::new("gravity", values, Course::UpAndDown).unwrap();
    assert_eq!(plan().with_ramp(ramp).unwrap().value_count(), 399_999, "in time that grows with it only");
    let crowd = initial::lattice(&container(), usize::MAX, 0.5).unwrap_err().to_string();
    assert!(crowd.contains("number of disks"), "{crowd}");
}
