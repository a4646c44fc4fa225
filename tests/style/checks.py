"""Checks of the project's style by a program. Each check takes the root of a source tree and returns its
findings, one line of text each."""

import ast
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess

CPP = {".cpp", ".hpp", ".cu", ".cuh"}
SCRIPTS = {".py", ".sh", ".sbatch"}
MOST_LINES = 400
MOST_COLUMNS = 120  # of Python; clang-format keeps the others
CLANG_FORMAT = 14
NOT_SOURCES = {".git", ".venv", ".gpu", "build", "results", "__pycache__"}
ROOMS = "src/README.md"


def files(root, suffixes=None, under=None):
    """Paths of the tree's files relative to its root, sorted."""
    found = []
    for folder, folders, names in os.walk(root / under if under else root):
        folders[:] = [f for f in folders if f not in NOT_SOURCES]
        found += [(pathlib.Path(folder) / name).relative_to(root) for name in names]
    return sorted(f for f in found if suffixes is None or f.suffix in suffixes)


def order_on(page):
    """What each folder may include, itself among it, from a page's line "base <- physics <- { a, b } <- main"."""
    lines = [line for line in page.read_text().splitlines() if re.match(r"    \w+ <- ", line)]
    if len(lines) != 1:
        raise ValueError(f"{page}: {len(lines)} lines with the order of the rooms")
    allowed, left = {}, set()
    for part in lines[0].split("<-"):
        beside = [room.strip() for room in part.strip(" {}").split(",")]
        for room in beside:
            allowed[room] = left | {room}
        left = left | set(beside)
    return allowed


def room_order(root):
    """Per room the rooms that its files may include."""
    return order_on(root / ROOMS)


def included(root, file):
    """The numbers of the lines of a file that include one of ours, with what they include."""
    for number, line in enumerate((root / file).read_text().splitlines(), 1):
        include = re.match(r'\s*#\s*include\s*"([^"]*)"', line)
        if include is not None:
            yield number, pathlib.PurePosixPath(include[1])


def wrong_includes(root):
    """Arrows against the order of the rooms. cuda/ is right of dem, and nothing in src/ includes it."""
    allowed = room_order(root)
    findings = []
    for file in files(root, CPP, "src") + files(root, CPP, "cuda"):
        in_src = file.parts[0] == "src"
        room = (file.parts[1] if len(file.parts) > 2 else file.stem) if in_src else "cuda"
        seen = allowed.get(room, set()) if in_src else allowed["dem"]
        if in_src and room not in allowed:
            findings.append(f"{file}: {room} is no room of {ROOMS}")
        for number, target in included(root, file):
            own_of_cuda = not in_src and (root / "cuda" / target).is_file()
            if not own_of_cuda and (len(target.parts) < 2 or target.parts[0] not in seen):
                findings.append(f"{file}:{number}: {room} may not include {target}")
    return findings


def wrong_includes_in_rooms(root):
    """Arrows against the order of a room's sub-rooms, which the room's page gives where the room has any."""
    findings = []
    for room in sorted(folder for folder in (root / "src").iterdir() if folder.is_dir()):
        sub_rooms = sorted(folder.name for folder in room.iterdir() if folder.is_dir())
        if not sub_rooms:
            continue
        allowed = order_on(room / "README.md")
        findings += [f"{room.name}/{sub_room} is no sub-room of src/{room.name}/README.md"
                     for sub_room in sub_rooms if sub_room not in allowed]
        for file in files(root, CPP, f"src/{room.name}"):
            if len(file.parts) < 4:
                findings.append(f"{file}: in none of the sub-rooms of {room.name}")
                continue
            for number, target in included(root, file):
                if target.parts[0] == room.name and target.parts[1] not in allowed.get(file.parts[2], set()):
                    findings.append(f"{file}:{number}: {room.name}/{file.parts[2]} may not include {target}")
    return findings


def long_files(root):
    findings = []
    for file in files(root, CPP | SCRIPTS):
        lines = len((root / file).read_text().splitlines())
        if lines > MOST_LINES:
            findings.append(f"{file}: {lines} lines, at most {MOST_LINES}")
    return findings


def long_python_lines(root):
    findings = []
    for file in files(root, {".py"}):
        for number, line in enumerate((root / file).read_text().splitlines(), 1):
            if len(line) > MOST_COLUMNS:
                findings.append(f"{file}:{number}: {len(line)} columns, at most {MOST_COLUMNS}")
    return findings


def attributes_without_layout(root):
    """Uses of an attribute that nvcc 13 lays out by two rules: code of kernels indexes arrays of such a type by another
    size than sizeof (tests/unit/cuda/layouts_test.cpp)."""
    findings = []
    for file in (file for under in ("src", "cuda") for file in files(root, CPP, under)):
        for number, line in enumerate((root / file).read_text(encoding="utf-8").splitlines(), 1):
            if "[[no_unique_address]]" in line:
                findings.append(f"{file}:{number}: [[no_unique_address]]")
    return findings


