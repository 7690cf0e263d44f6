//! Small files as other programs and people write them, with the values that they mean, or the refusal.

use std::fmt::Write as _;

use granular_edmd::Disk;
use granular_edmd_files::{ReadError, Reader, State};

use support::report::report;

/// Writes what a file says: box, time and gravity if it has them; then each disk, without what is as in
/// [`Disk::new`]; then the notes.
pub(crate) fn shown(read: Result<State, ReadError>) -> String {
    let state = match read {
        Ok(state) => state,
        Err(error) => return format!("refused: {}", report(&error)),
    };
    let mut text = String::new();
    if let Some(domain) = state.domain() {
        let letter = |is_periodic| if is_periodic { "p" } else { "" };
        let (sides, ends) = (letter(domain.periodic_sides), letter(domain.periodic_ends));
        let (x, y) = ([domain.left, domain.right], [domain.bottom, domain.top]);
        write!(text, "{}..{}{sides} {}..{}{ends}; ", x[0], x[1], y[0], y[1]).unwrap();
    }
    if let Some(time) = state.time() {
        write!(text, "t {time}; ").unwrap();
    }
    if let Some(gravity) = state.gravity() {
        write!(text, "g {}; ", gravity.acceleration()).unwrap();
    }
    let kinds = state.kind_names().iter().enumerate().map(|(number, name)| format!("{number} {name}"));
    let kinds: Vec<String> = kinds.collect();
    if !kinds.is_empty() {
        write!(text, "kinds {}; ", kinds.join(", ")).unwrap();
    }
    text += &state.disks().iter().map(shown_disk).collect::<Vec<_>>().join("; ");
    state.notes().iter().for_each(|note| write!(text, " | {note}").unwrap());
    text
}

fn shown_disk(disk: &Disk) -> String {
    let position = disk.position();
    let mut text = format!("({} {}) r{}", position.x, position.y, disk.radius());
    let mut add = |is_other: bool, what: String| {
        if is_other {
            write!(text, " {what}").unwrap();
        }
    };
    let (velocity, [right, up]) = (disk.velocity(), disk.image());
    add(disk.mass() != 1.0, format!("m{}", disk.mass()));
    add(velocity.length() != 0.0, format!("v({} {})", velocity.x, velocity.y));
    add(disk.angle() != 0.0, format!("a{}", disk.angle()));
    add(disk.angular_velocity() != 0.0, format!("w{}", disk.angular_velocity()));
    add(disk.inertia_factor() != 0.5, format!("b{}", disk.inertia_factor()));
    add(disk.kind().number() != 0, format!("k{}", disk.kind().number()));
    add(disk.image() != [0, 0], format!("i({right} {up})"));
    add(disk.id() != 0, format!("#{}", disk.id()));
    text
}

/// Checks what files say.
#[track_caller]
pub(crate) fn check(reader: &Reader, cases: &[(&str, &str)]) {
    let wrong: Vec<String> = cases
        .iter()
        .filter_map(|(text, expected)| {
            let found = shown(reader.read_from(text.as_bytes()));
            (found != *expected).then(|| format!("{text}\n  should be {expected}\n  but is    {found}\n"))
        })
        .collect();
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}

/// Returns the text of a frame with these keys and this row, or these rows with `/` between them.
pub(crate) fn xyz(keys: &str, rows: &str) -> String {
    let rows: Vec<&str> = rows.split('/').map(str::trim).collect();
    format!("{}\n{keys}\n{}\n", rows.len(), rows.join("\n"))
}

/// Returns a dump with these columns and rows, of a box of 10 by 5.
pub(crate) fn dump(columns: &str, rows: &str) -> String {
    let rows: Vec<&str> = rows.split('/').map(str::trim).collect();
    format!(
        "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS pp ff pp\n0 10\n0 5\n-0.5 0.5\n\
         ITEM: ATOMS {columns}\n{}\n",
        rows.len(),
        rows.join("\n")
    )
}

