"""Markdown tables of how runs of bed --csv scale with the number of ranks.

    rank_tables.py FILE.csv ...

Weak scaling compares runs with as many particles per rank, strong scaling runs with as many in all, both with one rank.
A run has both tables' efficiency where both kinds of run are there. Then, per run, the stages of each rank; and
what bodies cost.
"""
import argparse
import pathlib
import sys

import rank_runs

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import measured  # noqa: E402

# The bed with bodies lacks the few particles that are in their way: apart in size from the plain bed by less than this.
HOLE = 1e-2


def note(run, runs, key, value, unit):
    """What bed does not note itself. runs: those of the same kind, of which some may be with bodies."""
    words = [run.backend, "spheres" if run.dimension == "3" else "discs",
             "implicit" if run.integrator == "hht" else "explicit", run.precision, f"{run.ranks} ranks"]
    if run.bodies:
        words.append(f"{run.bodies} bodies")
    elif any(other.bodies and other.particles == run.particles for other in runs):
        words.append("a hole")
    measured.note(f"ranks/{', '.join(words)}/{run.particles:.3g} {key}", value, unit, commit=run.commit,
                  machine=run.device, backend=run.backend)


def table(columns, rows):
    return "\n".join(["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)] +
                     ["| " + " | ".join(row) + " |" for row in rows] + [""])


def per_particle(run):
    """Memory of all ranks over the particles [B], on the device if there is one."""
    column = "device_bytes" if run.backend == "cuda" else "host_bytes"
    return sum(run.of_all(column)) / run.particles


def halo_share(run):
    """What the halo takes of a step: on GPUs by the device's clock, with the share that runs beside the interior's
    rows. In implicit steps these are the halos of the forces; those of the linear solve are not looked at."""
    if run.backend == "cuda" and run.ranks > 1:
        slowest = max(run.of_rank, key=lambda rank: rank["halo_exposed"])
        hidden = 1 - slowest["halo_exposed"] / slowest["halo_seconds"] if slowest["halo_seconds"] > 0 else 1
        return f"{1e6 * slowest['halo_seconds']:.3g} us, {100 * hidden:.0f} % hidden"
    return f"{100 * run.largest('update_halo') / run.mean:.1f} % of the step"


def row(run, efficiency):
    seconds = run.seconds_per_step
    return [str(run.ranks), f"{run.particles:,}",
            f"{1e3 * seconds:.4g} ({1e3 * run.fastest:.4g} to {1e3 * run.slowest:.4g})",
            f"{run.particles / seconds:.3g}", f"{100 * efficiency:.1f} %", f"{100 * run.largest('imbalance'):.2f} %",
            f"{100 * sum(run.of_all('ghosts')) / run.particles:.2f} %",
            f"{1e-3 * run.largest('halo_bytes'):,.4g} to {run.largest('receivers')}",
            halo_share(run), f"{per_particle(run):.0f}"]


COLUMNS = ["ranks", "particles", "ms per step (fastest to slowest sample)", "particle-steps/s", "efficiency",
           "imbalance", "ghosts", "kB sent per halo update, to ranks (largest)",
           "halo update (slowest rank)", "memory per particle [B]"]


def scalings(runs):
    """{(kind, particles of the run on one rank): [(run, efficiency)]}, of runs alike but for size and ranks."""
    out = {}
    for one in (run for run in runs if run.ranks == 1):
        weak = [run for run in runs if run.particles == one.particles * run.ranks]
        strong = [run for run in runs if run.particles == one.particles]
        for kind, group in (("Weak", weak), ("Strong", strong)):
            if len(group) < 2:
                continue
            ideal = (lambda run: 1) if kind == "Weak" else (lambda run: run.ranks)
            out[kind, one.particles] = [(run, one.seconds_per_step / run.seconds_per_step / ideal(run))
                                        for run in sorted(group, key=lambda run: run.ranks)]
    return out


def stages(run, alike):
    names = [stage for stage in rank_runs.STAGES if run.largest(stage) > 1e-3 * run.mean]
    columns = ["rank", "particles", "ghosts", *(f"{name} [us]" for name in names), "other [us]"]
    rows = []
    for rank in run.of_rank:
        times = [rank[name] for name in names]
        for name in names:
            note(run, alike, f"{name}, rank {rank['rank']}", 1e6 * rank[name], "us")
        rows.append([str(rank["rank"]), f"{rank['owned']:,}", f"{rank['ghosts']:,}", *(f"{1e6 * t:.4g}" for t in times),
                     f"{1e6 * (run.mean - sum(times)):.4g}"])
    return table(columns, rows)


def bodies(runs):
    """Runs with bodies against those without, of as many ranks: on the bed without the particles in the bodies' way,
    and on the plain bed."""
    def steps_per_list(run):
        return f"{run.steps / max(run.list_builds, 1):.0f}"

    rows = []
    for run in (run for run in runs if run.bodies > 0):
        alike = [r for r in runs if r.bodies == 0 and r.ranks == run.ranks]
        hole = [r for r in alike if r.particles == run.particles]
        plain = [r for r in alike if run.particles < r.particles < (1 + HOLE) * run.particles]
        if not hole or not plain:
            continue
        row = [str(run.ranks), f"{run.particles:,}", str(run.bodies), f"{run.contacts:.1f}",
               f"{1e3 * run.seconds_per_step:.4g}", steps_per_list(run), f"{1e6 * run.of_rank[0]['mbs_correct']:.4g}"]
        for what, other in (("hole", hole[0]), ("plain bed", plain[0])):
            note(run, runs, f"longer than the {what}",
                 100 * (run.seconds_per_step / other.seconds_per_step - 1), "%")
            row += [f"{1e3 * other.seconds_per_step:.4g}", steps_per_list(other),
                    f"{100 * (run.seconds_per_step / other.seconds_per_step - 1):.1f} %"]
        rows.append(row)
    return rows


def report(runs):
    out = []
    for series in dict.fromkeys(run.series() for run in runs):
        alike = [run for run in runs if run.series() == series]
        commits = ", ".join(dict.fromkeys(run.commit for run in alike))
        what = ", ".join(f"{name} {value}" for name, value in zip(rank_runs.KIND[1:], series))
        out.append(f"## {what}; commit {commits}\n")
        for count in sorted({run.bodies for run in alike}):
            for (kind, size), group in scalings([run for run in alike if run.bodies == count]).items():
                per_rank = " per rank" if kind == "Weak" else ""
                out.append(f"{kind} scaling, {size:,} particles{per_rank}, {count} bodies:\n")
                out.append(table(COLUMNS, [row(*entry) for entry in group]))
                for run, efficiency in group:
                    note(run, alike, f"{kind.lower()} efficiency", 100 * efficiency, "%")
        if rows := bodies(alike):
            out.append("What bodies cost:\n")
            out.append(table(["ranks", "particles", "bodies", "their contacts", "ms per step", "steps per list",
                              "of a step rank 0 solves [us]", "with a hole in their place [ms]", "steps per list",
                              "bodies take longer by", "the plain bed [ms]", "steps per list", "bodies take longer by"],
                             rows))
        for run in alike:
            out.append(f"Stages per step, {run.ranks} rank(s), {run.particles:,} particles, {run.bodies} bodies, "
                       f"{run.mean * 1e6:.4g} us per step (mean):\n")
            out.append(stages(run, alike))
    return "\n".join(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=pathlib.Path, metavar="FILE.csv")
    print(report(rank_runs.read_runs(parser.parse_args().files)))


if __name__ == "__main__":
    sys.exit(main())
