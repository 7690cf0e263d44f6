//! Height profiles and fields of known states.

use std::f64::consts::PI;

use granular_edmd::boundary::{Boundary, Container, Domain, Region};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    Accumulator, DenseLayer, Fields, Grid, HeightProfile, Observer, SampleTimes, Sampled, Snapshot,
};
use granular_edmd::{Disk, ParameterError, Simulation, initial};

const DOMAIN: Domain = Domain::new(0.0, 60.0, 0.0, 150.0);

fn times() -> Result<SampleTimes, ParameterError> {
    SampleTimes::every(1.0)
}

fn disk(x: f64, y: f64) -> Result<Disk, ParameterError> {
    Disk::new(DVec2::new(x, y), 0.5)
}

fn gas() -> Result<Vec<Disk>, Box<dyn std::error::Error>> {
    let disks = initial::lattice(&Container::closed(60.0, 150.0)?, 1000, 0.5)?;
    Ok(initial::with_maxwellian_velocities(disks, 1.0, 1)?)
}

#[test]
fn a_profile_holds_the_area_of_all_disks() -> Result<(), Box<dyn std::error::Error>> {
    for bins in [1, 7, 150, 4000] {
        let mut profile = Sampled::new(HeightProfile::new(0.0, 150.0, bins)?, times()?);
        for time in 1..4 {
            profile.on_sample(&Snapshot::new(f64::from(time), &gas()?, DOMAIN, 0.0));
        }
        let area: f64 = profile.iter().map(|(_, packing)| packing * 60.0 * 150.0 / bins as f64).sum();
        assert!((area / (1000.0 * PI / 4.0) - 1.0).abs() < 1e-12, "{bins} bins: {area}");
        assert_eq!((profile.samples(), profile.next_sample()), (3, 4.0));
    }
    Ok(())
}

#[test]
fn a_disk_across_a_periodic_end_is_on_both_sides() -> Result<(), ParameterError> {
    let mut profile = Sampled::new(HeightProfile::new(0.0, 10.0, 10)?, times()?);
    let domain = Container::periodic(4.0, 10.0)?.domain();
    profile.on_sample(&Snapshot::new(1.0, &[disk(1.0, 0.0)?, disk(3.0, 9.75)?], domain, 0.0));
    let values: Vec<f64> = profile.iter().map(|(_, packing)| packing).collect();
    assert!((values.iter().sum::<f64>() - PI / 8.0).abs() < 1e-15, "{values:?}");
    assert!(values[0] > PI / 32.0 && values[9] > PI / 32.0, "{values:?}");
    Ok(())
}

#[test]
fn what_is_outside_a_profile_is_left_out() -> Result<(), ParameterError> {
    let mut profile = Sampled::new(HeightProfile::new(10.0, 20.0, 10)?, times()?);
    let disks = [disk(5.0, 10.0)?, disk(5.0, 20.0)?, disk(5.0, 1e30)?, disk(5.0, -1e30)?, disk(5.0, 9.4)?];
    profile.on_sample(&Snapshot::new(1.0, &disks, DOMAIN, 0.0));
    let values: Vec<f64> = profile.iter().map(|(_, packing)| packing).collect();
    let half = PI / 8.0 / 60.0;
    assert!((values[0] - half).abs() < 1e-15 && (values[9] - half).abs() < 1e-15);
    assert!(values[1..9].iter().all(|&packing| packing == 0.0));
    Ok(())
}

/// Two disks over bins of a quarter of their radius, against their chords.
#[test]
fn a_disk_is_cut_at_the_edges_of_bins() -> Result<(), ParameterError> {
    let mut profile = Sampled::new(HeightProfile::new(2.0, 6.0, 32)?, times()?);
    let disks = [disk(5.0, 4.1)?, disk(7.0, 2.05)?];
    for time in [1.0, 2.0] {
        profile.on_sample(&Snapshot::new(time, &disks, DOMAIN, 0.0));
    }
    let chord = |away: f64| 2.0 * (0.25 - away * away).max(0.0).sqrt();
    for (height, packing) in profile.iter() {
        let slices = (0..1000).map(|k| height + 0.125 * ((f64::from(k) + 0.5) / 1000.0 - 0.5));
        let mean: f64 = slices.map(|y| chord(y - 4.1) + chord(y - 2.05)).sum::<f64>() / 1000.0 / 60.0;
        // The slices resolve the ends of a disk to a thousandth of the square root there.
        assert!((packing - mean).abs() < 1e-7, "{height}: {packing} {mean}");
    }
    assert!(profile.iter().map(|(height, _)| height).eq((0..32).map(|k| 2.0625 + 0.125 * f64::from(k))));
    Ok(())
}

