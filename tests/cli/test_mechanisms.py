"""What the program says of joints and drivers: contradictions, redundancy, energy. Usage: as test_cli.py"""

import json
import math
import unittest

from test_cli import BAD_INPUT, DONE, FAILED, CommandLineTest

# Turned once in a second.
CRANK = """\
gravity = [0.0, 0.0, 0.0]

[space]
dimension = 3
min = [-3.0, -3.0, -3.0]
max = [3.0, 3.0, 3.0]
leaving = "ballistic"

[time]
end = 1.0

[output]
history_interval = 1e-2

[[bodies]]
name = "crank"
kind = "spatial"
position = [0.25, 0.0, 0.0]
mass = 2.0
inertia_tensor = [0.01, 0.05, 0.05, 0.0, 0.0, 0.0]
velocity = [0.0, 1.5707963267948966, 0.0]
body_angular_velocity = [0.0, 0.0, 6.283185307179586]

[[joints]]
name = "hinge"
type = "revolute"
bodies = ["ground", "crank"]
point = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
"""
DRIVEN = '\n[[drivers]]\nname = "{}"\njoint = "hinge"\nmotion = {}\n'
RAMP = '{{ kind = "ramp", value = {}, rate = {} }}'
TURN = "6.283185307179586"
FIRST = CRANK + DRIVEN.format("first", RAMP.format(0.0, TURN))


class EnergyTest(CommandLineTest):
    def warnings(self, deck, *settings):
        words = [word for setting in settings for word in ("--set", setting)]
        result = self.expect(DONE, "run", self.write("crank.toml", deck), "--output", self.folder / "out",
                             "--overwrite", *words)
        record = json.loads((self.folder / "out/run_record.json").read_text())
        self.assertRegex(result.stdout, r"J exchanged, [-+.0-9e]+ J taken out by the time integration; ")
        return record["warnings"], record["measures"]

    def test_a_crank_at_constant_speed_exchanges_next_to_nothing(self):
        for steps in ((), ("time.control=fixed", "time.step=5e-3")):
            warnings, measures = self.warnings(CRANK + DRIVEN.format("drive", RAMP.format(0.0, TURN)), *steps)
            self.assertGreater(abs(measures["energy_taken_by_integrator"]), 0.01 * measures["energy_exchanged"])
            self.assertEqual(warnings, [])

    def test_steps_that_are_too_long_for_it(self):
        warnings, _ = self.warnings(CRANK, "time.control=fixed", "time.step=0.05", "output.history_interval=0.05",
                                    "time.end=5", "integrator.hht_alpha=-0.3")
        self.assertIn("the time integration has changed the energy by ", warnings[0])


# A parallelogram of bars of 1 and 2 m, its cranks at an angle that a driver turns at 1 rad/s.
FOUR_BAR = """\
gravity = [0.0, 0.0]

[space]
dimension = 2
min = [-3.0, -3.0]
max = [3.0, 3.0]
leaving = "ballistic"

[time]
end = 1.0
step = 0.01
control = "fixed"

[output]
history_interval = 0.0
"""


def four_bar(angle, start):
    """With the velocities of the driver, which starts at `start`."""
    x, y = math.cos(angle), math.sin(angle)
    bodies = (("crank", x / 2, y / 2, 0.5, angle), ("coupler", 1 + x, y, 1, None),
              ("rocker", 2 + x / 2, y / 2, 0.5, angle))
    joints = (("foot", "ground", "crank", 0.0, 0.0), ("left", "crank", "coupler", x, y),
              ("right", "coupler", "rocker", 2 + x, y), ("end", "rocker", "ground", 2.0, 0.0))
    deck = FOUR_BAR
    for name, px, py, reach, turned in bodies:
        deck += (f'\n[[bodies]]\nname = "{name}"\nposition = [{px}, {py}]\nvelocity = [{-reach * y}, {reach * x}]\n'
                 "mass = 1.0\ninertia = 0.1\n")
        deck += "" if turned is None else f"angle = {turned}\nangular_velocity = 1.0\n"
    for name, one, two, px, py in joints:
        deck += f'\n[[joints]]\nname = "{name}"\ntype = "revolute"\nbodies = ["{one}", "{two}"]\npoint = [{px}, {py}]\n'
    return deck + f'\n[[drivers]]\nname = "drive"\njoint = "foot"\nmotion = {RAMP.format(start, 1.0)}\n'


