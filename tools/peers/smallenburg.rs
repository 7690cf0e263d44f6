//! The event-driven code for spheres of Frank Smallenburg (Eur. Phys. J. E **45**, 22 (2022)) as another
//! program.
//!
//! Its settings are constants in its source, so each choice of them is compiled from a changed copy. The
//! spheres lie in a plane and have no velocity out of it, and only the cells of the plane are looked into.
//! The third coordinate stays in its arithmetic.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use granular_edmd::Disk;

use super::elastic::{Measured, Speed, Start};
use benches::Outcome;

/// The flags of its makefile.
const FLAGS: [&str; 3] = ["-Ofast", "-funroll-loops", "-march=native"];

/// Temperature in the plane: the program gives its spheres a mean square velocity of 3.
const TEMPERATURE: f64 = 1.5;

/// Changes for spheres in a plane, and for the time on the processor in its report.
const CHANGES: [(&str, &str); 8] = [
    ("double maxtime = 100;", "double maxtime = 2.000001 * INTERVAL;"),
    ("double writeinterval = 1;", "double writeinterval = INTERVAL;"),
    ("const int usethermostat = 1;", "const int usethermostat = 0;"),
    ("p->vz = imsq * random_gaussian();", "p->vz = 0;"),
    ("while (cx*cy*cz > 8*N)", "while (cx*cy > 8*N)"),
    ("cz *= 0.9;", ""),
    ("for (cdz = cellz - 1; cdz < cellz + 2; cdz++)", "cdz = cellz;"),
    ("simtime, colcounter, pressnow, temperature", "simtime, colcounter, pressnow, 1e-6 * clock()"),
];

/// The settings that it leaves to its users.
#[derive(Debug, Clone, Copy)]
struct Settings {
    /// Radius of the neighbor lists in diameters.
    shell: f64,
    /// Most neighbors in a list.
    neighbors: u32,
    /// Time of a list of events, times the number of disks.
    list: f64,
    /// Time of all lists of events.
    span: f64,
}

/// The settings with which it comes.
const GIVEN: Settings = Settings { shell: 1.5, neighbors: 24, list: 1.0, span: 1.0 };

/// The program, a start, and the settings that are the fastest there.
pub(crate) struct Smallenburg<'a> {
    folder: &'a Path,
    start: &'a Start,
    settings: Settings,
}

impl<'a> Smallenburg<'a> {
    /// Searches for the fastest settings from this start, one after the other.
    pub(crate) fn tuned(folder: &'a Path, start: &'a Start) -> Outcome<Self> {
        let mut peer = Self { folder, start, settings: GIVEN };
        peer.try_all(&[1.2, 1.35, 1.75, 2.0, 2.5, 3.0, 4.0], |shell, given| Settings { shell, ..given })?;
        peer.try_all(&[8.0, 64.0], |list, given| Settings { list, ..given })?;
        peer.try_all(&[5.0], |span, given| Settings { span, ..given })?;
        peer.try_all(&[12, 16], |neighbors, given| Settings { neighbors, ..given })?;
        peer.build()?;
        Ok(peer)
    }

    /// Keeps the fastest of these values and the present one. A value with which the program ends is passed
    /// over, since a disk has too many neighbors.
    fn try_all<T: Copy>(&mut self, values: &[T], with: fn(T, Settings) -> Settings) -> Outcome<()> {
        let (given, mut best) = (self.settings, (f64::INFINITY, self.settings));
        for settings in std::iter::once(given).chain(values.iter().map(|&value| with(value, given))) {
            self.settings = settings;
            self.build()?;
            let time = self.measure().map_or(f64::INFINITY, |(speed, _)| speed.nanoseconds);
            best = if time < best.0 { (time, settings) } else { best };
        }
        self.settings = best.1;
        Ok(())
    }

    fn build(&self) -> Outcome<()> {
        let (place, interval) = (place()?, self.start.time / TEMPERATURE.sqrt());
        fs::create_dir_all(&place)?;
        fs::write(place.join("init.sph"), self.spheres())?;
        fs::write(place.join("in_a_plane.c"), self.source()?)?;
        let mut compile = Command::new("gcc");
        compile.args(FLAGS).args(["-w", "-include", "time.h", "-o", "in_a_plane", "in_a_plane.c"]);
        compile.arg("-I").arg(self.variant()).arg(format!("-DINTERVAL={interval:e}")).arg("-lm");
        let built = compile.current_dir(&place).output().map_err(|error| format!("gcc: {error}"))?;
        if built.status.success() {
            return Ok(());
        }
        Err(format!("it cannot be built: {}", String::from_utf8_lossy(&built.stderr)).into())
    }

