//! Motions that combine: the contract, the equations of the documentation, and what constructors refuse.

use granular_edmd::ParameterError;
use granular_edmd::wall::laws::check;
use granular_edmd::wall::{
    Approach, BiParabolic, Combined, Fixed, Sawtooth, Sinusoidal, Tabulated, Triangular, WallMotion,
    check_finite, first_touch,
};
use proptest::prelude::*;
use support::cases::few;

fn sine(frequency: f64) -> Sinusoidal {
    Sinusoidal::new(0.1, frequency).unwrap()
}

fn gate() -> Tabulated {
    Tabulated::new([(0.5, 0.0), (1.0, 0.3), (1.1, 0.3), (3.0, -0.2), (3.3, -0.1), (4.0, 0.0)]).unwrap()
}

fn keeps_its_contract(motion: &impl WallMotion) {
    for (from, to) in [(-3.0, 12.0), (0.49, 0.51), (1e4, 1e4 + 2.0)] {
        assert_eq!(check(motion, from, to), Ok(()), "from {from} to {to}");
    }
    assert_eq!(check_finite(motion), Ok(()));
}

#[test]
fn all_keep_the_contract() {
    let arcs = BiParabolic::new(0.1, 7.0).unwrap();
    let saw = Sawtooth::new(0.1, 3.0).unwrap();
    for start in few([0.0, -2.7, 0.3, 5.0], 3) {
        keeps_its_contract(&Combined::new(sine(10.0)).delayed_until(start).unwrap());
        keeps_its_contract(&Combined::new(arcs).delayed_until(start).unwrap());
        keeps_its_contract(&Combined::new(saw).delayed_until(start).unwrap());
        keeps_its_contract(&Combined::new(gate()).delayed_until(start).unwrap());
        keeps_its_contract(&Combined::new(gate()).starting_at(start).unwrap());
        keeps_its_contract(&Combined::new(saw).starting_at(start).unwrap());
        keeps_its_contract(&Combined::new(Triangular::new(0.1, 3.0).unwrap()).delayed_until(start).unwrap());
    }
    for factor in [-1.0, 0.0, 1e-3, 2.5] {
        keeps_its_contract(&Combined::new(sine(10.0)).scaled(factor).unwrap());
        keeps_its_contract(&Combined::new(Triangular::new(0.1, 3.0).unwrap()).scaled(factor).unwrap());
        keeps_its_contract(&Combined::new(gate()).scaled(factor).unwrap());
    }
    keeps_its_contract(&Combined::new(sine(10.0)).plus(sine(20.0)).unwrap());
    keeps_its_contract(&Combined::new(sine(10.0)).plus(sine(7.3)).unwrap());
    keeps_its_contract(&Combined::new(arcs).plus(saw).unwrap());
    keeps_its_contract(&Combined::new(Combined::new(arcs).delayed_until(1.0).unwrap()).plus(gate()).unwrap());
    keeps_its_contract(&gate());
    keeps_its_contract(&Tabulated::from_to(-1.0, 2.0, 0.3).unwrap());
    keeps_its_contract(&Tabulated::from_to(0.5, 0.5, 0.3).unwrap());
}

/// A chain of methods gives the motion that combinations of combinations give.
#[test]
fn a_chain_moves_as_nested_combinations_do() {
    let table = || Combined::new(Tabulated::new([(-1.0, 0.0), (1.0, 1.0), (4.0, 0.5)]).unwrap());
    let nested = |motion: Combined| Combined::new(motion);
    for (first, second) in [(0.7, 1.9), (-2.0, 0.5), (3.0, -1.5)] {
        let pairs = [
            (table().delayed_until(first), nested(table().delayed_until(first).unwrap())),
            (table().starting_at(first), nested(table().starting_at(first).unwrap())),
        ];
        for (chain, nested) in pairs {
            let chain = chain.unwrap().delayed_until(second).unwrap().scaled(-2.0).unwrap();
            let nested = Combined::new(nested.delayed_until(second).unwrap()).scaled(-2.0).unwrap();
            for k in -400..800 {
                let (one, other) = (chain.state(0.01 * f64::from(k)), nested.state(0.01 * f64::from(k)));
                assert!((one.displacement - other.displacement).abs() < 1e-12, "{first} {second} {k}");
            }
        }
    }
}

/// Follows the pieces of a motion at constant speeds, and checks that each goes on as it begins.
fn goes_on_as_it_begins(motion: &impl WallMotion) {
    let mut phase = 0.0;
    for _ in 0..400 {
        let until = motion.acceleration(phase).until;
        assert!(until > phase, "{phase}");
        let (begin, middle) = (motion.state(phase), motion.state(0.5 * (phase + until)));
        let expected = begin.displacement + 0.5 * (until - phase) * begin.velocity;
        assert!((middle.displacement - expected).abs() < 1e-9, "{phase}: {middle:?}, not {expected}");
        phase = until;
    }
}