class ContradictionTest(CommandLineTest):
    """With the line of the deck's table and its name, by check and run alike, however many rows are redundant."""

    def refusals(self, deck, *settings):
        path = self.write("bad.toml", deck)
        words = [word for setting in settings for word in ("--set", setting)]
        for command in ("check", "run"):
            yield self.expect(BAD_INPUT, command, path, *words).stderr.removeprefix("error: ")

    def line(self, deck, name):
        """Of the table with this name."""
        lines = deck.splitlines()
        return max(i for i in range(1, lines.index(f'name = "{name}"') + 1) if lines[i - 1].startswith("[["))

    def test_two_drivers_of_one_joint(self):
        for second, what in (((0.1, TURN), "positions that they require at t = 0 differ by 0.1 rad"),
                             ((0.0, 6.0), "velocities that they require at t = 0 differ by 0.283185 rad/s")):
            deck = FIRST + DRIVEN.format("second", RAMP.format(*second))
            place = f"{self.folder / 'bad.toml'}:{self.line(deck, 'second')}:1: drivers.second: "
            for redundant in ("error", "minimum-norm"):
                for text in self.refusals(deck, f"integrator.redundant={redundant}"):
                    self.assertEqual(text, f"{place}driver 'first', driver 'second' contradict each other: the {what}, "
                                           "and no motion satisfies them all. Change or remove one\n")

    def test_two_drivers_that_agree_are_redundant_and_may_share(self):
        deck = FIRST + DRIVEN.format("second", RAMP.format(0.0, TURN))
        for text in self.refusals(deck):
            self.assertIn(f"bad.toml:{self.line(deck, 'second')}:1: drivers.second: redundant constraints: ", text)
            self.assertIn('set integrator.redundant = "minimum-norm"', text)
            self.assertNotIn("singular", text)
        self.expect(DONE, "check", self.write("good.toml", deck), "--set", "integrator.redundant=minimum-norm")

    def test_a_driver_of_a_joint_that_another_one_holds(self):
        weld = '\n[[joints]]\nname = "weld"\ntype = "fixed"\nbodies = ["ground", "crank"]\npoint = [0.0, 0.0, 0.0]\n'
        for text in self.refusals(CRANK + weld + DRIVEN.format("drive", RAMP.format(0.0, TURN))):
            self.assertIn(": drivers.drive: joint 'weld', driver 'drive' contradict each other: the velocities", text)
            self.assertIn("differ by 6.28319 rad/s", text)

    def test_start_velocities_and_where_a_driver_starts(self):
        deck = CRANK + DRIVEN.format("drive", RAMP.format(0.0, 6.0))
        for text in self.refusals(deck):
            self.assertIn(f"bad.toml:{self.line(deck, 'drive')}:1: drivers.drive: driver 'drive': the velocities at "
                          "t = 0 contradict it by 0.283185 rad/s", text)
        for text in self.refusals(CRANK.replace("1.5707963267948966", "1.5")):
            self.assertIn(f"bad.toml:{self.line(CRANK, 'hinge')}:1: joints.hinge: joint 'hinge': the velocities", text)
        for text in self.refusals(CRANK + DRIVEN.format("drive", RAMP.format(0.2, TURN))):
            self.assertIn(": drivers.drive: driver 'drive': its motion and the joint's coordinate at t = 0 "
                          "differ by 0.2 rad",
                          text)

    def test_a_linkage_that_lies_flat(self):
        deck = four_bar(0.0, 0.0)
        for text in self.refusals(deck):
            self.assertIn("as in a flat linkage, the position is singular: permit it, or start elsewhere", text)
        share = ("--set", "integrator.redundant=minimum-norm")
        self.expect(DONE, "check", self.write("flat.toml", deck), *share)
        # The velocities with the least energy: the rocker's are not the crank's, and no motion goes on from there.
        resting = "".join(line for line in deck.splitlines(True) if "velocity" not in line)
        for text in self.refusals('velocities = "consistent"\n' + resting, share[1]):
            self.assertIn("no motion continues the velocities there", text)

    def test_a_linkage_that_comes_to_lie_flat(self):
        deck = self.write("flat.toml", four_bar(-0.5, -0.5))
        text = self.expect(FAILED, "run", deck, "--output", self.folder / "out").stderr
        self.assertIn("no convergence in 50 iterations", text)
        self.assertIn('it is singular; integrator.redundant = "minimum-norm" passes it', text)
        self.assertIn("driver 'drive' are redundant in this position", text)
        self.expect(DONE, "run", deck, "--output", self.folder / "shared", "--set", "integrator.redundant=minimum-norm")


