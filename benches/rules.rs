//! The impulse of each collision rule.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use granular_edmd::collision::{
    CollisionRule, Contact, ContactDuration, Elastic, Friction, Frictional, Impulse, Rough, Smooth, from_fn,
};

const CONTACTS: usize = 1024;

/// Returns slow and fast, grazing and central contacts, among which sticking and sliding alternate at random.
fn contacts() -> Vec<Contact> {
    let speeds = (0..CONTACTS).map(|k| (1.0 + (k * 37 % 101) as f64, (k * 53 % 211) as f64 - 105.0));
    speeds.map(|(closing, slip)| Contact::new(0.02 * closing, 0.02 * slip, 0.5, 0.5 / 3.0)).collect()
}

/// Returns a rule as a user would write it: restitution that falls with the speed of the impact, over the
/// library's friction.
fn speed_dependent() -> impl CollisionRule {
    let friction = Friction::from_inelasticity(0.05, 0.1).expect("valid");
    from_fn(move |contact: &Contact| -> Impulse {
        let restitution = 1.0 / (1.0 + 0.05 * contact.closing_speed().sqrt());
        friction.impulse(contact, contact.normal_impulse(restitution))
    })
}

fn impulses(criterion: &mut Criterion) {
    let frictional = Frictional::from_inelasticity(0.05, 0.05, 0.1).expect("valid");
    let rules: [(&str, Box<dyn CollisionRule>); 6] = [
        ("elastic", Box::new(Elastic)),
        ("smooth", Box::new(Smooth::from_inelasticity(0.05).expect("valid"))),
        ("rough", Box::new(Rough::from_inelasticity(0.05, 0.1).expect("valid"))),
        ("frictional", Box::new(frictional)),
        ("speed_dependent", Box::new(speed_dependent())),
        ("contact_duration", Box::new(ContactDuration::new(frictional, 1e-5).expect("valid"))),
    ];
    let contacts = contacts();
    let mut group = criterion.benchmark_group("impulse");
    group.throughput(Throughput::Elements(CONTACTS as u64));
    for (name, rule) in &rules {
        let sum = || contacts.iter().map(|contact| rule.impulse(black_box(contact)).normal()).sum::<f64>();
        group.bench_function(*name, |bencher| bencher.iter(sum));
    }
    group.finish();
}

criterion_group!(benches, impulses);
criterion_main!(benches);
