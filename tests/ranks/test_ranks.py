"""The program under mpirun: the same bits on any number of ranks, after a restart on another number too.
Usage: SCREE=path/to/scree MPIEXEC=path/to/mpirun [SCREE_TEST_BACKEND=cuda] python3 test_ranks.py"""

import math
import unittest

from mpi_case import DAM, DONE, EXPLICIT, FAILED, HERE, IMPLICIT, INPUT, LONELY, RanksTest, results

GAS = [INPUT / "examples/gas_periodic.toml", "particles.gas.count=1000", "time.end=0.02", "parallel.imbalance=0.0"]
NET = [INPUT / "paper/net_400.toml", "time.step=5e-4", "parallel.imbalance=0.05",
       'output.history_contacts=["net", "net.9"]']
FIELDS = ('["radius", "velocity", "mass", "material", "acceleration", "contact_loss", "loss_power", "integrator_loss", '
          '"image", "force", "contacts", "stress", "group"]')
# Spheres that fall, slide, stick, roll, part and leave; some of them have no friction with each other.
FRICTION = [HERE / "friction.toml", "parallel.imbalance=0.05"]
FRICTION_FIELDS = '["velocity", "angular_velocity", "orientation", "acceleration", "contact_loss", "force", "contacts"]'
FIXED = ["time.control=fixed"]
ROLLING = ["contact.pairs.0.rolling_friction=0.2", "contact.pairs.0.rolling_damping_ratio=0.2"]
# Motors, gears, a screw, a spring, a stop, friction, a bushing and a loop of hinges, all of them at work.
ELEMENTS = [HERE / "spatial_elements.toml", "parallel.imbalance=0.0"]
# Grains on walls of triangles at rest; a run that ends half-way has a snapshot there that the other has, too.
AT_REST = [HERE / "mesh_walls.toml", "parallel.imbalance=0.0", "time.end=0.1", "output.snapshot_interval=0.025"]
# Walls and bodies of triangles: at rest, driven, on motors and hinges, across periodic sides.
MESHES = [HERE / "meshes.toml", "parallel.imbalance=0.0"]
# The same with all that triangles add up.
WORKS = ['output.surface_fields=["pressure", "shear", "impact_work", "sliding_work", "wear_depth"]',
         "contact.pairs.0.wear_coefficient=1e-12"]
# Contacts, and joints and force elements, as lines.
LINES = ["output.contacts=true"]
# Powder that sticks to walls, meshes and bodies.
STICKY_MESHES = [HERE / "sticky_meshes.toml", "parallel.imbalance=0.0"]
# Wet sand in place of the powder.
BRIDGES = [HERE / "bridges.toml", "parallel.imbalance=0.0"]
# Plastic grains in place of the powder, which do not stick to some bodies, and plastic grains with a linear stiffness.
PLASTIC_MESHES = [*STICKY_MESHES, "contact.pairs.0.plasticity_ratio=0.6", "contact.pairs.0.work_of_adhesion=1.0",
                  "contact.pairs.0.adhesion_exponent=2.5", "contact.pairs.1.attraction=1e-6"]
PLASTIC = [HERE / "rolling.toml", "parallel.imbalance=0.05", "contact.pairs.0.plasticity_ratio=0.5",
           "contact.pairs.0.work_of_adhesion=200.0", "contact.pairs.0.attraction=1e-3"]
