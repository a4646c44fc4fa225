#!/usr/bin/env python3
"""Decks made by chance of all that a run may have, each run in several ways that must give the same bits: on some
ranks, with lists that reach elsewhere, stopped half-way and restarted on other ranks, with --backend cuda on the GPU
(but for contact laws with powers).

    .venv/bin/python tests/ranks/random_decks.py --scree build/release/scree [--count 50] [--seed 1] [--keep DIR]

A deck is that of --seed and its number: `--only NUMBER --keep DIR` makes one again and leaves it in DIR with its
results. Printed are a line per deck that differs or fails, and how many decks had what; the exit code is 1 if any
differs, or if more than half were refused."""

import argparse
import collections
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import tomlkit

DONE, BAD_INPUT, FAILED, HANGS = 0, 2, 3, 124
LIMIT = 200  # [s] of one run
RADIUS, STIFFNESS, DENSITY = 0.015, 4e4, 2500.0
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", HWLOC_COMPONENTS="-opencl")
SIZE = (0.5, 0.4, 0.3)


class DeckMaker:
    """One deck. features: what it has, in a word each."""

    def __init__(self, seed):
        self.chance = random.Random(seed)
        self.features = []
        self.explicit = self.choose("explicit", 0.65)
        if not self.explicit:
            self.features.append("implicit")
        self.spatial = self.choose("3d", 0.65)
        self.axes = 3 if self.spatial else 2
        self.law = self.chance.choice(("linear", "linear", "power", "hertz"))
        self.features.append(self.law)
        self.has_friction = self.choose("friction", 0.7)
        self.rolls = self.explicit and self.has_friction and self.choose("rolling", 0.4)
        self.attracts = self.explicit and self.law != "power" and self.choose("attraction", 0.3)
        self.deck = {"title": f"deck {seed}", "gravity": self.gravity(), "space": self.space(), "time": self.time(),
                     "integrator": self.integrator(), "materials": self.materials()}
        self.deck["contact"] = {"skin": self.chance.uniform(0.1, 0.6) * RADIUS, "pairs": self.pairs()}
        self.deck["particles"] = [self.group(k) for k in range(self.chance.choice((1, 2)))]
        self.add_surfaces()
        end = self.deck["time"]["end"]
        self.deck["output"] = {"history_interval": end / 8, "history_particles": [0], "checkpoint_interval": end / 2,
                               "contacts": self.choose("contact lines", 0.2)}
        self.deck["parallel"] = {"imbalance": 0.0}

    def choose(self, feature, probability):
        has = self.chance.random() < probability
        if has:
            self.features.append(feature)
        return has

    def direction(self, axes=(True, True, True)):
        """A unit vector along these axes."""
        while True:
            way = [self.chance.uniform(-1, 1) if axes[k] else 0.0 for k in range(self.axes)]
            size = math.hypot(*way)
            if 0.2 < size < 1:
                return [x / size for x in way]

    def gravity(self):
        return [self.chance.uniform(5, 12) * x for x in self.direction()]

    def space(self):
        space = {"dimension": self.axes, "min": [0.0] * self.axes, "max": list(SIZE[:self.axes]),
                 "wall_material": self.chance.choice(("rough", "slick")),
                 "leaving": self.chance.choice(("remove", "ballistic"))}
        for axis in "xyz"[:self.axes]:
            kind = self.chance.choice(("periodic", "walls", "open below", "walls"))
            if kind == "periodic":
                space |= {f"{axis}_min": "periodic", f"{axis}_max": "periodic"}
                self.features.append("periodic")
            elif kind == "walls":
                space |= {f"{axis}_min": "wall", f"{axis}_max": "wall"}
            else:
                space |= {f"{axis}_max": "wall"}
                self.features.append("open")
        return space

    def time(self):
        mass = DENSITY * (4 / 3 * math.pi * RADIUS**3 if self.spatial else math.pi * RADIUS**2)
        unit = math.sqrt(mass / STIFFNESS) if self.law == "linear" else 0.3 * math.sqrt(mass / STIFFNESS)
        step = (0.1 if self.explicit else 0.4) * unit
        adaptive = not self.explicit and self.choose("adaptive", 0.4)
        steps = self.chance.randrange(200, 500) // (10 if adaptive else 1)  # adaptive ones are shorter at impacts
        return {"end": steps * step, "step": step, "control": "adaptive" if adaptive else "fixed"}

    def integrator(self):
        if self.explicit:
            return {"particles": "velocity-verlet", "substeps": self.chance.choice((1, 1, 2, 3))}
        return {"particles": "hht", "hht_alpha": self.chance.choice((-0.3, -0.1, 0.0))}

    def materials(self):
        elastic = {"young_modulus": 1e6, "poisson_ratio": 0.3} if self.law == "hertz" else {}
        return [{"name": name} | elastic for name in ("rough", "slick")]

    def pairs(self):
        pairs = []
        for names in (["rough", "rough"], ["rough", "slick"], ["slick", "slick"]):
            stiffness = STIFFNESS * self.chance.uniform(0.5, 1.5)
            pair = {"materials": names}
            if self.law == "linear":
                pair |= {"stiffness": stiffness} | self.chance.choice(({}, {"damping": 2.0}, {"restitution": 0.7}))
            elif self.law == "power":
                pair |= {"stiffness": 40 * stiffness, "exponent": 1.5, "damping": self.chance.choice((0.0, 2.0))}
            else:
                pair |= {"restitution": self.chance.uniform(0.4, 1.0)}
            has_friction = self.has_friction and (names != ["slick", "slick"] or self.chance.random() < 0.5)
            if has_friction:
                pair |= {"friction": self.chance.uniform(0.1, 0.8)}
                if self.law == "power":
                    pair |= {"tangential_stiffness": 0.8 * stiffness}
                else:
                    pair |= {"tangential_damping_ratio": self.chance.choice((0.0, 0.2))}
            if has_friction and self.rolls:
                pair |= {"rolling_friction": self.chance.uniform(0.05, 0.3), "rolling_damping_ratio": 0.2}
            if self.attracts:
                pair |= self.chance.choice(({}, {"work_of_adhesion": 0.5 if self.law == "hertz" else 0.0,
                                                 "attraction": 2.0 if self.law == "linear" else 0.0}))
                pair = {key: value for key, value in pair.items() if value != 0.0 or key == "tangential_damping_ratio"}
            pairs.append(pair)
        return pairs

    def group(self, number):
        least = [0.08 * size for size in SIZE[:self.axes]]
        most = [0.92 * size for size in SIZE[:self.axes]]
        middle = 0.5 * SIZE[0]
        two = number == 1 or self.chance.random() < 0.5
        (least if number else most)[0] = middle if two else (least if number else most)[0]
        count = self.chance.randrange(20, 150 if self.spatial else 40)
        group = {"name": f"group{number}", "kind": "random", "count": count, "min": least, "max": most,
                 "density": DENSITY, "material": self.chance.choice(("rough", "slick")),
                 "random_velocity": self.chance.uniform(0.1, 1.5), "seed": self.chance.randrange(1000),
                 "radius": self.chance.choice((RADIUS, {"kind": "uniform", "min": 0.6 * RADIUS, "max": RADIUS}))}
        if self.has_friction and self.spatial and self.chance.random() < 0.5:
            group |= {"angular_velocity": [self.chance.uniform(-30, 30) for _ in range(3)]}
        return group

    def place(self):
        return [self.chance.uniform(0.2, 0.8) * size for size in SIZE[:self.axes]]

    def add_surfaces(self):
        plane = self.moving_plane() if self.chance.random() < 0.3 else None
        if plane:
            self.features.append("moving plane")
            self.deck.setdefault("walls", []).append(plane)
        if self.spatial and self.choose("mesh on the ground", 0.35):
            self.add_mesh("hill")
            moves = {"motions": [self.motion()]} if self.choose("moving mesh", 0.4) else {}
            self.deck.setdefault("walls", []).append({"name": "hill", "mesh": "hill", "material": "rough"} | moves)
        bodies = self.chance.choice((0, 0, 1, 2, 3))
        for number in range(bodies):
            self.add_body(f"body{number}")

    def motion(self):
        return {"type": "translation", "direction": self.direction(),
                "displacement": {"kind": "sine", "amplitude": 0.5 * RADIUS, "frequency": self.chance.uniform(5, 40)}}

    def moving_plane(self):
        closed = [self.deck["space"].get(f"{axis}_min") != "periodic" for axis in "xyz"[:self.axes]]
        if not any(closed):
            return None
        normal = self.direction(closed)
        plane = {"name": "plane", "point": [x - 0.3 * n for x, n in zip((0.25, 0.2, 0.15), normal)], "normal": normal,
                 "material": "rough", "motions": [self.motion()]}
        if self.chance.random() < 0.5:
            other = self.direction()
            along = sum(a * b for a, b in zip(other, normal))
            plane["surface_velocity"] = [0.5 * (a - along * b) for a, b in zip(other, normal)]
        return plane

    def add_mesh(self, name):
        kind = self.chance.choice(({"kind": "box", "size": [0.12, 0.1, 0.05]},
                                   {"kind": "cylinder", "radius": 0.05, "length": 0.12, "segments": 16},
                                   {"kind": "box", "size": [0.1, 0.1, 0.1], "refine": 0.03}))
        turned = {"rotation_axis": self.direction(), "rotation_angle": self.chance.uniform(0, 3)}
        offset = {"offset": self.place()} if name == "hill" else {}
        self.deck.setdefault("meshes", []).append({"name": name} | kind | turned | offset)

    def add_body(self, name):
        place = self.place()
        place[0] = (0.2 + 0.3 * len(self.deck.get("bodies", []))) * SIZE[0]  # beside the others
        body = {"name": name, "position": place, "mass": 0.5,
                "velocity": [self.chance.uniform(-1, 1) for _ in range(self.axes)]}
        in_space = self.spatial and self.spatial_bodies()
        if in_space:
            body |= {"kind": "spatial", "inertia_tensor": [5e-4, 6e-4, 7e-4, 0.0, 0.0, 0.0],
                     "body_angular_velocity": [self.chance.uniform(-20, 20) for _ in range(3)]}
        else:
            body |= {"inertia": 5e-4, "angular_velocity": self.chance.uniform(-20, 20)}
            body["velocity"] = body["velocity"][:2] + [0.0] * (self.axes - 2)
        if in_space and self.choose("mesh on a body", 0.4):
            self.add_mesh(name)
            body["meshes"] = [{"mesh": name, "material": "rough"}]
        else:
            offset = [self.chance.uniform(-0.03, 0.03) for _ in range(self.axes)]
            body["shapes"] = [{"radius": 0.03, "material": "rough"},
                              {"radius": 0.02, "offset": offset, "material": self.chance.choice(("rough", "slick"))}]
        self.features.append("bodies")
        self.deck.setdefault("bodies", []).append(body)
        if self.chance.random() < 0.4:
            self.features.append("joint")
            joint = {"name": f"pin of {name}", "type": "revolute", "bodies": ["ground", name],
                     "point": body["position"]}
            if in_space:
                joint["axis"] = self.direction()
            self.deck.setdefault("joints", []).append(joint)
            self.deck["velocities"] = "consistent"

    def spatial_bodies(self):
        if not hasattr(self, "in_space"):
            self.in_space = self.chance.random() < 0.6
        return self.in_space