SOLIDS = """
[[bodies]]
name = "{}"
kind = "spatial"
position = [{}, 2.0, 0.0]
solids = [{{ kind = "box", size = [0.1, 0.2, 0.3], offset = [0.5, 0.0, 0.0], density = 1000.0 }}]
{}"""


class CheckTest(CommandLineTest):
    def report(self, deck, *settings):
        words = [word for setting in settings for word in ("--set", setting)]
        return self.expect(DONE, "check", self.write("check.toml", deck), *words).stdout

    def test_bodies_of_solids_are_weighed(self):
        row = "count = 3\nspacing = [0.0, 0.0, 0.5]\n"
        report = self.report(CRANK + SOLIDS.format("block", 0.0, "") + SOLIDS.format("row", 2.0, row))
        weight = ("6 kg, centre of mass (0.5, 0, 0) m, inertia there principal 0.025, 0.05, 0.065 kg m^2\n")
        self.assertIn(f'\nsolids         body "block": {weight}', report)
        self.assertIn(f'\nsolids         row "row", each: {weight}', report)
        self.assertEqual(report.count("\nsolids "), 2)  # not the crank, and the row once
        planar = self.report(
            four_bar(0.5, 0.5).replace("mass = 1.0\ninertia = 0.1", 'solids = [{ kind = "cylinder", radius = 0.1, '
                                       "length = 0.5, density = 100.0 }]"))
        self.assertIn('solids         body "crank": 1.5708 kg, centre of mass (0, 0) m, inertia there 0.00785398 kg '
                      "m^2 about z\n", planar)

    def test_what_the_history_leaves_out(self):
        deck = CRANK + DRIVEN.format("drive", RAMP.format(0.0, TURN))
        self.assertNotIn("\nhistory        without", self.report(deck))
        self.assertIn("\nhistory        without 1 of the 2 joints, drivers and couplers: output.history_reactions = "
                      "1\n", self.report(deck, "output.history_reactions=1"))
        # None is wanted.
        self.assertNotIn("\nhistory        without", self.report(deck, "output.history_reactions=0"))


