//! Every kind of value that is read from files, with one field too many. Each is refused by name.

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
use granular_edmd::wall::{
    BiParabolic, Delayed, Sawtooth, Scaled, Sinusoidal, Summed, Tabulated, Triangular,
};
use granular_edmd::{Disk, initial};
use serde_json::json;

use crate::intruders::{refuses, refuses_intruders};
use crate::specimens::{checkpoint, container, resume};

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

/// A checkpoint is bytes in any format, so that nothing gets past its version and checksum.
#[test]
fn a_checkpoint_with_a_byte_too_many_is_refused() {
    let mut state = serde_json::to_value(checkpoint()).unwrap();
    state.as_array_mut().unwrap().push(json!(1));
    let error = serde_json::from_value::<Checkpoint>(state).unwrap_err();
    assert!(error.to_string().contains("damaged"), "{error}");
}

#[test]
fn too_many_disks_are_refused_at_once() {
    let crowd = initial::lattice(&container(), usize::MAX, 0.5).unwrap_err().to_string();
    assert!(crowd.contains("number of disks"), "{crowd}");
}
