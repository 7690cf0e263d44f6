//! Series as tables: names, units, and numbers to the bit.

use granular_edmd::boundary::{Boundary, Container, Domain};
use granular_edmd::collision::Elastic;
use granular_edmd::observable::{
    CenterOfMass, Energies, Heading, Observable, Observer, OfKind, OrderParameters, SampleTimes, Series,
    Snapshot, Tabular, Temperatures, from_fn,
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
    let fastest = from_fn(|snapshot: &Snapshot<'_>| snapshot.disks().len() as f64).named("count", "1");
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
    let mut table = csv::Reader::from_reader(table.as_slice());
    assert_eq!(table.headers().unwrap().get(2), Some("center_y [length]"));
    let rows: Vec<Vec<f64>> = table.deserialize().collect::<Result<_, _>>().unwrap();
    let mut lines = Vec::new();
    series.write_json_lines(&mut lines).unwrap();
    let lines = String::from_utf8(lines).unwrap();
    assert_eq!((rows.len(), lines.lines().count()), (10, 10));
    for (((time, (center, temperature)), row), line) in series.iter().zip(rows).zip(lines.lines()) {
        assert_eq!(row[..3], [time, center.x, center.y]);
        assert_eq!(row[3..], [temperature.horizontal, temperature.vertical, temperature.rotational]);
        let line: serde_json::Value = serde_json::from_str(line).unwrap();
        assert_eq!(line["vertical_temperature [energy]"], temperature.vertical);
        assert_eq!(line["time [time]"], time);
    }
}

#[test]
fn names_that_make_no_table_are_refused() {
    fn refused(observable: impl Tabular) -> String {
        Series::new(observable, times()).write_csv(Vec::new()).unwrap_err().to_string()
    }
    assert_eq!(refused((CenterOfMass, CenterOfMass)), "two columns are named \"center_x\"");
    let number = || from_fn(|_: &Snapshot<'_>| 1.0);
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
    assert_eq!(series.write_json_lines(Vec::new()).unwrap_err().to_string(), error);
}
