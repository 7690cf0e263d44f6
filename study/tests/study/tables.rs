//! Tables: header and rows agree with each other and with the library.

use std::collections::BTreeMap;
use std::path::Path;

use granular_edmd::statistics::Estimate;
use granular_edmd_study::vibrated_box::{Base, Sample, VibratedBox};
use granular_edmd_study::{Axis, Control, Course, Plan, Protocol, Ramp, Study, Width};

use crate::logs;
use crate::processes;
use crate::support::{AnyError, Scratch, done, small_plan};

/// The rows of a table, each by the names of its columns.
fn table(folder: &Path, name: &str) -> Result<Vec<BTreeMap<String, String>>, csv::Error> {
    csv::Reader::from_path(folder.join(name))?.into_deserialize().collect()
}

#[test]
fn tables_have_a_row_for_each_thing() {
    let (scratch, _) = done(&small_plan(), "tables");
    let rows = |name: &str| {
        let mut reader = csv::Reader::from_path(scratch.0.join(name)).unwrap();
        let header = reader.headers().unwrap().clone();
        (header, reader.records().map(Result::unwrap).collect::<Vec<_>>())
    };
    let (header, values) = rows("values.csv");
    assert_eq!(values.len(), 10);
    assert_eq!(
        header.iter().take(5).collect::<Vec<_>>(),
        ["ramp", "value", "leg", "inelasticity", "friction"]
    );
    assert_eq!(values[7].iter().take(5).collect::<Vec<_>>(), ["1", "2", "up", "0.02", "0.3"]);
    // Six samples are too few for an error, so the last column names all errors that are lower bounds.
    assert_eq!(header.iter().next_back(), Some("not_converged"));
    let all = "one_roll one_roll_magnitude two_rolls center_of_mass_height translational_energy rotational_energy \
               vertical_temperature energy_change";
    assert_eq!(values[7].iter().next_back(), Some(all));
    assert_eq!(rows("samples.csv").1.len(), 60);
    assert_eq!(rows("profiles.csv").1.len(), 300);
}

/// Each column of each table has a meaning, also one of a parameter that varies under a short name.
#[test]
fn columns_are_told_with_their_meanings() -> Result<(), AnyError> {
    let base = Base::Sinusoidal { amplitude: 0.1, angular_frequency: 10.0 };
    let experiment = VibratedBox::new(20, 10.0, base).with_height(20.0).with_gravity(0.02);
    let ramp = Ramp::new("amplitude", [0.1, 0.2], Course::Up)?.with_refinement(Width::Absolute(0.05))?;
    let plan = Plan::new(experiment, Protocol::new(2, 2, 2)?, 1)?.with_ramp(ramp)?;
    let plan = plan.with_axis(Axis::new("friction", [0.1])?)?.with_repeats(2)?;
    let (scratch, _) = done(&plan, "meanings");
    let rows = table(&scratch.0, "columns.csv")?;
    for row in &rows {
        assert!(row["meaning"].ends_with('.'), "{row:?}");
    }
    let meaning = |table: &str, column: &str| {
        let row = rows.iter().find(|row| row["table"] == table && row["column"] == column);
        row.map(|row| row["meaning"].clone()).unwrap_or_default()
    };
    assert_eq!(meaning("values", "amplitude"), "Amplitude of the base, in diameters.");
    assert_eq!(meaning("points", "one_roll_error"), "Standard error of the mean of one_roll.");
    assert!(meaning("transitions", "amplitude_near").starts_with("Value of amplitude on the near side"));
    assert!(meaning("values", "seed").starts_with("Seed of the ramp"));
    Ok(())
}

