"""Tables of documents, made of the rows that measured.py keeps. A layout (TOML) says per table:

    unshown = ["more/"]       # first of all, if at all: rows whose keys begin so may be in no table,
    kept = ["earlier/"]       # or be written by nothing any longer
    [NAME]
    page = "input/choosing.md"      # has <!-- table NAME --> and <!-- end of table NAME -->; what is between is made
    columns = ["case", "what is compared", "demanded", "measured"]       # one more is added: commit and machine
    cells = ["{$/T} ({$/T steps})"]          # of all rows, the columns behind the title's; "$": each of the row's parts
    [[NAME.rows]]
    title = "net"                            # or a list, of the first columns
    parts = ["impact/a", "impact/b"]         # the cell is made of each, with "; " between
    cells = ["{net/error}, order {net/order|3}"]     # in place of the table's
    shows = "{net/error}"                    # makes two cells of it: what was demanded, and what was measured

{KEY} is the number of the row with this key and its unit; {KEY|FORMAT} in another form: % (percent of one), a number
of digits, "number" (without its unit), "over OTHER" (how many times the number of the row with the key OTHER) or "above
OTHER" (by how many percent more). "optional" in front of a form, or as one: "-" where there is no such row. A row of a
table of which nothing was measured yet, because all of its places are optional, is left out.
"""
import argparse
import re
import tomllib

import measured

SCALES = {"us": 1e-6, "ms": 1e-3}  # other units are those of both numbers
PLACE = re.compile(r"\{([^{}|]+)(?:\|([^{}]*))?\}")
# What writes rows: the key, or what is written out of it in front of what is put in.
WRITER = re.compile(r"\b(?:measured(?:\.py\"?)?|note|note_samples)[\s(]+f?\"([^\"{$]+)(\"\s*\+|.)")


def round_to(value, digits):
    """Text of a number with so many significant digits."""
    number = float(f"{float(value):.{digits}g}")
    if number == 0 or 1e-3 <= abs(number) < 1e6:
        return f"{number:,.10g}"
    mantissa, exponent = f"{number:.{digits - 1}e}".split("e")
    return f"{mantissa.rstrip('0').rstrip('.') if '.' in mantissa else mantissa}e{int(exponent)}"


def as_it_is(value):
    """The digits that were given."""
    if re.fullmatch(r"-?\d{4,}(\.\d+)?", value):
        return f"{float(value):,.10g}"
    return re.sub(r"e\+?(-?)0*(\d)", r"e\1\2", value)


class Format:
    """Of {KEY|FORMAT}; digits: where it names none, None for those that were given."""

    def __init__(self, text, digits):
        self.percent, self.unit, self.digits = False, True, digits
        for word in (text or "").split():
            if word == "%":
                self.percent = True
            elif word == "number":
                self.unit = False
            elif word.isdigit():
                self.digits = int(word)
            else:
                raise SystemExit(f"error: the form {text}; allowed: %, number, digits, over KEY, above KEY")

    def number(self, value, least_digits=0):
        if self.percent:
            value = repr(100 * float(value))
        digits = self.digits or (3 if self.percent else None)
        return as_it_is(value) if digits is None else round_to(value, max(digits, least_digits))

    def with_unit(self, text, unit):
        unit = "%" if self.percent else unit
        return f"{text} {unit}" if unit and self.unit else text

    def measured(self, row):
        if row["unit"] == "bits":
            return "the same bits"
        if row["value"]:
            return self.with_unit(self.number(row["value"]), row["unit"])
        ends = list(dict.fromkeys(self.number(row[name], 3) for name in ("least", "most")))
        return self.with_unit(" to ".join(ends), row["unit"])

    def demanded(self, row):
        if row["unit"] == "bits":
            return "bit for bit"
        ends = [self.number(row[name], 4) for name in ("at_least", "at_most") if row[name]]
        if not ends:
            return "-"
        return self.with_unit(" to ".join(dict.fromkeys(ends)), row["unit"])


