"""Runs that fail, that go on from a checkpoint, and with another deck. Usage: as test_cli.py"""

import itertools
import json
import re
import shutil
import signal
import subprocess
import time
import unittest

from test_cli import (BAD_INPUT, DECK, DONE, ENVIRONMENT, EXPLICIT, FAILED, IO_FAILED, LIMIT, SCREE, STOPPED,
                      CommandLineTest)

FUNNEL = """gravity = [0, 0, -10]
[space]
dimension = 3
min = [-1, -1, -1]
max = [1, 1, 1]
[time]
end = 0.2
step = 1e-4
control = "fixed"
[integrator]
particles = "velocity-verlet"
[[contact.pairs]]
stiffness = 1e4
damping = 1.0
[[meshes]]
name = "funnel"
kind = "funnel"
radius = 0.05
top_radius = 0.5
length = 0.3
segments = 400
feature_angle = 0.005
[[walls]]
name = "funnel"
mesh = "funnel"
[[particles]]
kind = "random"
count = 200
min = [-0.3, -0.3, 0.3]
max = [0.3, 0.3, 0.6]
radius = 0.02
mass = 0.05
"""

# A soft grain whose centre goes through a sheet comes back.
SHEET = """[space]
dimension = 3
min = [-1, -1, -1]
max = [1, 1, 1]
[time]
end = 0.05
step = 1e-4
control = "fixed"
[[contact.pairs]]
stiffness = 7.0
[[meshes]]
name = "sheet"
kind = "rectangle"
size = [0.5, 0.5]
[[walls]]
name = "sheet"
mesh = "sheet"
[[particles]]
kind = "list"
positions = [[0, 0, 0.06]]
radius = 0.05
mass = 0.01
velocity = [0, 0, -2]
[output]
history_csv = true
history_particles = [0]
"""


