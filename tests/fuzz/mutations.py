"""Changes to the text of a deck. Each takes the text and a random.Random, and returns text or bytes."""

import re

NUMBERS = ["0", "-1", "1", "2", "3", "-0.0", "0.5", "1e-4", "1e9", "-1e9", "1e15", "1e300", "1.7e308", "1e-300",
           "5e-324", "1e400", "nan", "inf", "-inf", "+nan", "2147483647", "2147483648", "-2147483649",
           "9223372036854775807", "9223372036854775808", "-9223372036854775808", "1000000000", "10000000",
           "100000", "0x7fffffff", "0b11", "1_000", "01", "1.", ".5", "1e", "--1"]
OTHERS = ["true", "false", '""', '"x"', '"ground"', '"0"', "[]", "{}", "[[]]", "[0.0]", "[0, 0]", "[0.0, 0.0, 0.0]",
          "[1, 2, 3, 4]", "[nan, inf]", '["a", "a"]', '["", ""]', "[[0, 0], [0, 0]]", "[{}]", "{ kind = \"table\" }",
          '{ kind = "constant", value = 1e308 }', '{ kind = "ramp", rate = 1e300 }', '{ radius = 1e300 }',
          "[{ radius = 1e-320 }]", "1979-05-27", "07:32:00", "1979-05-27T07:32:00Z", "", "=", "'", '"""', "'''a\nb'''",
          '"""a\nb"""', "{ a = { b = { c = 1 } } }", "[1, true]", '[1, "a"]', "[1,", "{ a = 1"]
TEXTS = ["", ".", "..", "/", "a/b", "../../x", "/dev/null", "/etc", "\\u0000", "\\u0001", "\\u001b[31m", "\\n", "\\t",
         "\\u007f", "\\u0085", "\\u202e", "a b", " ", "ä", "粒子", "💥", "ground", "default", "0", "-1", "a.0", "x" * 300,
         "x" * 70000, "%s%n", "{}", "{0}", "\\\"", "\\\\", "--set", "\\ud800", "\\U00110000", "\\q"]

ASSIGNMENT = re.compile(r"^(\s*[\w.\"']+\s*=\s*)(.*)$")
NUMBER = re.compile(r"(?<![\w\"])-?\d+\.?\d*(?:[eE][-+]?\d+)?")
TEXT = re.compile(r'"[^"\n]*"')
HEADER = re.compile(r"^\s*\[")


def assignments(lines):
    return [i for i, line in enumerate(lines) if ASSIGNMENT.match(line)]


def on_lines(change):
    """A change of a list of lines, as one of a text."""
    def changed(text, rng):
        lines = text.split("\n")
        change(lines, rng)
        return "\n".join(lines)
    changed.__name__ = change.__name__
    return changed


@on_lines
def delete_line(lines, rng):
    del lines[rng.randrange(len(lines))]


@on_lines
def repeat_line(lines, rng):
    line = rng.choice(lines)
    lines.insert(rng.randrange(len(lines) + 1), line)


@on_lines
def swap_lines(lines, rng):
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]


def table_range(lines, rng):
    headers = [i for i, line in enumerate(lines) if HEADER.match(line)]
    if not headers:
        return 0, 0
    first = rng.choice(headers)
    return first, next((i for i in headers if i > first), len(lines))


@on_lines
def delete_table(lines, rng):
    first, last = table_range(lines, rng)
    del lines[first:last]


@on_lines
def repeat_table(lines, rng):
    first, last = table_range(lines, rng)
    lines.extend(lines[first:last])


@on_lines
def cut_tables_off(lines, rng):
    del lines[table_range(lines, rng)[0]:]


def replace_values(lines, rng, values):
    """The value of a key, or an entry of a list."""
    found = assignments(lines)
    if not found:
        return
    i = rng.choice(found)
    key, value = ASSIGNMENT.match(lines[i]).groups()
    entries = list(NUMBER.finditer(value))
    if len(entries) > 1 and rng.random() < 0.7:
        entry = rng.choice(entries)
        lines[i] = key + value[:entry.start()] + rng.choice(values) + value[entry.end():]
    else:
        lines[i] = key + rng.choice(values)


@on_lines
def other_number(lines, rng):
    replace_values(lines, rng, NUMBERS)


@on_lines
def other_type(lines, rng):
    replace_values(lines, rng, OTHERS)