#[test]
fn the_densest_layer_is_the_lowest_of_equals() {
    let layer = |profile: &[(f64, f64)]| DenseLayer::among(profile.iter().copied());
    let expected = DenseLayer::new(1.5, 0.5, 0.2);
    assert_eq!(layer(&[(0.5, 0.2), (1.5, 0.5), (2.5, 0.1), (3.5, 0.5)]), Some(expected));
    assert_eq!(layer(&[]), None);
}

#[test]
fn a_layer_on_a_gas_is_found() -> Result<(), ParameterError> {
    let mut profile = Sampled::new(HeightProfile::new(0.0, 30.0, 30)?, times()?);
    assert_eq!(profile.densest_layer(), None);
    let rows = (0..3).flat_map(|row| (0..60).map(move |column| (column, row)));
    let mut disks = rows
        .map(|(column, row)| disk(f64::from(column) + 0.5, 15.5 + f64::from(row)))
        .collect::<Result<Vec<_>, _>>()?;
    disks.push(disk(30.0, 2.5)?);
    profile.on_sample(&Snapshot::new(1.0, &disks, DOMAIN, 0.0));
    let layer = profile.densest_layer().unwrap();
    assert!((15.0..18.0).contains(&layer.height));
    assert!((layer.packing_fraction - PI / 4.0).abs() < 1e-12 && layer.least_below == 0.0);
    Ok(())
}

#[test]
fn a_sediment_has_nothing_below() -> Result<(), ParameterError> {
    let mut profile = Sampled::new(HeightProfile::new(0.0, 30.0, 30)?, times()?);
    let disks = (0..60).map(|column| disk(f64::from(column) + 0.5, 0.5)).collect::<Result<Vec<_>, _>>()?;
    profile.on_sample(&Snapshot::new(1.0, &disks, DOMAIN, 0.0));
    let layer = profile.densest_layer().unwrap();
    assert_eq!(layer.least_below, layer.packing_fraction);
    Ok(())
}

#[test]
fn a_swirl_is_flow_and_not_temperature() -> Result<(), Box<dyn std::error::Error>> {
    // The state is uniform in each cell: two disks with u + c and u - c, spins w + d and w - d.
    let region = Region::new(DVec2::ZERO, DVec2::new(60.0, 150.0));
    let mut fields = Sampled::new(Fields::new(Grid::new(region, 6, 5)?), times()?);
    let flow = |column: i32, row: i32| DVec2::new(f64::from(row) - 2.0, 2.5 - f64::from(column)) * 1e3;
    let mut disks = Vec::new();
    for (column, row) in (0..6).flat_map(|column| (0..5).map(move |row| (column, row))) {
        let corner = DVec2::new(10.0 * f64::from(column), 30.0 * f64::from(row));
        for sign in [-1.0, 1.0] {
            let at = Disk::new(corner + DVec2::new(5.0 + 2.0 * sign, 15.0), 0.5)?;
            let velocity = flow(column, row) + sign * DVec2::new(0.5, 1.0);
            disks.push(at.with_velocity(velocity)?.with_angular_velocity(100.0 + 2.0 * sign)?);
        }
    }
    fields.on_sample(&Snapshot::new(1.0, &disks, DOMAIN, 0.0));
    fields.on_sample(&Snapshot::new(2.0, &disks, DOMAIN, 0.0));
    for (column, row) in (0..6).flat_map(|column| (0..5).map(move |row| (column, row))) {
        let cell = fields.cell(column as usize, row as usize).unwrap();
        assert_eq!((cell.count, cell.number_density), (4, 2.0 / 300.0));
        assert!((cell.packing_fraction - 2.0 * PI / 4.0 / 300.0).abs() < 1e-15);
        assert!((cell.velocity - flow(column, row)).length() < 1e-9);
        assert!((cell.translational_temperature - 0.625).abs() < 1e-9, "{cell:?}");
        assert!((cell.angular_velocity - 100.0).abs() < 1e-9);
        assert!((cell.rotational_temperature - 0.125 * 4.0).abs() < 1e-9);
        assert_eq!(cell.center, DVec2::new(10.0 * f64::from(column) + 5.0, 30.0 * f64::from(row) + 15.0));
    }
    assert_eq!((fields.iter().count(), fields.samples()), (30, 2));
    Ok(())
}

