"""How explicit steps go on past the ranks that were measured: a model fitted to the rows of bed and chain_scaling.

    scaling_model.py --chain CHAIN.csv --out DIR [options] RANKS.csv ...
    scaling_model.py --kept [--out DIR]

RANKS.csv: of bed --csv, on one and more ranks (gpu_ranks.sh measures them). CHAIN.csv: of chain_scaling. --kept takes
both from tests/performance/measured.csv, what was measured on GPUs without friction and is kept there, and draws
postprocess/pictures/scaling_model.png where no --out is given.

A step of the particles on P ranks takes

    fixed + per_particle n + per_message m + per_byte B + per_level log2(P),

with n particles, m messages and B bytes per halo update of the rank that has most; all five are fitted, none below 0,
with relative errors alike. What a program hides behind its computation is in no term. The bed is flat: P boxes are cut
from a square, B is per_face sqrt(n) for each of up to 4 faces, m up to 8. Past one host a message takes at least
--network-latency more, and a byte at least 1 / --network-bandwidth.

With b bodies rank 0 solves for them in every step: --iterations times what chain_scaling measures per iteration,
between its lengths along straight lines in log b and log t. On a GPU that is done while the particles' kernels run, on
CPU ranks the others wait. What a step with bodies takes beyond that is coupling + coupling_per_rank P, fitted to the
runs with bodies, and the bytes of motion (down a tree) and contact sums (to rank 0; as if all bodies were touched) at
--network-bandwidth.

Prints the terms, the steps per second and efficiencies from 1 to 1,000 ranks, from where on rank 0 is the limit (its
solve and the exchange with it take as long as the step of the particles), and how many ranks take the most steps per
second. Writes DIR/scaling_model.md, .csv and, where there is matplotlib, .png.
"""
import argparse
import csv
import dataclasses
import itertools
import math
import pathlib
import sys

import numpy

import rank_runs
import scaling_plot

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import measured  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE, PICTURES = ROOT / "tests/performance/measured.csv", ROOT / "postprocess/pictures"
RANKS = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1000]
BODIES = [0, 20, 1000, 10000]
# What crosses per body and step: its motion twice, and twice the sums of one shape's contacts, as partition sends them
# (BodyMotion, InstantSums) [B].
MOTION_BYTES, WRENCH_BYTES = 2 * 64, 2 * 200
TERMS = ["fixed", "per_particle", "per_message", "per_byte", "per_level"]


def fit_nonnegative(matrix, times):
    """Coefficients >= 0 with the least sum of squared relative errors, and the largest relative error. Exact: of all
    sets of columns, the best whose own fit is nowhere negative."""
    scaled = matrix / times[:, None]
    norms = numpy.linalg.norm(scaled, axis=0)
    norms[norms == 0] = 1
    scaled = scaled / norms
    best, least = numpy.zeros(matrix.shape[1]), float(len(times))
    for count in range(1, min(matrix.shape) + 1):
        for columns in itertools.combinations(range(matrix.shape[1]), count):
            part = scaled[:, columns]
            solution, _, rank, _ = numpy.linalg.lstsq(part, numpy.ones(len(times)), rcond=1e-10)
            if rank < count or (solution < 0).any():
                continue
            error = numpy.sum((part @ solution - 1) ** 2)
            if error < least * (1 - 1e-9):
                least, best = error, numpy.zeros(matrix.shape[1])
                best[list(columns)] = solution
    best = best / norms
    return best, float(numpy.max(numpy.abs(matrix @ best / times - 1)))


def box_grid(ranks):
    """Boxes along the two sides of a square, as near to each other as bisection makes them."""
    levels = math.log2(ranks)
    along = 2 ** math.ceil(levels / 2)
    return along, ranks / along


def faces_and_messages(ranks):
    """Of the box that has most."""
    faces, near = 0, 1
    for boxes in box_grid(ranks):
        faces += min(max(math.ceil(boxes) - 1, 0), 2)
        near *= min(max(math.ceil(boxes), 1), 3)
    return faces, near - 1


@dataclasses.dataclass
class Network:
    per_host: int  # ranks
    latency: float  # [s]
    bandwidth: float  # [B/s]