class ChangesTest(CommandLineTest):
    def test_a_failed_run_goes_on_with_half_the_step(self):
        stiff = ("--set", "time.step=2e-3", "--set", "time.min_step=2e-3", "--set", "integrator.max_iterations=5")
        self.run_deck(FAILED, "out", *stiff)
        restart = ("--restart", self.folder / "out/checkpoint_failed.h5")
        smaller = ("--set", "time.step=1e-4", "--set", "time.min_step=1e-6", "--set", "time.end=0.4")
        self.assertIn("time.step: 0.002 -> 0.0001", self.run_deck(BAD_INPUT, "out", *restart, *smaller).stderr)
        result = self.run_deck(DONE, "out", *restart, *smaller, "--allow-changes")
        self.assertIn("warning: --allow-changes", result.stderr)
        record = json.loads((self.folder / "out/run_record.json").read_text())
        self.assertTrue(any("not bit for bit" in warning for warning in record["warnings"]))
        self.assertTrue(any(": time.step: 0.002 -> 0.0001" in line for line in record["run"]["changes"]))

    def test_every_refusal_names_the_key(self):
        wall = 'walls=[{name="floor",point=[0.0,-0.9],normal=[0.0,1.0]}]'
        self.run_deck(DONE, "out", "--set", wall, "--set", "time.end=0.01")
        restart = ("run", self.deck, "--output", "out", "--restart", "out/checkpoint_end.h5", "--set", wall, "--set",
                   "time.end=0.02")
        for setting, code, key in (
                ("output.history_bodies=[]", IO_FAILED, "keep output.history_bodies unchanged"),
                ("output.history_particles=[0]", IO_FAILED, "keep output.history_particles unchanged"),
                ('output.history_contacts=["pad"]', IO_FAILED, "keep output.history_contacts unchanged"),
                ('output.fields=["radius"]', IO_FAILED, "keep output.fields unchanged"),
                ("output.contacts=true", IO_FAILED, "set output.contacts = false"),
                ("output.links=false", IO_FAILED, "set output.links = true"),
                ("time.end=0.005", BAD_INPUT, "time.end"), ("gravity=[0.0,-5.0]", BAD_INPUT, "gravity: "),
                ("bodies.0.mass=2.0", BAD_INPUT, "bodies.pad.mass: ")):
            with self.subTest(setting=setting):
                self.assertIn(key, self.expect(code, *restart, "--set", setting).stderr)
        for setting, key in (("particles.0.size=[3,2]", "particles.discs.size: "),
                             ("walls.0.surface_velocity=[1.0,0.0]", "walls.floor.surface_velocity: ")):
            with self.subTest(setting=setting):
                result = self.expect(BAD_INPUT, *restart, "--allow-changes", "--set", setting)
                self.assertRegex(result.stderr, "(?m)^error: --restart .*" + key)

    def test_contacts_with_other_meshes_begin_anew(self):
        deck, checkpoint = self.write("funnel.toml", FUNNEL), self.folder / "out/checkpoint_end.h5"
        for friction in (0.3, 0.0):
            with self.subTest(friction=friction):
                words = ("run", deck, "--overwrite", "--set", f"contact.pairs.0.friction={friction}", "--output")
                self.expect(DONE, *words, self.folder / "out")
                self.expect(DONE, *words, self.folder / "other", "--restart", checkpoint, "--allow-changes", "--set",
                            "meshes.funnel.segments=12", "--set", "time.end=0.22")

    def test_a_particle_that_penetrated_an_open_surface_keeps_its_side_where_the_law_has_another_history(self):
        deck = self.write("sheet.toml", SHEET)

        def height(output, *words):
            """Height of the particle above the open surface at the end."""
            self.expect(DONE, "run", deck, "--overwrite", "--output", self.folder / output, *words)
            head, *_, last = self.history(output)
            return float(last.split(",")[head.split(",").index("particles/0/z [m]")])

        rough = ("--set", "contact.pairs.0.friction=0.3")
        for method in ("hht", "velocity-verlet"):
            for before, after in (((), rough), (rough, ())):
                with self.subTest(method=method, before=before):
                    words = ("--set", f"integrator.particles={method}")
                    self.assertLess(height("out", *words, *before), 0)
                    restart = ("--restart", self.folder / "out/checkpoint_end.h5", "--allow-changes")
                    self.assertGreater(height("other", *words, *after, "--set", "time.end=0.2", *restart), 0.05)

    def test_a_shape_that_penetrated_an_open_surface_keeps_its_side_where_particles_attract_each_other(self):
        ball = ('[[bodies]]\nname = "ball"\nkind = "spatial"\nposition = [0, 0, 0.06]\nvelocity = [0, 0, -2]\n'
                'mass = 0.01\ninertia_tensor = [1e-5, 1e-5, 1e-5, 0, 0, 0]\nshapes = [{ radius = 0.05 }]\n')
        deck = self.write("ball.toml", SHEET.replace("[[0, 0, 0.06]]", "[[0.8, 0.8, 0.8]]").replace(
            "stiffness = 7.0\n", "stiffness = 7.0\nfriction = 0.3\nattraction = 0.001\n").replace(
                "history_particles = [0]", 'history_bodies = ["ball"]') + ball)
        heights = {}
        for output, more in (("out", ()), ("other", ("--restart", self.folder / "out/checkpoint_end.h5",
                                                     "--allow-changes", "--set", "contact.skin=2e-3",
                                                     "--set", "time.end=0.2"))):
            self.expect(DONE, "run", deck, "--overwrite", *EXPLICIT, "--output", self.folder / output, *more)
            head, *_, last = self.history(output)
            heights[output] = float(last.split(",")[head.split(",").index("bodies/ball/z [m]")])
        self.assertLess(heights["out"], 0)
        self.assertGreater(heights["other"], 0.05)

    def test_allow_changes_is_for_restarts(self):
        self.assertIn("--restart", self.run_deck(BAD_INPUT, "out", "--allow-changes").stderr)


