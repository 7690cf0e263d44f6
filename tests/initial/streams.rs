//! Seeds: one seed for all parts of a run gives independent random numbers.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use granular_edmd::boundary::Thermal;
use granular_edmd::collision::{Contact, Impulse, from_fn};
use granular_edmd::initial::{self, Radii};
use granular_edmd::kinetic::{DirectSimulation, Maxwellian, MonteCarlo};
use granular_edmd::prelude::*;
use granular_edmd::random::{Stream, derived_seed, generator, uniform};
use granular_edmd::simulation::{Driving, Inlet, WhiteNoise};
use rand::Rng;

use super::disks;

/// Number of seeds, which count up from 0 as in real use.
const SEEDS: u64 = 1000;

/// The numbers are those of an independent program.
#[test]
fn streams_keep_their_bits() {
    let first = |seed, stream, index| generator(seed, stream, index).next_u64();
    let known: [(u64, u64); 10] = [
        (0x422c_8e96_dfc9_0169, 0x52a8_fb8f_e6b5_f5a4),
        (0x970e_d1d9_205b_5de1, 0xb8e6_8418_6d04_6498),
        (0x6016_5271_a586_ecde, 0x57ab_ec3e_ffd3_3d20),
        (0x217b_60d7_8ac0_74a6, 0xc87b_8ff7_fb29_2774),
        (0x7ce5_317f_d9cd_95c5, 0x2af4_5e48_b3b6_4817),
        (0xab16_73f9_38f3_e950, 0x88dc_5c33_acf4_04eb),
        (0x9342_37c7_950b_e416, 0x7eb6_07b5_08fd_5f3c),
        (0xdbe5_4235_18c8_9262, 0xbf92_8988_388f_acd6),
        (0xb54b_6f4e_d2d5_d1dc, 0xf5a0_2f8b_f503_25c9),
        (0xb7a5_b6ef_52ff_a729, 0x30b8_970a_68d2_3834),
    ];
    assert_eq!(Stream::ALL.len(), known.len());
    for (&stream, known) in Stream::ALL.iter().zip(known) {
        assert_eq!((first(1, stream, 0), first(2, stream, 7)), known, "{stream:?}");
    }
    assert_eq!(first(1, Stream::Custom(1), 0), 0x6d3e_d1f0_caae_f3be);
    assert_eq!(derived_seed(1, Stream::Custom(1), 0), 0xc8fa_c20d_9469_0212);
}

/// Returns numbers that follow from the first draws of the part with this stream.
fn first_draws(stream: Stream, seed: u64) -> Vec<f64> {
    let grain = Disk::new(DVec2::ZERO, 0.1).unwrap();
    let walls = Container::closed(20.0, 20.0).unwrap();
    let positions =
        |disks: Vec<Disk>| disks.iter().flat_map(|disk| disk.position().to_array()).collect::<Vec<_>>();
    let velocities = |disks: &[Disk]| disks.iter().flat_map(|disk| disk.velocity().to_array()).collect();
    let rule_calls = Mutex::new(Vec::new());
    let rule = from_fn(|contact: &Contact| {
        rule_calls.lock().unwrap().extend([contact.closing_speed(), contact.slip_speed()]);
        Impulse::new(2.0 * contact.normal_mass() * contact.closing_speed(), 0.0)
    });
    match stream {
        Stream::Places => positions(initial::scattered(&walls, 2, 0.1, 20.0, seed).unwrap()),
        Stream::Packing => positions(initial::packed_mix(&walls, vec![grain; 2], 20.0, seed).unwrap()),
        Stream::Velocities => {
            velocities(&initial::with_maxwellian_velocities(disks([0.5; 2]), 1.0, seed).unwrap())
        }
        Stream::Radii => Radii::uniform(1.0, 2.0).unwrap().draw(4, seed),
        Stream::Walls => {
            let walls = walls.with_temperature(Wall::Floor, Thermal::new(1.0).unwrap()).unwrap();
            let falling = Disk::new(DVec2::new(10.0, 1.0), 0.5).unwrap().with_velocity(DVec2::NEG_Y).unwrap();
            let mut run = Simulation::builder(Elastic, walls).disks([falling]).seed(seed).build().unwrap();
            run.step_until(1.0, &mut ()).unwrap();
            let disk = run.disks()[0];
            vec![disk.velocity().y, disk.velocity().x, disk.angular_velocity()]
        }
        Stream::Noise => {
            let mut kicked = disks([0.5; 30]);
            let mut noise = WhiteNoise::new(1.0, SampleTimes::every(1.0).unwrap(), seed).unwrap();
            noise.kick(&mut kicked).unwrap();
            velocities(&kicked[..2])
        }
        Stream::Inlets => {
            let models = disks((1..=100).map(|part| 0.001 * f64::from(part)));
            let places = [DVec2::ONE, DVec2::splat(19.0)];
            let times = SampleTimes::every(1.0).unwrap();
            let mut run = Simulation::builder(Elastic, walls).build().unwrap();
            run.add_inlet(Inlet::new(places, models, times, seed).unwrap()).unwrap();
            run.run_until(1.0, &mut ()).unwrap();
            let disk = run.disks()[0];
            vec![disk.radius(), disk.position().x, disk.position().y]
        }
        Stream::DirectSimulation => {
            let moving = initial::with_maxwellian_velocities(disks([0.5; 2]), 1.0, 1).unwrap();
            let mut gas = DirectSimulation::new(rule, moving, 0.1, seed).unwrap();
            gas.run_until(100.0).unwrap();
            rule_calls.lock().unwrap()[..2].to_vec()
        }
        Stream::MonteCarlo => {
            MonteCarlo::new(seed).with_samples(1).mean_energy_change(&rule, &Maxwellian::new(1.0).unwrap());
            // The middle stratum of the angle, where both speeds vary.
            rule_calls.lock().unwrap()[..4].to_vec()
        }
        Stream::Studies => {
            let mut random = generator(seed, stream, 0);
            (0..4).map(|_| uniform(&mut random)).collect()
        }
        other => panic!("add the first draws of {other:?}"),
    }
}