@dataclasses.dataclass
class Model:
    terms: dict  # TERMS [s]
    per_face: float  # halo bytes of a face over sqrt(n)
    uneven: float  # particles of the fullest rank over the mean
    solve: list  # [(bodies, s per step)]
    coupling: float  # [s]
    coupling_per_rank: float  # [s]
    hidden: bool  # the solve, behind the particles' kernels
    network: Network
    error: float = 0  # largest relative, of the particles' steps
    coupling_error: float | None = None  # the same with bodies; none measured
    smallest: float = 0  # particles per rank that were measured
    coupling_ranks: tuple = ()  # that bodies were measured on

    def particles(self, n, ranks):
        """Seconds of a step of n particles per rank."""
        faces, messages = faces_and_messages(ranks)
        t, many = self.terms, ranks > self.network.per_host
        n *= self.uneven if ranks > 1 else 1
        message = t["per_message"] + (self.network.latency if many else 0)
        byte = max(t["per_byte"], 1 / self.network.bandwidth if many else 0)
        level = t["per_level"] + (self.network.latency if many else 0)
        return (t["fixed"] + t["per_particle"] * n + message * messages + byte * self.per_face * faces * math.sqrt(n) +
                level * math.log2(ranks))

    def serial(self, bodies):
        """Seconds that rank 0 solves in a step."""
        if bodies == 0:
            return 0.0
        points = [(math.log(b), math.log(s)) for b, s in self.solve]
        x = math.log(bodies)
        (x0, y0), (x1, y1) = next(((p, q) for p, q in zip(points, points[1:]) if x <= q[0]), points[-2:])
        return math.exp(y0 + (y1 - y0) * (x - x0) / (x1 - x0))

    def crossing(self, bodies, ranks):
        """Seconds for the bytes of motion and wrenches. Those of the halo cost more: packing, and waits."""
        if ranks == 1:
            return 0.0
        return bodies * (MOTION_BYTES * math.log2(ranks) + WRENCH_BYTES) / self.network.bandwidth

    def exchange(self, bodies, ranks):
        """Seconds of a step with bodies beyond the particles and the solve."""
        if bodies == 0:
            return 0.0
        return self.coupling + self.coupling_per_rank * ranks + self.crossing(bodies, ranks)

    def step(self, n, ranks, bodies):
        own, solve = self.particles(n, ranks), self.serial(bodies)
        return (max(own, solve) if self.hidden else own + solve) + self.exchange(bodies, ranks)

    def limit(self, bodies, ranks_to_particles):
        """The least number of ranks, up to the largest of RANKS, at which rank 0 is the limit: its solve and the
        exchange with it take as long as the particles' step, halo and collectives included; None where they do
        nowhere. ranks_to_particles(P): per rank."""
        if bodies == 0:
            return None
        solve = self.serial(bodies)
        return next((p for p in range(1, RANKS[-1] + 1)
                     if solve + self.exchange(bodies, p) >= self.particles(ranks_to_particles(p), p)), None)

    def fastest(self, bodies, total):
        """The number of ranks, up to the largest of RANKS, that take the most steps per second of so many particles."""
        return min(range(1, RANKS[-1] + 1), key=lambda p: self.step(total / p, p, bodies))


def row_of(run):
    return [1.0, run.largest("owned"), run.largest("receivers"), run.largest("halo_bytes"), math.log2(run.ranks)]


