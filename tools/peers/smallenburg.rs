//! The event-driven codes for spheres of Frank Smallenburg (Eur. Phys. J. E **45**, 22 (2022)) as another
//! program.
//!
//! Settings are constants in the code, so each choice of settings is compiled from a changed copy. The
//! spheres lie in a plane, in one layer of cells, and have no velocity out of it. The third coordinate stays
//! in the arithmetic.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use granular_edmd::Disk;

use super::measured::{Measured, Speed, Start};
use benches::Outcome;

/// The flags of the makefiles.
const FLAGS: [&str; 3] = ["-Ofast", "-funroll-loops", "-march=native"];

/// Temperature in the plane: the code gives its spheres a mean square velocity of 3.
const TEMPERATURE: f64 = 1.5;

/// A variant of the code.
struct Variant {
    name: &'static str,
    file: &'static str,
    /// Changes of its text in addition to [`CHANGES`].
    changes: &'static [(&'static str, &'static str)],
    /// The lengths that are tried.
    lengths: &'static [f64],
}

/// Changes of all variants, for spheres in a plane, settings from outside, and the processor time in the
/// reports.
const CHANGES: [(&str, &str); 8] = [
    ("double writeinterval = 1;", "double writeinterval = INTERVAL;"),
    ("double eventlisttimemultiplier = 1;", "double eventlisttimemultiplier = LIST;"),
    ("double maxscheduletime = 1.0;", "double maxscheduletime = SPAN;"),
    ("p->vz = imsq * random_gaussian();", "p->vz = 0;"),
    ("while (cx*cy*cz > 8*N)", "while (cx*cy > 8*N)"),
    ("cz *= 0.9;", ""),
    ("cellz == 0 || ", "cellz < 0 || "),
    ("simtime, colcounter, pressnow, temperature", "simtime, colcounter, pressnow, 1e-6 * clock()"),
];

/// The variants: without neighbor lists, and with lists and a single event for each sphere. The third one,
/// with lists and many events, is slower than the second one.
const VARIANTS: [Variant; 2] = [
    Variant {
        name: "Cell",
        file: "mdCell.c",
        changes: &[
            ("double maxtime = 10;", "double maxtime = 2.000001 * INTERVAL;"),
            ("#define MAXCEL 75", "#define MAXCEL (COLUMNS)"),
            ("celllist[MAXCEL][MAXCEL][MAXCEL]", "celllist[MAXCEL][MAXCEL][1]"),
            ("cx = (int)(xsize - 0.0001) ;", "cx = (xsize - 0.0001) / LENGTH;"),
            ("cy = (int)(ysize - 0.0001) ;", "cy = (ysize - 0.0001) / LENGTH;"),
            ("cz = (int)(zsize - 0.0001) ;", "cz = 1;"),
            ("|| p->cellz == cz - 1", ""),
            ("|| part->cellz == cz - 1", ""),
            ("for ( dz = -1; dz < 2; dz++)", "for (dz = 0; dz < 1; dz++)"),
            ("for ( dz = cellz-1; dz < cellz+2; dz++)", "for (dz = cellz; dz < cellz + 1; dz++)"),
            ("int zmin = cellz-1;", "int zmin = cellz;"),
            ("int zmax = cellz+1;", "int zmax = cellz;"),
        ],
        lengths: &[1.0, 1.25, 1.5, 2.0, 2.5],
    },
    Variant {
        name: "Single",
        file: "mdSingle.c",
        changes: &[
            ("double maxtime = 100;", "double maxtime = 2.000001 * INTERVAL;"),
            ("const int usethermostat = 1;", "const int usethermostat = 0;"),
            ("#define MAXNEIGH 24", "#define MAXNEIGH NEIGHBORS"),
            ("const double shellsize = 1.5;", "const double shellsize = LENGTH;"),
            ("cz = (int)(zsize - 0.0001) / shellsize;", "cz = 1;"),
            ("|| cellz == cz - 1", ""),
            ("for (cdz = cellz - 1; cdz < cellz + 2; cdz++)", "for (cdz = cellz; cdz < cellz + 1; cdz++)"),
        ],
        lengths: &[1.2, 1.35, 1.5, 2.0, 3.0],
    },
];

impl Variant {
    /// Returns the code with the changes.
    fn source(&self, folder: &Path) -> Outcome<String> {
        let file = folder.join(self.name).join(self.file);
        let mut source = fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
        for (from, to) in CHANGES.iter().chain(self.changes) {
            if !source.contains(from) {
                return Err(format!("{} is another version: it has no “{from}”", file.display()).into());
            }
            source = source.replace(from, to);
        }
        Ok(source)
    }
}

/// The settings that are left to users.
#[derive(Clone, Copy)]
struct Settings {
    variant: &'static Variant,
    /// Size of the cells, or radius of the neighbor lists, in diameters.
    length: f64,
    /// Largest number of neighbors in a list.
    neighbors: u32,
    /// Time of a list of events, times the number of spheres.
    list: f64,
    /// Time of all lists of events.
    span: f64,
}

/// The program, an initial state, and the fastest settings for it.
pub(crate) struct Smallenburg<'a> {
    folder: &'a Path,
    start: &'a Start,
    place: PathBuf,
    settings: Settings,
}

