"""The manual as a page and as a JSON schema: both are checked in, current and right. Usage: as test_cli.py, by a Python
with postprocess/requirements.txt"""

import copy
import json
import pathlib
import re
import tomllib
import unittest

import jsonschema

from test_cli import BAD_INPUT, DECK, DONE, CommandLineTest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE, SCHEMA = ROOT / "input/keys.md", ROOT / "postprocess/scree/deck.schema.json"
MOST_RUNS = 3  # of the program, on decks with one kind of mistake
DECKS = sorted([*ROOT.glob("input/*/*.toml"), *ROOT.glob("tests/ranks/*.toml")])

# Decks with one thing wrong: what is added to which table of DECK, or put in the place of what is there.
WRONG = {
    "an unknown key": [("title", {"titel": "x"}), ("time", {"stop": 1.0}), ("particles", {"radii": 0.1}),
                       ("bodies", {"colour": "red"}), ("output", {"snapshots": 3}), ("contact", {"law": "hertz"})],
    "a wrong type": [("time", {"end": "1 s"}), ("time", {"step": True}), ("particles", {"size": [2, 2.5]}),
                     ("bodies", {"mass": [1.0]}), ("output", {"history_csv": 1}), ("title", {"title": 5}),
                     ("particles", {"radius": "0.05"}), ("space", {"dimension": 2.5}), ("bodies", {"shapes": 1})],
    "out of range": [("time", {"end": 0.0}), ("time", {"step": -1e-4}), ("bodies", {"mass": 0.0}),
                     ("space", {"dimension": 4}), ("output", {"compression": 10}), ("particles", {"radius": -0.05}),
                     ("integrator", {"hht_alpha": 0.1}), ("particles", {"size": [0, 3]}), ("bodies", {"count": 0}),
                     ("title", {"gravity": [0.0]}), ("spring_dampers", {"points": [[0.0, 0.0]]}),
                     ("bodies", {"name": ""}), ("bodies", {"name": "a/b"}), ("bodies", {"name": ".."}),
                     ("bodies", {"name": "a\nb"})],
    "a word that there is not": [("time", {"control": "variable"}), ("space", {"x_min": "open wall"}),
                                 ("space", {"leaving": "ignore"}), ("particles", {"kind": "grid"}),
                                 ("particles", {"radius": {"kind": "gauss", "mean": 1.0}}),
                                 ("bodies", {"kind": "flexible"})],
    "a key of another kind": [("particles", {"positions": [[0.0, 0.0]]}), ("time", {"max_step": 1e-3}),
                              ("bodies", {"inertia_tensor": [1.0] * 6}),
                              ("particles", {"radius": {"kind": "uniform", "min": 0.1, "max": 0.2, "mean": 0.1}}),
                              ("spring_dampers", {"actuator": {"kind": "ramp", "frequency": 1.0}})],
    "a key that is missing": [("time", {"end": None}), ("space", {"dimension": None}),
                              ("particles", {"spacing": None}), ("particles", {"kind": None}),
                              ("bodies", {"position": None}), ("bodies", {"name": None}),
                              ("particles", {"radius": {"kind": "uniform", "min": 0.1}}),
                              ("spring_dampers", {"actuator": {"kind": "ramp"}}), ("title", {"space": None})],
}


def changed(table, keys):
    """DECK with these values in one of its tables, or without those that are None; "title": its top."""
    deck = copy.deepcopy(tomllib.loads(DECK))
    place = deck if table == "title" else deck.setdefault(table, {})
    place = place[0] if isinstance(place, list) else place
    for key, value in keys.items():
        place.pop(key, None) if value is None else place.update({key: value})
    return deck


def toml(value):
    """A value of a deck as inline TOML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(entry)}" for key, entry in value.items()) + "}"
    return "[" + ", ".join(map(toml, value)) + "]" if isinstance(value, list) else json.dumps(value)


class PageTest(CommandLineTest):
    def test_the_page_and_the_schema_are_current(self):
        for word, path in (("--markdown", PAGE), ("--schema", SCHEMA)):
            self.assertEqual(self.expect(DONE, "keys", word).stdout, path.read_text(),
                             f"make it anew: scree keys {word} > {path.relative_to(ROOT)}")
        self.assertIn("--markdown", self.expect(BAD_INPUT, "keys", "--markdown", "--schema").stderr)

    def test_links_of_the_page_lead_somewhere(self):
        text = PAGE.read_text()
        anchors = re.findall(r'<a id="([^"]+)"></a>', text)
        self.assertEqual(len(anchors), len(set(anchors)))
        self.assertGreater(len(anchors), 250)
        self.assertFalse(set(re.findall(r"\]\(#([^)]+)\)", text)) - set(anchors))

    def test_the_page_has_every_key_of_the_manual(self):
        manual = re.findall(r"(?m)^  ([a-z_]+)$", self.expect(DONE, "keys").stdout)
        page = re.findall(r'(?m)^\| <a id="[^"]+"></a>`([a-z_]+)` \|', PAGE.read_text())
        self.assertEqual(sorted(page), sorted(manual))


class SchemaTest(CommandLineTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        schema = json.loads(SCHEMA.read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        cls.validator = jsonschema.Draft202012Validator(schema)

    def test_every_deck_is_valid(self):
        self.assertGreater(len(DECKS), 40)
        for path in DECKS:
            with self.subTest(deck=path.relative_to(ROOT)):
                self.validator.validate(tomllib.loads(path.read_text()))

    def test_wrong_decks_are_refused_by_the_schema_as_by_the_program(self):
        self.validator.validate(tomllib.loads(DECK))
        for what, decks in WRONG.items():
            for number, (table, keys) in enumerate(decks):
                with self.subTest(what, table=table, keys=keys):
                    deck = changed(table, keys)
                    self.assertFalse(self.validator.is_valid(deck))
                    if number >= MOST_RUNS:
                        continue
                    text = "\n".join(f"{key} = {toml(value)}" for key, value in deck.items())
                    self.assertIn("wrong.toml", self.expect(BAD_INPUT, "check", self.write("wrong.toml", text)).stderr)

    def test_every_default_is_one_of_the_values_that_are_allowed(self):
        def look(schema, path):
            if "default" in schema:
                whole = schema | {"$defs": self.validator.schema["$defs"]}
                self.validator.evolve(schema=whole).validate(schema["default"])
            for name, below in schema.get("properties", {}).items():
                look(below, f"{path}.{name}")
            if "items" in schema:
                look(schema["items"], path)

        look(self.validator.schema, "")


if __name__ == "__main__":
    unittest.main()
