"""The picture of scaling_model.py."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import figures  # noqa: E402


def plot(path, model, rows, runs, weak, totals, words):
    """rows: of scaling_model.predictions; weak, totals: particles per rank, and in all; words(number): as one reads
    it."""
    of_bodies = sorted({row["bodies"] for row in rows})
    colors = dict(zip(of_bodies, (figures.INK, figures.CPU, figures.OTHER, figures.GPU)))
    unit = "GPUs" if runs[0].backend == "cuda" else "ranks"
    figure, axes = figures.subplots(1, 1 + len(totals), figsize=(5.6 * (1 + len(totals)), 6), squeeze=False,
                                    sharey=True)
    for axis, (kind, size) in zip(axes[0], [("weak", weak), *(("strong", total) for total in totals)]):
        for bodies in of_bodies:
            part = [row for row in rows if (row["kind"], row["particles"], row["bodies"]) == (kind, size, bodies)]
            axis.plot([row["ranks"] for row in part], [1 / row["seconds_per_step"] for row in part], linewidth=2,
                      color=colors[bodies], label=f"{bodies:,} bodies" if bodies else "no bodies")
            limit = model.limit(bodies, (lambda p: size) if kind == "weak" else (lambda p: size / p))
            if limit:
                n = size if kind == "weak" else size / limit
                axis.plot([limit], [1 / model.step(n, limit, bodies)], "v", color=colors[bodies], markersize=11)
            if kind == "strong" and bodies:
                best = model.fastest(bodies, size)
                axis.plot([best], [1 / model.step(size / best, best, bodies)], "*", color=colors[bodies],
                          markersize=15, markeredgecolor="white")
        points = [run for run in runs if run.bodies == 0 and
                  abs(run.particles / (run.ranks if kind == "weak" else 1) / size - 1) < 1e-2]
        if points:
            axis.plot([run.ranks for run in points], [1 / run.seconds_per_step for run in points], "o",
                      color="white", markeredgecolor=figures.INK, markeredgewidth=2, markersize=9,
                      label="measured, no bodies")
        axis.set(xscale="log", yscale="log")
        axis.set_xticks([1, 10, 100, 1000], ["1", "10", "100", "1,000"])
        axis.yaxis.set_major_formatter(lambda value, _: f"{value:,g}")
        many = words(size).replace("1,000 million", "1 billion")
        figures.label(axis, f"{many} particles {'on each' if kind == 'weak' else 'in all'}", unit,
                      "steps per second" if kind == "weak" else "")
    for mark, text in (("v", "rank 0 is the limit"), ("*", "most steps per second")):
        axes[0][0].plot([], [], mark, color=figures.PALE, markersize=11, label=text)
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), fontsize=figures.SMALL, frameon=False)
    most = max(run.ranks for run in runs)
    figures.save(figure, path, f"Explicit steps of spheres: the model, fitted to 1 to {most} {unit} ({runs[0].device})")
