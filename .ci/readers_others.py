"""Reads the files of `export` by ASE, MDAnalysis, chemfiles, freud, pandas and polars, for `readers.py`."""

import warnings

import numpy as np

warnings.simplefilter("ignore")


def by_name(run):
    """Returns the readers by the names of their packages; `run` is the module `readers`."""
    folder, frames, column, in_space, same = run.folder, run.frames, run.column, run.in_space, run.same

    def close(what, read, expected, error):
        same(f"{what} to {error}", bool(np.all(np.abs(np.asarray(read) - expected) <= error)), True)

    def read_by_ase():
        from ase.io import read

        # Neither reader guesses: ASE takes each number by its shortest digits.
        for name, kind in [("run.xyz", "extxyz"), ("run.xyz.gz", "extxyz"), ("run.dump", "lammps-dump-text")]:
            all_atoms = read(str(folder / name), index=":", format=kind)
            same(f"number of frames of {name} by ASE", len(all_atoms), len(frames))
            for number, (atoms, frame) in enumerate(zip(all_atoms, frames)):
                place = f"{name} by ASE, frame {number}"
                # ASE shifts a dump by nothing, but computes its positions from shares of the box.
                close(f"{place}: positions", atoms.positions, in_space(column(frame, "position")), 1e-12)
                if kind == "lammps-dump-text":
                    same(f"{place}: time", atoms.arrays["v_time"].ravel()[0], frame["time"])
                    continue
                same(f"{place}: numbers", atoms.numbers, column(frame, "kind"))
                arrays = {"id": "id", "kind": "kind", "radius": "radius", "mass": "mass", "angle": "angle"}
                for array, known in (arrays | {"image": "image", "inertia_factor": "inertia_factor"}).items():
                    same(f"{place}: {array}", atoms.arrays[array], column(frame, known))
                same(f"{place}: velo", atoms.arrays["velo"], in_space(column(frame, "velocity")))
                same(f"{place}: omega", atoms.arrays["omega"][:, 2], column(frame, "angular_velocity"))
                same(f"{place}: pbc", list(atoms.pbc)[:2], frame["periodic"])
                same(f"{place}: time", float(atoms.info["Time"]), frame["time"])

    def read_by_mdanalysis():
        import MDAnalysis

        for name, kind in [("run.xyz", "XYZ"), ("run.dump", "LAMMPSDUMP")]:
            universe = MDAnalysis.Universe(str(folder / name), format=kind)
            same(f"number of frames of {name} by MDAnalysis", len(universe.trajectory), len(frames))
            for frame, read in zip(frames, universe.trajectory):
                # It counts the positions of a dump from the corner of the box, in single precision.
                corner = np.array([frame["left"], frame["bottom"], -0.5]) if kind == "LAMMPSDUMP" else np.zeros(3)
                places = in_space(column(frame, "position")) - corner
                close(f"{name} by MDAnalysis, frame {read.frame}: positions", read.positions, places, 1e-5)

    def read_by_chemfiles():
        import chemfiles

        chemfiles.set_warnings_callback(lambda message: None)
        for name, kind in [("run.xyz", "XYZ"), ("run.xyz.gz", "XYZ / GZ"), ("run.dump", "LAMMPS")]:
            trajectory = chemfiles.Trajectory(str(folder / name), "r", kind)
            same(f"number of frames of {name} by chemfiles", trajectory.nsteps, len(frames))
            for number, frame in enumerate(frames):
                read, place = trajectory.read_step(number), f"{name} by chemfiles, frame {number}"
                # It unwraps the positions of a dump.
                positions = column(frame, "position" if kind != "LAMMPS" else "unwrapped")
                close(f"{place}: positions", read.positions, in_space(positions), 1e-12)
                radii = [atom["radius"] for atom in read.atoms]
                same(f"{place}: radii", np.array(radii), column(frame, "radius"))

    def read_by_freud():
        import freud
        import gsd.hoomd

        with gsd.hoomd.open(str(folder / "run.gsd"), "r") as trajectory:
            for number, (read, frame) in enumerate(zip(trajectory, frames)):
                # As docs/guide/recipes.md has it: where there are walls, the box is larger.
                reach = 2.0
                sizes = read.configuration.box[:2] + reach * (read.log["periodic"] == 0)
                box, places = freud.Box(*sizes, is2D=True), read.particles.position
                query = freud.locality.AABBQuery(box, places)
                found = query.query(places, {"r_max": reach, "exclude_ii": True}).toNeighborList()
                apart = column(frame, "position")[:, None] - column(frame, "position")
                width = frame["right"] - frame["left"]
                apart[..., 0] -= width * np.round(apart[..., 0] / width)
                pairs = np.sum(np.hypot(apart[..., 0], apart[..., 1]) < reach) - len(places)
                same(f"run.gsd by freud, frame {number}: neighbors", len(found), int(pairs))

    def tables(read_csv, name):
        end, series = read_csv(str(folder / "end.csv")), read_csv(str(folder / "series.csv"))
        for axis, heading in enumerate(["x", "y"]):
            same(f"{heading} of end.csv by {name}", np.array(end[heading]), column(frames[-1], "position")[:, axis])
        for heading in ["id", "kind", "angle", "angular_velocity", "radius", "mass", "inertia_factor"]:
            same(f"{heading} of end.csv by {name}", np.array(end[heading]), column(frames[-1], heading))
        same(f"times by {name}", np.array(series["time [time]"]), np.array([frame["time"] for frame in frames]))

    def read_by_pandas():
        import pandas

        tables(lambda path: pandas.read_csv(path, float_precision="round_trip"), "pandas")

    def read_by_polars():
        import polars

        tables(polars.read_csv, "polars")

    return {
        "ase": read_by_ase,
        "MDAnalysis": read_by_mdanalysis,
        "chemfiles": read_by_chemfiles,
        "freud-analysis": read_by_freud,
        "pandas": read_by_pandas,
        "polars": read_by_polars,
    }