def closing_parenthesis(text, opening):
    """Index of the parenthesis that closes the one at `opening`; the text's length if there is none."""
    depth = 0
    for k in range(opening, len(text)):
        depth += {"(": 1, ")": -1}.get(text[k], 0)
        if depth == 0:
            return k
    return len(text)


def default_tolerances(root):
    """Uses of Catch's Approx without an epsilon or a margin: its default of 1.2e-5 is nobody's decision."""
    findings = []
    for file in files(root, CPP, "tests"):
        text = (root / file).read_text(encoding="utf-8")
        for use in re.finditer(r"\bApprox\s*[({]", text):
            end = closing_parenthesis(text, use.end() - 1) if text[use.end() - 1] == "(" else use.end()
            if not re.match(r"\)\s*\.\s*(epsilon|margin)\(", text[end:]):
                line = text.count("\n", 0, use.start()) + 1
                findings.append(f"{file}:{line}: Approx with the default tolerance; state .epsilon() or .margin()")
    return findings


def texts_without_encoding(root):
    """Where Python reads or writes a text by the encoding of the locale: in Latin-1 that is not the UTF-8 of decks."""
    findings = []
    for file in (file for under in ("postprocess", "jobs") for file in files(root, {".py"}, under)):
        for call in ast.walk(ast.parse((root / file).read_text(encoding="utf-8"))):
            if not isinstance(call, ast.Call) or any(word.arg == "encoding" for word in call.keywords):
                continue
            name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
            opens = isinstance(call.func, ast.Name) and name == "open"
            binary = any("b" in str(getattr(mode, "value", "")) for mode in call.args[1:2])
            decodes = any(word.arg == "text" for word in call.keywords)
            if name in ("read_text", "write_text") or (opens and not binary) or decodes:
                findings.append(f"{file}:{call.lineno}: a text without encoding=")
    return findings


def clang_format():
    """The program, or an error that says how to get it: versions format differently."""
    for name in (f"clang-format-{CLANG_FORMAT}", "clang-format"):
        program = shutil.which(name)
        if program is None:
            continue
        version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
        if re.search(rf"version {CLANG_FORMAT}\.", version):
            return program
    raise FileNotFoundError(f"clang-format {CLANG_FORMAT} is missing; on Debian 12: apt-get install clang-format")


def unformatted(root):
    program = clang_format()
    every = [file for room in ("src", "cuda", "tests") for file in files(root, CPP, room)]

    def first_finding(file):
        run = subprocess.run([program, "--dry-run", "--Werror", str(file)], cwd=root, capture_output=True, text=True)
        return run.stderr.splitlines()[0] if run.returncode else ""

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return [finding for finding in pool.map(first_finding, every) if finding]


def expanded(pattern):
    """A path with one group of alternatives {a,b} as the paths that it stands for."""
    group = re.search(r"\{([^{}]*)\}", pattern)
    if group is None:
        return [pattern]
    return [pattern[:group.start()] + part.strip() + pattern[group.end():] for part in group[1].split(",")]


def names_file(readme, text, root, base_names):
    """Whether a word of a page is a path of this repository at all, and whether it exists."""
    path = pathlib.PurePosixPath(text)
    places = [root, root / "src", (root / readme).parent]
    if len(path.parts) > 1 and any((place / path.parts[0]).is_dir() for place in places):
        return True, any(any(place.glob(one)) for place in places for one in expanded(text))
    if len(path.parts) == 1 and path.suffix in CPP | SCRIPTS:
        return True, any(path.match(one) or pathlib.PurePosixPath(one).match(text) for one in base_names)
    return False, False


def missing_paths(root):
    """Paths in the inline code of the pages that lead nowhere."""
    base_names = {file.name for file in files(root)}
    findings = []
    for readme in files(root, {".md"}):
        text = re.sub(r"^```.*?^```", "", (root / readme).read_text(), flags=re.S | re.M)
        for code in re.findall(r"`([^`]+)`", text):
            for word in code.split():
                word = re.sub(r":\d+$", "", word.strip(",;()\"'"))
                if re.search(r"[<>$=~@\\]|^/|^-|\.\.\.|://", word) or word.split("/")[0] in NOT_SOURCES:
                    continue
                is_path, is_there = names_file(readme, word, root, base_names)
                if is_path and not is_there:
                    findings.append(f"{readme}: `{word}` is not there")
    return findings


def wrong_commands(root):
    """Scripts that a page runs by their own names and that are not executable."""
    command = re.compile(r"(?:^ {4}|`)((?:tests|jobs|postprocess)/[\w/]+\.(?:py|sh)) +[^\s#]", re.M)
    findings = []
    for readme in files(root, {".md"}):
        for script in sorted(set(command.findall((root / readme).read_text()))):
            if (root / script).exists() and not os.access(root / script, os.X_OK):
                findings.append(f"{readme}: {script} is not executable")
    return findings