#[test]
fn tables_of_many_programs() {
    check(
        &Reader::new(),
        &[
            ("x,y,radius\n1,2,0.5\n", "(1 2) r0.5"),
            ("Y,X,R\n2,1,0.5\n", "(1 2) r0.5"),
            // pandas and R have a column of their own.
            (",x,y,radius\n0,1,2,0.5\n1,3,2,0.5\n", "(1 2) r0.5; (3 2) r0.5 | ignored: (without a name)"),
            ("\"\",\"x\",\"y\",\"radius\"\n\"1\",1,2,0.5\n", "(1 2) r0.5 | ignored: (without a name)"),
            // Units of the user's own, which are not converted.
            (
                "x [m],y [length],radius [mm],angle [deg],weight [kg]\n1,2,0.5,90,1\n",
                "(1 2) r0.5 | `angle [deg]` is in degrees, and ignored | numbers are read without conversion of units: \
                 x [m], radius [mm] | ignored: angle, weight",
            ),
            ("x;y;d;weight\n1;2;1;9\n", "(1 2) r0.5 | ignored: weight"),
            ("x\ty\tradius\tvx\tvy\n1\t2\t0.5\t3\t4\n", "(1 2) r0.5 v(3 4)"),
            ("# x y radius omega\n1 2 0.5 3\n# the end\n", "(1 2) r0.5 w3"),
            ("x, y, radius, angle\n1, 2, 0.5, 3\n", "(1 2) r0.5 a3"),
            ("id,x,y,radius\n1.0,1,2,0.5\n", "(1 2) r0.5 #1"),
            ("x,y,z,radius\n1,2,0,0.5\n", "(1 2) r0.5"),
            ("pos_x,pos_y,vel_x,vel_y,radius\n1,2,3,4,0.5\n", "(1 2) r0.5 v(3 4)"),
            // OVITO's and ParaView's tables.
            (
                "\"Particle Identifier\" \"Particle Type\" \"Position.X\" \"Position.Y\" \"Position.Z\" Radius\n4 2 1 2 0 0.5\n",
                "(1 2) r0.5 k2 #4",
            ),
            (
                "\"radius\",\"velocity:0\",\"velocity:1\",\"velocity:2\",\"Points:0\",\"Points:1\",\"Points:2\"\n0.5,3,4,0,1,2,0\n",
                "(1 2) r0.5 v(3 4)",
            ),
            (
                "x,y,radius,species\n1,2,0.5,\"a, b\"\n3,2,0.5,c\n",
                "kinds 0 a, b, 1 c; (1 2) r0.5; (3 2) r0.5 k1 | kinds are numbered by name: a, b 0, c 1",
            ),
            ("x,y,radius,mass\r\n1,2,0.5,2\r\n", "(1 2) r0.5 m2"),
            (
                "x,y,radius\n1,2,0.5\n3,2,0.5",
                "(1 2) r0.5; (3 2) r0.5 | the last line has no line break: its last number may be cut short",
            ),
            (
                "x,y,radius\n1,2,0.5\n3,2",
                "refused: line 3: the number of values must be 3, one for each column, but is \"2\"",
            ),
            ("x,y,radius\n1,,0.5\n", "refused: line 2: y must be a number, but is \"\""),
            ("x,radius\n1,0.5\n", "refused: line 1: the column `y` is missing"),
            (
                "x,y,radius\n1,2,0.5\n1,2,0.5\n3,2,0.5\n3.5,2,0.5\n",
                "refused: line 3: the disk overlaps the disk of line 2 by \
          1.0, a share of 1.0 of their distance at contact; it is the deepest of 2 such overlaps; two disks lie \
          nearly at the same place",
            ),
        ],
    );
}