class FailureTest(CommandLineTest):
    def failure(self, *words):
        """The message of a failed run; a restart from its last good state fails alike."""
        message = self.run_deck(FAILED, "failed", *words).stderr
        checkpoint = self.folder / "failed" / "checkpoint_failed.h5"
        self.assertTrue(checkpoint.exists())
        again = self.run_deck(FAILED, "failed", "--restart", checkpoint, *words)
        self.assertEqual(again.stderr, message)
        # What it goes on from is the good state that the message tells.
        time = re.search(r"at t = (\S+) s", message).group(1)
        self.assertRegex(again.stdout, rf"(?m)^last good state, t = [0-9.e-]+ s: {checkpoint}$")
        kept = float(re.search(r"last good state, t = (\S+) s", again.stdout).group(1))
        self.assertLessEqual(kept, float(time))
        return message

    def test_a_particle_that_leaves(self):
        for words in ((), EXPLICIT):
            with self.subTest(words=words):
                message = self.failure("--set", "space.leaving=error", "--set", "particles.0.velocity=[0, 30]", *words)
                self.assertRegex(message, r"stage accept: particle [45] is outside the domain")
                self.assertIn("space.leaving", message)

    def test_a_particle_that_goes_through_a_wall(self):
        soft = ("--set", "space.y_max=wall", "--set", "particles.0.velocity=[0, 30]",
                "--set", "contact.pairs.0.stiffness=100")
        message = self.failure(*soft)
        self.assertIn("beyond a side that is a wall: its overlap with the wall exceeded its radius; "
                      "increase the stiffness of the contact", message)
        self.assertIn("warning: contact \"default\" on \"default\": the stiffness is too low for impacts at 3", message)

    def test_a_body_that_leaves_is_counted(self):
        free = DECK[:DECK.index("[[spring_dampers]]")] + DECK[DECK.index("[[particles]]"):]
        deck = self.write("free.toml", free.replace("inertia", "velocity = [0.0, -30.0]\ninertia"))
        result = self.expect(DONE, "run", deck, "--output", "out", "--set", "time.end=0.05", "--set", "time.step=5e-4")
        warnings = re.findall(r'warning: body "pad" is outside the domain at t = ([0-9.]+) s: a body that leaves is '
                              "counted, but neither stopped nor removed", result.stderr)
        self.assertEqual(len(warnings), 1)
        self.assertAlmostEqual(float(warnings[0]), 0.8 / 30, delta=1e-3)
        self.assertRegex(result.stdout, "0 particles escaped from the domain, 1 body is outside\n")
        record = json.loads((self.folder / "out" / "run_record.json").read_text())
        self.assertEqual(record["counts"]["bodies_outside"], 1)
        rows = [row.split(",") for row in self.history("out") if not row.startswith("#")]
        column = next(i for i, name in enumerate(rows[0]) if "bodies_outside" in name)
        counts = [float(row[column]) for row in rows[1:]]
        self.assertEqual(sorted(set(counts)), [0, 1])
        self.assertEqual(counts, sorted(counts))

    def test_the_smallest_step(self):
        message = self.failure("--set", "integrator.max_iterations=2")
        self.assertIn("stage ", message)
        self.assertIn("no convergence in 2 iterations", message)
        self.assertIn("time.min_step", message)

    def test_a_force_that_is_not_finite(self):
        message = self.failure("--set", "contact.pairs.0.stiffness=1e300")
        self.assertIn("stage contact_force", message)
        self.assertRegex(message, r"particle \d is not finite|residual")

    def test_materials_that_do_not_feel_each_other(self):
        self.run_deck(DONE, "ghosts", "--set", "contact.pairs.0.stiffness=0", "--set", "contact.pairs.0.damping=0")


