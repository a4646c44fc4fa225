"""Style of plots of measurements: large letters, few lines, colours for the colour-blind, names beside the
curves. matplotlib is loaded when a plot is drawn: measurements need none."""

CPU, GPU, OTHER, FOURTH = "#0072b2", "#d55e00", "#009e73", "#cc79a7"  # Okabe and Ito's
INK, PALE = "#262626", "#6a6a6a"
SMALL, LARGE = 12, 16  # letters [pt]


def subplots(*shape, **options):
    """As matplotlib.pyplot.subplots(), with this style."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot
    figure, axes = matplotlib.pyplot.subplots(*shape, dpi=130, layout="constrained", **options)
    for each in figure.axes:
        each.spines[["top", "right"]].set_visible(False)
        each.grid(True, which="major", color="#e2e2e2", linewidth=0.7)
        each.set_axisbelow(True)
        each.tick_params(labelsize=SMALL, colors=INK)
    return figure, axes


def label(axes, title, x, y):
    axes.set_title(title, loc="left", fontsize=LARGE - 2, color=INK, pad=10)
    axes.set_xlabel(x, fontsize=SMALL + 1, color=INK)
    axes.set_ylabel(y, fontsize=SMALL + 1, color=INK)


def beside(axes, x, y, text, color, shift=(8, 0), **options):
    """A curve's name at one of its points."""
    axes.annotate(text, (x, y), shift, textcoords="offset points", color=color, fontsize=SMALL,
                  **{"ha": "left", "va": "center", **options})


def save(figure, path, title=None):
    if title:
        figure.suptitle(title, fontsize=LARGE, x=0.01, ha="left", color=INK)
    figure.savefig(path, metadata={"Title": title} if title else None)