#[test]
fn frames_by_number_and_step() {
    let frame =
        |step: u32, x: &str| dump("x y radius", &format!("{x} 2 0.5")).replace("100", &step.to_string());
    // The first frame overlaps, and the second is out of its box: only a frame that is asked for is checked.
    let text = frame(0, "1 2 0.5 / 1") + &frame(100, "1 9 0.5 / 1") + &frame(200, "5");
    let of = |reader: Reader| shown(reader.read_from(text.as_bytes()));
    let last = "0..10p 0..5; (5 2) r0.5";
    assert_eq!(of(Reader::new()), last);
    assert_eq!(of(Reader::new().with_frame(2)), last);
    assert_eq!(of(Reader::new().with_frame(-1)), last);
    assert_eq!(of(Reader::new().with_step(200)), last);
    assert!(
        of(Reader::new().with_frame(0))
            .starts_with("refused: line 11: the disk overlaps the disk of line 10")
    );
    assert!(
        of(Reader::new().with_frame(-2)).starts_with("refused: line 21: the disk at (1.0, 9.0) is outside")
    );
    assert_eq!(of(Reader::new().with_frame(3)), "refused: there is no frame with number 3: the file has 3");
    assert_eq!(of(Reader::new().with_frame(-4)), "refused: there is no frame with number -4: the file has 3");
    assert_eq!(of(Reader::new().with_step(7)), "refused: there is no frame with step 7: the file has 3");
    let states: Vec<_> =
        Reader::new().with_tolerance(1.0).unwrap().frames(text.as_bytes()).unwrap().collect();
    assert_eq!(states.len(), 2);
    assert!(states[0].is_ok() && states[1].is_err());
}

#[test]
fn soft_disks() {
    let text = "x,y,radius\n1,2,0.5\n1.99,2,0.5\n2.9899,2,0.5\n";
    let of = |reader: Reader| shown(reader.read_from(text.as_bytes()));
    let told = "refused: line 3: the disk overlaps the disk of line 2 by 0.01, a share of 0.01 of their distance at contact; \
                it is the deepest of";
    let radii = |radius: &str| format!("(1 2) r{radius}; (1.99 2) r{radius}; (2.9899 2) r{radius}");
    assert!(of(Reader::new()).starts_with(&format!("{told} 2 such")), "{}", of(Reader::new()));
    let some = Reader::new().with_tolerance(1e-3).unwrap();
    assert!(of(some.clone()).starts_with(&format!("{told} 1 such")));
    assert_eq!(of(Reader::new().with_tolerance(0.011).unwrap()), radii("0.5"));
    let note = " | all radii are shrunk by the deepest overlap, a share of 0.01";
    assert_eq!(of(Reader::new().with_shrunk_radii()), radii("0.495") + note);
    assert_eq!(of(Reader::new().with_shrunk_radii().with_tolerance(0.011).unwrap()), radii("0.495") + note);
    let deeper = of(some.with_shrunk_radii());
    assert!(deeper.starts_with(told) && deeper.ends_with("such overlaps; a larger tolerance accepts them"));
    // Shrinking leaves at least half of each radius.
    let near = |x: &str| format!("x,y,radius\n1,2,0.5\n{x},2,0.5\n");
    let shrunk = |x: &str| shown(Reader::new().with_shrunk_radii().read_from(near(x).as_bytes()));
    assert!(shrunk("1.5").starts_with("(1 2) r0.25; (1.5 2) r0.25 | all radii are shrunk"));
    for x in ["1", "1.25", "1.49"] {
        assert!(
            shrunk(x).ends_with("such overlaps; two disks lie nearly at the same place"),
            "{}",
            shrunk(x)
        );
    }
    // Overlaps across a periodic side.
    let seam = xyz(
        "Lattice=\"10 0 0 0 5 0 0 0 1\" pbc=\"T F F\" Properties=pos:R:2:radius:R:1",
        "0.375 2 0.5 / 9.5 2 0.5",
    );
    let state = Reader::new().with_shrunk_radii().read_from(seam.as_bytes()).unwrap();
    assert_eq!((state.shrunk(), state.disks()[1].radius()), (0.125, 0.4375));
}

#[test]
fn radii_and_masses_from_the_reader() {
    let reader = Reader::new().with_radius(0.5).unwrap().with_density(4.0).unwrap();
    check(
        &reader,
        &[
            (
                "1\na comment\nH 1 2 0\n",
                "kinds 0 H; (1 2) r0.5 m3.141592653589793 | kinds are numbered by name: H 0",
            ),
            (
                "1\na comment\nH 1 2 0 9 9\n",
                "kinds 0 H; (1 2) r0.5 m3.141592653589793 | kinds are numbered by name: H 0 | ignored: 5 to 6",
            ),
            ("x y\n1 2\n", "(1 2) r0.5 m3.141592653589793"),
        ],
    );
    assert!(Reader::new().with_radius(0.0).is_err());
    assert!(Reader::new().with_density(f64::NAN).is_err());
    assert!(Reader::new().with_tolerance(-1.0).is_err());
}