#[test]
fn repeats_have_seeds_of_their_own_and_are_told_together() -> Result<(), AnyError> {
    let (scratch, study) = done(&processes::plan(1), "repeats");
    let points: Vec<_> = study.points().collect::<Result<_, _>>()?;
    let rows = table(&scratch.0, "points.csv")?;
    assert_eq!((points.len(), rows.len()), (3, 3));
    for (point, row) in points.iter().zip(&rows) {
        let [first, second] = point.records() else { panic!("two repeats") };
        assert_eq!(first.experiment(), second.experiment());
        assert_ne!(first.samples(), second.samples());
        let height = point.mean(|sample| sample.height);
        assert_eq!(point.estimate("center_of_mass_height"), Some(height));
        let heights = [first, second].map(|record| record.mean(|sample| sample.height));
        assert_eq!(Estimate::over_repeats(heights), height);
        assert!((height.mean() - 0.5 * (heights[0].mean() + heights[1].mean())).abs() < 1e-12);
        let scatter = 0.5 * (heights[0].mean() - heights[1].mean()).abs();
        assert!(height.standard_error() >= scatter * (1.0 - 1e-12), "{height} {scatter}");
        let told = [height.mean(), height.standard_error(), height.independent_samples()];
        let cells = [
            "center_of_mass_height",
            "center_of_mass_height_error",
            "center_of_mass_height_independent_samples",
        ]
        .map(|name| row[name].parse::<f64>());
        assert_eq!(cells.map(Result::unwrap), told);
        assert_eq!((row["repeats"].as_str(), height.samples()), ("2", 12));
        assert_eq!(
            row["not_converged"].split(' ').any(|name| name == "center_of_mass_height"),
            !height.is_converged()
        );
    }
    assert_eq!(points[0].estimate("max_overlap"), None, "a number without an error");
    Ok(())
}

/// Samples and repeats without collisions have no energy change, and one alone has no error.
#[test]
fn an_energy_change_comes_from_collisions() -> Result<(), AnyError> {
    let base = Base::Thermal { temperature: 2.0, slip: false };
    let experiment =
        VibratedBox::new(2, 8.0, base).with_height(9.0).with_gravity(0.05).with_inelasticity(0.1);
    let plan = Plan::new(experiment, Protocol::new(0, 3, 3)?, 9)?.with_repeats(6)?;
    let (scratch, study) = done(&plan, "few-collisions");
    for row in table(&scratch.0, "samples.csv")? {
        assert_eq!(row["collisions"] == "0", row["energy_change"].is_empty(), "{row:?}");
    }
    let (mut means, mut lone) = (Vec::new(), 0);
    for (row, record) in table(&scratch.0, "values.csv")?.iter().zip(study.records()) {
        let collided = record?.samples().iter().filter(|sample| sample.collisions > 0).count();
        assert_eq!(collided == 0, row["energy_change"].is_empty(), "{row:?}");
        assert_eq!(collided < 2, row["energy_change_error"].is_empty(), "{row:?}");
        lone += usize::from(collided == 1);
        means.extend(row["energy_change"].parse::<f64>());
    }
    assert!(lone > 0 && means.len() < 6, "{means:?}");
    let together: f64 = table(&scratch.0, "points.csv")?[0]["energy_change"].parse()?;
    assert!(together <= means.iter().fold(-1.0, |a: f64, b| a.max(*b)), "{together} {means:?}");
    Ok(())
}

/// Tables of an unfinished study never mix the repeats of one point with those of another.
#[test]
fn tables_of_a_study_half_done_keep_points_apart() -> Result<(), AnyError> {
    let scratch = Scratch::new("half-done-points");
    let study = Study::create(&scratch.0, &processes::plan(1))?;
    for ramp in [0, 3, 5] {
        study.run_ramp(ramp, &Control::default())?;
    }
    assert_eq!(study.write_tables()?, 3);
    let rows = table(&scratch.0, "points.csv")?;
    let height = |sample: &Sample| sample.height;
    for (row, ramp) in rows.iter().zip([0, 3, 5]) {
        let record = study.record(ramp, 0)?.ok_or("no record")?;
        assert_eq!((row["point"].clone(), row["repeats"].as_str()), ((ramp / 2).to_string(), "1"));
        assert_eq!(row["center_of_mass_height"].parse::<f64>()?, record.mean(height).mean());
    }
    drop(study);
    logs::forget(&scratch.0, 0, 0);
    assert_eq!(Study::<VibratedBox>::open(&scratch.0)?.points().count(), 2);
    Ok(())
}
