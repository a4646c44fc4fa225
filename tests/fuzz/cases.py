"""Makes the cases: mutated decks, particle files, mesh files and --set words, and damaged checkpoints."""

import dataclasses
import pathlib
import random
import re

import h5py
import numpy as np

import damage
import mutations
from judge import Case

HERE = pathlib.Path(__file__).resolve().parent
OWN = sorted((HERE / "decks").glob("*.toml"))
INPUT = sorted((HERE.parents[1] / "input").glob("*/*.toml"))
LARGEST = 100000  # bytes of a word of the command line


def named_files():
    """The files that the decks here name."""
    files = {name: (HERE / "decks" / name).read_bytes() for name in ("particles.csv", "wedge.stl")}
    with h5py.File("particles.h5", "w", driver="core", backing_store=False) as file:
        for name, values in (("x", [0.2, 0.5, 0.8]), ("y", [0.9, 0.9, 0.9]), ("z", [0.3, 0.5, 0.7]), ("vx", [0.0] * 3),
                             ("vy", [-1.0] * 3), ("vz", [0.0] * 3), ("radius", [0.05, 0.04, 0.05])):
            file[name] = np.array(values)
        file.flush()
        files["particles.h5"] = file.id.get_file_image()
    return files


@dataclasses.dataclass
class Key:
    """As `scree keys` declares it. table: "" for the top of the deck. facts: what it takes."""
    table: str
    is_list: bool
    name: str
    facts: str = ""


def declared_keys(manual):
    keys, table, is_list = [], "", False
    for line in manual.splitlines():
        if header := re.match(r"(\[+)([\w.]+)\]+", line):
            table, is_list = header.group(2), len(header.group(1)) == 2
        elif re.match(r"\S", line):
            table, is_list = None if "(" in line and "top" not in line else "", False
        elif (key := re.match(r"  (\w+)$", line)) and table is not None:
            keys.append(Key(table, is_list, key.group(1)))
        elif keys and not keys[-1].facts:
            keys[-1].facts = line.strip().split(";")[0]
    return keys


def plausible_value(key, rng):
    """One that the key's declaration may allow."""
    if key.facts.startswith("one of"):
        return rng.choice(re.findall(r'"[^"]*"', key.facts) or ['""'])
    number = rng.choice(["0.0", "1e-9", "1e-6", "1e-4", "1e-3", "0.02", "0.1", "1.0", "-0.3", "10.0", "1e3", "1e6"])
    name = rng.choice(["arm", "cord", "cord.1", "wheel", "hinge", "steel", "rubber", "chain", "paddle", "x_min",
                       "ground"])
    for start, value in (("true or false", rng.choice(["true", "false"])),
                         ("an integer", rng.choice("0123579") + "0"[:rng.choice([0, 0, 1])]),
                         ("a number", number),
                         ("2 or 3 numbers", rng.choice([f"[{number}, 0.1]", f"[0.1, {number}, 0.0]"])),
                         ("a list of texts", f'["{name}"]'), ("a list of 2 texts", f'["{name}", "ground"]'),
                         ("a list of integers", "[0, 3]"), ("a list", f"[{number}, 0.5]")):
        if key.facts.startswith(start):
            return value
    return f'"{name}"'


def some_value(key, rng):
    if rng.random() < 0.5:
        return plausible_value(key, rng)
    if rng.random() < 0.25:
        return f'"{rng.choice(mutations.TEXTS)}"'
    return rng.choice(mutations.NUMBERS + mutations.OTHERS)


KINDS = ("deck", "declared_key", "words", "particles", "meshes", "checkpoint")