/// Returns the columns of numbers over all seeds with mean 0 and variance 1: the numbers, and their squares,
/// which show that a large number in one part goes with a special place in another.
fn columns(stream: Stream) -> Vec<Vec<f64>> {
    let rows: Vec<Vec<f64>> = (0..SEEDS).map(|seed| first_draws(stream, seed)).collect();
    let mean = |column: &[f64]| column.iter().sum::<f64>() / SEEDS as f64;
    let standard = |column: Vec<f64>| -> Vec<f64> {
        let middle = mean(&column);
        let squares: Vec<f64> = column.iter().map(|number| (number - middle) * (number - middle)).collect();
        let deviation = mean(&squares).sqrt();
        column.iter().map(|number| (number - middle) / deviation).collect()
    };
    let numbers: Vec<Vec<f64>> =
        (0..rows[0].len()).map(|draw| standard(rows.iter().map(|row| row[draw]).collect())).collect();
    let squares =
        numbers.iter().map(|column| standard(column.iter().map(|number| number * number).collect()));
    numbers.iter().cloned().chain(squares).collect()
}

#[test]
fn parts_with_one_seed_are_independent() {
    let all: Vec<(Stream, Vec<Vec<f64>>)> =
        Stream::ALL.iter().map(|&stream| (stream, columns(stream))).collect();
    for (index, (stream, columns)) in all.iter().enumerate() {
        for (other, others) in &all[..index] {
            for (one, two) in columns.iter().flat_map(|one| others.iter().map(move |two| (one, two))) {
                let correlation = one.iter().zip(two).map(|(a, b)| a * b).sum::<f64>() / SEEDS as f64;
                let error = (SEEDS as f64).sqrt().recip();
                assert!(correlation.abs() < 4.0 * error, "{stream:?} and {other:?}: {correlation}");
            }
        }
    }
}

/// Outside of checks and unit tests, no part makes a generator from a bare seed.
#[test]
fn every_seed_goes_through_a_stream() {
    fn files(folder: &Path) -> Vec<PathBuf> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for file in ["src", "study/src"].into_iter().flat_map(|folder| files(&root.join(folder))) {
        let text = fs::read_to_string(&file).unwrap();
        let code = text.split("mod tests").next().unwrap();
        let is_check = file.components().any(|part| part.as_os_str().to_string_lossy().starts_with("laws"));
        assert!(is_check || !code.contains("seed_from_u64"), "{}", file.display());
    }
}
