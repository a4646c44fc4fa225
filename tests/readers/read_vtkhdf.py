#!/usr/bin/env python3
"""Opens a result directory with VTK's own reader and compares every time step with the raw HDF5 data.

    python3 tests/readers/read_vtkhdf.py RESULT_DIR [--steps N]

Needs vtk >= 9.5, h5py and numpy. Exits with 1 at the first mismatch, which it names.
"""

import argparse
import json
import pathlib
import sys
import tomllib

import h5py
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

WIDTHS = {"velocity": 3, "force": 3, "acceleration": 3, "image": 3, "stress": 9,
          "angular_velocity": 3, "angular_acceleration": 3, "orientation": 4}  # of particles' fields; else 1
BODY_FIELDS = {
    "body": 1,
    "kind": 1,
    "radius": 1,
    "velocity": 3,
    "angle": 1,
    "angular_velocity": 1,
    "force": 3,
    "contacts": 1,
    "origin": 3,
}
CENTER = 1  # kind of the points of bodies.vtkhdf that are centres of mass


def require(condition, message):
    if not condition:
        sys.exit(f"error: {message}")


class ErrorCounter:
    """Counts what VTK would only print."""

    def __init__(self, algorithm):
        self.count = 0
        algorithm.AddObserver("ErrorEvent", self.add)

    def add(self, *_):
        self.count += 1


def check_attributes(file, path):
    root = file["VTKHDF"]
    require(list(root.attrs["Version"]) == [2, 0], f"{path}: VTKHDF Version {root.attrs['Version']}")
    require(root.attrs["Type"] == b"PolyData", f"{path}: VTKHDF Type {root.attrs['Type']}")

    def check(name, item):
        if isinstance(item, h5py.Dataset):
            for attribute in ("unit", "description"):
                require(item.attrs.get(attribute), f"{path}: {name} has no {attribute}")

    root.visititems(check)


CONSTANT = {"global_id", "radius", "mass", "material", "group", "body", "kind"}  # fields of points that never change


def check_offsets(root, path, fields):
    """The snapshots' rows follow each other without a gap, to the end of every dataset; those of fields that never
    change begin anew where the number of points changes."""
    steps = root["Steps"]
    count = root["NumberOfPoints"][:][steps["PartOffsets"][:]]
    first = np.concatenate([[0], np.cumsum(count)])
    require(
        steps.attrs["NSteps"] == len(count), f"{path}: NSteps is {steps.attrs['NSteps']} for {len(count)}"
    )
    require(len(root["Points"]) == first[-1], f"{path}: {len(root['Points'])} rows of Points for {first[-1]}")
    require(
        np.array_equal(steps["PointOffsets"], first[:-1]), f"{path}: PointOffsets do not follow each other"
    )
    new = np.diff(count, prepend=-1) != 0
    shared = np.concatenate([[0], np.cumsum(count[new])])
    for name in fields:
        constant = name in CONSTANT
        wanted, end = (shared[np.cumsum(new) - 1], shared[-1]) if constant else (first[:-1], first[-1])
        rows = len(root[f"PointData/{name}"])
        require(rows == end, f"{path}: {rows} rows of {name} for {end}")
        offsets = steps[f"PointDataOffsets/{name}"]
        require(np.array_equal(offsets, wanted), f"{path}: offsets of {name} do not follow each other")


def raw_snapshot(root, step, fields):
    """Points and fields of one step, read by the offsets alone."""
    steps = root["Steps"]
    count = root["NumberOfPoints"][steps["PartOffsets"][step]]
    first = steps["PointOffsets"][step]
    data = {"Points": root["Points"][first : first + count]}
    for name in fields:
        first = steps[f"PointDataOffsets/{name}"][step]
        data[name] = root[f"PointData/{name}"][first : first + count]
    return data


# The fields that count the entries of a list in the group Scree.
COUNTED = {"names": "body", "materials": "material", "groups": "group"}


def check_names(where, polydata, names, raw):
    """The lists are field data of the step, and no field counts past them."""
    for name, entries in names.items():
        array = polydata.GetFieldData().GetAbstractArray(name)
        require(array is not None, f"{where}: no field data {name}")
        found = [array.GetValue(k) for k in range(array.GetNumberOfValues())]
        require(found == entries, f"{where}: {name} are {found}")
        numbers = raw.get(COUNTED[name], np.zeros(0, int))
        require(((numbers >= 0) & (numbers < len(entries))).all(), f"{where}: {COUNTED[name]} counts past {name}")