class Maker:
    def __init__(self, seed, manual, kinds):
        self.seed, self.kinds = seed, kinds
        self.keys = declared_keys(manual)
        self.decks = [(path, path.read_text()) for path in OWN * 3 + INPUT]
        self.files = named_files()
        self.checkpoints = []  # (deck's text, checkpoint's bytes, state hash)

    def make(self, number):
        rng = random.Random(f"{self.seed} {number}")
        return getattr(self, rng.choice(self.kinds))(rng)

    def base(self, rng):
        path, text = rng.choice(self.decks)
        return text, {name: data for name, data in self.files.items() if path in OWN and f'"{name}"' in text}

    def deck(self, rng):
        text, files = self.base(rng)
        data, kinds = mutations.mutate(text, rng)
        return Case(kinds, {"deck.toml": data, **files})

    def declared_key(self, rng):
        """A key of the manual with some value, in a table of the deck."""
        text, files = self.base(rng)
        there = [key for key in self.keys if not key.table or f"[{key.table}]" in text]
        for _ in range(rng.choice([1, 1, 2, 3])):
            key = rng.choice(there if rng.random() < 0.9 else self.keys)
            table, line = key.table, f"{key.name} = {some_value(key, rng)}\n"
            headers = list(re.finditer(rf"^\[+{re.escape(table)}\]+.*\n", text, re.MULTILINE)) if table else []
            if not headers:
                text = line + text if not table else f"{text}\n[{rng.choice([table, f'[{table}]'])}]\n{line}"
                continue
            header = rng.choice(headers)
            end = text.find("\n[", header.end())
            body = text[header.end():end if end >= 0 else len(text)]
            body = re.sub(rf"^{key.name} *=.*\n", "", body, flags=re.MULTILINE)
            text = text[:header.end()] + line + body + (text[end:] if end >= 0 else "")
        return Case(("declared_key",), {"deck.toml": text.encode(errors="surrogatepass"), **files})

    def words(self, rng):
        text, files = self.base(rng)
        words = []
        for _ in range(rng.choice([1, 1, 2, 5])):
            words += ["--set", self.word(rng)]
        return Case(("set_word",), {"deck.toml": text.encode(), **files}, words)

    def word(self, rng):
        key = rng.choice(self.keys)
        element = rng.choice(["0.", "0.", "1.", "arm.", "99.", "-1.", ""]) if key.is_list else ""
        word = (f"{key.table}.{element}" if key.table else "") + f"{key.name}={some_value(key, rng)}"
        choice = rng.random()
        if choice < 0.1:
            word = word.replace("=", " = ", 1)
        elif choice < 0.15:
            word = ".".join([rng.choice(["a", "time"])] * rng.choice([2, 50, 300, 30000])) + "=1"
        elif choice < 0.25:
            at = rng.randrange(len(word) + 1)
            inserted = rng.choice(["=", ".", "..", "[", '"', "\n", "\x1b", "#", "ä", ",", "-", "\udcff"])
            word = word[:at] + inserted + word[at:]
        elif choice < 0.3:
            word = "".join(chr(rng.randrange(1, 256)) for _ in range(rng.choice([0, 1, 5, 40])))
        return word[:LARGEST]

    def particles(self, rng):
        name = rng.choice(["particles.csv", "particles.h5"])
        deck = next(text for _, text in self.decks if f'"{name}"' in text)
        files = {**self.files, "deck.toml": deck.encode()}
        if name.endswith(".h5"):
            files[name], kind = damage.damaged(files[name], rng)
            return Case(("particle_file", kind), files)
        changes = [mutations.delete_line, mutations.repeat_line, mutations.swap_lines, mutations.scale_number,
                   mutations.truncate, mutations.random_bytes, mutations.other_encoding, other_cell, other_cell]
        files[name], kinds = mutations.mutate(files[name].decode(), rng, changes)
        return Case(("particle_file", *kinds), files)

    def meshes(self, rng):
        deck = next(text for _, text in self.decks if '"wedge.stl"' in text)
        files = {**self.files, "deck.toml": deck.encode()}
        changes = [mutations.delete_line, mutations.repeat_line, mutations.swap_lines, mutations.scale_number,
                   mutations.truncate, mutations.random_bytes]
        files["wedge.stl"], kinds = mutations.mutate(files["wedge.stl"].decode(), rng, changes)
        return Case(("mesh_file", *kinds), files)

    def checkpoint(self, rng):
        text, files, data, state_hash = rng.choice(self.checkpoints)
        data, kind = damage.damaged(data, rng)
        return Case(("checkpoint", kind), {"deck.toml": text.encode(), "damaged.h5": data, **files},
                    restart="damaged.h5", state_hash=state_hash)

    def add_checkpoint(self, deck, data, state_hash):
        text = deck.read_text()
        files = {name: content for name, content in self.files.items() if f'"{name}"' in text}
        self.checkpoints.append((text, files, data, state_hash))


def other_cell(text, rng):
    cells = list(re.finditer(r"[^,\n]+", text))
    if not cells:
        return text
    cell = rng.choice(cells)
    new = rng.choice(mutations.NUMBERS + ["", "x", "radius", "mass", '"1"', "\x1b[31m", "1;2", "1 2", "é", "a" * 3000])
    return text[:cell.start()] + new + text[cell.end():]