class Runner:
    def __init__(self, arguments, folder):
        self.arguments, self.folder = arguments, folder

    def run(self, name, ranks, words, backend="cpu", overwrite=True):
        """The state's hash and the history's; the last line printed where the run did not end well."""
        command = [self.arguments.mpiexec, "-n", str(ranks)] if ranks > 1 else []
        command += [self.arguments.scree, "run", self.folder / "deck.toml", "--backend", backend, "--output",
                    self.folder / name, "--set", "output.history_csv=true", *words]
        command += ["--overwrite"] if overwrite else []
        process = subprocess.Popen([str(word) for word in command], env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        try:
            errors = process.communicate(timeout=LIMIT)[1]
        except subprocess.TimeoutExpired:
            process.terminate()  # mpirun takes its ranks along, which a kill would leave behind
            process.communicate()
            return HANGS, f"not ended after {LIMIT} s"
        if process.returncode != DONE:
            lines = [line for line in errors.splitlines() if "scree" in line or "error" in line] or [""]
            return process.returncode, lines[0]
        record = json.loads((self.folder / name / "run_record.json").read_text())
        history = (self.folder / name / "history.csv").read_bytes()
        return DONE, (record["run"]["state_hash"], hashlib.sha256(history).hexdigest()[:16])


def settings(*words):
    return [part for word in words for part in ("--set", word)]


def ways_of(maker, runner):
    """Each way to run a deck: its name and what it gave."""
    chance, time = maker.chance, maker.deck["time"]
    for ranks in chance.sample((2, 3, 4, 5), 2):
        yield f"{ranks} ranks", runner.run(f"ranks_{ranks}", ranks, [])
    skin = maker.deck["contact"]["skin"]
    for factor in (0.3, 2.5):
        yield f"skin {factor}", runner.run(f"skin_{factor}", 1, settings(f"contact.skin={factor * skin!r}"))
    if time["control"] == "fixed":
        before, after = chance.sample((1, 2, 3), 2)
        half = settings(f"time.end={time['end'] / 2!r}")
        restart = ["--restart", runner.folder / "parts" / "checkpoint.h5"]
        code, found = runner.run("parts", before, half)
        yield f"restart from {before} to {after} ranks", \
            runner.run("parts", after, restart, overwrite=False) if code == DONE else (code, found)
    if runner.arguments.backend == "cuda" and maker.law != "power":  # pow() has other bits there
        yield "GPU", runner.run("gpu", 1, [], "cuda")


def judge(arguments, number):
    """Of one deck: its maker and what is to be said of it, in lines; None where it is refused."""
    maker = DeckMaker(f"{arguments.seed}/{number}")
    with tempfile.TemporaryDirectory(prefix="scree_random_") as place:
        folder = arguments.keep / str(number) if arguments.keep else pathlib.Path(place)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "deck.toml").write_text(tomlkit.dumps(maker.deck))
        runner = Runner(arguments, folder)
        code, first = runner.run("first", 1, [])
        if code == BAD_INPUT:
            return maker, None, first
        lines = [] if code in (DONE, FAILED) else [f"exit code {code}: {first}"]
        for way, (other, found) in ways_of(maker, runner) if code == DONE else ():
            if other != DONE:
                lines.append(f"{way}: exit code {other}: {found}")
            elif found[0] != first[0]:
                lines.append(f"{way}: another state")
            elif found[1] != first[1]:
                lines.append(f"{way}: another history")
        return maker, lines, first if code != DONE else ""


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scree", required=True, type=pathlib.Path)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--count", type=int, default=50, help="of decks (default: 50)")
    parser.add_argument("--only", type=int, help="number of the one deck that is made")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the decks and their results")
    parser.add_argument("--backend", choices=("cpu", "cuda"), default="cpu", help="cuda: also on the GPU")
    parser.add_argument("--mpiexec", default="mpirun")
    parser.add_argument("--jobs", type=int, default=2)
    return parser.parse_args()


def main():
    arguments = parse_arguments()
    numbers = [arguments.only] if arguments.only is not None else range(arguments.count)
    had, refused, stopped, different = collections.Counter(), collections.Counter(), collections.Counter(), 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for number, (maker, lines, first) in zip(numbers, pool.map(lambda n: judge(arguments, n), numbers)):
            if lines is None:
                refused[first] += 1
                continue
            if first:
                stopped[first] += 1
            had.update(set(maker.features))
            different += bool(lines)
            for line in lines:
                print(f"deck {number} ({', '.join(sorted(set(maker.features)))}): {line}", flush=True)
    for what, counts in (("refused", refused), ("ended early", stopped)):
        for message, count in counts.items():
            print(f"{count} {what}: {message}")
    print(f"{len(numbers)} decks, {refused.total()} refused, {stopped.total()} ended early, {different} differ;",
          ", ".join(f"{count} with {feature}" for feature, count in had.most_common()))
    return 1 if different or 2 * refused.total() > len(numbers) else 0


if __name__ == "__main__":
    sys.exit(main())
