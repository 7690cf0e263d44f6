//! Measures as tables: names, units, and numbers to the bit.

use granular_edmd::boundary::{Boundary, Container, Domain, Region};
use granular_edmd::collision::Elastic;
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{
    CenterOfMass, CollisionCounts, CollisionHistograms, Energies, EnergyChange, EnergyChangeProfile, Fields,
    Grid, Heading, HeightProfile, MeanSquaredDisplacement, Observable, Observer, OfKind, OrderParameters,
    PairCorrelation, SampleTimes, Sampled, Series, Snapshot, Stress, Table, Tabular, Temperatures,
    TimeCorrelation, Velocities, VelocityDistribution, WallStress, measured_by,
};
use granular_edmd::{Kind, Simulation, initial};

fn names(observable: &impl Tabular) -> Vec<String> {
    observable.headings().iter().map(|heading| heading.name().to_owned()).collect()
}

fn times() -> SampleTimes {
    SampleTimes::every(0.5).unwrap()
}

#[test]
fn every_observable_has_a_heading_for_each_number() {
    let domain = Container::closed(10.0, 10.0).unwrap().domain();
    let disks = initial::lattice(&Container::closed(10.0, 10.0).unwrap(), 9, 0.5).unwrap();
    let snapshot = Snapshot::new(0.0, &disks, domain, 1.0);
    let fastest = measured_by(|snapshot: &Snapshot<'_>| snapshot.disks().len() as f64).named("count", "1");
    let all = (
        OrderParameters,
        CenterOfMass,
        Energies,
        &Temperatures,
        OfKind::new(Kind::new(3), Energies),
        fastest,
    );
    let mut row = Vec::new();
    all.add_numbers(&all.measure(&snapshot), &mut row);
    assert_eq!(row.len(), all.headings().len());
    assert_eq!(row.last(), Some(&9.0));
    assert_eq!(names(&all)[2..5], ["center_x", "center_y", "translational_energy"]);
    assert_eq!(names(&all)[10], "translational_energy_of_kind_3");
    assert_eq!(all.headings()[0], Heading::new("one_roll", "length/time"));
}

/// Returns the numbers of a table in CSV, without its headings.
fn numbers(csv: &str) -> Vec<Vec<f64>> {
    csv.lines().skip(1).map(|row| row.split(',').map(|number| number.parse().unwrap()).collect()).collect()
}

#[test]
fn tables_read_back_to_the_same_bits() {
    let container = Container::closed(10.0, 10.0).unwrap();
    let disks = initial::lattice(&container, 20, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 7).unwrap();
    let mut run = Simulation::builder(Elastic, container).disks(disks).gravity(0.1).build().unwrap();
    let mut series = Series::new((CenterOfMass, Temperatures), times());
    run.run_until(5.0, &mut series).unwrap();

    let mut table = Vec::new();
    series.write_csv(&mut table).unwrap();
    let table = String::from_utf8(table).unwrap();
    assert_eq!(table.lines().next().unwrap().split(',').nth(2), Some("center_y [length]"));
    let rows = numbers(&table);
    assert_eq!(rows.len(), 10);
    for ((time, (center, temperature)), row) in series.iter().zip(rows) {
        assert_eq!(row[..3], [time, center.x, center.y]);
        assert_eq!(row[3..], [temperature.horizontal, temperature.vertical, temperature.rotational]);
    }
}

#[test]
fn names_that_make_no_table_are_refused() {
    fn refused(observable: impl Tabular) -> String {
        Series::new(observable, times()).write_csv(Vec::new()).unwrap_err().to_string()
    }
    assert_eq!(refused((CenterOfMass, CenterOfMass)), "two columns are named \"center_x\"");
    let number = || measured_by(|_: &Snapshot<'_>| 1.0);
    assert_eq!(refused(number().named("time", "1")), "two columns are named \"time\"");
    let plain = "the name of a column must be of letters, digits and underscores, but is \"a,b\"";
    assert_eq!(refused(number().named("a,b", "1")), plain);
    assert_eq!(
        refused(number().named("a", "\"")),
        "the unit of a column must be in plain words, but is \"\\\"\""
    );
}

/// An observable that breaks its promise is an error, and no row is written in the wrong columns.
#[test]
fn rows_have_a_number_for_each_heading() {
    struct Short;
    impl Observable for Short {
        type Value = f64;
        fn measure(&self, _: &Snapshot<'_>) -> f64 {
            1.0
        }
    }
    impl Tabular for Short {
        fn headings(&self) -> Vec<Heading> {
            vec![Heading::new("a", "1"), Heading::new("b", "1")]
        }
        fn add_numbers(&self, value: &f64, row: &mut Vec<f64>) {
            row.push(*value);
        }
    }
    let mut series = Series::new((Short, CenterOfMass), SampleTimes::every(1.0).unwrap());
    series.on_sample(&Snapshot::new(1.0, &[], Domain::new(0.0, 4.0, 0.0, 6.0), 1.0));
    let error = series.write_csv(Vec::new()).unwrap_err().to_string();
    assert_eq!(error, "a row has 4 numbers for 5 headings");
}

/// Counts the rows, and checks that each has a number for each heading and that the file holds them.
fn rows(table: &impl Table) -> usize {
    let columns = table.headings().len();
    assert!(table.rows().all(|row| row.len() == columns));
    let mut csv = Vec::new();
    table.write_csv(&mut csv).unwrap();
    let read = numbers(&String::from_utf8(csv).unwrap());
    let bits = |row: Vec<f64>| row.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    let count = read.len();
    assert!(read.into_iter().map(bits).eq(table.rows().map(bits)));
    count
}

#[test]
fn every_measure_is_a_table() {
    let container = Container::closed(10.0, 10.0).unwrap();
    let disks = initial::lattice(&container, 20, 0.5).unwrap();
    let disks = initial::with_maxwellian_velocities(disks, 1.0, 7).unwrap();
    let mut run = Simulation::builder(Elastic, container).disks(disks).build().unwrap();
    let grid = Grid::new(Region::new(DVec2::ZERO, DVec2::splat(10.0)), 4, 3).unwrap();
    let mut sampled = (
        Sampled::new(PairCorrelation::new(2.0, 5).unwrap(), times()),
        Sampled::new(HeightProfile::new(0.0, 10.0, 6).unwrap(), times()),
        Sampled::new(Fields::new(grid), times()),
        Sampled::new(VelocityDistribution::new(4.0, 7).unwrap(), times()),
        Sampled::new(EnergyChangeProfile::new(0.0, 10.0, 8).unwrap(), times()),
    );
    let mut clocked = (
        MeanSquaredDisplacement::new(9, times()).unwrap(),
        TimeCorrelation::new(Velocities, 10, times()).unwrap(),
        Stress::new(times()),
        WallStress::new(times()).with_wall("floor", 10.0).unwrap().with_wall("right", 10.0).unwrap(),
    );
    let mut heard = (
        EnergyChange::default(),
        CollisionCounts::default(),
        CollisionHistograms::new(4.0, 4.0, 12).unwrap(),
    );
    run.run_until(20.0, &mut (&mut sampled, &mut clocked.0, &mut clocked.1, &mut clocked.2, &mut heard))
        .unwrap();
    run.run_until(40.0, &mut clocked.3).unwrap();

    let (pairs, heights, fields, velocities, changes) = &sampled;
    assert_eq!([rows(&**pairs), rows(&**heights), rows(&**fields)], [5, 6, 12]);
    assert_eq!([rows(&**velocities), rows(&**changes)], [7, 8]);
    let (displacement, correlation, stress, walls) = &clocked;
    assert_eq!([rows(displacement), rows(correlation)], [10, 11]);
    assert_eq!([rows(stress), rows(walls)], [1, 2]);
    let (change, counts, histograms) = &heard;
    // Disks with disks, and with each of four walls.
    assert_eq!([rows(change), rows(counts), rows(histograms)], [5, 1, 12]);
    assert_eq!(stress.rows().next().unwrap()[0], stress.tensor().pressure.mean());
    assert_eq!(displacement.headings()[2], Heading::new("squared_displacement_error", "length^2"));
    assert_eq!(rows(velocities.speed()), 7);
}
