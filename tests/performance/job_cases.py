"""The jobs that jobs.py times: decks of input/examples with the settings of their heads, and beds on four floors."""
import dataclasses
import pathlib

import mesh_bed

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "input/examples"
# Particles as in the head of excavator.toml with a million of them: (radii [m], step [s]).
EXCAVATOR = (0.00205, 0.00273), 1.3e-5
# The arm's tables, with its descent twice as fast from t = 0 on instead of from 0.5 s on: what the deck does from 1 s
# on, when the bucket enters the bed, happens 0.7 s earlier. By then the bed is at rest, too.
TIMES = [0, 0.2, 0.55, 1.0, 1.5, 1.9, 2.4, 2.9, 3.3]
LENGTHS = {"boom": [0.6277, 0.5877, 0.5539, 0.5625, 0.5665, 0.5819, 0.6345, 0.6777, 0.6777],
           "stick": [0.6192, 0.6314, 0.6396, 0.6794, 0.723, 0.7406, 0.7328, 0.7052, 0.7052],
           "bucket": [0.162, 0.1608, 0.1656, 0.1588, 0.161, 0.1834, 0.2212, 0.2686, 0.2686]}
DIGGING = 0.45  # from where on digging is timed [s]; 1.15 s of the deck
# Of the other decks: their own number of particles, the settings of a million, and the end [s] of both.
OTHERS = {
    "drum_lifters": ("grains", 800, 0.5, 0.08, {
        "radius.min": 0.000325, "radius.max": 0.000464, "/contact.pairs.0.stiffness": 2000,
        "/contact.pairs.1.stiffness": 2000, "/time.step": 1.8e-6, "/meshes.drum.segments": 528}),
    "wheel_rig": ("bed", 4500, 0.5, 0.3, {
        "radius.min": 0.00099, "radius.max": 0.00132, "/meshes.tire.segments": 192, "/time.step": 8e-6}),
    "screw_lift": ("grains", 2400, 0.5, 0.15, {
        "radius.min": 0.00061, "radius.max": 0.00075, "/time.step": 4.6e-6, "/meshes.pipe.inner_radius": 0.0425,
        "/meshes.screw.segments": 120, "/meshes.pipe.segments": 192})}
SIDE, STEPS = 27, 5000  # of the beds on floors
DRIVEN = ('motions = [{ type = "translation", direction = [1.0, 0.0, 0.0], displacement = { kind = "sine", '
          'amplitude = 0.001, frequency = 5.0 } }]\n')
BELT = "surface_velocity = [0.1, 0.0, 0.0]\n"


@dataclasses.dataclass
class Job:
    name: str
    particles: int
    deck: pathlib.Path | str  # a file, or the text of one
    end: float  # [s]
    settings: dict = dataclasses.field(default_factory=dict)
    start: float = 0  # from where on it is timed, with the state of a run up to there [s]
    asked: bool = False  # only where --only has its name

    def overrides(self, end):
        """The words of --set. Snapshots of the first and the last state alone, which no step waits for."""
        off = {"output.snapshot_interval": 0, "output.checkpoint_wall_interval": 0, "output.fields": []}
        return [word for key, value in {**self.settings, **off, "time.end": f"{end:.9g}"}.items()
                for word in ("--set", f"{key}={value}")]


def amount(particles):
    """1e6, 5e3, 800"""
    return f"{particles:.0e}".replace("e+0", "e") if particles >= 1000 and particles % 1000 == 0 else str(particles)


def scaled(particles, at_a_million):
    """A length of the bed of a million particles for another number of them, in the same volume."""
    return float(f"{at_a_million * (1e6 / particles) ** (1 / 3):.4g}")


def early_arm():
    return {f"cylinders.{name}_cylinder.length.{key}": values
            for name, lengths in LENGTHS.items() for key, values in (("times", TIMES), ("values", lengths))}


def excavator(particles, steps):
    """While it digs, for about so many steps; while its bed falls; and from the start on."""
    radii, step = EXCAVATOR
    name, deck = f"excavator {amount(particles)}", EXAMPLES / "excavator.toml"
    settings = {}
    if particles != 5000:
        settings = {"particles.bed.count": particles, "particles.bed.radius.min": scaled(particles, radii[0]),
                    "particles.bed.radius.max": scaled(particles, radii[1])}
    if particles >= 1e6:
        settings["time.step"] = scaled(particles, step)
    window = steps * scaled(particles, step)
    whole = 2.0 if particles < 1e6 else 1.5
    return [Job(f"{name}, digging", particles, deck, DIGGING + window, {**settings, **early_arm()}, start=DIGGING),
            Job(f"{name}, falling", particles, deck, 0.1 if particles < 4e6 else 0.05, settings),
            Job(f"{name}, to {whole:g} s", particles, deck, whole, settings, asked=particles >= 1e6)]


def other(deck, million):
    """A deck at its own size, or with the settings of a million."""
    group, count, own_end, end, settings = OTHERS[deck]
    name = deck.split("_")[0]
    if not million:
        return Job(f"{name} {count}", count, EXAMPLES / f"{deck}.toml", own_end)
    keys = {key[1:] if key[0] == "/" else f"particles.{group}.{key}": value for key, value in settings.items()}
    return Job(f"{name} 1e6", 1_000_000, EXAMPLES / f"{deck}.toml", end,
               {f"particles.{group}.count": 1_000_000, **keys})


def floors(side=SIDE, steps=STEPS):
    """A bed of 2e4 on a plane and on meshes: at rest, driven, and a conveyor, with the skin that a deck leaves out."""
    bed = mesh_bed.deck(side, side, steps).replace(f"skin = {mesh_bed.SKIN * mesh_bed.RADIUS:.9g}\n", "")
    mesh = mesh_bed.mesh(side, 0.0107)
    return [Job(f"floor, {name}", side ** 3, bed + floor, 2e-5 * steps)
            for name, floor in (("plane", mesh_bed.PLANE), ("mesh at rest", mesh), ("driven mesh", mesh + DRIVEN),
                                ("mesh as conveyor", mesh + BELT))]


def conveyor():
    """The deck's grains, 5.2 times as small, and as many more."""
    settings = {"particles.grains.radius": 0.0015, "particles.grains.origin": [-0.16, -0.045, 0.05],
                "particles.grains.spacing": [0.0038, 0.0038, 0.0038], "particles.grains.size": [36, 24, 23],
                "contact.pairs.0.stiffness": 2000}
    return Job("conveyor 2e4", 36 * 24 * 23, EXAMPLES / "conveyor.toml", 0.25, settings)


def all_jobs():
    """In the order in which they are run: what is cheap, or asked for first, in front."""
    return [*floors(), conveyor(), *excavator(5000, 5000), *excavator(100_000, 20_000), *excavator(1_000_000, 6000),
            *(other(deck, True) for deck in OTHERS), *(other(deck, False) for deck in OTHERS),
            *excavator(4_000_000, 2000)]


def quick_jobs():
    """A few steps of each, with few particles."""
    def few(job, particles, end):
        group = "bed" if "bed.count" in str(job.settings) or job.deck.stem in ("excavator", "wheel_rig") else "grains"
        return dataclasses.replace(job, particles=particles, end=end,
                                   settings={**job.settings, f"particles.{group}.count": particles})
    digging, falling, _ = excavator(5000, 5000)
    return [*floors(3, 20), dataclasses.replace(conveyor(), end=2e-4),
            dataclasses.replace(few(digging, 100, 0.012), start=0.01), few(falling, 100, 0.002),
            *(few(other(deck, False), 50, 0.002) for deck in OTHERS)]