# Particles that are born at once, in a stream and by a table of rates, on surfaces that move, and leave again.
BIRTHS = [HERE / "births.toml", "parallel.imbalance=0.0"]
# Soft grains, and a body of spheres, that are half-way through sheets, past which their contacts keep their sides.
SHEETS = [HERE / "open_surfaces.toml", "parallel.imbalance=0.0"]
# On one rank, on these numbers, and with a restart in the middle: three ranks in the first half, two in the second.
MAIN_CASES = {
    "5.3 net and 400 particles": ([*NET, "time.end=0.6", "output.history_particles=[0, 399]"], (4, 8)),
    "the same, explicit": ([*NET, *EXPLICIT, "integrator.substeps=10", "time.end=0.85", "space.leaving=remove"],
                           (4,)),
    "dam break, implicit": ([*DAM, *IMPLICIT, "time.end=0.24"], (4, 8)),
    "dam break, explicit": ([*DAM, *EXPLICIT, "time.end=0.24", "integrator.substeps=3"], (4, 8)),
    "periodic gas, implicit": ([*GAS, *LINES, *IMPLICIT], (4, 8)),
    "periodic gas, explicit": ([*GAS, *EXPLICIT], (4, 8)),
    "friction": ([*FRICTION, "time.end=0.08"], (4, 8)),
    "friction after Hertz and Mindlin": ([HERE / "friction_hertz.toml", "parallel.imbalance=0.0", "time.end=0.08"],
                                        (4,)),
    "sticky": ([HERE / "sticky.toml", "parallel.imbalance=0.05", "time.end=2e-3"], (4,)),
    "meshes that stick and their works": ([*STICKY_MESHES, *WORKS, *LINES, "time.end=2e-3"], (4,)),
    "meshes with liquid bridges and their works": ([*BRIDGES, *WORKS, *LINES, "time.end=4e-3"], (4,)),
    "meshes and births": ([*BIRTHS, "time.end=0.08"], (4, 8)),
    "rolling": ([HERE / "rolling.toml", "parallel.imbalance=0.05", "time.end=0.08"], (4,)),
    "plastic": ([*PLASTIC, "time.end=0.08"], (4,)),
    "meshes with plastic grains and their works": ([*PLASTIC_MESHES, *WORKS, *LINES, "time.end=2e-3"], (4,)),
    # Bodies among them that turn and go through a side, driven, and some in friction with them.
    "friction on bodies": ([HERE / "frictional_bodies.toml", *LINES, "parallel.imbalance=0.0", "time.end=0.08",
                           "output.snapshot_interval=0.02"], (4,)),
    "meshes, a light plate under heavy spheres": ([HERE / "loaded_plate.toml", "parallel.imbalance=0.0",
                                                   "time.end=0.08"], (4,)),
    "bodies in space": ([HERE / "spatial_bodies.toml", "parallel.imbalance=0.0", "time.end=0.08"], (4,)),
    "elements in space": ([*ELEMENTS, "time.end=0.08"], (4,)),
    "meshes and their works": ([*MESHES, *WORKS, "time.end=0.08"], (4,)),
    "meshes at rest and their works": ([*AT_REST, *WORKS], (4,)),
    "meshes, soft sheets": ([*SHEETS, "time.end=0.08"], (4,)),
    "friction, implicit": ([*FRICTION, *IMPLICIT, *FIXED, "time.step=8e-5", "time.end=0.08"], (4, 8)),
    "friction after Hertz and Mindlin, implicit": ([HERE / "friction_hertz.toml", *IMPLICIT, *FIXED,
                                                   "parallel.imbalance=0.0", "time.step=8e-5", "time.end=0.08"],
                                                  (4,)),
    "friction on bodies, implicit": ([HERE / "frictional_bodies.toml", *IMPLICIT, *FIXED, "integrator.substeps=1",
                                     "parallel.imbalance=0.0", "time.end=0.08"], (4,)),
    "rolling, implicit": ([HERE / "rolling.toml", *IMPLICIT, *FIXED, "parallel.imbalance=0.05", "time.step=8e-5",
                           "time.end=0.08"], (2, 4)),
}
# On one rank and on these numbers.
OTHER_CASES = {
    "bodies in space, implicit": ([HERE / "spatial_bodies.toml", *IMPLICIT, *FIXED, "integrator.substeps=1",
                                   "parallel.imbalance=0.0", "time.end=0.08"], (2,)),
    "elements in space, implicit": ([*ELEMENTS, *IMPLICIT, *FIXED, "integrator.substeps=1", "time.end=0.08"],
                                    (2, 4)),
    "meshes": ([*MESHES, "time.end=0.08"], (3,)),
    "meshes at rest": (AT_REST, (3,)),
    "crates on planes": ([HERE / "crates.toml", *LINES, "parallel.imbalance=0.0"], (2, 4)),
    "crates on planes, implicit": ([HERE / "crates.toml", *IMPLICIT, *FIXED, "integrator.substeps=1",
                                    "parallel.imbalance=0.0", "time.step=8e-5"], (2, 4)),
    "meshes and their works, implicit": ([*MESHES, *WORKS, *IMPLICIT, *FIXED, "integrator.substeps=1",
                                          "time.end=0.08"], (2, 4)),
    "open surfaces with friction": ([*SHEETS, "contact.pairs.0.friction=0.4", "time.end=0.08"], (3,)),
    "open surfaces with friction, implicit": ([*SHEETS, *IMPLICIT, *FIXED, "integrator.substeps=1",
                                              "contact.pairs.0.friction=0.4", "time.end=0.08"], (4,)),
    "meshes and births, implicit": ([*BIRTHS, *IMPLICIT, *FIXED, "integrator.substeps=1", "time.step=4e-5",
                                     "time.end=0.08"], (2, 4)),
    "friction on bodies, rolling, implicit": ([HERE / "frictional_bodies.toml", *IMPLICIT, *FIXED, *ROLLING,
                                               "integrator.substeps=1", "parallel.imbalance=0.0", "time.end=0.08"],
                                              (2, 4)),
    "sticky, implicit": ([HERE / "sticky.toml", *IMPLICIT, *FIXED, "contact.pairs.0.adhesion=dmt",
                          "parallel.imbalance=0.05", "time.end=1e-3"], (2, 4)),
    "many sizes": ([HERE / "sizes.toml", "parallel.imbalance=0.0"], (2, 4)),
    "5.3, particles removed": ([*NET, "time.end=0.85", "space.leaving=remove"], (3,)),
    "valley, adaptive": ([INPUT / "paper/valley.toml", "time.control=adaptive", "time.end=0.8"], (2,)),
}
CASES = {**MAIN_CASES, **OTHER_CASES}