def fit(runs, chain, iterations, network):
    """A Model of runs alike but for sizes, ranks and bodies. Ends the program where they are too few."""
    bare = [run for run in runs if run.bodies == 0]
    if len({run.ranks for run in bare}) < 2 or len({run.largest("owned") for run in bare}) < 2:
        raise SystemExit("error: the fit needs runs without bodies of at least two sizes and two numbers of ranks")
    matrix = numpy.array([row_of(run) for run in bare])
    times = numpy.array([run.seconds_per_step for run in bare])
    coefficients, error = fit_nonnegative(matrix, times)
    terms = dict(zip(TERMS, map(float, coefficients)))
    if terms["per_particle"] == 0:
        raise SystemExit("error: the measured steps do not become longer with more particles; measure larger ones")
    faces = [(faces_and_messages(run.ranks)[0] * math.sqrt(run.largest("owned")), run.largest("halo_bytes"))
             for run in bare if run.ranks > 1]
    per_face = sum(x * y for x, y in faces) / sum(x * x for x, _ in faces)
    widest = max(bare, key=lambda run: run.ranks)
    model = Model(terms, per_face, max(1.0, widest.largest("owned") * widest.ranks / widest.particles),
                  [(bodies, iterations * seconds) for bodies, seconds in chain], 0.0, 0.0,
                  bare[0].backend == "cuda", network, error, None, min(run.largest("owned") for run in bare))
    fit_coupling(model, runs, bare)
    return model


def fit_coupling(model, runs, bare):
    """From the runs with bodies beside those without of the same size and ranks. The solve is what was measured
    there."""
    rows, more, whole = [], [], []
    for run in (run for run in runs if run.bodies > 0):
        beside = next((b for b in bare if (b.ranks, b.particles) == (run.ranks, run.particles)), None)
        if beside is None:
            continue
        solve, own = run.of_rank[0]["mbs_correct"], beside.seconds_per_step
        rows.append([1.0, run.ranks]), whole.append(run.seconds_per_step)
        more.append(run.seconds_per_step - (max(own, solve) if model.hidden else own + solve) -
                    model.crossing(run.bodies, run.ranks))
    if not rows:
        return
    # Relative to the whole step: a difference of two measurements has their errors.
    weights = numpy.array(whole)
    matrix, target = numpy.array(rows) / weights[:, None], numpy.array(more) / weights
    best, least = (0.0, 0.0), float(numpy.sum(target**2))
    for columns in ([0], [1], [0, 1]):
        if len(rows) < len(columns) or len({row[1] for row in rows}) < len(columns):
            continue
        solution = numpy.linalg.lstsq(matrix[:, columns], target, rcond=None)[0]
        error = float(numpy.sum((matrix[:, columns] @ solution - target) ** 2))
        if (solution >= 0).all() and error < least * (1 - 1e-9):
            values = dict(zip(columns, solution))
            least, best = error, (float(values.get(0, 0)), float(values.get(1, 0)))
    model.coupling, model.coupling_per_rank = best
    model.coupling_ranks = tuple(sorted({ranks for _, ranks in rows}))
    model.coupling_error = float(numpy.max(numpy.abs(matrix @ numpy.array(best) - target)))


def predictions(model, weak, totals):
    """One dict per kind of scaling, size, number of bodies and number of ranks. within: as many particles per rank as
    were measured, or more."""
    rows = []
    for kind, size in [("weak", weak), *(("strong", total) for total in totals)]:
        for bodies in BODIES:
            for ranks in RANKS:
                n = size if kind == "weak" else size / ranks
                seconds = model.step(n, ranks, bodies)
                one = model.step(size, 1, 0)
                efficiency = one / seconds / (1 if kind == "weak" else ranks)
                rows.append({"kind": kind, "particles": size, "bodies": bodies, "ranks": ranks,
                             "seconds_per_step": seconds, "efficiency": efficiency, "within": n >= model.smallest})
    return rows


def against_measured(model, runs):
    lines = ["| ranks | particles | measured [ms] | model [ms] | off by |", "|" + "---|" * 5]
    for run in sorted((run for run in runs if run.bodies == 0), key=lambda run: (run.ranks, run.particles)):
        own = model.particles(run.particles / run.ranks, run.ranks)
        lines.append(f"| {run.ranks} | {run.particles:,} | {1e3 * run.seconds_per_step:.4g} | {1e3 * own:.4g} "
                     f"| {100 * (own / run.seconds_per_step - 1):.2g} % |")
    return [*lines, ""]


