"""What is said of inserters and outlets that cannot be. Usage: SCREE=path/to/scree python3 test_inserter_messages.py"""

import unittest

from test_cli import BAD_INPUT, DONE, CommandLineTest

DECK = """gravity = [0, 0, -9.81]
[space]
dimension = 3
min = [0, 0, 0]
max = [1, 1, 1]
z_min = "wall"
[time]
end = 1
step = 1e-4
control = "fixed"
[[contact.pairs]]
stiffness = 1000.0
[[walls]]
name = "slope"
point = [0, 0, 0.1]
normal = [0.1, 0, 1]
[[inserters]]
name = "rain"
kind = "box"
min = [0.2, 0.2, 0.5]
max = [0.8, 0.8, 0.9]
number_rate = 200
radius = 0.01
density = 1000
[[inserters]]
name = "stream"
kind = "face"
center = [0.5, 0.5, 0.4]
width = 0.2
velocity = [0, 0, -1]
mass_rate = 0.1
radius = 0.01
density = 1000
[[outlets]]
name = "hole"
kind = "sphere"
center = [0.5, 0.5, 0]
region_radius = 0.1
"""
RAIN, STREAM, HOLE = "inserters.rain.", "inserters.stream.", "outlets.hole."
MANY = ", ".join(f'{{ name = "{k}", kind = "sphere", center = [0, 0, 0], region_radius = 0.1 }}' for k in range(9))
# Settings, and a part of the message.
REFUSED = (
    ((RAIN + "mass_total=1.0",), "exactly one measure of the births must be given"),
    ((RAIN + "solid_fraction=0.1",), "exactly one measure of the births must be given"),
    ((RAIN + "number=0",), "rain.number must be an integer from 1 to 1000000000"),
    ((RAIN + "number_rate=0.0",), "rain.number_rate must be a number above 0 [1/s]"),
    ((RAIN + "number_rate=1e12",), "up to 1e+12 particles would be born until time.end; at most 1e+09 may be"),
    ((RAIN + "kind=blob",), 'must be one of "box", "cylinder", "sphere", "mesh", "face"'),
    ((RAIN + "kind=sphere",), 'not used with kind = "sphere", only with "box"'),
    ((RAIN + "max=[0.1,0.8,0.9]",), "must be larger than min in every component"),
    ((RAIN + "max=[0.21,0.8,0.9]",), "the largest particles, of radius 0.01 m, do not fit into the region; it has "
     "room for radii up to 0.005 m"),
    ((RAIN + "min=[2.0,0.2,0.5]", RAIN + "max=[3.0,0.8,0.9]"), "the region is outside the domain of [space]"),
    ((RAIN + "on=nobody",), 'there is no body named "nobody"'),
    ((RAIN + "on=slope",), "is a plane at rest: leave the key out"),
    ((RAIN + "start=0.5", RAIN + "end=0.5"), "must be above start = 0.5 s"),
    ((RAIN + "interval=-1.0",), "rain.interval must be a number of at least 0 [s]"),
    ((RAIN + "interval=1e-300",), "must not be below 1e-15 s"),
    (("gravity=[0.0,0.0,0.0]",), "missing; without gravity it must be a number of at least 0 [s]"),
    ((RAIN + "rate_times=[0.0,1.0]",), "must have as many entries as rate_times: 2"),
    ((RAIN + "rate_times=[0.0]", RAIN + "rate_factors=[1.0]"), "must have at least two entries"),
    ((RAIN + "rate_times=[0.0,0.5,0.5]", RAIN + "rate_factors=[1.0,1.0,1.0]"), "must increase"),
    ((RAIN + "rate_times=[-1.0,0.5]", RAIN + "rate_factors=[1.0,1.0]"), "must not be negative"),
    ((RAIN + "rate_times=[0.0,0.5]", RAIN + "rate_factors=[1.0,-1.0]"), "rate_factors must be a list of numbers"),
    ((RAIN + "rate_times=[0.0,0.5]", RAIN + "rate_factors=[1.0,1.0]", RAIN + "start=0.1"),
     "not used together with rate_times"),
    ((RAIN + "tries=0",), "rain.tries must be an integer from 1 to 10000"),
    ((RAIN + "blocked=maybe",), 'must be one of "wait", "drop", "error"'),
    ((RAIN + "most_waiting=-1",), "rain.most_waiting must be an integer of at least 0"),
    ((RAIN + "most_waiting=1", RAIN + "blocked=drop"), 'used with blocked = "wait" only'),
    ((RAIN + "seed=-1",), "rain.seed must be an integer of at least 0"),
    ((RAIN + "gap=-1.0",), "rain.gap must be a number of at least 0 [m]"),
    ((RAIN + "random_velocity=-1.0",), "rain.random_velocity must be a number of at least 0 [m/s]"),
    ((RAIN + "material=stone",), 'there is no material named "stone"'),
    ((RAIN + "mixture=[{radius=0.01,density=1000.0}]",), "not used together with mixture, whose components have it"),
    ((RAIN + "name=stream",), "repeated; names must be different"),
    ((RAIN + "mesh=box",), 'not used with kind = "box", only with "mesh"'),
    ((STREAM + "velocity=[0.0,0.0,0.0]",), "missing; particles pass a face with a velocity"),
    ((STREAM + "normal=[0.0,0.0,1.0]",), "must point to the side that velocity leads to"),
    ((STREAM + "width_axis=[0.0,0.0,1.0]",), "must not be along the normal"),
    ((STREAM + "region_radius=0.1",), "exactly one of the keys width and region_radius must be given for a face"),
    ((STREAM + "mass_rate=100.0",), "more than random positions can fill (0.55); a larger face, a higher velocity or a "
     "lower rate is needed"),
    ((HOLE + "on=nobody",), 'there is no body named "nobody"'),
    ((HOLE + "interval=0.0",), "hole.interval must be a number above 0 [s]"),
    ((HOLE + "interval=1e-300",), "must not be below 1e-15 s"),
    ((HOLE + "start=0.5", HOLE + "end=0.4"), "must be above start = 0.5 s"),
    ((HOLE + "region_radius=0.0",), "hole.region_radius must be a number above 0 [m]"),
    ((HOLE + "kind=box",), 'not used with kind = "box", only with'),
    (("gravity=[0.0,0.0,0.0]", RAIN + "interval=0.1"), "missing; without gravity it must be a number above 0 [s]"),
    ((f"outlets=[{MANY}]",), "a deck can have at most 8 outlets"),
)
REFUSED_2D = (
    ('kind = "cylinder"\nends = [[0, 0.5], [1, 0.5]]\nregion_radius = 0.1\nnumber = 3', "a cylinder needs 3D"),
    ('kind = "face"\ncenter = [0.5, 0.5]\nregion_radius = 0.1\nvelocity = [0, -1]\nnumber_rate = 3',
     "not used in 2D: a face is a line of the length width"),
    ('kind = "face"\ncenter = [0.5, 0.5]\nwidth = 0.1\nheight = 0.1\nvelocity = [0, -1]\nnumber_rate = 3',
     "not used in 2D: a face is a line of the length width"),
    ('kind = "face"\ncenter = [0.5, 0.5]\nwidth = 0.1\nvelocity = [0, -1]\nsolid_fraction = 0.1',
     "not used for a face, which has no volume"),
    ('kind = "box"\nmin = [0.1, 0.1]\nmax = [0.9, 0.9]\nsolid_fraction = 0.7', "more than random positions can fill"),
)


