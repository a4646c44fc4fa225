"""The timeline of scree run --trace. Usage: as test_cli.py"""

import json
import pathlib
import subprocess
import unittest

from test_cli import BAD_INPUT, DONE, ENVIRONMENT, IO_FAILED, LIMIT, SCREE, CommandLineTest

INPUT = pathlib.Path(__file__).resolve().parents[2] / "input"
DIGGER = [INPUT / "examples/excavator.toml", "--set", "particles.bed.count=50", "--set", "time.end=0.006", "--backend",
          "cpu"]


class TraceTest(CommandLineTest):
    def trace(self, words, name="trace.json"):
        """The events of the timeline that a run wrote, {rank: [event]}, in the order of their begin."""
        self.expect(DONE, "run", *words, "--trace", self.folder / name, "--output", self.folder / name[:-5])
        return self.events(self.folder / name)

    def events(self, path):
        ranks, names, host = {}, {}, {}
        for event in json.loads(path.read_text())["traceEvents"]:
            if event["ph"] == "M":
                lanes = names if event["name"] == "process_name" else host
                lanes[event["pid"]] = event["args"]["name"]
                continue
            self.assertEqual(event["ph"], "X")
            ranks.setdefault(event["pid"], []).append(event)
        self.assertEqual(names, {rank: f"rank {rank}" for rank in ranks})
        self.assertEqual(host, {rank: "host" for rank in ranks})  # the only lane without a GPU
        for of in ranks.values():
            of.sort(key=lambda event: (event["ts"], -event["dur"]))
            self.assert_nested(of)
        return ranks

    def assert_nested(self, events):
        """On a lane an event lies within another or outside of it."""
        open_events = []
        for event in events:
            end = event["ts"] + event["dur"]
            while open_events and open_events[-1] <= event["ts"]:
                open_events.pop()
            if open_events:
                self.assertLessEqual(end, open_events[-1] + 0.002, event)  # [us]: times are rounded
            self.assertGreaterEqual(event["dur"], 0)
            open_events.append(end)

    def state(self, name):
        return json.loads((self.folder / name / "run_record.json").read_text())["run"]["state_hash"]

    def assert_steps(self, events, first, steps):
        """Batches are those steps, and each of these has its stages."""
        batches = [event["args"] for event in events if event["cat"] == "steps"]
        self.assertEqual(batches[0]["first"], first)
        for one, other in zip(batches, batches[1:]):
            self.assertEqual(one["first"] + one["steps"], other["first"])
        self.assertEqual(sum(batch["steps"] for batch in batches), steps)
        names = [event["name"] for event in events if event["cat"] == "stage"]
        self.assertEqual(names.count("contact_force"), steps)
        for stage in "broadcast_motion", "reduce_wrench", "mbs_correct", "accept":
            self.assertGreaterEqual(names.count(stage), steps, stage)

    def test_steps_beside_bodies(self):
        (events,) = self.trace([*DIGGER, "--trace-from", "20", "--trace-steps", "30"]).values()
        self.assert_steps(events, 20, 30)
        self.expect(DONE, "run", *DIGGER, "--output", self.folder / "plain")
        self.assertEqual(self.state("trace"), self.state("plain"))

    def test_ranks(self):
        words = [*DIGGER, "--trace-steps", "10", "--trace", self.folder / "trace.json", "--output", self.folder / "out"]
        subprocess.run(["mpirun", "--oversubscribe", "-n", "2", SCREE, "run", *map(str, words)], check=True,
                       env=ENVIRONMENT | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                                          "OMPI_MCA_mpi_yield_when_idle": "1"},
                       timeout=LIMIT, stdout=subprocess.DEVNULL)
        ranks = self.events(self.folder / "trace.json")
        self.assertEqual(sorted(ranks), [0, 1])
        for events in ranks.values():
            self.assert_steps(events, 0, 10)

    def test_implicit_steps(self):
        (events,) = self.trace([INPUT / "paper/net_9.toml", "--set", "time.end=0.01", "--trace-steps", "3"]).values()
        self.assertEqual([(event["name"], event["args"]["steps"]) for event in events if event["cat"] == "steps"],
                         [("step", 1)] * 3)
        self.assertIn("particle_correct", {event["name"] for event in events})

    def test_a_run_that_is_shorter(self):
        (events,) = self.trace([*DIGGER, "--trace-from", "90"]).values()
        self.assertEqual(events[0]["args"]["first"], 90)
        self.assertEqual(self.events(self.folder / "trace.json"), {0: events})

    def test_a_restart_counts_from_its_start(self):
        self.expect(DONE, "run", *DIGGER, "--output", self.folder / "first")
        words = [*DIGGER, "--set", "time.end=0.01", "--restart", self.folder / "first/checkpoint_end.h5"]
        (events,) = self.trace([*words, "--trace-from", "5", "--trace-steps", "4"]).values()
        steps = json.loads((self.folder / "first/run_record.json").read_text())["counts"]["steps"]
        self.assert_steps(events, steps + 5, 4)

    def test_what_is_refused(self):
        out = ["--output", self.folder / "out"]
        self.assertIn("--trace", self.expect(BAD_INPUT, "run", *DIGGER, *out, "--trace-steps", "3").stderr)
        self.expect(BAD_INPUT, "run", *DIGGER, *out, "--trace", self.folder / "a", "--trace-steps", "0")
        self.expect(BAD_INPUT, "run", *DIGGER, *out, "--trace", self.folder / "a", "--trace-from=-1")
        done = self.expect(IO_FAILED, "run", *DIGGER, *out, "--trace", self.folder / "none/trace.json")
        self.assertIn("none/trace.json", done.stderr)


if __name__ == "__main__":
    unittest.main()
