"""Reads the files of `export` by OVITO, VTK, LAMMPS and GSD, and compares every number with what the run had."""

import csv
import gzip
import json
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

import numpy as np

folder = pathlib.Path(sys.argv[1])
frames = json.loads((folder / "expected.json").read_text())
checked = 0


def column(frame, name):
    return np.array([disk[name] for disk in frame["disks"]])


def in_space(vectors):
    return np.column_stack([vectors, np.zeros(len(vectors))])


def same(what, read, expected, roundings=0):
    """Ends the check unless both have the same shape and numbers: the same bits, or up to so many roundings."""
    global checked
    read, expected = np.asarray(read), np.asarray(expected)
    if read.shape != expected.shape:
        sys.exit(f"error: {what} has the shape {read.shape}, not {expected.shape}")
    if roundings:
        is_same = np.all(np.abs(read - expected) <= roundings * np.spacing(np.abs(expected)))
    else:
        is_same = read.astype(expected.dtype).tobytes() == expected.tobytes()
    if not is_same:
        differs = np.flatnonzero(read != expected)[:5]
        sys.exit(f"error: {what} is {read.flat[differs]!r} where the run had {expected.flat[differs]!r}")
    checked += read.size


def read_by_ovito():
    from ovito.io import import_file

    for name in ["run.xyz", "run.xyz.gz", "run.dump", "run.dump.gz"]:
        pipeline = import_file(str(folder / name))
        same(f"number of frames of {name}", pipeline.source.num_frames, len(frames))
        for number, frame in enumerate(frames):
            data = pipeline.compute(number)
            particles = data.particles
            of_ovito(f"{name}, frame {number}", data, particles, frame, is_xyz="xyz" in name)
    gsd_by_ovito()
    render_by_ovito(pipeline)


def of_ovito(place, data, particles, frame, is_xyz):
    # OVITO reads decimal numbers faster than exactly: most are the nearest ones, some their neighbors. It
    # keeps radii in single precision.
    def check(name, expected):
        read = particles[name][...]
        expected = expected.astype(read.dtype) if name == "Radius" else expected
        same(f"{place}: {name}", read, expected, roundings=1)

    check("Particle Identifier", column(frame, "id"))
    check("Particle Type", column(frame, "kind") + (0 if is_xyz else 1))
    check("Position", in_space(column(frame, "position")))
    check("Velocity", in_space(column(frame, "velocity")))
    check("angle", column(frame, "angle"))
    check("Radius", column(frame, "radius"))
    check("Mass", column(frame, "mass"))
    if is_xyz:
        check("angular_velocity", column(frame, "angular_velocity"))
        check("inertia_factor", column(frame, "inertia_factor"))
        check("image", column(frame, "image"))
        check("unwrapped", column(frame, "unwrapped"))
        same(f"{place}: gravity", data.attributes["Gravity"], frame["gravity"])
    else:
        # OVITO takes `x y z` as position, and so leaves out `xu yu`, of which it makes the same.
        check("Periodic Image", np.column_stack([column(frame, "image"), 0 * column(frame, "id")]))
        turning = np.zeros((len(frame["disks"]), 3))
        turning[:, 2] = column(frame, "angular_velocity")
        check("Angular Velocity", turning)
    same(f"{place}: time", data.attributes["Time"], frame["time"], roundings=1)
    cell = data.cell[...]
    same(f"{place}: corner of the box", cell[:2, 3], np.array([frame["left"], frame["bottom"]]), roundings=1)
    same(f"{place}: width of the box", cell[0, 0], frame["right"] - frame["left"])
    same(f"{place}: periodic directions", list(data.cell.pbc)[:2], frame["periodic"])


def in_single(numbers):
    return np.asarray(numbers, dtype=np.float32)


def of_schema(place, frame):
    """Returns what a file of GSD has for a frame: positions from its center, in single precision."""
    disks = len(frame["disks"])
    center = np.array([0.5 * (frame["left"] + frame["right"]), frame["bottom"]])
    radius, mass, half = column(frame, "radius"), column(frame, "mass"), 0.5 * column(frame, "angle")
    inertia = np.zeros((disks, 3))
    inertia[:, 2] = column(frame, "inertia_factor") * mass * radius**2
    turned = np.zeros((disks, 4))
    turned[:, 0], turned[:, 3] = np.cos(half), np.sin(half)
    return center, in_single(in_space(column(frame, "position") - center)), in_single(inertia), in_single(turned)