class Tables:
    """layout: as above; rows: of measured.read(); digits: of measured numbers."""

    def __init__(self, layout, rows, digits=None):
        self.unshown, self.kept = tuple(layout.pop("unshown", ())), tuple(layout.pop("kept", ()))
        self.layout, self.digits = layout, digits
        self.rows, self.used = {}, set()
        self.absent = 0  # optional places without a row, so far
        for row in rows:
            self.rows.setdefault(row["key"], {})[row["backend"]] = row
        self.problems = []

    def find(self, key, optional=False):
        """Its row, of the first backend that there is."""
        self.used.add(key)
        if key not in self.rows:
            if not optional:
                self.problems.append(f"{key}: no such row")
            return None
        return next(iter(self.rows[key].values()))

    def compared(self, how, row, other):
        """Of two rows in the same or in related units."""
        ratio = float(row["value"]) * SCALES.get(row["unit"], 1) / float(other["value"]) / SCALES.get(other["unit"], 1)
        return f"{round_to(ratio, 2 if ratio < 10 else 3)}" if how == "over" else f"{100 * (ratio - 1):+.2g} %"

    def fill(self, template, found, what="measured"):
        """The text, with its places filled; the rows go into `found`."""
        def put(match):
            optional, form = re.fullmatch(r"(optional)? ?(.*)", match[2] or "").groups()
            comparison = re.fullmatch(r"(over|above) (.*)", form)
            keys = (match[1], *(comparison.groups()[1:] if comparison else ()))
            rows = [self.find(key, optional) for key in keys]
            if None in rows:
                self.absent += bool(optional)
                return "-" if optional else "?"
            found.extend(rows)
            if comparison:
                return self.compared(comparison[1], *rows)
            return getattr(Format(form, self.digits), what)(*rows)
        return PLACE.sub(put, template)

    def cells(self, table, row):
        """Of a row; None if nothing of it was measured yet."""
        absent = self.absent
        titles, found = row["title"] if isinstance(row["title"], list) else [row["title"]], []
        if "shows" in row:
            texts = [self.fill(row["shows"], [], "demanded"), self.fill(row["shows"], found)]
        else:
            parts = row.get("parts", [""])
            texts = ["; ".join(dict.fromkeys(self.fill(cell.replace("$", part), found) for part in parts))
                     for cell in row.get("cells", table.get("cells", []))]
        titles = [self.fill(title, found) for title in titles]
        if not found and self.absent > absent:
            return None
        machines = {}
        for one in found:
            machines.setdefault(short(one["commit"]), {})[one["machine"]] = True
        return [*titles, *texts, "; ".join(f"{commit}, {' and '.join(of)}" for commit, of in machines.items())]

    def markdown(self, name):
        table = self.layout[name]
        columns = [*table["columns"], "commit, machine"]
        lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
        for row in table["rows"]:
            cells = self.cells(table, row)
            if cells is None:
                continue
            if len(cells) != len(columns):
                self.problems.append(f"table {name}, {row['title']}: {len(cells)} cells for {len(columns)} columns")
            lines.append("| " + " | ".join(cells) + " |")
        return "\n".join(lines)

    def page(self, path, text):
        """The page with its tables made anew."""
        for name, table in self.layout.items():
            if table["page"] != path:
                continue
            made = self.markdown(name)
            begin, end = f"<!-- table {name} -->\n", f"<!-- end of table {name} -->"
            parts = re.split(f"({re.escape(begin)}|{re.escape(end)})", text)
            if len(parts) != 5:
                self.problems.append(f"{path}: must have once {begin.strip()} and {end}")
                continue
            text = "".join([parts[0], begin, made, "\n", end, parts[4]])
        return text

    def unused(self):
        return [f"{key}: no table shows it" for key in self.rows
                if key not in self.used and not key.startswith(self.unshown)]


def short(commit):
    """7 digits of it, and whether it was modified."""
    return re.sub(r"^([0-9a-f]{7})[0-9a-f]+", r"\1", commit)


def written(root, folders):
    """Keys that the sources write, and what others begin with."""
    keys, families = set(), set()
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in (".cpp", ".hpp", ".py", ".sh"):
                continue
            for key, end in WRITER.findall(path.read_text()):
                if "/" in key:
                    (keys if end == '"' else families).add(key)
    return keys, families


def without_writer(rows, keys, families):
    """Rows that nothing writes, and what is written and has no row."""
    have = {row["key"] for row in rows}
    problems = [f"{key}: nothing in the sources writes it" for key in sorted(have)
                if key not in keys and not key.startswith(tuple(families))]
    problems += [f"{key}: the sources write it, and the data have no row" for key in sorted(keys - have)]
    return problems + [f"{family}: the sources write such keys, and the data have no row"
                       for family in sorted(families) if not any(key.startswith(family) for key in have)]


def run(description, root, layout, data, folders, digits=None):
    """Of a script: makes the pages of a layout, or with --check says what is wrong with them. Returns the exit code."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="writes nothing; 1 where a page is not current")
    checking = parser.parse_args().check
    rows = measured.read(root / data)
    tables = Tables(tomllib.loads((root / layout).read_text()), rows, digits)
    for path in dict.fromkeys(table["page"] for table in tables.layout.values()):
        text = (root / path).read_text()
        made = tables.page(path, text)
        if made != text and checking:
            tables.problems.append(f"{path}: a table is not what {data} gives")
        if made != text and not checking and not tables.problems:
            (root / path).write_text(made)
    new = [row for row in rows if not row["key"].startswith(tables.kept)]
    problems = tables.problems + tables.unused() + without_writer(new, *written(root, folders))
    print("\n".join(dict.fromkeys(problems)), end="\n" if problems else "")
    return 1 if problems else 0
