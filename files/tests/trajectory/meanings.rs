//! Files whose columns mean something else than their names suggest to a reader of disks, as programs that
//! track particles and people write them: each is read by its meaning, or refused with a way out.

use granular_edmd::observable::Snapshot;
use granular_edmd::prelude::*;
use granular_edmd_files::{Reader, State};

use crate::corpus::{check, dump, shown, xyz};

fn with_radius() -> Reader {
    Reader::new().with_radius(0.5).unwrap()
}

/// The last frame is read, and the names of frames and times are many.
#[test]
fn frames_of_tables_are_frames() {
    for name in [
        "t",
        "T",
        "Slice",
        "Time (s)",
        "time_s",
        "frame",
        "frame_number",
        "frame_id",
        "frames",
        "seconds",
        "FRAME",
        "POSITION_T",
        "step",
        "time [s]",
    ] {
        let text = format!("x,y,radius,{name}\n1,2,0.5,0\n3,2,0.5,0\n1,3,0.5,1\n3,3,0.5,1\n");
        let read = |reader: Reader| shown(reader.read_from(text.as_bytes()));
        let last = read(Reader::new());
        assert!(last.contains("(1 3) r0.5; (3 3) r0.5"), "{name}: {last}");
        assert!(last.contains(" | this is frame 1 of 2 by `"), "{name}: {last}");
        let first = read(Reader::new().with_frame(0));
        assert!(first.contains("(1 2) r0.5; (3 2) r0.5"), "{name}: {first}");
        assert_eq!(read(Reader::new().with_step(1)), last, "{name}");
        assert!(read(Reader::new().with_step(7)).contains("there is no frame with step 7"), "{name}");
    }
    // Rows of one particle after the other, and a time beside the frame.
    check(
        &with_radius().with_frame(0),
        &[(
            "particle,x,y,frame,time\n1,1,2,0,0.5\n1,1,3,1,1.5\n2,3,2,0,0.5\n2,3,3,1,1.5\n",
            "t 0.5; (1 2) r0.5 #1; (3 2) r0.5 #2 | this is frame 0 of 2 by `frame`",
        )],
    );
    check(
        &with_radius(),
        &[
            ("x,y,time\n1,2,0.5\n3,2,0.5\n", "t 0.5; (1 2) r0.5; (3 2) r0.5"),
            (
                "x,y,frame,time\n1,2,0,1\n3,2,0,2\n",
                "refused: line 3: time must be the same in all rows of a frame, but is \"2\"",
            ),
            // Particles that come twice, although the table names no frames.
            ("track_id,x,y\n4,1,2\n4,1,3\n", "refused: line 3: the disk 4 is already in line 2"),
        ],
    );
}

#[test]
fn tables_of_programs_that_track_particles() {
    check(
        &with_radius(),
        &[
            // trackpy, whose mass is a brightness and whose size is that of a spot.
            (
                ",y,x,mass,size,ecc,signal,raw_mass,ep,frame,particle\n0,2,1,1167.5,3.1,0.1,9,1200,0.05,0,0\n",
                "(1 2) r0.5 #1 | y points down in images, and up here: the disks are mirrored | `mass` is the brightness of a spot here, and ignored | ids begin with 0 in the file, and \
                 are greater by 1 here | ignored: (without a name), mass, size, ecc, signal, raw_mass, ep",
            ),
            // ImageJ: an empty name above the numbers of rows, and degrees.
            (
                " \tArea\tX\tY\tMajor\tMinor\tAngle\n1\t9\t1\t2\t3\t3\t90\n",
                "(1 2) r0.5 | y points down in images, and up here: the disks are mirrored | `Angle` is in degrees here, and ignored | ignored: (names of rows), Area, Major, Minor, Angle",
            ),
            // TrackMate: three more rows of names and units.
            (
                "LABEL,ID,TRACK_ID,POSITION_X,POSITION_Y,POSITION_Z,POSITION_T,FRAME,RADIUS\n\
                 Label,Spot ID,Track ID,X,Y,Z,T,Frame,Radius\nLabel,Spot ID,Track ID,X,Y,Z,T,Frame,R\n\
                 ,,,(micron),(micron),(micron),(sec),,(micron)\nID7,7,0,1,2,0,0,0,0.25\n",
                "t 0; (1 2) r0.25 #7 | lines without numbers below the names, skipped: 3 | the radius that was given is ignored, since the file has radii | ignored: LABEL, TRACK_ID",
            ),
            // scikit-image's `regionprops_table`.
            (
                "label,centroid-1,centroid-0,equivalent_diameter\n1,1,2,0.5\n",
                "(1 2) r0.25 | y points down in images, and up here: the disks are mirrored | the radius that was given is \
              ignored, since the file has radii | ignored: label",
            ),
        ],
    );
    let scaled = Reader::new().with_scale(0.5).unwrap();
    check(
        &scaled,
        &[
            (
                "x (px),y (px),radius,vx\n2,4,1,6\n",
                "(1 2) r0.5 v(3 0) | numbers are read without conversion of units: x (px), y (px)",
            ),
            (
                &xyz(
                    "Lattice=\"20 0 0 0 10 0 0 0 1\" pbc=\"T F F\" Gravity=2 Properties=pos:R:2:radius:R:1:density:R:1",
                    "2 4 1 3",
                ),
                "0..10p 0..5; g [0, -1]; (1 2) r0.5 m9.42477796076938",
            ),
        ],
    );
}