def check_step(path, step, polydata, raw, fields, names):
    where = f"{path}, step {step}"
    count = len(raw["Points"])
    for kind in ("Points", "Verts", "Cells"):
        found = getattr(polydata, f"GetNumberOf{kind}")()
        require(found == count, f"{where}: {found} {kind} for {count}")
    if count == 0:
        return
    connectivity = vtk_to_numpy(polydata.GetVerts().GetConnectivityArray())
    require(np.array_equal(connectivity, np.arange(count)), f"{where}: vertices do not name their points")
    positions = vtk_to_numpy(polydata.GetPoints().GetData())
    require(np.array_equal(positions, raw["Points"]), f"{where}: Points differ")
    for name, width in fields.items():
        array = polydata.GetPointData().GetArray(name)
        require(array is not None, f"{where}: no field {name}")
        components = array.GetNumberOfComponents()
        require(components == width, f"{where}: {name} has {components} components")
        values = vtk_to_numpy(array)
        require(np.isfinite(values).all(), f"{where}: {name} is not finite")
        require(np.array_equal(values, raw[name]), f"{where}: {name} differs")
    kind = raw.get("kind", np.zeros(count, int))
    radius = raw.get("radius", (kind != CENTER).astype(float))
    require(np.array_equal(radius > 0, kind != CENTER), f"{where}: a radius is not positive, or one of a centre is")
    identity = raw["global_id" if "global_id" in raw else "body"]
    for value in np.unique(kind):
        require((np.diff(identity[kind == value]) >= 0).all(), f"{where}: not in the order of the ids")
    check_names(where, polydata, names, raw)


def check_file(path, fields):
    """Returns the number of steps."""
    reader = vtk.vtkHDFReader()
    errors = ErrorCounter(reader)
    require(reader.CanReadFile(str(path)), f"{path}: VTK's reader does not take it")
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    with h5py.File(path, "r") as file:
        check_attributes(file, path)
        root = file["VTKHDF"]
        names = {name: lines[()].decode().splitlines() for name, lines in file["Scree"].items()}
        require("materials" in names, f"{path}: no names of materials")
        check_offsets(root, path, fields)
        times = root["Steps/Values"][:]
        found = reader.GetNumberOfSteps()
        require(found == len(times), f"{path}: {found} steps for {len(times)}")
        require((np.diff(times) > 0).all(), f"{path}: times do not increase")
        counts = []
        for step, time in enumerate(times):
            reader.SetStep(step)
            reader.Update()
            found = reader.GetTimeValue()
            require(found == time, f"{path}, step {step}: time {found} for {time}")
            raw = raw_snapshot(root, step, fields)
            check_step(path, step, reader.GetOutput(), raw, fields, names)
            counts.append(len(raw["Points"]))
    require(errors.count == 0, f"{path}: VTK reported {errors.count} errors")
    span = f"t = {times[0]:g} .. {times[-1]:g} s"
    print(f"{path}: {len(times)} steps, {span}, {min(counts)} to {max(counts)} points: right")
    return len(times)


def history_columns(directory):
    """{"group/name": values}"""
    with h5py.File(directory / "history.h5", "r") as file:
        columns = {}
        file.visititems(lambda name, item: columns.update({name: item[:]}) if isinstance(item, h5py.Dataset) else None)
        return columns