/// Three disks of different masses in one cell of a grid away from the origin, and what is on its edges.
#[test]
fn a_mixture_has_the_flow_and_the_temperatures_of_its_masses() -> Result<(), ParameterError> {
    let region = Region::new(DVec2::new(10.0, 20.0), DVec2::new(16.0, 24.0));
    let mut fields = Sampled::new(Fields::new(Grid::new(region, 3, 1)?), times()?);
    let kind = |x: f64, mass: f64, factor: f64, vx: f64, vy: f64, spin: f64| {
        let disk =
            Disk::new(DVec2::new(x, 20.5), 0.25 * mass)?.with_mass(mass)?.with_inertia_factor(factor)?;
        disk.with_velocity(DVec2::new(vx, vy))?.with_angular_velocity(spin)
    };
    let own = [
        kind(12.5, 1.0, 1.0, 1.0, 3.0, 2.0)?,
        kind(13.0, 2.0, 0.5, -1.0, 0.0, -1.0)?,
        kind(12.1, 4.0, 0.25, 0.5, -2.0, 5.0)?,
    ];
    let edges =
        [(10.0, 20.0), (16.0, 20.0), (15.0, 24.0), (9.9, 21.0), (15.0, 19.9)].map(|(x, y)| disk(x, y));
    let disks = edges.into_iter().chain(own.map(Ok)).collect::<Result<Vec<_>, _>>()?;
    fields.on_sample(&Snapshot::new(1.0, &disks, DOMAIN, 0.0));
    assert_eq!(fields.next_sample(), 2.0);
    assert_eq!(fields.iter().map(|cell| cell.count).collect::<Vec<_>>(), [1, 3, 0]);
    let cell = fields.cell(1, 0).unwrap();
    assert_eq!(cell.center, DVec2::new(13.0, 22.0));
    let sum = |quantity: &dyn Fn(&Disk) -> f64| own.iter().map(quantity).sum::<f64>();
    let flow = own.iter().map(|disk| disk.mass() * disk.velocity()).sum::<DVec2>() / 7.0;
    let inertia = sum(&Disk::moment_of_inertia);
    let spin = sum(&|disk| disk.moment_of_inertia() * disk.angular_velocity()) / inertia;
    let translational = sum(&|disk| disk.mass() * (disk.velocity() - flow).length_squared()) / 6.0;
    let rotational = sum(&|disk| disk.moment_of_inertia() * (disk.angular_velocity() - spin).powi(2)) / 3.0;
    assert!((cell.velocity - flow).length() < 1e-14 && (cell.angular_velocity - spin).abs() < 1e-14);
    assert!((cell.translational_temperature - translational).abs() < 1e-13);
    assert!((cell.rotational_temperature - rotational).abs() < 1e-13);
    assert_eq!(cell.number_density, 3.0 / 8.0);
    assert!((cell.packing_fraction - PI * 21.0 / 16.0 / 8.0).abs() < 1e-14);
    Ok(())
}

/// Rounding would make some temperatures negative, and a file of them could not be read.
#[test]
fn a_disk_alone_has_no_negative_temperature() -> Result<(), Box<dyn std::error::Error>> {
    for k in 1..2000_u32 {
        let mut fields = Fields::new(Grid::new(Region::new(DVec2::ZERO, DVec2::splat(10.0)), 1, 1)?);
        let (mass, angle) = (0.3 + 0.0013 * f64::from(k), f64::from(k));
        let velocity = DVec2::new(libm::sin(angle), libm::cos(2.0 * angle));
        let disk = disk(5.0, 5.0)?.with_mass(mass)?.with_velocity(velocity)?.with_angular_velocity(angle)?;
        fields.add(&Snapshot::new(1.0, &[disk], DOMAIN, 0.0)).unwrap();
        let cell = fields.cell(0, 0).ok_or("no cell")?;
        assert!(cell.translational_temperature >= 0.0 && cell.rotational_temperature >= 0.0, "{cell:?}");
    }
    Ok(())
}

#[test]
fn a_gas_at_rest_has_its_temperature_and_no_flow() -> Result<(), Box<dyn std::error::Error>> {
    let region = Region::new(DVec2::ZERO, DVec2::new(60.0, 150.0));
    let mut fields = Sampled::new(Fields::new(Grid::new(region, 1, 1)?), times()?);
    let disks = initial::without_drift(gas()?)?;
    fields.on_sample(&Snapshot::new(1.0, &disks, DOMAIN, 0.0));
    let cell = fields.cell(0, 0).unwrap();
    let energy: f64 = disks.iter().map(Disk::translational_energy).sum::<f64>() / 1000.0;
    assert!(cell.velocity.length() < 1e-12 && (cell.translational_temperature - energy).abs() < 1e-12);
    assert!(fields.cell(1, 0).is_none() && fields.cell(0, 1).is_none());
    Ok(())
}

/// A disk exactly on the right side of a periodic box is in the first column, too.
#[test]
fn a_disk_on_a_seam_is_in_one_cell() -> Result<(), Box<dyn std::error::Error>> {
    let container = Container::periodic(10.0, 10.0)?;
    let disks = [2.0, 4.0, 6.0, 8.0, 10.0].map(|place| disk(place, place));
    let disks = disks.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut run = Simulation::builder(Elastic, container).disks(disks).build()?;
    let region = Region::new(DVec2::ZERO, DVec2::splat(10.0));
    let mut fields = Sampled::new(Fields::new(Grid::new(region, 5, 5)?), times()?);
    run.run_until(5.0, &mut fields)?;
    let counts: Vec<u64> = (0..5).filter_map(|index| Some(fields.cell(index, index)?.count)).collect();
    assert!(counts[0] > 0 && counts.iter().all(|&count| count == counts[0]), "{counts:?}");
    Ok(())
}