#[test]
fn headers_with_units_names_of_rows_and_comments() {
    let noted =
        |columns: &str| format!("(1 2) r0.5 | numbers are read without conversion of units: {columns}");
    check(
        &Reader::new(),
        &[
            ("x (um),y (um),radius (um)\n1,2,0.5\n", &noted("x (um), y (um), radius (um)")),
            ("x_um,y_um,radius_um\n1,2,0.5\n", &noted("x_um, y_um, radius_um")),
            ("x {mm},y/mm,rad\n1,2,0.5\n", &noted("x {mm}, y/mm")),
            ("cx,cy,rad\n1,2,0.5\n", "(1 2) r0.5"),
            ("center_x,center_y,r\n1,2,0.5\n", "(1 2) r0.5"),
            ("\tx\ty\tradius\n0\t1\t2\t0.5\n", "(1 2) r0.5 | ignored: (names of rows)"),
            ("     x    y  radius\n0  1.0  2.0     0.5\n", "(1 2) r0.5 | ignored: (names of rows)"),
            ("# made on Monday\n# by hand, twice\nx,y,radius\n1,2,0.5\n", "(1 2) r0.5"),
            ("sep=;\nx;y;radius\n1;2;0.5\n", "(1 2) r0.5"),
            (
                "x;y;radius\n1,5;2;0.5\n",
                "refused: line 2: x must be a number with a decimal point, but is \"1,5\"",
            ),
            // All cells of a row: they are no names.
            (
                "x;y;radius\n1,5;2,5;0,5\n3;4;1\n",
                "refused: line 2: x must be a number with a decimal point, but is \"1,5\"",
            ),
            ("x,y,radius\nNA,NA,NA\n1,2,0.5\n", "refused: line 2: x must be a number, but is \"NA\""),
            (
                "1,2,0.5\n3,2,0.5\n",
                "refused: line 1: the first line of a table must be the names of its columns, such as x,y,radius, but is \
                 \"1,2,0.5\"",
            ),
            ("x,y,D\n1,2,1\n", "(1 2) r0.5 | `D` is read as the diameter"),
            ("position[x],position[y],radius,d/dt\n1,2,0.5,7\n", "(1 2) r0.5 | ignored: d/dt"),
            ("x,y,radius,theta\n1,2,0.5,30\n", "(1 2) r0.5 | ignored: theta"),
            (
                "x,y,radius,angle (deg)\n1,2,0.5,30\n",
                "(1 2) r0.5 | `angle (deg)` is in degrees, and ignored | ignored: angle",
            ),
        ],
    );
}

