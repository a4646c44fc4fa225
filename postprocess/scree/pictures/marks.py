"""Scale bar and directions of a picture, instead of axes."""

from scree.pictures.framing import scale_bar_length
from scree.pictures.palette import PALE_INK

LETTERS = 11  # font size [pt]


def draw_scale_bar(axes):
    """A scale bar below the picture."""
    left, right = axes.get_xlim()
    length = scale_bar_length(right - left)
    ends, below = [left, left + length], axes.get_xaxis_transform()
    axes.plot(ends, [-0.02, -0.02], transform=below, color=PALE_INK, linewidth=2.5, solid_capstyle="butt",
              clip_on=False)
    axes.annotate(f"{length:g} m", (ends[1], -0.02), (6, 0), xycoords=below, textcoords="offset points", ha="left",
                  va="center", fontsize=LETTERS, color=PALE_INK)


def draw_directions(axes, origin, length, directions):
    """Arrows of the global axes. directions: of these in the picture, {name: [2]}."""
    for name, direction in directions.items():
        style = {"arrowstyle": "-|>", "color": PALE_INK, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 9}
        axes.annotate("", origin + length * direction, origin, arrowprops=style)
        axes.text(*(origin + 1.4 * length * direction), name, ha="center", va="center", fontsize=LETTERS,
                  color=PALE_INK)
