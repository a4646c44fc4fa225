#!/usr/bin/env python3
"""The pace of real jobs: excavator, drum with lifters, wheel rig, screw, conveyor, beds on walls of triangles, and beds
with friction, rolling resistance and a net of bodies beside them, all in one call. Prints a markdown table.

    jobs.py PROGRAM [--bed BED] [--backend cuda] [--ranks 1 2 4] [--sizes 1e5 1e6] [--only NAME ...] [--old PROGRAM ...]

Times are wall seconds of the loop of steps (on one core the CPU's), without the start. "of bed" compares a job with
the bed with friction (linear law) that the same call timed, per particle and step. Jobs that dig begin with the state
of a run up to there, kept in the folder --keep for later calls; so is a part of it that --settle ended. --old: other
programs, run by turns with the first, whose numbers alone are noted. --list prints the names of the jobs.
"""
import argparse
import csv
import json
import os
import pathlib
import re
import shlex
import signal
import statistics
import subprocess
import sys
import tempfile
import time

import job_cases
import rank_runs

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import measured  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
LISTS = ("migrate", "sort_cells", "exchange_halo", "neighbors")
SHOWN = {"contact_force": ("contact_force",), "reduce_wrench": ("reduce_wrench",), "mbs_correct": ("mbs_correct",),
         "lists": LISTS, "accept, broadcast": ("accept", "broadcast_motion")}
COLUMNS = ["job", "program", "ranks", "us per step", "of bed", "particle-steps/s", "contacts per particle",
           "steps per list", "lists, share", *SHOWN, "rest", "steps", "state"]
SIZES = {"cuda": [10_000, 20_000, 100_000, 1_000_000], "cpu": [800, 2400, 4500, 5000, 10_000, 20_000]}
# Beds that bed makes, by their options; the first is what "of bed" compares with.
BEDS = {"friction": [], "friction, rolling": ["--rolling"], "friction, Hertz": ["--hertz"],
        "friction, Hertz, rolling": ["--hertz", "--rolling"]}
FEW = ["--repeats", "1", "--seconds", "0"]  # --quick
GRACE = 120  # seconds in which a program that was asked to stop must end


class Failed(Exception):
    pass


def call(words, ranks, limit, mpirun):
    """Runs a program until it ends, or asks it to stop after `limit` seconds: mpirun passes this signal on. The text
    that it printed."""
    words = [str(word) for word in words]
    if ranks > 1:
        words = ["mpirun", "--oversubscribe", *shlex.split(mpirun), "-n", str(ranks), *words]
    with tempfile.TemporaryFile("w+") as printed:
        environment = {name: value for name, value in ENVIRONMENT.items() if name != "SCREE_MEASURED"}
        with subprocess.Popen(words, stdout=printed, stderr=subprocess.STDOUT, env=environment) as program:
            try:
                program.wait(limit)
            except subprocess.TimeoutExpired:
                program.send_signal(signal.SIGUSR1)
                try:
                    program.wait(GRACE)
                except subprocess.TimeoutExpired:
                    program.kill()
        printed.seek(0)
        text = printed.read()
        if program.returncode not in (0, 5):
            raise Failed(f"{' '.join(words)}: exit code {program.returncode}\n" + "\n".join(text.splitlines()[-8:]))
        return text


def run(program, job, end, folder, arguments, ranks, limit, more=()):
    """Runs a job up to `end`, with more options; its run record."""
    deck = job.deck
    if isinstance(deck, str):
        deck = folder.parent / "deck.toml"
        deck.write_text(job.deck)
    words = [program, "run", deck, "--backend", arguments.backend, "--output", folder, *job.overrides(end), *more]
    call(words, ranks, limit, arguments.mpirun)
    return json.loads((folder / "run_record.json").read_text())


def restarted(checkpoint):
    return ["--restart", checkpoint, "--allow-changes"]  # an earlier program may name its keys otherwise


def settled(program, job, arguments, ranks, keep):
    """The checkpoint with which the timed part of a job begins; made if it is not kept from an earlier call, which may
    have been stopped on the way."""
    folder = keep / re.sub(r"[^\w.]+", "_", f"{job.name} {job.particles} {arguments.backend}")
    whole, part = folder / "checkpoint_end.h5", folder / "checkpoint.h5"
    if not whole.exists():
        run(program, job, job.start, folder, arguments, ranks, arguments.settle,
            restarted(part) if part.exists() else ())
    if not whole.exists():
        raise Failed(f"{job.name}: stopped after {arguments.settle} s, before it begins at {job.start} s; a further "
                     f"call with --keep {keep} continues")
    return whole