class ComparedTest(RanksTest):
    """Runs whose bits are compared."""
    def run_compared(self, ranks, deck, output, settings, first):
        """A run that has the bits of another; returns its counts."""
        self.run_deck(DONE, ranks, deck, output, settings)
        record = self.record(output)
        self.assertEqual(record["run"]["ranks"], ranks)
        self.assertEqual(self.hash(output), self.hash(first))
        for count in ("steps", "newton_iterations", "linear_iterations", "list_builds", "particles_escaped"):
            self.assertEqual(record["counts"][count], self.record(first)["counts"][count], count)
        self.assertEqual(self.bytes_of(output, "history.csv"), self.bytes_of(first, "history.csv"))
        for kind in ("particles", "bodies", "surfaces", "contacts", "links"):
            self.assertEqual(self.datasets(output, f"{kind}.vtkhdf"), self.datasets(first, f"{kind}.vtkhdf"), kind)
        return record["counts"]

    def assert_same_content(self, parts, whole, name):
        """The first part of a run plans the chunks of its files, for fewer snapshots than the whole run has."""
        self.assertEqual(self.datasets(parts, name, chunks=False), self.datasets(whole, name, chunks=False), name)


class SameBitsTest(ComparedTest):
    def test_every_number_of_ranks_gives_the_bits_of_one(self):
        for name, ((deck, *overrides), counts) in OTHER_CASES.items():
            migrated, settings, first = 0, [*overrides, "output.history_csv=true"], f"{name} 1"
            self.run_deck(DONE, 1, deck, first, settings)
            self.assertGreaterEqual(self.record(first)["counts"]["steps"], 500 if "adaptive" in name else 1000)
            for ranks in counts:
                with self.subTest(case=name, ranks=ranks):
                    migrated += self.run_compared(ranks, deck, f"{name} {ranks}", settings, first)["migrated"]
            self.assertGreater(migrated, 0, name)


class ContinuedTest(ComparedTest):
    def test_many_ranks_and_a_restart_on_another_number_of_them_give_the_bits_of_one(self):
        for name, ((deck, *overrides), counts) in MAIN_CASES.items():
            end = next(float(word.removeprefix("time.end=")) for word in overrides if "time.end=" in word)
            settings = [*overrides, f"output.checkpoint_interval={end / 2}", "output.history_csv=true"]
            whole, parts, moved = f"whole {name}", f"parts {name}", []
            self.run_deck(DONE, 1, deck, whole, settings)
            for ranks in counts:
                with self.subTest(case=name, ranks=ranks):
                    moved.append(self.run_compared(ranks, deck, f"{name} {ranks}", settings, whole))
            with self.subTest(case=name):
                self.run_deck(DONE, 3, deck, parts, [*settings, f"time.end={end / 2}"])
                moved.append(self.record(parts)["counts"])
                self.run_deck(DONE, 2, deck, parts, settings, "--restart", self.folder / parts / "checkpoint.h5")
                moved.append(self.record(parts)["counts"])
                self.assert_continued(name, overrides, parts, whole)
            for count in ("migrated", "rebalances"):
                self.assertGreater(sum(counts[count] for counts in moved), 0, f"{name}: {count}")

    def assert_continued(self, name, overrides, parts, whole):
        self.assertEqual(self.hash(parts), self.hash(whole))
        self.assertEqual(self.bytes_of(parts, "history.csv"), self.bytes_of(whole, "history.csv"))
        self.assert_same_content(parts, whole, "surfaces.vtkhdf")
        surfaces = self.datasets(parts, "surfaces.vtkhdf")
        self.assertEqual(surfaces is not None, results is not None and name.startswith("meshes"))
        if surfaces is not None and "works" in name:
            self.assertIn("VTKHDF/CellData/wear_depth", surfaces)
        if results is not None and LINES[0] in overrides:
            for lines in ("contacts.vtkhdf", "links.vtkhdf"):
                self.assert_same_content(parts, whole, lines)
            self.assertGreater(self.datasets(parts, "contacts.vtkhdf")["VTKHDF/CellData/first"][1][0], 10)
        for series in ("particles.vtkhdf", "bodies.vtkhdf") if surfaces is not None else ():
            self.assert_same_content(parts, whole, series)
        counts = self.record(parts)["counts"]
        self.assertGreaterEqual(counts["steps"], 1000)
        self.assertEqual(counts["history_rows"], self.record(whole)["counts"]["history_rows"])