#[test]
fn files_that_are_no_text() {
    let refused = |bytes: &[u8]| shown(Reader::new().read_from(bytes));
    let latin = b"1\nProperties=pos:R:2:radius:R:1 Title=\"K\xf6rner\"\n1 2 0.5\n";
    assert!(
        refused(latin).starts_with("refused: line 2: the text must be UTF-8, but is"),
        "{}",
        refused(latin)
    );
    let wide: Vec<u8> = "x,y,radius\n1,2,0.5\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(
        refused(&[&[0xff, 0xfe], wide.as_slice()].concat())
            .starts_with("refused: line 1: the text must be UTF-8")
    );
    assert_eq!(refused(b""), "refused: the file ends after line 0, where a frame should follow");
    assert!(
        refused(b"title = \"a plan\"\n")
            .starts_with("refused: line 1: the file must be extended XYZ, a dump or")
    );
}

/// Files that version 0.3.0 wrote, to the bit.
#[test]
fn files_of_version_0_3_0() {
    let disks = "(0.1 0.7) r0.5 v(0.3333333333333333 -2) a100000.1 w-0.1 k7 i(-2 1) #3; \
                 (13.9 2.2250738585072014e-308) r0.3 m0.1 v(-0.00000000000000000001 1) b1 #4";
    let shown =
        |disks: &str| disks.replace("2.2250738585072014e-308", &2.225_073_858_507_201_4e-308_f64.to_string());
    let xyz = "2\nLattice=\"15.0 0.0 0.0 0.0 15.1 0.0 0.0 0.0 1.0\" Origin=\"0.0 -0.1 -0.5\" pbc=\"T F F\" \
               Properties=id:I:1:species:S:1:pos:R:3:velo:R:3:angle:R:1:angular_velocity:R:1:radius:R:1:mass:R:1:\
               inertia_factor:R:1:image:I:2:unwrapped:R:2 Time=0.30000000000000004 Gravity=0.3 \
               Domain=\"0.0 15.0 -0.1 inf\"\n\
               3 7 0.1 0.7 0.0 0.3333333333333333 -2.0 0.0 100000.1 -0.1 0.5 1.0 0.5 -2 1 -29.9 0.7\n\
               4 0 13.9 2.2250738585072014e-308 0.0 -1e-20 1.0 0.0 0.0 0.0 0.3 0.1 1.0 0 0 13.9 2.2250738585072014e-308\n";
    let head = "0..15p -0.1..inf; t 0.30000000000000004; ";
    let csv = "id,kind,x,y,vx,vy,angle,angular_velocity,radius,mass,inertia_factor,image_x,image_y\n\
               3,7,0.1,0.7,0.3333333333333333,-2.0,100000.1,-0.1,0.5,1.0,0.5,-2,1\n\
               4,0,13.9,2.2250738585072014e-308,-1e-20,1.0,0.0,0.0,0.3,0.1,1.0,0,0\n";
    let dump = "ITEM: UNITS\nlj\nITEM: TIME\n0.30000000000000004\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\n\
                ITEM: BOX BOUNDS pp fs pp\n0.0 15.0\n-0.1 15.0\n-0.5 0.5\n\
                ITEM: ATOMS id type x y z xu yu ix iy vx vy angle omegaz radius mass\n\
                3 8 0.1 0.7 0.0 -29.9 0.7 -2 1 0.3333333333333333 -2.0 100000.1 -0.1 0.5 1.0\n\
                4 1 13.9 2.2250738585072014e-308 0.0 13.9 2.2250738585072014e-308 0 0 -1e-20 1.0 0.0 0.0 0.3 0.1\n";
    check(
        &Reader::new(),
        &[
            (xyz, &shown(&format!("{head}g [0, -0.3]; {disks}"))),
            (csv, &shown(disks)),
            (dump, &shown(&format!("{head}{}", disks.replace(" b1", "")))),
        ],
    );
    let torn = xyz.trim_end();
    check(&Reader::new(), &[(torn, "refused: the file ends after line 4, where a line break should follow")]);
}