#[test]
fn grids_without_extent_are_refused() {
    let region = |x: f64, y: f64| Region::new(DVec2::ZERO, DVec2::new(x, y));
    for (x, y, columns, rows) in [
        (0.0, 1.0, 1, 1),
        (-1.0, -1.0, 1, 1),
        (f64::INFINITY, 1.0, 1, 1),
        (f64::NAN, 1.0, 1, 1),
        (1.0, 1.0, 0, 1),
        (1.0, 1.0, usize::MAX, 2),
        (1e-300, 1e-300, 1, 1),
    ] {
        assert!(Grid::new(region(x, y), columns, rows).is_err(), "{x} {y} {columns} {rows}");
    }
    assert!(HeightProfile::new(1.0, 1.0, 1).is_err());
    assert!(HeightProfile::new(0.0, f64::INFINITY, 1).is_err());
    assert!(HeightProfile::new(0.0, 1.0, 0).is_err());
    assert!(HeightProfile::new(-f64::MAX, f64::MAX, 1).is_err());
}

/// Two ways lead to the mean energy change: over all collisions, and layer by layer. At rest in the mean, the
/// layers have the temperature with which the disks started.
#[test]
fn energy_change_by_height_sums_up_to_that_of_all_collisions() -> Result<(), Box<dyn std::error::Error>> {
    use granular_edmd::kinetic::{Maxwellian, mean_energy_change};
    use granular_edmd::observable::{EnergyChange, EnergyChangeProfile};
    use granular_edmd::prelude::*;
    use granular_edmd::statistics::BlockedMean;

    let rule = Frictional::from_inelasticity(0.001, 0.001, 0.02)?;
    let container =
        Container::closed(100.0, 100.0)?.with_rule(Wall::Floor, Elastic)?.with_rule(Wall::Lid, Elastic)?;
    let container = container.with_rule(Wall::Left, Elastic)?.with_rule(Wall::Right, Elastic)?;
    let disks = initial::scattered(&container, 1000, 0.5, 100.0, 5)?;
    let disks = initial::with_maxwellian_velocities(disks, 2.0, 6)?;
    let mut simulation = Simulation::builder(rule, container).disks(disks).build()?;
    let mut all = EnergyChange::default();
    let mut profile = Sampled::new(EnergyChangeProfile::new(0.0, 100.0, 4)?, SampleTimes::every(0.5)?);
    simulation.run_until(20.0, &mut (&mut all, &mut profile))?;

    let layers = profile.layers().iter().map(|layer| &layer.energy_change);
    assert_eq!(layers.clone().map(BlockedMean::count).sum::<u64>(), all.disks().count());
    let sum: f64 = layers.map(BlockedMean::sum).sum();
    assert!((sum - all.disks().sum()).abs() < 1e-10 * sum.abs());

    // There are some ten collisions per disk, and each pair loses 4 % of T, so the gas cools by a fifth
    // underway. The standard error of 5000 collisions is 1.5 %, and the bound is five of them.
    let ratio = profile.rotational_ratio().unwrap();
    let expected = mean_energy_change(&rule, &Maxwellian::new(1.0)?.with_rotational_temperature(ratio)?);
    let measured = profile.relative_energy_change().unwrap();
    assert!((measured / expected - 1.0).abs() < 0.08, "{measured} {expected}");
    Ok(())
}

/// A profile that reaches beyond a periodic domain holds each disk once.
#[test]
fn a_profile_beyond_a_periodic_end_holds_no_image() -> Result<(), Box<dyn std::error::Error>> {
    let disk = |y: f64| Disk::new(DVec2::new(5.0, y), 0.4);
    let disks = vec![disk(9.0)?, disk(1.5)?];
    let run = Simulation::builder(Elastic, Container::periodic(10.0, 10.0)?).disks(disks).build()?;
    let area = 0.16 * PI;
    for ((bottom, top), inside, height) in [
        ((-10.0, 20.0), 2.0, 10.0),
        ((8.0, 20.0), 1.0, 2.0),
        ((-2.5, 2.5), 1.0, 2.5),
        ((0.0, 10.0), 2.0, 10.0),
    ] {
        let mut profile = HeightProfile::new(bottom, top, 1)?;
        profile.add(&run.snapshot()).unwrap();
        let (_, fraction) = profile.iter().next().ok_or("no bin")?;
        let expected = inside * area / (10.0 * height);
        assert!((fraction - expected).abs() < 1e-12, "{bottom} to {top}: {fraction}, not {expected}");
    }
    Ok(())
}