# A rod of 0.3 m between a crank of 0.1 m and a slider, which is driven out to `reach` + travel.
def slider_crank(angle, motion):
    x, y = 0.1 * math.cos(angle), 0.1 * math.sin(angle)
    slider = x + math.sqrt(0.09 - y * y)
    deck = 'velocities = "consistent"\n' + FOUR_BAR.replace("step = 0.01\ncontrol", "step = 1e-3\ncontrol")
    for name, px, py, turned in (("crank", x / 2, y / 2, angle), ("rod", (x + slider) / 2, y / 2, -math.asin(y / 0.3)),
                                 ("slider", slider, 0.0, 0.0)):
        deck += (f'\n[[bodies]]\nname = "{name}"\nposition = [{px}, {py}]\nangle = {turned}\nmass = 1.0\n'
                 "inertia = 1e-3\n")
    for name, one, two, px, py in (("pivot", "ground", "crank", 0.0, 0.0), ("pin", "crank", "rod", x, y),
                                   ("wrist", "rod", "slider", slider, 0.0)):
        deck += f'\n[[joints]]\nname = "{name}"\ntype = "revolute"\nbodies = ["{one}", "{two}"]\npoint = [{px}, {py}]\n'
    deck += '\n[[joints]]\nname = "guide"\ntype = "translational"\nbodies = ["ground", "slider"]\naxis = [1.0, 0.0]\n'
    return deck + f'\n[[drivers]]\nname = "push"\njoint = "guide"\nmotion = {motion}\n', slider


class DeadPointTest(CommandLineTest):
    """The driver is named, whatever the steps, and no advice is given that does not pass the dead point."""

    def failure(self, deck, *settings):
        words = [word for setting in settings for word in ("--set", setting)]
        result = self.expect(FAILED, "run", self.write("reach.toml", deck), "--output", self.folder / "out",
                             "--overwrite", *words)
        self.assertIn("driver 'push' asks for a motion that the mechanism cannot follow", result.stderr)
        for name in ("'pivot'", "'pin'", "'wrist'"):
            self.assertIn(f"joint {name}", result.stderr)
        for advice in ("min_step", "tolerance;", "passes"):
            self.assertNotIn(advice, result.stderr)
        return result.stderr

    def test_a_slider_that_is_driven_past_its_reach(self):
        deck, start = slider_crank(0.5, RAMP.format(0.0, 0.1))
        for settings in ((), ("time.control=adaptive",), ("integrator.redundant=minimum-norm",),
                         ("time.control=adaptive", "integrator.redundant=minimum-norm")):
            time = float(self.failure(deck, *settings).split("t = ")[1].split(" ")[0])
            self.assertAlmostEqual(time, (0.4 - start) / 0.1, 3)

    def test_one_that_jumps_past_it(self):
        """Within a step or a few: the last good state is not as near to the dead point as after a slow approach."""
        motion = 'motion = { kind = "step", value = 0.0, end_value = 0.3, start = 0.1, end = 0.11 }'
        deck, _ = slider_crank(0.5, motion.removeprefix("motion = "))
        for settings in (("time.step=0.01",), ("time.step=1e-3",), ("time.control=adaptive",)):
            self.failure(deck, *settings)

    def test_a_start_at_the_dead_point(self):
        """Shared reactions do not pass it: no advice says so, and with them the run names the driver."""
        motion = '{ kind = "step", value = 0.0, end_value = 0.05, start = 0.0, end = 0.5 }'
        path = self.write("flat.toml", slider_crank(0.0, motion)[0])
        text = self.expect(BAD_INPUT, "check", path).stderr
        self.assertIn("drivers.push: driver 'push' asks for a motion that the mechanism cannot follow: its position at "
                      "t = 0 is a dead point, where joint 'pivot', joint 'pin', joint 'wrist', driver 'push' are "
                      "dependent", text)
        self.assertIn('redundant = "minimum-norm" does not pass it', text)
        result = self.expect(FAILED, "run", path, "--output", self.folder / "flat",
                             "--set", "integrator.redundant=minimum-norm", "--set", "time.control=adaptive")
        self.assertIn("driver 'push' asks for a motion that the mechanism cannot follow", result.stderr)

    def test_a_driver_that_turns_its_joint_too_far_in_a_step(self):
        motion = '{ kind = "step", end_value = 3.5, start = 0.1, end = 0.11 }'
        deck = 'velocities = "consistent"\n' + CRANK + DRIVEN.format("drive", motion)
        path = self.write("turns.toml", deck)
        warned = "driver 'drive' rotates its joint by 6.56 rad in a step of 0.01 s at its fastest"
        self.assertIn(warned, self.expect(DONE, "check", path, "--set", "time.control=fixed", "--set",
                                          "time.step=0.01").stderr)
        self.assertNotIn("rotates its joint", self.expect(DONE, "check", path, "--set", "time.control=fixed", "--set",
                                                         "time.step=1e-4").stderr)

    def test_one_that_comes_to_rest_there(self):
        motion = "{{ kind = \"step\", value = 0.0, end_value = {}, start = 0.1, end = 0.6 }}"
        _, start = slider_crank(0.5, "0.0")
        self.failure(slider_crank(0.5, motion.format(0.4 - start + 1e-3))[0])
        within = self.write("within.toml", slider_crank(0.5, motion.format(0.99 * (0.4 - start)))[0])
        self.expect(DONE, "run", within, "--output", self.folder / "within")