def rotation(quaternion):
    w, x, y, z = quaternion
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def check_surfaces(path, names, steps):
    """The triangles of every step by VTK's reader against the raw data; that they move with their bodies as the
    history says, and that what acts on them adds up to the force there. names: of the bodies, all in the history."""
    reader = vtk.vtkHDFReader()
    errors = ErrorCounter(reader)
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    require(reader.GetNumberOfSteps() == steps, f"{path}: {reader.GetNumberOfSteps()} steps for {steps}")
    history = history_columns(path.parent)
    with h5py.File(path, "r") as file:
        check_attributes(file, path)
        root = file["VTKHDF"]
        triangles = root["Polygons/Connectivity"][:].reshape(-1, 3)
        once = {name: root[f"CellData/{name}"][:] for name in ("surface", "body", "wall", "material", "triangle")}
        fields = [name for name in root["CellData"] if name not in once]
        start, pushed = root["Points"][: root["NumberOfPoints"][0]], 0
        for step, time in enumerate(root["Steps/Values"][:]):
            where = f"{path}, step {step}"
            reader.SetStep(step)
            reader.Update()
            data = reader.GetOutput()
            found = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
            require(np.array_equal(found, triangles), f"{where}: other triangles")
            points = vtk_to_numpy(data.GetPoints().GetData())
            first = step * len(start)
            require(np.array_equal(points, root["Points"][first : first + len(start)]), f"{where}: Points differ")
            values = {name: vtk_to_numpy(data.GetCellData().GetArray(name)) for name in (*once, *fields)}
            rows = slice(step * len(triangles), (step + 1) * len(triangles))
            raw = once | {name: root[f"CellData/{name}"][rows] for name in fields}
            for name, array in raw.items():
                require(np.array_equal(values[name], array), f"{where}: {name} differs")
            sides = points[triangles[:, 1:]] - points[triangles[:, :1]]
            area = np.cross(sides[:, 0], sides[:, 1]) / 2
            force = raw["shear"] * np.linalg.norm(area, axis=1)[:, None] - raw["pressure"][:, None] * area
            row = np.flatnonzero(history["step/time"] == time)
            require(len(row) == 1, f"{where}: no row of the history")
            for body, name in enumerate(names):
                at = {column: history[f"bodies/{name}/{column}"][row[0]] for column in
                      ("x", "y", "z", "e0", "e1", "e2", "e3")}
                at0 = {column: history[f"bodies/{name}/{column}"][0] for column in at}
                center, center0 = (np.array([a[c] for c in "xyz"]) for a in (at, at0))
                turn, turn0 = (rotation([a[f"e{k}"] for k in range(4)]) for a in (at, at0))
                of_body = np.unique(triangles[once["body"] == body])
                moved = center + (start[of_body] - center0) @ (turn @ turn0.T).T
                require(np.abs(points[of_body] - moved).max() < 1e-12, f"{where}: not with the body {name}")
                told = np.array([history[f"contacts/{name}/f{c}"][row[0]] for c in "xyz"])
                found = force[once["body"] == body].sum(axis=0)
                # Of contacts at edges the triangle does not tell the normal.
                close = np.linalg.norm(found - told) <= 0.05 * np.linalg.norm(told)
                require(close, f"{where}: {found} N on {name} for {told} N")
                pushed += np.linalg.norm(told) > 0
    require(pushed > 0, f"{path}: nothing touches")
    require(errors.count == 0, f"{path}: VTK reported {errors.count} errors")
    print(f"{path}: {len(triangles)} triangles, with their bodies at {steps} steps: right")