class InserterMessagesTest(CommandLineTest):
    def check(self, code, text, settings=()):
        given = [word for setting in settings for word in ("--set", setting)]
        return self.expect(code, "check", self.write("births.toml", text), *given)

    def test_check_says_what_will_be_born(self):
        text = self.check(DONE, DECK).stdout
        self.assertRegex(text, r"particles      0 and at most 2\d\d of inserters, radius 0.01 m")
        self.assertIn('"rain": 200 particles until time.end, of 0.004189 kg each on average, radius 0.01 m; born every',
                      text)
        self.assertIn('"stream": 0.1 kg until time.end', text)

    def test_a_dense_stream_is_warned_of(self):
        self.assertIn("many random positions are occupied, and births are late",
                      self.check(DONE, DECK, [STREAM + "mass_rate=12.0"]).stderr)

    def test_births_after_the_end_are_warned_of(self):
        self.assertIn("inserters.rain: no particle is born until time.end = 1 s",
                      self.check(DONE, DECK, [RAIN + "start=1.5"]).stderr)

    def test_what_a_deck_must_not_say(self):
        for settings, part in REFUSED:
            with self.subTest(settings=settings):
                message = self.check(BAD_INPUT, DECK, settings).stderr
                self.assertRegex(message, r"(?m)^error: (--set |.*births\.toml:\d+:\d+: )")
                self.assertIn(part, message)

    def test_what_a_deck_in_2d_must_not_say(self):
        for keys, part in REFUSED_2D:
            with self.subTest(keys=keys):
                deck = ("gravity = [0, -9.81]\n[space]\ndimension = 2\nmin = [0, 0]\nmax = [1, 1]\n[time]\nend = 1\n"
                        "step = 1e-4\n[[contact.pairs]]\nstiffness = 1000.0\n[[inserters]]\nname = \"rain\"\n"
                        f"radius = 0.01\ndensity = 1000\n{keys}\n")
                self.assertIn(part, self.check(BAD_INPUT, deck).stderr)


if __name__ == "__main__":
    unittest.main()