STOP = """
[[joint_limits]]
name = "stop"
joint = "hinge"
{}
stiffness = {}
"""


class StartTest(CommandLineTest):
    def both(self, code, deck):
        path = self.write("start.toml", deck)
        for words in (("check", path), ("run", path, "--output", self.folder / "out", "--overwrite")):
            yield self.expect(code, *words).stderr

    def resting(self, stop):
        """The arm lies level, at angle 0; its weight acts at 0.25 m."""
        deck = CRANK.replace("gravity = [0.0, 0.0, 0.0]", "gravity = [0.0, -10.0, 0.0]")
        deck = deck.replace("end = 1.0", "end = 0.01")
        return "".join(line for line in deck.splitlines(True) if "velocity" not in line) + stop

    def test_a_stop_that_holds_more_than_can_be_meant_is_refused(self):
        for side, words in (("lower = 0.5", "below lower = 0.5"), ("upper = -0.5", "above upper = -0.5")):
            for text in self.both(BAD_INPUT, self.resting(STOP.format(side, 1e6))):
                self.assertIn("joint limit 'stop': violated at t = 0: joint 'hinge' is at 0 rad, 0.5 rad " + words,
                              text)
                self.assertIn("stores 1.25e+05 J", text)
                self.assertIn("start the joint within its limits, or move this one", text)
                self.assertNotIn("step", text)

    def test_one_that_is_passed_by_little_is_warned_of(self):
        for text in self.both(DONE, self.resting(STOP.format("lower = 1e-3", 1e5))):
            self.assertIn("warning: joint limit 'stop': violated at t = 0: joint 'hinge' is at 0 rad, 0.001 rad "
                          "below lower = 0.001. The limit starts with 100 N m, stores 0.05 J and accelerates the joint",
                          text)

    def test_one_that_a_weight_rests_on_is_not(self):
        for side in ("lower = 5e-5", "lower = 0.0", "upper = 0.0"):
            for text in self.both(DONE, self.resting(STOP.format(side, 1e5))):
                self.assertEqual(text, "")

    def test_angles_that_look_like_degrees(self):
        turned = "rotation_axis = [1.0, 0.0, 0.0]\nrotation_angle = "
        deck = CRANK.replace("[[joints]]", turned + "45.0\n\n[[joints]]", 1).replace("[0.0, 0.0, 6.283185307179586]",
                                                                                     "[0.0, 0.0, 0.0]")
        deck = "".join(line for line in deck.splitlines(True) if "velocity" not in line).partition("[[joints]]")[0]
        for text in self.both(DONE, deck):
            self.assertIn("bodies.crank.rotation_angle = 45.0: 45 rad are 7.16 revolutions; angles are in radians: 45 "
                          "degrees are 0.785398", text)
        for text in self.both(DONE, deck.replace("45.0", "6.28")):
            self.assertEqual(text, "")


if __name__ == "__main__":
    unittest.main()