def check_lines(path, steps):
    """The lines of every step by VTK's reader against the raw data. Returns for each step {name: values} of the lines,
    with their "ends" [lines][2][3]."""
    reader = vtk.vtkHDFReader()
    errors = ErrorCounter(reader)
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    require(reader.GetNumberOfSteps() == steps, f"{path}: {reader.GetNumberOfSteps()} steps for {steps}")
    found = []
    with h5py.File(path, "r") as file:
        check_attributes(file, path)
        root, first_line, first_point = file["VTKHDF"], 0, 0
        require(len(root.get("PointData", {})) == 0, f"{path}: has fields of points")
        for step, time in enumerate(root["Steps/Values"][:]):
            where = f"{path}, step {step}"
            reader.SetStep(step)
            reader.Update()
            require(reader.GetTimeValue() == time, f"{where}: time {reader.GetTimeValue()} for {time}")
            data, points = reader.GetOutput(), root["NumberOfPoints"][root["Steps/PartOffsets"][step]]
            require(data.GetNumberOfLines() == data.GetNumberOfCells() == points // 2, f"{where}: other lines")
            raw = {name: field[first_line : first_line + points // 2] for name, field in root["CellData"].items()}
            raw["ends"] = root["Points"][first_point : first_point + points].reshape(-1, 2, 3)
            if points:
                ids = vtk_to_numpy(data.GetLines().GetConnectivityArray())
                require(np.array_equal(ids, np.arange(points)), f"{where}: lines do not name their points")
                ends = vtk_to_numpy(data.GetPoints().GetData()).reshape(-1, 2, 3)
                require(np.array_equal(ends, raw["ends"]), f"{where}: Points differ")
                for name in root["CellData"]:
                    values = vtk_to_numpy(data.GetCellData().GetArray(name))
                    require(np.array_equal(values, raw[name]), f"{where}: {name} differs")
                    require(np.isfinite(values).all(), f"{where}: {name} is not finite")
            found.append(raw)
            first_line, first_point = first_line + points // 2, first_point + points
        rows = {"Points": first_point} | {f"CellData/{name}": first_line for name in root["CellData"]}
        for name, count in rows.items():
            require(len(root[name]) == count, f"{path}: {len(root[name])} rows of {name} for {count}")
    require(errors.count == 0, f"{path}: VTK reported {errors.count} errors")
    counts = [len(raw["ends"]) for raw in found]
    print(f"{path}: {steps} steps, {min(counts)} to {max(counts)} lines: right")
    return found


def check_contacts(directory, steps):
    """That the contacts of each particle are as many as its field says, and their forces add up to its force."""
    lines = check_lines(directory / "contacts.vtkhdf", steps)
    with h5py.File(directory / "particles.vtkhdf", "r") as file:
        root = file["VTKHDF"]
        for step, contacts in enumerate(lines):
            where = f"{directory}, step {step}"
            points = raw_snapshot(root, step, ("global_id", "force", "contacts"))
            ids = points["global_id"]
            number, force = np.zeros(len(ids), int), np.zeros((len(ids), 3))
            first, second = contacts["first"], contacts["second"]
            between = second >= 0
            require((np.diff(first) >= 0).all(), f"{where}: contacts not in the order of the ids")
            require((second[between] > first[between]).all(), f"{where}: a contact's first id is not the lower one")
            require(((first < 0) == (contacts["first_body"] >= 0)).all(), f"{where}: a contact of nobody")
            for of, sign in ((first, 1), (second, -1)):
                rows = of >= 0
                at = np.searchsorted(ids, of[rows])
                np.add.at(number, at, 1)
                np.add.at(force, at, sign * contacts["force"][rows])
            require(np.array_equal(number, points["contacts"]), f"{where}: other numbers of contacts")
            apart = np.abs(force - points["force"]).max(initial=0)
            require(apart <= 1e-10 * np.abs(points["force"]).max(initial=0), f"{where}: forces are {apart} N apart")
    require(sum(len(contacts["first"]) for contacts in lines) > 0, f"{directory}: nothing touches")


def check_links(directory, steps):
    """That joints have the reactions of the history."""
    lines, history = check_lines(directory / "links.vtkhdf", steps), history_columns(directory)
    with h5py.File(directory / "links.vtkhdf", "r") as file:
        names, times = file["Scree/names"][()].decode().splitlines(), file["VTKHDF/Steps/Values"][:]
    for time, links in zip(times, lines):
        row = np.flatnonzero(history["step/time"] == time)[0]
        require(np.array_equal(links["link"], np.arange(len(names))), f"{directory}: links do not name the names")
        for k in np.flatnonzero(links["kind"] == 0):
            columns = [history.get(f"reactions/{names[k]}/f{axis}", np.zeros(row + 1))[row] for axis in "xyz"]
            require(np.array_equal(links["reaction"][k], columns), f"{directory}: other reaction of {names[k]}")
            apart = abs(np.linalg.norm(columns) - links["force"][k])
            require(apart <= 1e-14 * links["force"][k], f"{directory}: {names[k]}: other force")


def particle_fields(directory):
    """{name: width} of what the run's deck wants."""
    deck = json.loads((directory / "run_record.json").read_text())["run"]["resolved_deck"]
    wanted = tomllib.loads(deck)["output"]["fields"]
    return {name: WIDTHS.get(name, 1) for name in ["global_id", *wanted]}


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("result_directory", type=pathlib.Path)
    parser.add_argument("--steps", type=int, help="number of snapshots that must be there")
    arguments = parser.parse_args()
    directory = arguments.result_directory
    steps = check_file(directory / "particles.vtkhdf", particle_fields(directory))
    require(arguments.steps in (None, steps), f"{steps} snapshots where {arguments.steps} must be")
    bodies = arguments.result_directory / "bodies.vtkhdf"
    surfaces = directory / "surfaces.vtkhdf"
    if surfaces.exists():
        with h5py.File(surfaces, "r") as file:
            check_surfaces(surfaces, file["Scree/names"][()].decode().split(), steps)
    if (directory / "contacts.vtkhdf").exists():
        check_contacts(directory, steps)
    if (directory / "links.vtkhdf").exists():
        check_links(directory, steps)
    if bodies.exists():
        same = check_file(bodies, BODY_FIELDS) == steps
        require(same, "particles and bodies differ in their number of snapshots")


if __name__ == "__main__":
    main()
