//! Tables: header and rows agree.

use crate::support::{done, small_plan};

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
    // Six samples tell no error: the last column names all that are lower bounds.
    assert_eq!(header.iter().next_back(), Some("not_converged"));
    let all = "one_roll one_roll_magnitude two_rolls height translational_energy rotational_energy \
               vertical_temperature energy_change";
    assert_eq!(values[7].iter().next_back(), Some(all));
    assert_eq!(rows("samples.csv").1.len(), 60);
    assert_eq!(rows("profiles.csv").1.len(), 300);
}
