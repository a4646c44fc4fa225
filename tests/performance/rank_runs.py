"""The rows that bed --csv writes, one per run and rank, as runs."""
import csv
import dataclasses
import re

STAGES = ["predict", "migrate", "sort_cells", "exchange_halo", "neighbors", "update_halo", "broadcast_motion",
          "contact_force", "reduce_wrench", "mbs_correct", "particle_correct", "accept", "output"]
KIND = ["commit", "device", "backend", "precision", "dimension", "integrator", "rebuild", "friction"]
# Of a run as a whole; the other columns are those of a rank.
WHOLE = {"bodies": int, "contacts": float, "ranks": int, "particles": int, "list_builds": int, "steps": float,
         "seconds_per_step": float, "fastest": float, "slowest": float, "mean": float}
OF_RANK = {"rank": int, "owned": int, "ghosts": int, "receivers": int, "halo_bytes": int, "imbalance": float,
           "host_bytes": float, "device_bytes": float, "halo_seconds": float, "halo_exposed": float,
           **{stage: float for stage in STAGES}}


@dataclasses.dataclass
class Run:
    kind: dict  # KIND: text
    whole: dict  # WHOLE
    of_rank: list  # dicts of OF_RANK, by rank

    def __getattr__(self, name):
        values = {**self.__dict__.get("kind", {}), **self.__dict__.get("whole", {})}
        if name not in values:
            raise AttributeError(name)
        return values[name]

    def largest(self, column):
        return max(rank[column] for rank in self.of_rank)

    def of_all(self, column):
        return [rank[column] for rank in self.of_rank]

    def series(self):
        """Runs are compared with those that differ in size and ranks alone."""
        return tuple(self.kind[name] for name in KIND if name != "commit")


def read_chain(path):
    """[(bodies, seconds per iteration)] of chain_scaling, bodies increasing."""
    try:
        with open(path, newline="") as file:
            out = sorted((int(row["bodies"]), float(row["seconds_per_iteration"])) for row in csv.DictReader(file))
    except OSError as error:
        raise SystemExit(f"error: {path}: {error.strerror}")
    except (KeyError, ValueError) as error:
        raise SystemExit(f"error: {path}: {error}; must be written by chain_scaling")
    if len(out) < 2:
        raise SystemExit(f"error: {path}: {len(out)} rows; must be two or more")
    return out


def read_runs(paths):
    """The runs of all files, in their order; of the same run measured twice the last. Ends the program, with a message,
    on a file that is not of bed."""
    runs, unfinished = {}, None
    for path in paths:
        try:
            with open(path, newline="") as file:
                rows = list(csv.DictReader(file))
        except OSError as error:
            raise SystemExit(f"error: {path}: {error.strerror}")
        for number, row in enumerate(rows, start=2):
            try:
                whole = {name: kind(row[name]) for name, kind in WHOLE.items()}
                rank = {name: kind(row[name]) for name, kind in OF_RANK.items()}
                kind = {name: row[name] for name in KIND}
            except (KeyError, TypeError, ValueError) as error:
                raise SystemExit(f"error: {path}:{number}: {error}; must be a row of bed --csv")
            if rank["rank"] == 0:
                unfinished = Run(kind, whole, [])
            if unfinished is None or len(unfinished.of_rank) != rank["rank"]:
                raise SystemExit(f"error: {path}:{number}: rank {rank['rank']}; must come after those before it")
            unfinished.of_rank.append(rank)
            if len(unfinished.of_rank) == whole["ranks"]:
                runs[(unfinished.series(), whole["bodies"], whole["particles"], whole["ranks"])] = unfinished
                unfinished = None
        if unfinished:
            raise SystemExit(f"error: {path}: ends within a run of {unfinished.ranks} ranks")
    if not runs:
        raise SystemExit(f"error: {', '.join(map(str, paths))}: no runs")
    return list(runs.values())


KEPT = "bed/cuda, spheres, explicit, double"  # of the keys of measured.csv
KEPT_BEDS = ("list where needed", "plain")  # without bodies
KEPT_PLOUGH, KEPT_BODIES = "with a row drawn through it", 20  # of 8 million particles
CHAIN_ITERATIONS = 2  # of a step of "earlier/chain for the model"


def kept(rows):
    """The runs and the chain that scaling_model.py fits, of the rows of measured.csv: (runs, [(bodies, seconds per
    iteration)]). Of a rank: its share of the particles, one receiver, the bytes of its halo."""
    table = {row["key"]: row for row in rows}
    scale = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "MB": 1e6}

    def value(key):
        row = table[key]
        return scale[row["unit"]] * float(row["value"])

    runs = []
    for key, row in table.items():
        found = re.fullmatch(rf"({KEPT}(, .*)?)/(\d+) step", key)
        said = found[2].split(", ")[1:] if found and found[2] else []
        if not said or not set(said) <= {*KEPT_BEDS, KEPT_PLOUGH, "2 ranks", "per rank"}:
            continue
        ranks, particles, bodies = 1 + ("2 ranks" in said), int(found[3]), KEPT_BODIES * (KEPT_PLOUGH in said)
        whole = dict.fromkeys(WHOLE, 0) | {"bodies": bodies, "ranks": ranks, "particles": particles,
                                           "seconds_per_step": value(key)}
        rank = dict.fromkeys(OF_RANK, 0) | {"owned": particles // ranks, "receivers": ranks - 1}
        if ranks > 1:
            rank["halo_bytes"] = value(f"{found[1]}/{found[3]} halo")
        if bodies and ranks > 1:
            rank["mbs_correct"] = value(f"ranks/cuda, spheres, explicit, double, 2 ranks, {bodies} bodies/8e+06 "
                                        "mbs_correct, rank 0")
        kind = dict.fromkeys(KIND, "") | {"rebuild": next((bed for bed in KEPT_BEDS if bed in said), ""),
                                          "commit": row["commit"], "device": row["machine"], "backend": "cuda",
                                          "precision": "double", "dimension": "3", "integrator": "explicit"}
        runs.append(Run(kind, whole, [{**rank, "rank": number} for number in range(ranks)]))
    chain = sorted((int(key.rsplit("/", 1)[1].split()[0]), value(key) / CHAIN_ITERATIONS)
                   for key in table if key.startswith("earlier/chain for the model/"))
    runs.sort(key=lambda run: run.rebuild != "plain")  # first, as the runs with bodies are compared with these
    return runs, chain
