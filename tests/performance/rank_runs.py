"""The rows that bed --csv writes, one per run and rank, as runs."""
import csv
import dataclasses

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