#[test]
fn what_is_missing_or_not_used_is_told() {
    check(
        &Reader::new(),
        &[
            (
                "x,y\n1,2\n",
                "refused: line 1: the column `radius`, or one radius for all (with_radius, --radius), is missing",
            ),
            (
                "x,y,Area,Feret\n1,2,9,3\n",
                "refused: line 1: the column `radius`, or one radius for all, from Area or Feret (with_radius, \
                 --radius), is missing",
            ),
            (
                "x,y,radius\n1,2,0.5\n3,2,0.25\n",
                "(1 2) r0.5; (3 2) r0.25 | all masses are 1, since the file has none; a density (with_density, --density) \
                 gives them by size",
            ),
        ],
    );
    let reader = with_radius().with_density(2.0).unwrap();
    check(
        &reader,
        &[(
            "x,y,radius,mass\n1,2,0.25,1\n",
            "(1 2) r0.25 | the radius that was given is ignored, since the file has radii | the density that was given is \
             ignored, since the file has masses",
        )],
    );
}

/// Plain XYZ has a name and three coordinates. Others are read only by their names.
#[test]
fn plain_xyz_of_own_columns_is_refused() {
    let told = |read: String| {
        assert!(read.starts_with("refused") && read.contains("Properties="), "{read}");
    };
    told(shown(with_radius().read_from(xyz("x y radius r g b", "1.5 2 0.5 1 0 0").as_bytes())));
    told(shown(with_radius().read_from(xyz("", "A 1 2 0.63922 / A 3 4 0.5").as_bytes())));
    check(
        &with_radius(),
        &[
            (
                &xyz("i = 1, time = 0.500, E = -1", "A 1 2 0"),
                "t 0.5; kinds 0 A; (1 2) r0.5 | kinds are numbered by name: A 0 | ignored: E, i",
            ),
            (
                &xyz("time=3ps", "A 1 2 0"),
                "kinds 0 A; (1 2) r0.5 | the time \"3ps\" is no number, and ignored | kinds are numbered by name: A 0",
            ),
        ],
    );
}

#[test]
fn headers_of_wrong_lengths_are_refused() {
    let one = |keys: &str| shown(Reader::new().read_from(xyz(keys, "5 5 0.5").as_bytes()));
    let lattice =
        |numbers: &str| one(&format!("Lattice=\"{numbers}\" pbc=\"T T F\" Properties=pos:R:2:radius:R:1"));
    for numbers in
        ["10 0 0 0 10 0", "10 0 0 0 10 0 0", "10 0 0 0 10 0 0 0", "10 0 0 0 10 0 0 0 inf", "10 nan"]
    {
        assert!(lattice(numbers).starts_with("refused: line 2: Lattice must be"), "{}", lattice(numbers));
    }
    for numbers in ["10 10", "10 10 1", "10 0 0 10", "10 0 0 0 10 0 0 0 1"] {
        assert!(lattice(numbers).starts_with("0..10p 0..10p"), "{}", lattice(numbers));
    }
    let origin = |numbers: &str| {
        one(&format!("Lattice=\"10 10\" Origin=\"{numbers}\" pbc=\"T T F\" Properties=pos:R:2:radius:R:1"))
    };
    for numbers in ["0 0", "0 0 0 0 0", "0 inf 0"] {
        assert!(
            origin(numbers).starts_with("refused: line 2: Origin must be 3 numbers"),
            "{}",
            origin(numbers)
        );
    }
    let told = one("Properties=pos:R:4:radius:R:1");
    assert_eq!(told, "refused: line 2: pos must be of 2 or 3 columns, but is \"pos:R:4\"");
    let tilted = dump("x y radius", "1 2 0.5").replace("BOUNDS pp ff pp", "BOUNDS xy xz yz pp ff pp");
    let told = shown(Reader::new().read_from(tilted.as_bytes()));
    assert_eq!(told, "refused: line 6: the box must be three lines of 3 numbers, but is \"0 10\"");
}