    /// Returns the folder of its variant that its author calls the fastest.
    fn variant(&self) -> PathBuf {
        self.folder.join("Single")
    }

    /// Returns its code with the changes and the settings.
    fn source(&self) -> Outcome<String> {
        let Settings { shell, neighbors, list, span } = self.settings;
        let settings = [
            ("#define MAXNEIGH 24", format!("#define MAXNEIGH {neighbors}")),
            ("const double shellsize = 1.5;", format!("const double shellsize = {shell};")),
            ("double eventlisttimemultiplier = 1;", format!("double eventlisttimemultiplier = {list};")),
            ("double maxscheduletime = 1.0;", format!("double maxscheduletime = {span};")),
        ];
        let file = self.variant().join("mdSingle.c");
        let mut source = fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
        for (from, to) in CHANGES.map(|(from, to)| (from, to.to_owned())).into_iter().chain(settings) {
            if source.matches(from).count() != 1 {
                return Err(format!("{} has “{from}” not once: another version?", file.display()).into());
            }
            source = source.replace(from, &to);
        }
        Ok(source)
    }

    /// Returns the start as it reads it: spheres in the middle one of three layers of cells.
    fn spheres(&self) -> String {
        let (Start { side, disks, .. }, thickness) = (self.start, self.thickness());
        let mut text = format!("{}\n{side} {side} {thickness}\n", disks.len());
        // Writing into a text cannot fail.
        for place in disks.iter().map(Disk::position) {
            let _ = writeln!(text, "a {} {} {} 0.5", place.x, place.y, 0.5 * thickness);
        }
        text
    }

    fn thickness(&self) -> f64 {
        (3.0 * self.settings.shell).ceil() + 1.0
    }

    /// Runs it for a stretch that does not count and for one that does.
    pub(crate) fn measure(&self) -> Outcome<Measured> {
        let place = place()?;
        let output = Command::new(place.join("in_a_plane")).current_dir(&place).output()?;
        let said = String::from_utf8(output.stdout)?;
        let reports = said.lines().filter_map(report).collect::<Vec<_>>();
        let &[_, [start, before, _, earlier], [end, after, pressure, later]] = reports.as_slice() else {
            return Err(format!("it said “{}”", said.lines().last().unwrap_or_default()).into());
        };
        let (count, collisions) = (self.start.disks.len() as f64, after - before);
        let rate = 2.0 * collisions / (count * (end - start) * TEMPERATURE.sqrt());
        // A third of the virial at the temperature 1 is half of it at 1.5.
        let compressibility = pressure * self.start.side.powi(2) * self.thickness() / count;
        Ok((Speed { nanoseconds: 1e9 * (later - earlier) / collisions, rate }, compressibility))
    }

    /// Returns the settings and flags.
    pub(crate) fn settings(&self) -> String {
        let Settings { shell, neighbors, list, span } = self.settings;
        format!("shell {shell}, {neighbors} neighbors, lists of {list}/N over {span}")
    }
}

/// Returns the folder of its changed copy and its files.
fn place() -> Outcome<PathBuf> {
    benches::working_folder("smallenburg")
}

/// Returns time, collisions, pressure and seconds on the processor of a line with a report.
fn report(line: &str) -> Option<[f64; 4]> {
    let number = |name: &str| line.split(name).nth(1)?.split([',', ' ']).next()?.parse().ok();
    Some([number("Simtime: ")?, number("Collisions: ")?, number("Press: ")?, number("T: ")?])
}

/// Returns the name and version of the compiler, and its flags.
pub(crate) fn compiler() -> String {
    let said = Command::new("gcc").arg("--version").output().map(|output| output.stdout).unwrap_or_default();
    let name = String::from_utf8_lossy(&said).lines().next().unwrap_or("gcc").to_owned();
    format!("{name} {}", FLAGS.join(" "))
}