def contacts(folder):
    """At the end, of particles and with surfaces."""
    found = re.search(r"^contacts = (\d+)", (folder / "status.toml").read_text(), re.M)
    return int(found[1]) if found else 0


def seconds_of_loop(record, arguments, ranks):
    """On one core, where other work may run beside, at most the CPU's."""
    cost = record["cost"]
    if arguments.backend == "cpu" and ranks == 1:
        return min(cost["loop_seconds"], cost["cpu_seconds"])
    return cost["loop_seconds"]


def shown(us, step):
    """The stages of the table, and what is left of the step: output on the way, and other stages. [us] Stages are wall
    times; beside other work on a core they are scaled to the step's CPU time."""
    scale = min(1, step / max(1e-9, sum(us.values()) - us["output"]))
    stages = {name: scale * sum(us[stage] for stage in stages) for name, stages in SHOWN.items()}
    return {**stages, "rest": max(0, step - sum(stages.values()))}


def numbers(record, folder, arguments, ranks):
    """Of a run of scree, in microseconds per step."""
    steps, particles = record["starts"][-1]["steps"], record["counts"]["particles"]
    if steps == 0:
        raise Failed("no step within the time limit")
    us = {stage["stage"]: 1e6 * stage["seconds"] / steps for stage in record["stages"]}
    of_steps = sum(us.values()) - us["output"]
    step = 1e6 * seconds_of_loop(record, arguments, ranks) / steps
    return {"step": step, "rate": 1e6 * particles / step, "contacts": contacts(folder) / particles, "steps": steps,
            "particles": particles, "lists": record["counts"]["list_builds"],
            "share": 100 * sum(us[stage] for stage in LISTS) / of_steps,
            "stages": shown(us, step),
            "state": record["run"]["state_hash"] if record["run"]["status"] == "done" else "stopped",
            "record": record}


def time_job(program, job, arguments, ranks, keep):
    more = []
    if job.start > 0:
        more += restarted(settled(arguments.program, job, arguments, max(arguments.ranks), keep))
    if arguments.trace and program == arguments.program:
        arguments.trace.mkdir(parents=True, exist_ok=True)
        name = re.sub(r"[^\w.]+", "_", f"{job.name} {ranks} ranks")
        more += ["--trace", arguments.trace / f"{name}.json", "--trace-from", 10 if arguments.quick else 1000]
    with tempfile.TemporaryDirectory(prefix="scree_jobs_") as scratch:
        folder = pathlib.Path(scratch) / "results"
        record = run(program, job, job.end, folder, arguments, ranks, arguments.time_limit, more)
        return numbers(record, folder, arguments, ranks)


def time_bed(bed, particles, options, arguments, ranks):
    """The rows that bed writes for a size: of the bed, or with --net of the bed, one with a hole, and with bodies."""
    with tempfile.TemporaryDirectory(prefix="scree_jobs_") as scratch:
        path = pathlib.Path(scratch) / "bed.csv"
        samples = FEW if arguments.quick else ["--repeats", "3", "--seconds", "0.1"]
        words = [bed, "--tile", ROOT / "tests/reference/bed_tile.h5", "--csv", path, "--backend", arguments.backend,
                 "--rebuild", "0", "--particles", particles, *samples, *options]
        call(words, ranks, arguments.time_limit, arguments.mpirun)
        with path.open(newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["rank"] == "0"]
    return [numbers_of_bed(row) for row in rows]


def numbers_of_bed(row):
    us = {stage: 1e6 * float(row[stage]) for stage in rank_runs.STAGES}
    step, particles = 1e6 * float(row["seconds_per_step"]), int(row["particles"])
    return {"step": step, "rate": 1e6 * particles / step, "contacts": None, "steps": int(float(row["steps"])),
            "particles": particles, "lists": int(row["list_builds"]),
            "share": 100 * sum(us[stage] for stage in LISTS) / max(1e-9, sum(us.values())),
            "stages": shown(us, step), "state": "-", "record": None, "device": row["device"], "commit": row["commit"]}


