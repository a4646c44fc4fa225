"""What check and run say of the deck's steps, and what they choose. Usage: SCREE=path/to/scree python3 test_steps.py"""

import json
import re
import unittest

from test_cli import BAD_INPUT, DONE, CommandLineTest

TWO_RANKS = ("mpirun", "--oversubscribe", "-n", "2")
# Spheres with friction fall into a funnel. Nothing is said of integrators and steps.
HOPPER = """
gravity = [0.0, 0.0, -9.81]
[space]
dimension = 3
min = [-0.2, -0.2, -0.2]
max = [0.2, 0.2, 1.0]
leaving = "remove"
[time]
end = 0.02
[[contact.pairs]]
stiffness = 2e4
restitution = 0.5
friction = 0.4
[[meshes]]
name = "hopper"
kind = "funnel"
radius = 0.03
top_radius = 0.15
length = 0.2
[[walls]]
name = "hopper"
mesh = "hopper"
[[particles]]
name = "grains"
kind = "lattice"
origin = [-0.045, -0.045, 0.1]
spacing = [0.021, 0.021, 0.021]
size = [5, 5, 36]
count = 900
radius = 0.01
density = 2500.0
"""


class StepsTest(CommandLineTest):
    def test_check_and_run_say_what_the_step_makes_of_impacts(self):
        damped = ("--set", "contact.pairs.0.damping=90.0", "--set", "time.end=0.02")
        fine = self.expect(DONE, "check", self.deck, *damped)
        self.assertRegex(fine.stdout, r"restitution: 0\.5\d+; in steps of 0\.0001 s: 0\.5\d+, error 0\.\d+ %; "
                         r"steps up to 0\.000\d+ s: error at most 2 %\n")
        self.assertNotIn("has an error of", fine.stderr)
        coarse = (*damped, "--set", "time.step=1e-2")
        warning = (r"warning: time\.step: with steps of 0\.01 s the rebound of \"default\" on \"default\" has an error "
                   r"of \d+ %: restitution 0\.\d+ instead of restitution 0\.5\d+; the error is at most 2 % with steps "
                   r"up to 0\.000\d+ s, and 0\.01 % with time\.control = \"adaptive\"\n")
        self.assertRegex(self.expect(DONE, "check", self.deck, *coarse).stderr, warning)
        log = self.run_deck(DONE, "out", *coarse)
        self.assertEqual(len(re.findall(warning, log.stdout + log.stderr)), 1)
        self.assertIn("has an error of", (self.folder / "out/run_record.json").read_text())
        adaptive = self.expect(DONE, "check", self.deck, *damped, "--set", "time.control=adaptive").stdout
        self.assertIn("in adaptive steps of about ", adaptive)

    def test_a_deck_that_names_neither_integrator_nor_step_runs_at_full_speed(self):
        deck = self.write("hopper.toml", HOPPER)
        said = self.expect(DONE, "check", deck)
        self.assertEqual(said.stderr, "")
        step = re.search(r"fixed step (\S+) s \((\d+) steps\)\n {15}chosen: (.+)\n", said.stdout)
        self.assertIn("within 2 %", step[3])
        self.assertIn("particles velocity-verlet, 1 substep\n               chosen: 900 particles may touch, with "
                      "friction: from 20 on", said.stdout)
        hashes = []
        for name, launcher in (("one", ()), ("two", TWO_RANKS)):
            out = self.folder / name
            log = self.expect(DONE, "run", deck, "--output", out, launcher=launcher).stdout
            for chosen in ('chosen: integrator.particles = "velocity-verlet" (900 particles',
                           f"chosen: time.step = {step[1]} ({step[3]})"):
                self.assertIn(chosen, log)
            record = json.loads((out / "run_record.json").read_text())
            self.assertEqual(record["counts"]["steps"], int(step[2]))
            self.assertEqual(record["warnings"], [])
            hashes.append(record["run"]["state_hash"])
            for line in ('particles = "velocity-verlet"  # chosen: ', f"step = {step[1]}  # chosen: ",
                         'control = "fixed"\n'):
                self.assertIn(line, record["run"]["resolved_deck"])
        self.assertEqual(*hashes)
        # A deck that names what was chosen is the same deck, and goes on from the checkpoint.
        named = ["--set", "integrator.particles=velocity-verlet", "--set", f"time.step={step[1]}",
                 "--set", "time.end=0.021"]
        restart = ["--restart", self.folder / "one/checkpoint_end.h5", "--output", self.folder / "one"]
        self.expect(DONE, "run", deck, *named, *restart)
        refused = self.expect(BAD_INPUT, "run", deck, "--set", "integrator.particles=hht", *restart).stderr
        self.assertIn('integrator.particles: "velocity-verlet" -> "hht"', refused)

    def test_a_named_integrator_is_taken_and_so_is_what_names_one(self):
        deck = self.write("hopper.toml", HOPPER)
        for words, reason in ((("integrator.particles=hht",), None), (("time.control=adaptive",), "time.control"),
                              (("time.tolerance=1e-7",), "time.tolerance"),
                              (("particles.grains.count=19",), "19 particles")):
            said = self.expect(DONE, "check", deck, *[word for each in words for word in ("--set", each)]).stdout
            self.assertIn("particles HHT, too\n", said)
            chosen = re.search(r"particles HHT, too\n {15}chosen: (.+)\n", said)
            self.assertEqual(chosen is not None, reason is not None)
            self.assertTrue(reason is None or reason in chosen[1])
            self.assertRegex(said, r"adaptive steps from .*\n {15}\d+ steps without any contact, "
                                   r"about \S+ of \S+ s with contacts at all times\n")

    def test_a_wall_faster_than_the_contacts_are_stiff_is_warned_of(self):
        wall = ('[[walls]]\nname = "plate"\npoint = [0, 0, -0.1]\nnormal = [0, 0, 1]\n'
                '[[walls.motions]]\ntype = "translation"\ndirection = [0, 0, 1]\n'
                'displacement = { kind = "sine", amplitude = 0.02, frequency = 600.0 }\n')
        deck = self.write("plate.toml", HOPPER + wall)
        warning = r"the stiffness is too low for impacts at \S+ m/s .* move at up to 75\.4 m/s\)"
        self.assertRegex(self.expect(DONE, "check", deck).stderr, warning)
        self.expect(DONE, "run", deck, "--output", self.folder / "plate", "--set", "time.end=1e-4")
        self.assertRegex((self.folder / "plate/run_record.json").read_text(), warning)


if __name__ == "__main__":
    unittest.main(verbosity=2)