def markdown(model, rows, runs, weak, totals):
    t = model.terms
    bandwidth = f" ({1e-9 / t['per_byte']:.4g} GB/s)" if t["per_byte"] else ""
    first, commits = runs[0], ", ".join(sorted({run.commit for run in runs}))
    lines = [f"Fitted to {len(runs)} runs: {first.device}, {first.precision}, {first.dimension}D, commit {commits}.",
             "",
             "| term | value |", "|---|---|",
             f"| fixed | {1e6 * t['fixed']:.4g} us |", f"| per particle | {1e9 * t['per_particle']:.4g} ns |",
             f"| per message of a halo update | {1e6 * t['per_message']:.4g} us |",
             f"| per byte of a halo update | {1e9 * t['per_byte']:.4g} ns{bandwidth} |",
             f"| per doubling of the ranks | {1e6 * t['per_level']:.4g} us |",
             f"| bytes of a face over sqrt(n) | {model.per_face:.4g} |",
             f"| particles of the fullest rank over the mean | {model.uneven:.4g} |",
             f"| largest error of the fit | {100 * model.error:.2g} % |"]
    if model.coupling_error is None:
        lines.append("| coupling with bodies | not measured: 0 |")
    else:
        lines.append(f"| coupling with bodies | {1e6 * model.coupling:.4g} us + {1e6 * model.coupling_per_rank:.4g} us "
                     f"per rank, largest error {100 * model.coupling_error:.2g} % of a step; from runs on "
                     f"{', '.join(map(str, model.coupling_ranks))} ranks, beyond them extrapolated |")
    lines += [f"| rank 0's solve of {bodies:,} bodies | {1e3 * seconds:.4g} ms |" for bodies, seconds in model.solve]
    lines += [f"| assumed past {model.network.per_host} ranks | {1e6 * model.network.latency:.3g} us more per message, "
              f"at most {1e-9 * model.network.bandwidth:.3g} GB/s |", ""]
    lines += ["The particles' steps, measured and by the model:", "", *against_measured(model, runs)]
    for kind, size in [("weak", weak), *(("strong", total) for total in totals)]:
        what = "per rank" if kind == "weak" else "in all"
        lines += [f"{kind.capitalize()} scaling, {size:,.0f} particles {what}: steps/s (efficiency against one rank "
                  "without bodies; *: fewer particles per rank than measured)", "",
                  "| ranks | " + " | ".join(f"{b:,} bodies" for b in BODIES) + " |", "|" + "---|" * (1 + len(BODIES))]
        for ranks in RANKS:
            cells = [row for row in rows if (row["kind"], row["particles"], row["ranks"]) == (kind, size, ranks)]
            lines.append(f"| {ranks:,} | " + " | ".join(
                f"{1 / row['seconds_per_step']:.4g} ({100 * row['efficiency']:.1f} %){'' if row['within'] else '*'}"
                for row in cells) + " |")
        lines.append("")
    return "\n".join(lines + limits(model, weak, totals)) + "\n"


def count(number):
    """With three digits, and in millions from one on: 7.94 million."""
    millions = number >= 1e6
    return f"{float(f'{number / 1e6 if millions else number:.3g}'):,g}{' million' if millions else ''}"


def limits(model, weak, totals):
    """Sentences on where rank 0 is the limit, and on the ranks with the most steps per second."""
    lines = ["Rank 0 is the limit where its solve and the exchange with it take as long as the step of the particles:",
             ""]
    for bodies in BODIES:
        if bodies:
            at = model.limit(bodies, lambda p: weak)
            lines.append(f"- {bodies:,} bodies, {count(weak)} particles per rank: " +
                         ("the limit nowhere" if at is None else f"the limit from {at:,} rank(s) on"))
        for total in totals:
            at, best = model.limit(bodies, lambda p: total / p), model.fastest(bodies, total)
            measured.note(f"scaling_model/{total:.2g} particles, {bodies} bodies/limit", at or "", "GPUs")
            measured.note(f"scaling_model/{total:.2g} particles, {bodies} bodies/fastest", best, "GPUs")
            measured.note(f"scaling_model/{total:.2g} particles, {bodies} bodies/rate",
                          float(1 / model.step(total / best, best, bodies)), "steps/s")
            where = "nowhere" if at is None else f"from {at:,} rank(s) on ({count(total / at)} particles per rank)"
            lines.append(f"- {bodies:,} bodies, {count(total)} particles in all: the limit {where}; most steps per "
                         f"second, {1 / model.step(total / best, best, bodies):,.4g}, on {best:,} rank(s) "
                         f"({count(total / best)} particles per rank)")
    return lines