#[test]
fn late_kinks_and_jumps_are_where_pieces_end() {
    let triangular = |frequency| Triangular::new(0.3, frequency).unwrap();
    for k in 0..200 {
        let start = -5.0 + 0.173 * f64::from(k);
        let of = triangular(1.0 + 0.07 * f64::from(k));
        goes_on_as_it_begins(&Combined::new(of).starting_at(start).unwrap());
        goes_on_as_it_begins(&Combined::new(of).delayed_until(start).unwrap());
        // The pieces of both end at almost the same times.
        let both = Combined::new(of).plus(triangular(3.0 * of.angular_frequency())).unwrap();
        goes_on_as_it_begins(&Combined::new(both).delayed_until(start).unwrap());
        goes_on_as_it_begins(
            &Combined::new(Sawtooth::new(0.3, of.angular_frequency()).unwrap()).starting_at(start).unwrap(),
        );
    }
}

#[test]
fn a_disk_meets_a_late_wall_that_turns_at_once() {
    // Rounding has put the end of a fall before the rise that follows, and the search passed over the rise.
    let wall = Combined::new(Triangular::new(0.446_825_572_013_631_04, 4.063_886_831_113_892_5).unwrap())
        .starting_at(19.858_224_823_536_09);
    let wall = wall.unwrap();
    for k in 0..2000 {
        let (height, velocity) = (0.45 + 1e-4 * f64::from(k), -0.03 - 1e-4 * f64::from(k % 97));
        let approach = Approach::new(0.0, height, velocity, 0.0);
        let touch = first_touch(&wall, &approach, 20.0).touch().unwrap_or(20.0);
        let gap = |time: f64| height + velocity * time - wall.state(time).displacement;
        for step in 0..1000 {
            let time = touch * f64::from(step) / 1000.0;
            assert!(
                gap(time) > -1e-9,
                "{height} {velocity}: {} at {time}, first touch at {touch}",
                gap(time)
            );
        }
    }
}

#[test]
fn jumps_are_found_behind_starts_and_fast_oscillations() {
    let saw = Sawtooth::new(0.1, 3.0).unwrap();
    for k in 0..200 {
        let start = -3.0 + 0.171 * f64::from(k);
        assert!(
            Combined::new(Combined::new(saw).starting_at(start).unwrap()).scaled(-1.0).is_err(),
            "{start}"
        );
        assert!(
            Combined::new(Combined::new(saw).delayed_until(start).unwrap()).scaled(-1.0).is_err(),
            "{start}"
        );
    }
    let sum = Combined::new(sine(1e6)).plus(saw).unwrap();
    assert!(Combined::new(Combined::new(sum).delayed_until(50.0).unwrap()).scaled(-1.0).is_err());
    assert!(
        Combined::new(Combined::new(sine(10.0)).plus(Triangular::new(0.1, 3.0).unwrap()).unwrap())
            .scaled(-1.0)
            .is_ok()
    );
}

#[test]
fn a_sum_has_the_longer_period_if_the_shorter_one_divides_it() {
    let of = |motion: &dyn WallMotion| motion.period();
    let long = of(&sine(10.0));
    assert_eq!(of(&Combined::new(sine(10.0)).plus(sine(40.0)).unwrap()), long);
    assert_eq!(of(&Combined::new(sine(10.0)).plus(sine(10.0)).unwrap()), long);
    assert_eq!(of(&Combined::new(Fixed).plus(sine(10.0)).unwrap()), long);
    assert_eq!(of(&Combined::new(sine(10.0)).plus(sine(7.3)).unwrap()), None);
    assert_eq!(of(&Combined::new(sine(10.0)).plus(gate()).unwrap()), None);
    assert_eq!(of(&Combined::new(Fixed).plus(Fixed).unwrap()), None);
}

/// A delayed wall rests at the place at which its motion begins, at phase 0.
#[test]
fn a_delayed_wall_rests_where_it_begins() {
    let shifted = Tabulated::new([(-1.0, 0.0), (1.0, 1.0)]).unwrap();
    let late = Combined::new(shifted).delayed_until(4.0).unwrap();
    for (time, displacement, velocity) in
        [(-9.0, 0.5, 0.0), (3.999, 0.5, 0.0), (4.0, 0.5, 1.0), (5.0, 1.0, 0.0)]
    {
        let state = late.state(time);
        assert_eq!((state.displacement, state.velocity), (displacement, velocity), "{time}");
    }
}