def options_of(bed, names):
    """The options as this bed takes them, with 0.15 where one takes a number; None where it has not got one."""
    text = subprocess.run([bed, "--help"], capture_output=True, text=True).stdout
    words = []
    for name in names:
        found = re.search(rf"^\s*{name}\b(.*)$", text, re.M)
        if not found:
            return None
        words += [name, "0.15"] if re.match(r" (FLOAT|NUM|REAL|TEXT)", found[1]) else [name]
    return words


class Table:
    """Prints each row as it comes, and notes the numbers of the first program."""

    def __init__(self, arguments):
        self.arguments, self.beds, self.states, self.left = arguments, {}, {}, []
        print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS), flush=True)

    def of_bed(self, one, ranks):
        """With the bed of the nearest size."""
        beds = [bed for (_, of), bed in self.beds.items() if of == ranks]
        if not beds:
            return None
        bed = min(beds, key=lambda bed: abs(bed["particles"] - one["particles"]))
        return one["step"] / one["particles"] / (bed["step"] / bed["particles"])

    def add(self, name, program, ranks, runs):
        """The median of some runs."""
        runs = sorted(runs, key=lambda one: one["step"])
        one = runs[len(runs) // 2]
        ratio = self.of_bed(one, ranks)
        every = one["steps"] / one["lists"] if one["lists"] else None
        cells = [name, program, str(ranks), f"{one['step']:.1f}", text_of(ratio, ".2f"), f"{one['rate']:.3g}",
                 text_of(one["contacts"], ".2f"), text_of(every, ".1f"), text_of(one["share"], ".1f") + " %",
                 *(f"{us:.1f}" for us in one["stages"].values()), str(one["steps"]), one["state"]]
        print("| " + " | ".join(cells) + " |", flush=True)
        if one["state"] not in ("-", "stopped"):
            self.states.setdefault(name, set()).update(run["state"] for run in runs)
        if program == self.arguments.names[0]:
            self.note(name, ranks, one, runs, ratio, every)

    def note(self, name, ranks, one, runs, ratio, every):
        where = self.arguments.backend + (f", {ranks} ranks" if ranks > 1 else "")
        of = {"record": one["record"]} if one["record"] else {
            "commit": one["commit"], "machine": self.arguments.machine or one["device"],
            "backend": self.arguments.backend}
        ends = {"least": runs[0]["step"], "most": runs[-1]["step"]}
        measured.note(f"jobs/{where}/{name}/step", one["step"], "us", **{**of, **ends})
        values = {"rate": (one["rate"], "particle-steps/s"), "of bed": (ratio, ""), "contacts": (one["contacts"], ""),
                  "steps per list": (every, ""), "lists, share": (one["share"], "%")}
        values |= {stage: (us, "us") for stage, us in one["stages"].items() if us > 0}
        for what, (value, unit) in values.items():
            if value is not None:
                measured.note(f"jobs/{where}/{name}/{what}", value, unit, **of)

    def leave(self, name, why):
        self.left.append(f"{name}: {why}")
        print(f"{name}: {why}", file=sys.stderr, flush=True)

    def end(self):
        """Whether all that was asked for was timed, and states agree."""
        different = [name for name, states in self.states.items() if len(states) > 1]
        print("\n" + "\n".join([f"different states: {name}" for name in different] +
                               [f"not timed: {line}" for line in self.left] or ["all states agree"]))
        return not different and not self.left


def text_of(value, form):
    return "-" if value is None else format(value, form)


def beds(arguments, table, sizes):
    """Beds first: they are what the jobs are compared with."""
    for ranks in arguments.ranks:
        for name, names in BEDS.items():
            options = options_of(arguments.bed, names)
            for particles in sizes if name == "friction" or wanted(f"bed {name}", arguments) else []:
                title = f"bed {job_cases.amount(particles)}, {name}"
                if options is None:
                    print(f"{title}: {arguments.bed} has no {' '.join(names)}", file=sys.stderr, flush=True)
                    continue
                with_friction = ["--friction", "0.5", *options, *(["--wall"] if ranks > 1 else [])]
                try:
                    (one,) = time_bed(arguments.bed, particles, with_friction, arguments, ranks)
                except Failed as error:
                    table.leave(title, str(error))
                    continue
                if name == "friction":
                    table.beds[particles, ranks] = one
                table.add(title, arguments.names[0], ranks, [one])
        for particles in sizes if wanted("net", arguments) else []:
            try:
                rows = time_bed(arguments.bed, particles, ["--net"], arguments, ranks)
                for title, one in zip(("frictionless bed", "hole", "net of 20"), rows, strict=True):
                    if title != "hole":
                        table.add(f"{title} {job_cases.amount(particles)}", arguments.names[0], ranks, [one])
            except Failed as error:
                table.leave(f"net {particles}", str(error))


def wanted(name, arguments):
    return not arguments.only or any(word in name for word in arguments.only)


def chosen(arguments):
    """Jobs, in the order in which they are run."""
    if arguments.quick:
        return [job for job in job_cases.quick_jobs() if wanted(job.name, arguments)]

    def of_size(job):
        return any(abs(job.particles - size) <= 0.05 * size for size in arguments.sizes)
    return [job for job in job_cases.all_jobs()
            if wanted(job.name, arguments) and of_size(job) and (not job.asked or job.name in (arguments.only or []))]


def bed_sizes(arguments, jobs):
    """Of the jobs, and those asked for; bed makes multiples of 1e4."""
    sizes = [job.particles for job in jobs] + ([] if arguments.only and jobs else arguments.sizes)
    return [10_000] if arguments.quick else sorted({max(10_000, round(size / 10_000) * 10_000) for size in sizes})


def time_jobs(arguments, table, jobs, keep):
    begun = time.monotonic()
    programs = dict(zip(arguments.names, [arguments.program, *arguments.old]))
    for job in jobs:
        for ranks in arguments.ranks:
            runs = {name: [] for name in programs}
            for name, program in list(programs.items()) * arguments.repeats:
                if time.monotonic() - begun > arguments.budget:
                    table.leave(f"{job.name}, {ranks} ranks", "the time of --budget is over")
                    continue
                try:
                    runs[name].append(time_job(program, job, arguments, ranks, keep))
                except Failed as error:
                    table.leave(f"{job.name}, {ranks} ranks, {name}", str(error))
            for name, of in runs.items():
                if of:
                    table.add(job.name, name, ranks, of)


def parse(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--bed", type=pathlib.Path, help="the program bed; without it no beds are timed")
    parser.add_argument("--backend", choices=["cuda", "cpu"], default="cuda")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1])
    parser.add_argument("--sizes", type=float, nargs="+", help="particles (default: all but 4e6; cpu: up to 2e4)")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="jobs whose names contain one of these")
    parser.add_argument("--old", type=pathlib.Path, nargs="+", default=[], metavar="PROGRAM")
    parser.add_argument("--repeats", type=int, default=1, help="runs of each job and program (default 1)")
    parser.add_argument("--time-limit", type=float, default=60, help="seconds of a run, which then stops (default 60)")
    parser.add_argument("--settle", type=float, default=200, help="the same before the timed part (default 200)")
    parser.add_argument("--budget", type=float, default=1e9, help="seconds after which no further run begins")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for states before the timed part")
    parser.add_argument("--trace", type=pathlib.Path, metavar="FOLDER", help="timelines of 200 steps after 1,000")
    parser.add_argument("--machine", help="name of the machine in the notes")
    parser.add_argument("--mpirun", default="", help="options of mpirun")
    parser.add_argument("--quick", action="store_true", help="a few steps of each job, to see that all of it works")
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args(words)
    arguments.program, arguments.old = arguments.program.absolute(), [path.absolute() for path in arguments.old]
    arguments.bed = arguments.bed and arguments.bed.absolute()
    arguments.sizes = [int(size) for size in arguments.sizes or SIZES[arguments.backend]]
    arguments.names = [f"{number}" if number else "new" for number in range(1 + len(arguments.old))]
    return arguments


def main():
    arguments = parse(sys.argv[1:])
    jobs = chosen(arguments)
    if arguments.list:
        print("\n".join(job.name for job in jobs))
        return 0
    if arguments.machine:
        measured.always(machine=arguments.machine)
    table = Table(arguments)
    if arguments.bed:
        beds(arguments, table, bed_sizes(arguments, jobs))
    with tempfile.TemporaryDirectory(prefix="scree_jobs_kept_") as scratch:
        time_jobs(arguments, table, jobs, arguments.keep or pathlib.Path(scratch))
    return 0 if table.end() else 1


if __name__ == "__main__":
    sys.exit(main())
