//! Each measure in each setting: right, compared with a value that is computed anew from everything that
//! happened in the run, or refused by name.

mod areas;
mod collisions;
mod histories;
mod log;
mod states;
mod systems;

use granular_edmd::ParameterError;
use systems::{Setting, settings};

/// The largest difference of a measure from its true values, or the reason why it refuses.
type Cell = Result<f64, String>;

/// A measure, a row of the table: its name, its tolerance, and its comparison in a setting.
struct Measure(&'static str, f64, fn(&Setting) -> Cell);

/// Tolerance of sums of the same terms in another order.
const ROUNDING: f64 = 1e-9;

/// Tolerance of areas that are counted on a grid of points.
const GRID: f64 = 3e-3;

/// Returns all measures, the rows of the table.
fn measures() -> Vec<Measure> {
    vec![
        Measure("`CenterOfMass`", ROUNDING, states::center_of_mass),
        Measure("`Energies`", ROUNDING, states::energies),
        Measure("`Temperatures`", ROUNDING, states::temperatures),
        Measure("`TemperaturesAboutFlow`", ROUNDING, states::temperatures_about_flow),
        Measure("`OfKind` of temperatures", ROUNDING, states::temperatures_of_a_kind),
        Measure("`OrderParameters`", ROUNDING, states::order_parameters),
        Measure("`HexaticOrder`", ROUNDING, states::hexatic_order),
        Measure("`Series` of the number of disks", ROUNDING, states::numbers_of_disks),
        Measure("`VelocityDistribution`", ROUNDING, states::velocity_distribution),
        Measure("`HeightProfile`", GRID, areas::height_profile),
        Measure("`Fields`", GRID, areas::fields),
        Measure("`PairCorrelation` in the bulk", ROUNDING, areas::pair_correlation),
        Measure("`Stress`", GRID, areas::stress),
        Measure("`WallStress`", ROUNDING, collisions::wall_stress),
        Measure("`Arrivals`", ROUNDING, collisions::arrivals),
        Measure("`Crossings`", ROUNDING, histories::crossings),
        Measure("`CollisionCounts`", ROUNDING, collisions::collision_counts),
        Measure("`CollisionHistograms`", ROUNDING, collisions::collision_histograms),
        Measure("`EnergyChange`", ROUNDING, collisions::energy_change),
        Measure("`BetweenKinds` of energy changes", ROUNDING, collisions::energy_change_between_kinds),
        Measure("`EnergyChangeProfile`", ROUNDING, collisions::energy_change_profile),
        Measure("`MeanSquaredDisplacement`", ROUNDING, histories::displacements),
        Measure("`TimeCorrelation` of velocities", ROUNDING, histories::correlations),
    ]
}

/// The cells that refuse: measure, setting, and words of the error. All others are right.
const REFUSED: [(&str, &str, &str); 2] = [
    ("`WallStress`", "periodic both ways", "number of walls named \"floor\" must be at least 1"),
    ("`Arrivals`", "periodic both ways", "number of walls named \"floor\" must be at least 1"),
];

/// Returns the largest relative difference of two lists of numbers; infinite if they cannot be compared.
fn far(measured: &[f64], truth: &[f64]) -> f64 {
    let difference = |(one, other): (&f64, &f64)| {
        if one.is_nan() && other.is_nan() { 0.0 } else { (one - other).abs() / other.abs().max(1e-3) }
    };
    let worst = measured.iter().zip(truth).map(difference);
    let worst = worst.fold(0.0, |worst: f64, one| if one > worst || one.is_nan() { one } else { worst });
    if measured.len() == truth.len() && !worst.is_nan() { worst } else { f64::INFINITY }
}

#[expect(clippy::needless_pass_by_value, reason = "it is what `map_err` and `err` give")]
fn told(error: ParameterError) -> String {
    error.to_string()
}

/// Compares a cell, and returns what the table shows of it.
fn cell(Measure(measure, tolerance, compare): &Measure, setting: &Setting) -> Result<&'static str, String> {
    let refusal = REFUSED.iter().find(|(row, column, _)| row == measure && *column == setting.name);
    match (compare(setting), refusal) {
        (Ok(difference), None) if difference <= *tolerance => Ok("right"),
        (Err(error), Some((.., words))) if error.contains(words) => Ok("refused"),
        (outcome, _) => Err(format!("{measure} in {}: {outcome:?}", setting.name)),
    }
}

#[test]
fn each_measure_is_right_in_each_setting_or_refuses_by_name() {
    let (settings, mut faults, mut refused) = (settings(), Vec::new(), 0);
    let names: Vec<&str> = settings.iter().map(|setting| setting.name).collect();
    let mut table = format!("| | {} |\n|{}\n", names.join(" | "), "---|".repeat(names.len() + 1));
    for measure in measures() {
        let cells = settings.iter().map(|setting| cell(&measure, setting));
        let cells: Vec<&str> = cells
            .map(|cell| {
                cell.unwrap_or_else(|fault| {
                    faults.push(fault);
                    "wrong"
                })
            })
            .collect();
        refused += cells.iter().filter(|&&cell| cell == "refused").count();
        table.extend(["| ", measure.0, " | ", &cells.join(" | "), " |\n"]);
    }
    support::table::table("measures in settings", &table);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    let all = measures().len() * settings.len();
    assert!(10 * refused <= all, "{refused} of {all} cells refuse");
    println!("{} cells are right, {refused} refuse", all - refused);
}