impl<'a> Smallenburg<'a> {
    /// Searches for the fastest settings for this initial state.
    pub(crate) fn tuned(folder: &'a Path, start: &'a Start) -> Outcome<Self> {
        let place = benches::working_folder("smallenburg")?;
        fs::create_dir_all(&place)?;
        fs::write(place.join("init.sph"), spheres(start))?;
        let first = Settings { variant: &VARIANTS[0], length: 1.0, neighbors: 24, list: 8.0, span: 5.0 };
        let mut peer = Self { folder, start, place, settings: first };
        let lengths = VARIANTS.iter().flat_map(|variant| {
            variant.lengths.iter().map(move |&length| Settings { variant, length, ..first })
        });
        peer.keep_fastest(lengths.collect())?;
        let queues = [(8.0, 5.0), (1.0, 1.0), (1.0, 5.0), (8.0, 1.0), (64.0, 5.0)];
        peer.keep_fastest(queues.map(|(list, span)| Settings { list, span, ..peer.settings }).into())?;
        peer.keep_fastest([24, 16, 12].map(|neighbors| Settings { neighbors, ..peer.settings }).into())?;
        peer.build()?;
        Ok(peer)
    }

    /// Keeps the fastest of these settings. Settings with which the program aborts, because a sphere has too
    /// many neighbors, are skipped.
    fn keep_fastest(&mut self, all: Vec<Settings>) -> Outcome<()> {
        let mut best = (f64::INFINITY, self.settings);
        for settings in all {
            self.settings = settings;
            self.build()?;
            let time = self.measure().map_or(f64::INFINITY, |(speed, _)| speed.nanoseconds);
            best = if time < best.0 { (time, settings) } else { best };
        }
        self.settings = best.1;
        Ok(())
    }

    fn build(&self) -> Outcome<()> {
        let Settings { variant, length, neighbors, list, span } = self.settings;
        fs::write(self.place.join("in_a_plane.c"), variant.source(self.folder)?)?;
        let mut compile = Command::new("gcc");
        compile.args(FLAGS).args(["-w", "-include", "time.h", "-o", "in_a_plane", "in_a_plane.c", "-lm"]);
        compile.arg("-I").arg(self.folder.join(variant.name));
        let interval = self.start.time / TEMPERATURE.sqrt();
        let columns = (self.start.side / length).ceil();
        let numbers = [
            ("LENGTH", length),
            ("NEIGHBORS", neighbors.into()),
            ("LIST", list),
            ("SPAN", span),
            ("INTERVAL", interval),
            ("COLUMNS", columns),
        ];
        compile.args(numbers.map(|(name, number)| format!("-D{name}={number}")));
        let built = compile.current_dir(&self.place).output().map_err(|error| format!("gcc: {error}"))?;
        if built.status.success() {
            return Ok(());
        }
        Err(format!("it cannot be built: {}", String::from_utf8_lossy(&built.stderr)).into())
    }

    /// Runs the program for two intervals, of which only the second counts.
    pub(crate) fn measure(&self) -> Outcome<Measured> {
        let output = Command::new(self.place.join("in_a_plane")).current_dir(&self.place).output()?;
        let said = String::from_utf8(output.stdout)?;
        let reports = said.lines().filter_map(report).collect::<Vec<_>>();
        let &[_, [start, before, _, earlier], [end, after, pressure, later]] = reports.as_slice() else {
            return Err(format!("it said “{}”", said.lines().last().unwrap_or_default()).into());
        };
        let (count, collisions) = (self.start.disks.len() as f64, after - before);
        let rate = 2.0 * collisions / (count * (end - start) * TEMPERATURE.sqrt());
        // A third of the virial at the temperature 1 is half of it at 1.5.
        let compressibility = pressure * self.start.side.powi(2) / count;
        Ok((Speed { nanoseconds: 1e9 * (later - earlier) / collisions, rate }, compressibility))
    }

    /// Returns the settings.
    pub(crate) fn settings(&self) -> String {
        let Settings { variant, length, neighbors, list, span } = self.settings;
        let neighbors =
            if variant.name == "Cell" { String::new() } else { format!(" of {neighbors} neighbors") };
        format!("{} {length}{neighbors}, lists of {list}/N over {span}", variant.name)
    }
}

/// Returns an initial state in the form that the code reads: spheres in a plane, in a box as thick as one of
/// them.
fn spheres(start: &Start) -> String {
    let mut text = format!("{}\n{side} {side} 1\n", start.disks.len(), side = start.side);
    // Writing into a text cannot fail.
    for place in start.disks.iter().map(Disk::position) {
        let _ = writeln!(text, "a {} {} 0.5 0.5", place.x, place.y);
    }
    text
}

/// Returns time, collisions, pressure and processor seconds from a line of a report.
fn report(line: &str) -> Option<[f64; 4]> {
    let number = |name: &str| line.split(name).nth(1)?.split([',', ' ']).next()?.parse().ok();
    Some([number("Simtime: ")?, number("Collisions: ")?, number("Press: ")?, number("T: ")?])
}

/// Returns the name of the compiler, and its flags.
pub(crate) fn compiler() -> String {
    let said = Command::new("gcc").arg("--version").output().map(|output| output.stdout).unwrap_or_default();
    let name = String::from_utf8_lossy(&said).lines().next().unwrap_or("gcc").to_owned();
    format!("{name} {}", FLAGS.join(" "))
}