class FilesTest(RanksTest):
    @unittest.skipIf(results is None, "needs postprocess/requirements.txt")
    def test_every_number_of_ranks_writes_the_same_files(self):
        for compression in (0, 3):
            settings = [*EXPLICIT, "integrator.substeps=3", "time.end=0.02", "output.snapshot_interval=0.01",
                        f"output.compression={compression}", f"output.fields={FIELDS}"]
            for ranks in (1, 2, 4):
                with self.subTest(compression=compression, ranks=ranks):
                    self.run_deck(DONE, ranks, DAM[0], f"{compression} {ranks}", settings)
                    for name in ("particles.vtkhdf", "bodies.vtkhdf", "history.h5", "checkpoint_end.h5"):
                        files = [self.datasets(f"{compression} {n}", name) for n in (1, ranks)]
                        self.assertEqual(files[0], files[1], name)
                    position = files[1]["real_rows/particles/position"]
                    self.assertEqual(position[3], "gzip" if compression else None)
        sizes = [(self.folder / f"{c} 4" / "checkpoint_end.h5").stat().st_size for c in (0, 3)]
        self.assertLess(sizes[1], sizes[0])

    @unittest.skipIf(results is None, "needs postprocess/requirements.txt")
    def test_every_number_of_ranks_writes_the_same_spins(self):
        deck, *settings = [*FRICTION, "time.end=0.04", "output.snapshot_interval=0.01",
                           f"output.fields={FRICTION_FIELDS}"]
        for ranks in (1, 2, 3):
            self.run_deck(DONE, ranks, deck, f"spins {ranks}", settings)
            for name in ("particles.vtkhdf", "history.h5", "checkpoint_end.h5"):
                self.assertEqual(self.datasets(f"spins {ranks}", name), self.datasets("spins 1", name), name)

    def test_ranks_without_particles_take_part(self):
        deck = self.write("lonely.toml", LONELY.replace("stiffness = 1e5", "stiffness = 1e5\nfriction = 0.5"))
        for steps in (EXPLICIT, IMPLICIT):
            for ranks in (1, 4):
                with self.subTest(steps=steps[0], ranks=ranks):
                    output = f"{steps[0]} {ranks}"
                    self.run_deck(DONE, ranks, deck, output, [*steps, "time.end=0.02"])
                    self.assertEqual(self.hash(output), self.hash(f"{steps[0]} 1"))

    def test_every_element_in_space_acts_among_the_grains(self):
        deck, *overrides = ELEMENTS
        self.run_deck(DONE, 1, deck, "elements", [*overrides, "output.history_csv=true"])
        columns = self.columns("elements")

        def ends(element, unit):
            values = columns[f"efforts/{element}/effort [{unit}]"]
            return min(values), max(values)
        self.assertEqual(ends("drive", "N m")[1], 5)  # its limit, for a time
        self.assertLess(ends("drive", "N m")[0], 4.9)
        self.assertGreater(ends("winder", "N m")[1] - ends("winder", "N m")[0], 0.01)
        self.assertGreater(ends("coil", "N")[1] - ends("coil", "N")[0], 0.1)
        self.assertEqual(ends("stop", "N m")[1], 0)
        self.assertLess(ends("stop", "N m")[0], -1)
        self.assertEqual(ends("dry", "N m"), (-0.05, 0.05))  # slides both ways
        self.assertGreater(ends("friction", "N m")[1], 0.1)
        self.assertGreater(max(columns["coordinates/axle/angle [rad]"]), math.pi)  # counted
        self.assertGreater(max(columns["bushings/rubber/fy [N]"]), 10)
        self.assertLess(min(columns["reactions/mesh/torque_z [N m]"]), -0.1)
        for body in ("swing", "drum", "paddle", "nut", "gate", "tassel"):
            self.assertGreater(max(columns[f"contacts/{body}/contacts [1]"]), 0, body)

    def test_velocities_found_at_the_start_and_reactions_that_oscillate(self):
        deck = INPUT / "examples/hold_and_move.toml"
        for ranks in (1, 2):
            self.run_deck(DONE, ranks, deck, f"held {ranks}", ["time.end=0.03"])
            self.assertIn("from 0.0 to 6.28", self.record(f"held {ranks}")["run"]["start_change"])
            text = self.run_deck(FAILED, ranks, deck, f"oscillating {ranks}", ["integrator.hht_alpha=0.0"]).stderr
            self.assertEqual(text.count("integrator.hht_alpha = 0 does not damp; set it below zero"), 1)
        self.assertEqual(self.hash("held 1"), self.hash("held 2"))
        self.assertEqual(self.hash("oscillating 1"), self.hash("oscillating 2"))

    def test_a_stop_condition_ends_any_number_of_ranks_at_the_same_step(self):
        region = '{name="right", kind="cylinder", ends=[[0.6, 0.1, 0.2], [2.0, 0.1, 0.2]], radius=0.15}'
        settings = [*EXPLICIT, "integrator.substeps=3", f"output.history_regions=[{region}]", "output.history_csv=true",
                    "output.history_interval=2e-3", "parallel.imbalance=0.05",
                    'stop=[{column="regions/right/mass", above=2.3, over=0.03}, {column="energy/kinetic", above=1e9}]']
        for ranks in (1, 2, 4):
            with self.subTest(ranks=ranks):
                self.run_deck(DONE, ranks, DAM[0], f"stop {ranks}", settings)
                run, first = self.record(f"stop {ranks}"), self.record("stop 1")
                self.assertIn('"0": regions/right/mass above 2.3 for 0.03 s; ', run["run"]["stop_condition"])
                self.assertEqual(run["run"]["stop_condition"], first["run"]["stop_condition"])
                self.assertEqual((self.hash(f"stop {ranks}"), run["counts"]["steps"]),
                                 (self.hash("stop 1"), first["counts"]["steps"]))
                self.assertEqual(self.bytes_of(f"stop {ranks}", "history.csv"),
                                 self.bytes_of("stop 1", "history.csv"))
        self.assertGreater(self.record("stop 4")["counts"]["migrated"], 0)
        settings = [*settings, "output.checkpoint_interval=0.025"]
        self.run_deck(DONE, 3, DAM[0], "whole", settings)
        self.run_deck(DONE, 2, DAM[0], "rest", settings, "--restart", self.folder / "whole/checkpoint.h5")
        self.assertEqual(self.hash("rest"), self.hash("whole"))

    def test_uneven_loads_move_the_boxes(self):
        deck, *overrides = MAIN_CASES["dam break, explicit"][0]
        log = self.run_deck(DONE, 4, deck, "dam", [*overrides, "parallel.imbalance=0.1"]).stdout
        self.assertEqual(log.count("\nt = "), 11)  # progress is one line per tenth, then the summary
        self.assertNotIn("\r", log)
        record = self.record("dam")
        self.assertGreater(record["counts"]["rebalances"], 0)
        self.assertGreater(record["measures"]["largest_imbalance"], 0.1)

    def test_lists_built_often_and_seldom_give_the_bits_of_frictional_particles(self):
        cases = {deck: [] for deck in ("friction", "friction_hertz", "rolling", "frictional_bodies", "spatial_elements",
                                    "meshes", "mesh_walls", "sticky_meshes", "bridges")}
        size = {"sticky_meshes": 0.02, "bridges": 0.02}  # of a deck's lengths
        cases["meshes"] = [*WORKS, "contact.pairs.1.wear_coefficient=3e-12"]
        cases["spatial_bodies"] = [*IMPLICIT, *FIXED, "integrator.substeps=1", "time.end=0.04"]  # steps begin anew
        for deck, overrides in cases.items():
            builds = []
            for skin in (1e-5, 1e-3, 8e-3):
                output = f"{deck} {skin}"
                self.run_deck(DONE, 2, HERE / f"{deck}.toml", output,
                              [*overrides, f"contact.skin={skin * size.get(deck, 1)}", "output.history_csv=true"])
                first = f"{deck} 1e-05"
                self.assertEqual(self.hash(output), self.hash(first), deck)
                self.assertEqual(self.bytes_of(output, "history.csv"), self.bytes_of(first, "history.csv"))
                builds.append(self.record(output)["counts"]["list_builds"] / self.record(output)["counts"]["steps"])
            self.assertGreater(builds[0], 0.4, deck)
            self.assertLess(builds[2], 0.1, deck)


if __name__ == "__main__":
    unittest.main(verbosity=2)
