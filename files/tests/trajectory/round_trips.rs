//! Files read back to the same bits, and start the same run.

use std::f64::consts::PI;
use std::fs::File;
use std::io::BufReader;

use granular_edmd::boundary::{Container, Domain, Wall};
use granular_edmd::collision::{Elastic, Frictional};
use granular_edmd::glam::DVec2;
use granular_edmd::observable::{SampleTimes, Snapshot};
use granular_edmd::wall::BiParabolic;
use granular_edmd::{Disk, Simulation, initial};
use granular_edmd_files::{ExtendedXyz, Frame, FrameFormat, Gsd, LammpsDump, Reader, Recorder, State};

use crate::scratch::Scratch;
use crate::states::{assert_same_bits, for_each_snapshot, mixture};

fn text(format: &dyn FrameFormat, snapshot: &Snapshot<'_>) -> Vec<u8> {
    let mut text = Vec::new();
    format.write_frame(&Frame::new(0, snapshot), &mut text).unwrap();
    text
}

#[test]
fn extended_xyz_keeps_all_bits() {
    for_each_snapshot(|snapshot| {
        let state = Reader::new().read_from(text(&ExtendedXyz, snapshot).as_slice()).unwrap();
        assert_same_bits(state.disks(), snapshot.disks());
        assert_eq!(state, State::of(snapshot));
    });
}

#[test]
fn tables_keep_all_bits_of_disks() {
    for_each_snapshot(|snapshot| {
        let mut table = Vec::new();
        State::of(snapshot).write_csv(&mut table).unwrap();
        assert_same_bits(Reader::new().read_from(table.as_slice()).unwrap().disks(), snapshot.disks());
    });
}

/// The format has no place for angles, inertia factors, periodic directions and an open top. A mass is a
/// density there, which costs one rounding at most.
#[test]
fn data_of_lammps_keep_the_bits_that_they_have_a_place_for() {
    let mut missed = 0;
    for_each_snapshot(|snapshot| {
        let mut data = Vec::new();
        State::of(snapshot).write_lammps_data(&mut data).unwrap();
        let state = Reader::new().read_from(data.as_slice()).unwrap();
        assert_eq!(state.time(), Some(snapshot.time()));
        let domain = state.domain().unwrap();
        let Domain { left, right, bottom, top, .. } = snapshot.domain();
        assert_eq!((domain.left, domain.right, domain.bottom), (left, right, bottom));
        assert!(domain.top == top || top.is_infinite());
        let as_read = |(read, disk): (&Disk, &Disk)| {
            let mass = read.mass();
            assert!((mass / disk.mass() - 1.0).abs() < 3e-16, "{mass} {}", disk.mass());
            missed += usize::from(mass != disk.mass());
            let disk = disk.with_angle(0.0).unwrap().with_mass(mass).unwrap();
            disk.with_inertia_factor(0.5).unwrap()
        };
        let written: Vec<Disk> = state.disks().iter().zip(snapshot.disks()).map(as_read).collect();
        assert_same_bits(state.disks(), &written);
    });
    assert!(missed < 400, "{missed} of 800 masses differ by a rounding");
}

#[test]
fn a_run_starts_from_any_frame_as_if_it_had_not_stopped() {
    let scratch = Scratch::new("restart");
    let path = scratch.path("run.xyz");
    let mut run = mixture();
    let mut recorder = Recorder::create(&path, ExtendedXyz, SampleTimes::every(0.5).unwrap()).unwrap();
    run.run_until(4.0, &mut recorder).unwrap();
    let states: Vec<State> = Reader::new()
        .frames(BufReader::new(File::open(&path).unwrap()))
        .unwrap()
        .collect::<Result<_, _>>()
        .unwrap();
    assert_eq!(states.len(), 8);
    assert_same_bits(states[7].disks(), &run.disks());
    assert!(states[7].disks().iter().any(|disk| disk.image()[0] != 0), "no disk has passed the sides");
    // The run from a frame predicts anew, in another epoch, so it is the same to some digits, as long as
    // chaos allows.
    let base = BiParabolic::new(0.1, 10.0).unwrap();
    let container =
        Container::open(15.0).unwrap().with_periodic_sides().unwrap().with_motion(Wall::Floor, base).unwrap();
    let state = states[6].clone();
    let mut again = Simulation::builder(Frictional::from_inelasticity(0.02, 0.02, 0.2).unwrap(), container)
        .gravity(state.gravity().unwrap())
        .starting_at(state.time().unwrap())
        .disks(state.into_disks())
        .build()
        .unwrap();
    again.run_until(4.0, &mut ()).unwrap();
    for (again, run) in again.disks().iter().zip(run.disks()) {
        assert!(again.position().distance(run.position()) < 1e-9);
        assert!((again.angle() - run.angle()).abs() < 1e-9);
    }
}

