"""Checks of the pages (*.md) by a program: widths, links with their anchors, numbers of the first page, and the names
in src/adding.md. Each check takes the root of a source tree and returns its findings, one line of text each."""

import re

import checks

FIRST = "README.md"
MOST_LINES = 120  # of the first page
MOST_COLUMNS = 132  # of text; tables and code have lines of their own
ADDING = "src/adding.md"


def pages(root):
    return checks.files(root, {".md"})


def without_code(text):
    """The text with empty lines in place of blocks of code."""
    return re.sub(r"^```.*?^```", lambda block: "\n" * block[0].count("\n"), text, flags=re.S | re.M)


def wide_lines(root):
    findings = []
    for page in pages(root):
        for number, line in enumerate(without_code((root / page).read_text()).splitlines(), 1):
            if len(line) > MOST_COLUMNS and not re.match(r" *\||    ", line):
                findings.append(f"{page}:{number}: {len(line)} columns, at most {MOST_COLUMNS}")
    return findings


def long_first_page(root):
    lines = len((root / FIRST).read_text().splitlines())
    return [f"{FIRST}: {lines} lines, at most {MOST_LINES}"] if lines > MOST_LINES else []


def anchors(text):
    """What a link may name behind the #: the headings as GitHub writes them, and anchors by name."""
    found = []
    for heading in re.findall(r"^#+ +(.+?) *$", without_code(text), re.M):
        anchor = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        found.append(f"{anchor}-{found.count(anchor)}" if anchor in found else anchor)
    return found + re.findall(r'<a id="([^"]+)"></a>', text)


def dead_links(root):
    findings = []
    for page in pages(root):
        for target in re.findall(r"\]\(([^)\s]+)\)", without_code((root / page).read_text())):
            path, _, anchor = target.partition("#")
            if re.match(r"\w+:", target):
                continue
            goal = root / page if not path else (root / page).parent / path
            if not goal.exists():
                findings.append(f"{page}: the link {target} leads nowhere")
            elif anchor and (goal.suffix != ".md" or anchor not in anchors(goal.read_text())):
                findings.append(f"{page}: the link {target}: no such heading")
    return findings


def goals(root, page):
    """The pages that a page links to."""
    found = set()
    for target in re.findall(r"\]\(([^)#\s]+)", without_code((root / page).read_text())):
        goal = ((root / page).parent / target).resolve()
        if goal.suffix == ".md" and goal.is_relative_to(root):
            found.add(goal.relative_to(root))
    return found


def unfounded_numbers(root):
    """Bold numbers in the first page's tables that the page which their row links to has not."""
    findings = []
    for line in (root / FIRST).read_text().splitlines():
        row = re.match(r"\| \*\*(.+?)\*\* \|.*\]\(([^)#\s]+)", line)
        if row and row[1] not in (root / row[2]).read_text():
            findings.append(f"{FIRST}: {row[2]} does not say {row[1]}")
    return findings


def named_files(root, text):
    """Files under src/ or the root that the code marks of a text name, patterns expanded."""
    named = set()
    for word in re.findall(r"`([^`]+)`", text):
        if "/" in word:
            for place in (root / "src", root):
                named |= {file for file in place.glob(word) if file.is_file()}
    return named


def untrue_instructions(root):
    """Words in code marks of src/adding.md that stand in none of the files that their section names, and files that ask
    for the values of an enum that a section names as `Enum::*` without being named there."""
    findings = []
    for section in re.split(r"^## ", (root / ADDING).read_text(), flags=re.M)[1:]:
        title = section.splitlines()[0]
        files = named_files(root, section)
        text = "\n".join(file.read_text() for file in sorted(files))
        for word in (word for word in re.findall(r"`([^`]+)`", section) if "/" not in word):
            enum = word.removesuffix("::*")
            if not re.search(rf"\b{re.escape(enum)}\b", text):
                findings.append(f'{ADDING}, "{title}": none of its files has {enum}')
            if enum != word:
                asking = {root / file for file in checks.files(root, checks.CPP, "src")
                          if re.search(rf"\b{enum}::\w|using \w+ = {enum};", (root / file).read_text())}
                findings += [f'{ADDING}, "{title}": {file.relative_to(root)} asks for {enum} and is not named'
                             for file in sorted(asking - files)]
    return findings