def choose(runs, name):
    """The runs of one backend; they must be of one device and method."""
    chosen = [run for run in runs if run.backend == name]
    if not chosen:
        raise SystemExit(f"error: --backend {name}: allowed: {', '.join(sorted({run.backend for run in runs}))}, "
                         "which the files have runs of")
    for column in ("device", "precision", "dimension", "integrator"):
        if len(values := {run.kind[column] for run in chosen}) > 1:
            raise SystemExit(f"error: runs of more than one {column}: {', '.join(sorted(values))}; give files of one")
    return chosen


def positive(text):
    value = float(text)
    if not value > 0 or math.isinf(value):
        raise argparse.ArgumentTypeError(f"{text}: must be a positive number")
    return value


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=pathlib.Path, metavar="RANKS.csv")
    parser.add_argument("--chain", type=pathlib.Path, metavar="CHAIN.csv")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR")
    parser.add_argument("--kept", action="store_true", help="the runs of tests/performance/measured.csv")
    parser.add_argument("--backend", choices=["cuda", "cpu"], default="cuda", help="whose runs (default: cuda)")
    parser.add_argument("--weak", type=positive, default=8e6, metavar="N", help="particles per rank (default: 8e6)")
    parser.add_argument("--strong", type=positive, nargs="+", default=[64e6, 1e9], metavar="N",
                        help="particles in all (default: 64e6 1e9)")
    parser.add_argument("--iterations", type=positive, default=2,
                        help="of the bodies' solve per step, as bed --plough prints (default: 2)")
    parser.add_argument("--per-host", type=positive, default=8, metavar="RANKS", help="ranks of one host (default: 8)")
    parser.add_argument("--network-latency", type=positive, default=5e-6, metavar="S", help="assumed (default: 5e-6)")
    parser.add_argument("--network-bandwidth", type=positive, default=40e9, metavar="B/S",
                        help="per rank, assumed (default: 40e9)")
    arguments = parser.parse_args()
    if arguments.kept == bool(arguments.files or arguments.chain) or not (arguments.kept or arguments.out):
        parser.error("RANKS.csv, --chain and --out are needed, or --kept without files")
    if not arguments.kept and not (arguments.files and arguments.chain):
        parser.error("RANKS.csv and --chain belong together")
    if arguments.kept:
        runs, chain = rank_runs.kept(measured.read(TABLE))
    else:
        runs, chain = rank_runs.read_runs(arguments.files), rank_runs.read_chain(arguments.chain)
    runs = choose(runs, arguments.backend)
    network = Network(int(arguments.per_host), arguments.network_latency, arguments.network_bandwidth)
    model = fit(runs, chain, arguments.iterations, network)
    rows = predictions(model, arguments.weak, arguments.strong)
    measured.always(commit=runs[0].commit, machine=f"model, fitted to {runs[0].device}", backend=arguments.backend)
    measured.note("scaling_model/a message", 1e6 * model.terms["per_message"], "us")
    measured.note("scaling_model/exchange with a rank", 1e6 * model.coupling_per_rank, "us")
    measured.note(f"scaling_model/{arguments.weak:.2g} particles each, 2 ranks",
                  100 * model.step(arguments.weak, 1, 0) / model.step(arguments.weak, 2, 0), "%")
    text = markdown(model, rows, runs, arguments.weak, arguments.strong)
    if arguments.out:
        arguments.out.mkdir(parents=True, exist_ok=True)
        (arguments.out / "scaling_model.md").write_text(text)
        with open(arguments.out / "scaling_model.csv", "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
    print(text)
    try:
        scaling_plot.plot((arguments.out or PICTURES) / "scaling_model.png", model, rows, runs, arguments.weak,
                          arguments.strong, count)
    except ImportError as error:
        print(f"no figure: {error}")


if __name__ == "__main__":
    sys.exit(main())