/// Some programs begin a text with a byte order mark.
#[test]
fn a_byte_order_mark_is_no_text() {
    let disk = Disk::new(DVec2::new(1.0, 2.0), 0.5).unwrap();
    let xyz = "\u{feff}1\nProperties=pos:R:2:radius:R:1\n1 2 0.5\n";
    assert_eq!(Reader::new().read_from(xyz.as_bytes()).unwrap().disks(), [disk]);
    assert_eq!(Reader::new().read_from("\u{feff}x,y,radius\n1,2,0.5\n".as_bytes()).unwrap().disks(), [disk]);
    let lammps = "\u{feff}\n1 atoms\n0 9 xlo xhi\n0 9 ylo yhi\n\nAtoms\n\n1 1 1 1 1 2 0\n";
    assert_eq!(Reader::new().read_from(lammps.as_bytes()).unwrap().disks()[0].position(), disk.position());
    assert!(Reader::new().read_from("x,y,radius\n\u{feff}1,2,0.5\n".as_bytes()).is_err());
}

#[test]
fn files_of_others_are_read() {
    let ase = "2\r\nLattice=\"10 0 0 0 5 0 0 0 1\" Origin=\"-1 0 0\" Properties=species:S:1:pos:R:3:forces:R:3:radius:R:1 \
               title=\"Time=9 a word\" pbc=\"T T F\" energy=-3.5\r\n1 0.0 1.0 0.0 9 9 9 0.5\r\n0 4 1 0 9 9 9 0.25\r\n";
    let state = Reader::new().read_from(ase.as_bytes()).unwrap();
    assert_eq!((state.time(), state.gravity()), (None, None));
    let domain = Domain::new(-1.0, 9.0, 0.0, 5.0).with_periodic_sides().with_periodic_ends();
    assert_eq!(state.domain(), Some(domain));
    assert_eq!(state.disks()[0].kind().number(), 1);
    assert_eq!(state.disks()[1], Disk::new(DVec2::new(4.0, 1.0), 0.25).unwrap());
    // A file as `write_data` of LAMMPS writes it, with atoms in any order, and other sections.
    let lammps = "LAMMPS data file via write_data, version 22 Jul 2025, timestep = 100, units = lj\n\n2 atoms\n2 atom types\n\n\
                  -1 61 xlo xhi\n-1 151 ylo yhi\n-0.5 0.5 zlo zhi\n\nPair Coeffs # gran/hooke/history\n\n1\n2\n\n\
                  Atoms # sphere\n\n2 2 1 1.9 9 10 0 0 0 0\n1 1 1 1.9 5 10 0 0 0 0\n\nVelocities\n\n\
                  2 1 -2 0 0 0 0.5\n1 0 0 0 0 0 0\n";
    let state = Reader::new().read_from(lammps.as_bytes()).unwrap();
    let [second, first] = state.disks() else { panic!("{state:?}") };
    assert_eq!((first.position().x, second.position().x), (5.0, 9.0));
    assert_eq!((second.velocity(), second.angular_velocity()), (DVec2::new(1.0, -2.0), 0.5));
    assert_eq!((second.kind().number(), state.time()), (1, None));
}

/// A dump has no place for inertia factors, gravity and an open top, but for all else.
#[test]
fn dumps_are_read_back_to_the_same_bits() {
    for_each_snapshot(|snapshot| {
        let state = Reader::new().read_from(text(&LammpsDump, snapshot).as_slice()).unwrap();
        let disks = snapshot.disks().iter().zip(state.disks());
        let disks: Vec<Disk> =
            disks.map(|(disk, read)| disk.with_inertia_factor(read.inertia_factor()).unwrap()).collect();
        assert_same_bits(state.disks(), &disks);
        assert_eq!((state.time(), state.domain()), (Some(snapshot.time()), Some(snapshot.domain())));
        assert!(state.notes().is_empty(), "{:?}", state.notes());
    });
}