class RestartTest(CommandLineTest):
    VARIANTS = {"hht": (), "velocity-verlet": EXPLICIT, "adaptive": ("--set", "time.control=adaptive"),
                "periodic history": ("--set", "output.history_interval=0.0007")}
    LONGER = ("--set", "time.step=4e-6", "--set", "output.history_interval=0.001", "--set", "time.end=0.2")
    AT_END = ("--set", "output.checkpoint_interval=0.2")  # the discs have met the pad by then

    def test_a_restarted_run_ends_with_the_same_bits(self):
        for name, words in self.VARIANTS.items():
            with self.subTest(name=name):
                words = (*words, "--set", "output.checkpoint_interval=0.15")
                self.run_deck(DONE, "whole", *words)
                shutil.copytree(self.folder / "whole", self.folder / "parts", dirs_exist_ok=True)
                restarted = self.run_deck(DONE, "parts", *words, "--restart", self.folder / "parts/checkpoint.h5")
                self.assertNotIn("t = 0.2", restarted.stdout)  # it went on from 0.3 s
                self.assert_same_results("parts", "whole")

    def test_a_signal_stops_the_run_and_a_restart_completes_it(self):
        self.run_deck(DONE, "whole", *self.LONGER, *self.AT_END)
        blocked = ("env", "--block-signal=TERM", "--block-signal=USR1")
        for number, launcher in itertools.product((signal.SIGTERM, signal.SIGUSR1), ((), blocked)):
            with self.subTest(signal=number.name, launcher=launcher):
                run = self.start("parts", *self.LONGER, *self.AT_END, launcher=launcher)
                run.send_signal(number)
                text = run.stdout.read()
                self.assertEqual(run.wait(LIMIT), STOPPED, text)
                self.assertIn("continue with --restart", text)
                self.run_deck(DONE, "parts", *self.LONGER, *self.AT_END, "--restart",
                              self.folder / "parts/checkpoint.h5")
                self.assert_same_results("parts", "whole")

    LONG = ("--set", "time.step=4e-6", "--set", "output.history_interval=0.001")

    def stopped(self, run, number):
        """A run that the signal has ended with a checkpoint."""
        run.send_signal(number)
        text = run.stdout.read()
        self.assertEqual(run.wait(LIMIT), STOPPED, text)
        record = json.loads((self.folder / "out/run_record.json").read_text())["run"]
        self.assertEqual(record["status"], f"stopped by signal: {signal.strsignal(number)}")
        self.run_deck(DONE, "out", "--restart", self.folder / "out/checkpoint.h5", *self.LONG, "--set", "time.end=0.05")

    def test_every_handled_signal_stops_a_run_with_a_checkpoint(self):
        for number in (signal.SIGINT, signal.SIGHUP, signal.SIGUSR2, signal.SIGXCPU):
            with self.subTest(signal=number.name):
                self.stopped(self.start("out", *self.LONG, "--set", "time.end=0.05"), number)

    def test_an_ignored_hangup_stays_ignored(self):
        run = self.start("out", *self.LONG, "--set", "time.end=0.05", launcher=("nohup",))
        run.send_signal(signal.SIGHUP)
        self.stopped(run, signal.SIGUSR2)

    def test_a_run_goes_on_where_nobody_reads_its_log(self):
        self.run_deck(DONE, "whole", *self.LONG, "--set", "time.end=0.05")
        line = f"{SCREE} run {self.deck} --output {self.folder}/out {' '.join(self.LONG)} --set time.end=0.05"
        shell = subprocess.run(["bash", "-c", f"{line} | head -1; exit ${{PIPESTATUS[0]}}"], cwd=self.folder,
                               env=ENVIRONMENT, capture_output=True, text=True, timeout=LIMIT)
        self.assertEqual((shell.returncode, shell.stderr), (DONE, ""))
        self.assertEqual(len(shell.stdout.splitlines()), 1)
        self.assert_same_history("out", "whole")
        self.assertEqual(json.loads((self.folder / "out/run_record.json").read_text())["run"]["status"], "done")

    def test_a_checkpoint_by_the_clock_on_the_wall_changes_no_bit(self):
        for words in ((), EXPLICIT, ("--set", "time.control=adaptive", "--set", "time.max_step=2e-5")):
            with self.subTest(words=words):
                hashes = []
                for interval in (0, 1e-9):  # never, or at every look at any clock
                    shutil.rmtree(self.folder / "out", ignore_errors=True)
                    self.run_deck(DONE, "out", *words, "--set", "time.step=2e-5", "--set", "time.end=0.002",
                                  "--set", f"output.checkpoint_wall_interval={interval}")
                    self.assertEqual((self.folder / "out/checkpoint.h5").exists(), interval > 0)
                    record = json.loads((self.folder / "out/run_record.json").read_text())
                    hashes.append(record["run"]["state_hash"])
                self.assertEqual(*hashes)

    def test_a_killed_run_leaves_files_to_restart_from(self):
        frequent = ("--set", "output.checkpoint_interval=0.002")
        self.run_deck(DONE, "whole", *self.LONGER, *self.AT_END)
        run = self.start("parts", *self.LONGER, *frequent)
        run.kill()
        self.assertEqual(run.wait(LIMIT), -signal.SIGKILL)
        self.run_deck(DONE, "parts", *self.LONGER, *self.AT_END, "--restart", self.folder / "parts/checkpoint.h5")
        self.assert_same_results("parts", "whole")

    def test_another_deck_is_refused_but_a_later_end_is_not(self):
        self.run_deck(DONE, "out", "--set", "time.end=0.01", "--set", "output.checkpoint_interval=0.01")
        restart = ("--restart", self.folder / "out/checkpoint.h5")
        for key in ("contact.pairs.0.damping=4.0", "time.step=2e-4", "particles.0.mass=2.0"):
            message = self.run_deck(BAD_INPUT, "out", *restart, "--set", key).stderr
            self.assertIn("another deck", message)
            self.assertIn("time.end", message)
            name, value = key.split("=")
            key = re.escape(name).replace("0", "[a-z0-9]+")
            self.assertRegex(message, rf"{key}(\.value)?: \S+ -> {float(value)!r}(;|\n)")
        self.run_deck(DONE, "out", *restart, "--set", "title=corrected")
        self.run_deck(DONE, "out", *restart, "--set", "time.end=0.02")
        self.run_deck(DONE, "whole", "--set", "time.end=0.02", "--set", "output.checkpoint_interval=0.01")
        self.assert_same_history("out", "whole")

    def test_an_end_between_two_rows_has_a_row_and_the_next_ones_stay_where_they_were(self):
        def rows(output):
            return {line.split(",")[0]: line for line in self.history(output) if line[0] in "0123456789"}

        for name, words in (("fixed", ()), ("explicit", EXPLICIT),
                            ("adaptive", ("--set", "time.control=adaptive", "--set", "time.max_step=1e-4"))):
            with self.subTest(name=name):
                words = (*words, "--set", "output.history_interval=0.003")
                self.run_deck(DONE, "whole", *words, "--set", "time.end=0.02")
                self.run_deck(DONE, "parts", *words, "--set", "time.end=0.01")
                for end in ("0.01", "0.02", "0.02"):  # without a step, on, without a step
                    self.run_deck(DONE, "parts", *words, "--set", f"time.end={end}", "--restart",
                                  self.folder / "parts/checkpoint_end.h5")
                whole, parts = rows("whole"), rows("parts")
                self.assertEqual([round(float(time), 9) for time in whole],
                                 [0, 0.003, 0.006, 0.009, 0.012, 0.015, 0.018, 0.02])
                self.assertEqual(len(self.history("parts")), len(self.history("whole")) + 1)
                self.assertEqual(sorted({*whole, "0.01"}, key=float), list(parts))
                for time in list(whole)[:4]:
                    self.assertEqual(parts[time], whole[time])

    def test_a_folder_is_no_checkpoint_and_an_end_that_is_reached_is_told(self):
        self.run_deck(DONE, "out")
        message = self.run_deck(BAD_INPUT, "out", "--restart", self.folder / "out").stderr
        newest = self.folder / "out/checkpoint_end.h5"
        self.assertIn(f"must be a file, but is a folder; its newest checkpoint is {newest}\n", message)
        result = self.run_deck(DONE, "again", "--restart", self.folder / "out/checkpoint_end.h5")
        self.assertIn("nothing left to do: the run has reached time.end = 0.4 s", result.stdout)

    def test_a_finished_run_in_another_folder_has_the_row_and_the_snapshot_of_its_end(self):
        for words in ((), EXPLICIT):
            with self.subTest(words=words):
                words = (*words, "--set", "output.history_interval=0.1")
                self.run_deck(DONE, "out", *words)
                self.run_deck(DONE, "again", *words, "--restart", self.folder / "out/checkpoint_end.h5")
                (head, last), end = self.history("again"), self.history("out")[-1]
                step = head.split(",").index("step/length [s]")
                self.assertEqual(last, ",".join("0" if k == step else x for k, x in enumerate(end.split(","))))
                record = json.loads((self.folder / "again/run_record.json").read_text())
                self.assertEqual(record["counts"]["snapshots"], 1)
                # Later starts go on there.
                again = ("run", self.deck, "--output", self.folder / "again", *words, "--restart",
                         self.folder / "again/checkpoint_end.h5", "--set")
                self.expect(DONE, *again, "time.end=0.4")
                self.assertEqual(len(self.history("again")), 2)
                self.expect(DONE, *again, "time.end=0.5")
                self.assertEqual(len(self.history("again")), 3)

    def test_a_checkpoint_past_the_end_by_round_off_is_of_a_finished_run(self):
        end, periodic = ("--set", "time.end=0.009"), ("--set", "output.checkpoint_interval=0.001")
        self.assertGreater(9 * 0.001, 0.009)
        self.run_deck(DONE, "out", *end, *periodic)
        for words in (*end, *periodic), end:  # as a job of a chain does, and with other intervals
            with self.subTest(words=words):
                result = self.run_deck(DONE, "out", *words, "--restart", self.folder / "out/checkpoint.h5")
                self.assertIn("nothing left to do: the run has reached time.end = 0.009 s", result.stdout)
                self.assertIn("t = 0.009 s after 90 steps", result.stdout)
                shutil.copy(self.folder / "out/checkpoint_end.h5", self.folder / "out/checkpoint.h5")
        self.run_deck(DONE, "out", "--set", "time.end=0.02", *periodic, "--restart",
                      self.folder / "out/checkpoint.h5")
        self.run_deck(DONE, "whole", "--set", "time.end=0.02", *periodic)
        self.assert_same_history("out", "whole")
        message = self.run_deck(BAD_INPUT, "out", *end, "--restart", self.folder / "out/checkpoint_end.h5").stderr
        self.assertIn("the checkpoint is at t = 0.02 s, past time.end = 0.009 s", message)

    def test_checkpoints_that_cannot_be_read(self):
        self.run_deck(DONE, "out", "--set", "time.end=0.02", "--set", "output.checkpoint_interval=0.01")
        whole = (self.folder / "out" / "checkpoint.h5").read_bytes()
        (self.folder / "truncated.h5").write_bytes(whole[: len(whole) // 2])
        self.write("empty.h5", "")
        self.write("text.h5", "no checkpoint")
        for name in ("absent.h5", "truncated.h5", "empty.h5", "text.h5", "out/history.h5"):
            with self.subTest(name=name):
                restart = ("--set", "time.end=0.02", "--restart", self.folder / name)
                message = self.run_deck(IO_FAILED, "out", *restart).stderr
                self.assertIn(name, message)


if __name__ == "__main__":
    unittest.main()