#[test]
fn dumps_of_own_steps_and_types() {
    check(
        &Reader::new().with_step(12),
        &[(&dump("x y radius", "1 2 0.5").replace("\n100\n", "\n12.000000\n"), "0..10p 0..5; (1 2) r0.5")],
    );
    check(
        &Reader::new(),
        &[
            (&dump("x y radius", "1 2 0.5").replace("\n100\n", "\n12.5\n"), "0..10p 0..5; (1 2) r0.5"),
            (
                &dump("type x y radius", "0 1 2 0.5"),
                "refused: line 10: type must be from 1 to 65536, but is \"0\"",
            ),
        ],
    );
}

const HEAD: &str = "t\n\n2 atoms\n2 atom types\n0 9 xlo xhi\n0 9 ylo yhi\n\n";

#[test]
fn data_of_lammps_of_styles_without_radii() {
    let masses = "Masses\n\n1 2.0\n2 3.0\n\n";
    let disks = "(1 2) r0.5 m2 v(7 0) #1; (3 2) r0.5 m3 k1 #2";
    let note = "no side is periodic, since the file does not say which are, and all images are 0";
    for (style, rows) in [
        ("atomic", "1 1 1 2 0\n2 2 3 2 0\n"),
        ("charge", "1 1 0.5 1 2 0\n2 2 0.5 3 2 0\n"),
        ("bond", "1 9 1 1 2 0\n2 9 2 3 2 0\n"),
        ("molecular", "1 9 1 1 2 0\n2 9 2 3 2 0\n"),
        ("full", "1 9 1 0.5 1 2 0\n2 9 2 0.5 3 2 0\n"),
    ] {
        let text = format!("{HEAD}{masses}Atoms # {style}\n\n{rows}\nVelocities\n\n1 7 0 0\n2 0 0 0\n");
        let read = shown(with_radius().read_from(text.as_bytes()));
        let read = read.split(" | ignored").next().unwrap().to_owned();
        assert_eq!(read, format!("0..9 0..9; {disks} | {note}"), "{style}");
        let told = shown(Reader::new().read_from(text.as_bytes()));
        assert!(told.contains("(with_radius, --radius)"), "{told}");
    }
}

/// Periodic sides and walls remain what they are through each file, and flags are numbers.
#[test]
fn data_of_lammps_keep_their_periodicity() -> Result<(), Box<dyn std::error::Error>> {
    for image in [[1, 0], [0, 0], [0, -1]] {
        for sort in 0..4 {
            let container = Container::closed(10.0, 10.0)?;
            let container = if sort & 1 > 0 { container.with_periodic_sides()? } else { container };
            let container = if sort & 2 > 0 { container.with_periodic_ends()? } else { container };
            let disks = [Disk::new(DVec2::new(5.0, 5.0), 0.5)?.with_image(image)];
            let snapshot = Snapshot::new(0.5, &disks, container.domain(), 0.0);
            let mut file = Vec::new();
            State::of(&snapshot).write_lammps_data(&mut file)?;
            let state = Reader::new().read_from(&file[..])?;
            assert_eq!((state.domain(), state.time()), (Some(snapshot.domain()), Some(0.5)));
            assert!(state.notes().is_empty(), "{:?}", state.notes());
        }
    }
    let atoms = |flags: &str| {
        format!("{}Atoms # sphere\n\n1 1 1 1 5 5 0 {flags}\n", HEAD.replace("2 atoms", "1 atoms"))
    };
    let walls = "no side is periodic, since the file does not say which are, and all images are 0";
    for flags in ["-0 +0 0", "00 0 0", "0.0 0 0"] {
        let read = shown(Reader::new().read_from(atoms(flags).as_bytes()));
        assert!(read.starts_with("0..9 0..9; ") && read.ends_with(walls), "{read}");
    }
    let read = shown(Reader::new().read_from(atoms("0 -2 0").as_bytes()));
    let note = "the box is periodic in y only, since the file does not say where it is, and images along it are not 0";
    assert!(read.starts_with("0..9 0..9p; ") && read.ends_with(note), "{read}");
    Ok(())
}

#[cfg(feature = "gzip")]
#[test]
fn the_cause_of_a_damaged_compressed_file_is_told() {
    let error = Reader::new().read_from(&[0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255, 1][..]).unwrap_err();
    assert!(error.to_string().starts_with("cannot read line 1: "), "{error}");
}
