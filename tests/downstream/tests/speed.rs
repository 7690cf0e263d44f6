//! Measures the cost of your own rule: a rule that is 5 % slower is told from one that is 1 % slower.
//!
//! Times depend on the machine, so this runs only when asked for:
//! `cargo test --release --test speed -- --ignored --nocapture`.

use std::hint::black_box;

use granular_edmd::collision::{CollisionRule, Contact, Impulse};
use granular_edmd::speed::{self, Comparison, Finding};

/// A rule that does useless work in each collision.
#[derive(Debug, Clone, Copy)]
struct Slower<R> {
    rule: R,
    turns: u32,
}

impl<R: CollisionRule> CollisionRule for Slower<R> {
    fn impulse(&self, contact: &Contact) -> Impulse {
        for turn in 0..self.turns {
            black_box(turn);
        }
        self.rule.impulse(contact)
    }
}

#[test]
#[ignore = "a measurement of times"]
fn five_percent_are_told_from_one() {
    let run = speed::dense().unwrap();
    let with = |turns| run.clone().with_rule(Slower { rule: *run.rule(), turns });
    let stretch = |turns| {
        let run = with(turns);
        move || speed::measure(&run, 10_000, &mut ())
    };
    let compared = |turns| Comparison::between(stretch(0), stretch(turns)).unwrap();
    // The processor does the first turns beside other work, so the cost of a turn is none at first.
    let turns_for = |share: f64| {
        let (mut few, mut many) = (0, 1024);
        while many - few > 4 {
            let middle = u32::midpoint(few, many);
            let is_slow = compared(middle).ratio().median > 1.0 + share;
            (few, many) = if is_slow { (few, middle) } else { (middle, many) };
        }
        many
    };
    let [none, one, five] = [0, turns_for(0.01), turns_for(0.05)].map(|turns| {
        let comparison = compared(turns);
        println!("{turns} turns:\n{comparison}\n");
        comparison
    });
    assert_eq!(five.finding(), Finding::Slower);
    assert!(one.interval()[1] < five.interval()[0]);
    assert!(none.interval()[1] < five.interval()[0]);
}