/// A table of a smooth rise follows it to second order in the distance of rows, and a rest stays a rest.
#[test]
fn a_table_follows_what_it_was_made_of() {
    let errors = [8, 16, 32, 64].map(|rows: u32| {
        let row = |k: u32| f64::from(k) / f64::from(rows);
        let table = Tabulated::new((0..=rows).map(|k| (row(k), libm::exp(row(k))))).unwrap();
        let error = |k: u32| {
            (table.state(0.3 + 1e-3 * f64::from(k)).velocity - libm::exp(0.3 + 1e-3 * f64::from(k))).abs()
        };
        (0..400).map(error).fold(0.0, f64::max)
    });
    assert!(errors.windows(2).all(|pair| pair[1] < 0.3 * pair[0]), "{errors:?}");
    for time in [0.0, 0.5, 1.0, 1.04, 1.1, 4.0, 9.0] {
        assert_eq!(gate().state(time).velocity, 0.0, "{time}");
    }
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let told = |result: Result<(), ParameterError>| result.unwrap_err().to_string();
    let table = |rows: &[(f64, f64)]| told(Tabulated::new(rows.iter().copied()).map(drop));
    assert_eq!(table(&[]), "number of rows must be at least 2, but is 0");
    assert_eq!(table(&[(1.0, 2.0)]), "number of rows must be at least 2, but is 1");
    assert_eq!(table(&[(0.0, 0.0), (f64::NAN, 1.0)]), "time of row 1 must be finite, but is NaN");
    assert_eq!(
        table(&[(0.0, f64::INFINITY), (1.0, 1.0)]),
        "displacement of row 0 must be finite, but is inf"
    );
    let late = "time of row 1 must be later than 3 by more than rounding, but is ";
    assert_eq!(table(&[(3.0, 0.0), (2.0, 1.0)]), format!("{late}2"));
    assert_eq!(table(&[(3.0, 0.0), (3.0, 1.0)]), format!("{late}3"));
    assert!(table(&[(3.0, 0.0), (3f64.next_up(), 1.0)]).starts_with(late));
    let fast = "acceleration before row 1 must be finite, but is ";
    assert!(table(&[(0.0, 0.0), (1e-200, 1.0)]).starts_with(fast));
    assert!(table(&[(0.0, -1e308), (1.0, 1e308)]).starts_with(fast));
    assert_eq!(
        told(Tabulated::from_to(0.0, 1.0, 0.0).map(drop)),
        "duration must be finite and positive, but is 0"
    );
    let saw = Sawtooth::new(0.1, 3.0).unwrap();
    assert_eq!(
        told(Combined::new(saw).scaled(-2.0).map(drop)),
        "factor of a motion that jumps must be not negative, but is -2"
    );
    assert_eq!(
        told(Combined::new(Fixed).scaled(f64::NAN).map(drop)),
        "factor of a motion must be finite, but is NaN"
    );
    let far = || Tabulated::from_to(0.0, 1e300, 1e9).unwrap();
    let largest = "largest displacement of a motion must be finite, but is inf";
    assert_eq!(told(Combined::new(far()).scaled(1e9).map(drop)), largest);
    let huge = || Combined::new(far()).scaled(1e8).unwrap();
    assert_eq!(told(Combined::new(huge()).plus(huge()).map(drop)), largest);
    assert_eq!(
        told(Combined::new(Fixed).delayed_until(f64::INFINITY).map(drop)),
        "start of a motion must be finite, but is inf"
    );
}

proptest! {
    /// Any table keeps the contract, passes through its rows, and never turns between two of them.
    #[test]
    fn any_table_keeps_the_contract(steps in prop::collection::vec((1e-3..2.0f64, -1.0..1.0f64), 2..12)) {
        let mut time = -2.0;
        let rows: Vec<(f64, f64)> = steps.iter().map(|&(wait, place)| { time += wait; (time, place) }).collect();
        let table = Tabulated::new(rows.iter().copied()).unwrap();
        prop_assert_eq!(check(&table, -3.0, time + 1.0), Ok(()));
        for pair in rows.windows(2) {
            let ((from, low), (to, high)) = (pair[0], pair[1]);
            prop_assert_eq!(table.state(from).displacement, low);
            // A velocity that should be 0 has the rounding of those from which it is computed.
            let rounding = 1e-13 * (2.0 / 1e-3);
            for k in 0..=50 {
                let velocity = table.state(from + 0.02 * f64::from(k) * (to - from)).velocity;
                prop_assert!(velocity * (high - low).signum() >= -rounding, "{velocity} at {k}");
            }
        }
    }
}