def read_by_gsd():
    import gsd.hoomd

    with gsd.hoomd.open(str(folder / "run.gsd"), "r") as trajectory:
        same("number of frames of run.gsd", len(trajectory), len(frames))
        # From the last to the first: any frame is read without those before it.
        for number in reversed(range(len(frames))):
            read, frame, place = trajectory[number], frames[number], f"run.gsd, frame {number}"
            read.validate()
            particles, (center, positions, inertia, turned) = read.particles, of_schema(place, frame)
            same(f"{place}: step", read.configuration.step, number)
            same(f"{place}: dimensions", read.configuration.dimensions, 2)
            same(f"{place}: width", read.configuration.box[0], in_single(frame["right"] - frame["left"]))
            same(f"{place}: time", read.log["time"], np.array([frame["time"]]))
            same(f"{place}: gravity", read.log["gravity"], np.array([[0.0, -frame["gravity"]]]))
            same(f"{place}: center", read.log["center"], center.reshape(1, 2))
            same(f"{place}: ids", read.log["particles/id"], column(frame, "id"))
            same(f"{place}: kinds", particles.typeid, column(frame, "kind"))
            same(f"{place}: names", [int(name) for name in particles.types], list(range(len(particles.types))))
            same(f"{place}: positions", particles.position, positions)
            same(f"{place}: velocities", particles.velocity, in_single(in_space(column(frame, "velocity"))))
            same(f"{place}: diameters", particles.diameter, in_single(2 * column(frame, "radius")))
            same(f"{place}: masses", particles.mass, in_single(column(frame, "mass")))
            same(f"{place}: images", particles.image[:, :2], column(frame, "image"))
            same(f"{place}: moments of inertia", particles.moment_inertia, inertia, roundings=1)
            # The cosine of NumPy may differ by a rounding, which a small number shows much enlarged.
            close = np.allclose(particles.orientation, turned, rtol=0, atol=1e-7)
            momentum = 2 * turned * np.column_stack([column(frame, "angular_velocity") * inertia[:, 2]] * 4)
            momentum = np.column_stack([-momentum[:, 3], momentum[:, 1:3], momentum[:, 0]])
            same(f"{place}: turned", close and np.allclose(particles.angmom, momentum, rtol=0, atol=1e-6), True)


def gsd_by_ovito():
    from ovito.io import import_file

    pipeline = import_file(str(folder / "run.gsd"))
    same("number of frames of run.gsd", pipeline.source.num_frames, len(frames))
    for number, frame in enumerate(frames):
        data, place = pipeline.compute(number), f"run.gsd by OVITO, frame {number}"
        _, positions, _, _ = of_schema(place, frame)
        same(f"{place}: positions", in_single(data.particles["Position"][...]), positions)
        same(f"{place}: radii", in_single(data.particles["Radius"][...]), in_single(column(frame, "radius")))
        same(f"{place}: time", data.attributes["time"], frame["time"])


def render_by_ovito(pipeline):
    from ovito.vis import TachyonRenderer, Viewport

    pipeline.add_to_scene()
    view = Viewport(type=Viewport.Type.Front, camera_dir=(0, 0, -1), camera_up=(0, 1, 0))
    view.zoom_all()
    try:
        view.render_image(size=(500, 500), filename=str(folder / "ovito.png"), renderer=TachyonRenderer())
    except RuntimeError as error:
        print(f"SKIPPED, OVITO RENDERS NO PICTURE: {str(error).splitlines()[0]}", file=sys.stderr)


def read_by_vtk():
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    series = xml.etree.ElementTree.parse(folder / "run.pvd").findall("Collection/DataSet")
    disks = [entry for entry in series if entry.get("name") == "disks"]
    edges = [entry for entry in series if entry.get("name") == "box"]
    same("number of frames of run.pvd", [len(disks), len(edges)], [len(frames)] * 2)
    for entry, box, frame in zip(disks, edges, frames):
        same("time of run.pvd", float(entry.get("timestep")), frame["time"])
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(folder / entry.get("file")))
        reader.Update()
        data = reader.GetOutput()
        arrays = data.GetPointData()

        def check(name, expected):
            same(f"{entry.get('file')}: {name}", vtk_to_numpy(arrays.GetArray(name)), expected)

        for name in ["id", "kind", "angle", "angular_velocity", "radius", "mass", "inertia_factor", "image"]:
            check(name, column(frame, name))
        check("velocity", in_space(column(frame, "velocity")))
        check("unwrapped", in_space(column(frame, "unwrapped")))
        same("places", vtk_to_numpy(data.GetPoints().GetData()), in_space(column(frame, "position")))
        same("time", vtk_to_numpy(data.GetFieldData().GetArray("TimeValue")), np.array([frame["time"]]))
        same("vertices", data.GetNumberOfVerts(), len(frame["disks"]))
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(folder / box.get("file")))
        reader.Update()
        bounds = reader.GetOutput().GetBounds()
        same("box", bounds[:3], np.array([frame["left"], frame["right"], frame["bottom"]]))
        same("periodic edges", vtk_to_numpy(reader.GetOutput().GetCellData().GetArray("periodic")), [1, 0, 1])
    render_by_vtk(data, reader.GetOutput())