/// Single precision for the disks, double precision for time, gravity and the box.
#[test]
fn gsd_is_read_back_to_single_precision() {
    let scratch = Scratch::new("gsd-back");
    let (gsd, xyz) = (scratch.path("run.gsd"), scratch.path("run.xyz"));
    let times = SampleTimes::every(0.5).unwrap();
    let mut both =
        [Recorder::create(&gsd, Gsd, times).unwrap(), Recorder::create(&xyz, ExtendedXyz, times).unwrap()];
    let [one, other] = &mut both;
    mixture().run_until(6.0, &mut (one, other)).unwrap();
    for frame in 0..12 {
        let reader = Reader::new().with_frame(frame);
        let (read, exact) = (reader.read(&gsd).unwrap(), reader.read(&xyz).unwrap());
        assert_eq!(reader.read_from(std::fs::read(&gsd).unwrap().as_slice()).unwrap(), read);
        assert_eq!((read.time(), read.domain()), (exact.time(), exact.domain()));
        assert_eq!((read.gravity(), read.disks().len()), (exact.gravity(), 40));
        for (read, exact) in read.disks().iter().zip(exact.disks()) {
            let near = |read: f64, exact: f64, size: f64| {
                assert!((read - exact).abs() <= 2e-7 * size, "{read} {exact}");
            };
            near(read.position().distance(exact.position()), 0.0, 40.0);
            near(read.velocity().distance(exact.velocity()), 0.0, exact.velocity().length());
            near((0.5 * (read.angle() - exact.angle())).sin(), 0.0, 1.0);
            near(read.angular_velocity(), exact.angular_velocity(), 2.0 * exact.angular_velocity().abs());
            near(read.inertia_factor(), exact.inertia_factor(), 1.0);
            assert_eq!([read.radius(), read.mass()], [exact.radius(), exact.mass()]);
            assert_eq!((read.kind(), read.image(), read.id()), (exact.kind(), exact.image(), exact.id()));
        }
    }
}

/// Three numbers of single precision give an inertia factor a little beyond its limits.
#[test]
fn rings_and_heavy_points_come_back_from_gsd() {
    let (scratch, factors) = (Scratch::new("gsd-rings"), [1.0, 1e-6, Disk::HOMOGENEOUS_INERTIA_FACTOR]);
    let container = Container::closed(30.0, 30.0).unwrap();
    let disks = initial::lattice(&container, 99, 0.5).unwrap().into_iter().enumerate();
    let disks = disks.map(|(index, disk)| {
        let share = index as f64 / 99.0;
        let disk =
            Disk::new(disk.position(), 0.2 + 0.3 * share).unwrap().with_mass(0.1 + PI * share).unwrap();
        disk.with_inertia_factor(factors[index % 3]).unwrap()
    });
    let mut run = Simulation::builder(Elastic, container).disks(disks).build().unwrap();
    let path = scratch.path("run.gsd");
    run.run_until(1.0, &mut Recorder::create(&path, Gsd, SampleTimes::every(0.5).unwrap()).unwrap()).unwrap();
    let read = Reader::new().read(&path).unwrap();
    let read: Vec<f64> = read.disks().iter().map(Disk::inertia_factor).collect();
    assert_eq!(read, factors.repeat(33));
}

#[test]
fn a_dump_says_what_it_holds() {
    for_each_snapshot(|snapshot| {
        let text = String::from_utf8(text(&LammpsDump, snapshot)).unwrap();
        let rows = text.split_once("ITEM: ATOMS ").unwrap().1;
        let (names, rows) = rows.split_once('\n').unwrap();
        let names: Vec<&str> = names.split(' ').collect();
        assert_eq!(rows.lines().count(), snapshot.disks().len());
        for (row, disk) in rows.lines().zip(snapshot.disks()) {
            let cells: Vec<f64> = row.split(' ').map(|cell| cell.parse().unwrap()).collect();
            let cell = |name| cells[names.iter().position(|&other| other == name).unwrap()];
            let unwrapped = snapshot.domain().unwrapped(disk);
            assert_eq!(DVec2::new(cell("x"), cell("y")), disk.position());
            assert_eq!(DVec2::new(cell("xu"), cell("yu")), unwrapped);
            assert_eq!(DVec2::new(cell("vx"), cell("vy")), disk.velocity());
            assert_eq!([cell("angle"), cell("omegaz")], [disk.angle(), disk.angular_velocity()]);
            assert_eq!([cell("radius"), cell("mass")], [disk.radius(), disk.mass()]);
            assert_eq!(cell("type"), f64::from(disk.kind().number()) + 1.0);
            assert_eq!([cell("ix"), cell("iy")], disk.image().map(f64::from));
        }
    });
}