def scale_number(text, rng):
    numbers = list(NUMBER.finditer(text))
    if not numbers:
        return text
    number = rng.choice(numbers)
    factor = rng.choice([-1.0, 0.5, 2.0, 10.0, 1.0 + 1e-12, 1e3, 1e-3, 1e6, 1e-6, 1e12, 1e-12, 1e100, 1e-100])
    value = float(number.group()) * factor
    whole = "." not in number.group() and value.is_integer()  # infinity is not
    shown = str(int(value)) if whole else repr(value)
    return text[:number.start()] + shown + text[number.end():]


def other_text(text, rng):
    texts = list(TEXT.finditer(text))
    if not texts:
        return text
    old = rng.choice(texts)
    new = f'"{rng.choice(TEXTS)}"' if rng.random() < 0.6 else rng.choice(texts).group()
    if rng.random() < 0.2:  # wherever it stands, a name and those who use it
        return text.replace(old.group(), new)
    return text[:old.start()] + new + text[old.end():]


@on_lines
def misspelt_key(lines, rng):
    found = assignments(lines)
    if not found:
        return
    i = rng.choice(found)
    name = lines[i].split("=")[0].strip()
    at = rng.randrange(len(name) + 1)
    new = rng.choice([name[:at] + name[at + 1:], name[:at] + "x" + name[at:], name.upper(), f'"{rng.choice(TEXTS)}"',
                      f"{name}.{name}", "ä", ""])
    lines[i] = lines[i].replace(name, new, 1)


@on_lines
def deep_key(lines, rng):
    depth = rng.choice([3, 20, 100, 300, 3000, 30000])
    part = rng.choice(["a", "time", '"b"'])
    key = ".".join([part] * depth)
    at = rng.randrange(len(lines) + 1)
    lines.insert(at, rng.choice([f"{key} = 1", f"[{key}]", f"[[{key}]]", f"x = {{ {key} = 1 }}"]))


@on_lines
def deep_value(lines, rng):
    depth = rng.choice([3, 100, 300, 3000, 30000])
    start, end = rng.choice([("[", "]"), ("{ a = ", " }"), ("[{ a = ", " }]")])
    found = assignments(lines)
    if found:
        i = rng.choice(found)
        lines[i] = ASSIGNMENT.match(lines[i]).group(1) + start * depth + end * rng.choice([depth, 0])


@on_lines
def many_entries(lines, rng):
    found = assignments(lines)
    if found:
        i = rng.choice(found)
        entry = rng.choice(["0.0", "[0.0, 0.0]", '"a"', "{ radius = 0.1 }", "[0.0, 0.0, 0.0]", "1"])
        lines[i] = ASSIGNMENT.match(lines[i]).group(1) + "[" + ", ".join([entry] * rng.choice([1, 1000, 20000])) + "]"


def truncate(text, rng):
    return text.encode()[:rng.randrange(len(text.encode()) + 1)]


def random_bytes(text, rng):
    data = bytearray(text.encode())
    for _ in range(rng.choice([1, 1, 3, 20])):
        at = rng.randrange(len(data) + 1)
        data[at:at + rng.choice([0, 1, 4])] = bytes(rng.randrange(256) for _ in range(rng.choice([0, 1, 2])))
    return bytes(data)


def other_encoding(text, rng):
    return rng.choice([lambda: b"\xef\xbb\xbf" + text.encode(), lambda: text.replace("\n", "\r\n").encode(),
                       lambda: text.replace("\n", "\r").encode(), lambda: text.encode("utf-16"),
                       lambda: text.encode("utf-16-le"), lambda: text.encode() + b"\0",
                       lambda: b"\xef\xbb\xbf" * 2 + text.encode(), lambda: text.encode().replace(b"\n", b"\x0b\n")])()


CHANGES = [delete_line, repeat_line, swap_lines, delete_table, repeat_table, cut_tables_off, other_number, other_number,
           other_number, other_type, other_type, scale_number, scale_number, scale_number, other_text, other_text,
           misspelt_key, deep_key, deep_value, many_entries, truncate, random_bytes, other_encoding]


def mutate(text, rng, changes=None):
    """The changed text as bytes, and the names of its changes."""
    kinds = []
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        change = rng.choice(changes or CHANGES)
        kinds.append(change.__name__)
        text = change(text, rng)
        if isinstance(text, bytes):
            return text, tuple(kinds)
    return text.encode(errors="surrogatepass"), tuple(kinds)