def render_by_vtk(disks, edges):
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
    from vtkmodules.vtkFiltersCore import vtkGlyph3D
    from vtkmodules.vtkFiltersSources import vtkSphereSource
    from vtkmodules.vtkIOImage import vtkPNGWriter
    from vtkmodules.vtkRenderingCore import (
        vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter,
    )

    disks.GetPointData().SetActiveScalars("radius")
    sphere = vtkSphereSource(radius=1.0, theta_resolution=24, phi_resolution=24)
    glyphs = vtkGlyph3D(scale_factor=1.0)
    glyphs.SetScaleModeToScaleByScalar()
    glyphs.SetInputData(disks)
    glyphs.SetSourceConnection(sphere.GetOutputPort())
    renderer = vtkRenderer(background=(1, 1, 1))
    for source, is_disks in [(glyphs.GetOutputPort(), True), (edges, False)]:
        mapper = vtkPolyDataMapper()
        mapper.SetInputConnection(source) if is_disks else mapper.SetInputData(source)
        mapper.SetScalarRange(0.35, 0.5)
        actor = vtkActor(mapper=mapper)
        if not is_disks:
            mapper.ScalarVisibilityOff()
            actor.GetProperty().SetColor(0, 0, 0)
        renderer.AddActor(actor)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(500, 500)
    window.AddRenderer(renderer)
    window.Render()
    image = vtkWindowToImageFilter(input=window)
    writer = vtkPNGWriter(file_name=str(folder / "vtk.png"))
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


def read_by_lammps():
    """Reads the data file and writes it back; LAMMPS prints one or two digits less than a number needs."""
    script = """
        units lj
        dimension 2
        atom_style sphere
        boundary p f p
        newton off
        comm_modify vel yes
        read_data end.data
        pair_style gran/hooke/history 1000 300 1 0.3 0.1 1
        pair_coeff * *
        write_data back.data nocoeff
    """
    (folder / "in.read").write_text("\n".join(line.strip() for line in script.splitlines()))
    binaries = pathlib.Path(sys.executable).parent
    environment = dict(os.environ, LD_LIBRARY_PATH=str(binaries.parent / "lib"))
    command = [str(binaries / "lmp"), "-in", "in.read", "-screen", "none", "-log", "lammps.log"]
    subprocess.run(command, cwd=folder, env=environment, check=True, timeout=60)
    text = (folder / "back.data").read_text().split("Atoms # sphere")[1]
    atoms, velocities = text.split("Velocities")
    rows = [np.array(sorted([float(cell) for cell in line.split()] for line in part.split("\n") if line.strip()))
            for part in (atoms, velocities)]
    frame = frames[-1]
    mass = column(frame, "mass")
    radius = column(frame, "radius")
    expected_atoms = np.column_stack([
        column(frame, "id"), column(frame, "kind") + 1, 2 * radius, mass / (4 / 3 * np.pi * radius**3),
        in_space(column(frame, "position")), in_space(column(frame, "image")),
    ])
    turning = np.zeros((len(mass), 3))
    turning[:, 2] = column(frame, "angular_velocity")
    expected_velocities = np.column_stack([column(frame, "id"), in_space(column(frame, "velocity")), turning])
    global checked
    for what, read, expected in zip(["atoms", "velocities"], rows, [expected_atoms, expected_velocities]):
        worst = np.max(np.abs(read - expected) / np.maximum(1, np.abs(expected)))
        if read.shape != expected.shape or worst > 1e-14:
            sys.exit(f"error: {what} of LAMMPS differ by {worst}")
        checked += read.size


def read_by_python():
    """The files that need no module: tables, and compressed ones as any reader of gzip sees them."""
    for name in ["run.xyz", "run.dump"]:
        same(name, gzip.open(folder / f"{name}.gz").read() == (folder / name).read_bytes(), True)
    with open(folder / "series.csv") as table:
        rows = list(csv.reader(table))
    same("headings", len(rows[0]), len(rows[1]))
    for row, frame in zip(rows[1:], frames, strict=True):
        masses = column(frame, "mass")
        height = float(row[rows[0].index("center_y [length]")])
        mean = masses @ column(frame, "position")[:, 1] / masses.sum()
        if abs(height - mean) > 1e-12:
            sys.exit(f"error: the center of mass is at {mean}, not at {height}")


read_by_python()
for reader in sys.argv[2:]:
    {"ovito": read_by_ovito, "vtk": read_by_vtk, "lammps": read_by_lammps, "gsd": read_by_gsd}[reader]()
    print(f"{reader}: as the run had it, {checked} numbers so far")
