"""What scree-post paraview puts together: one file for ParaView, which has nothing of this package."""

import ast
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
PACKAGE = HERE.parent
# What draws a mechanism, each after what it imports.
DRAWING_FILES = [PACKAGE / "fields.py",
                 *(PACKAGE / "pictures" / f"{name}.py" for name in ("styles", "model", "mechanism")), HERE / "rods.py"]
MODULES = ("results", "colors", "view")  # of this folder, each after what it imports

# Modules, as programmable filters put numpy's max, all and others in place of those of the file itself.
START = """
for NAME, TEXT in MODULES.items():
    module = sys.modules[NAME] = types.ModuleType(NAME)
    exec(compile(TEXT, f"{NAME}.py", "exec"), module.__dict__)
    if NAME == "results":
        module.FOLDER, module.DECK, module.DRAWING = FOLDER, DECK, DRAWING

if __name__ == "__main__":
    sys.modules["view"].main()
"""


def joined(paths):
    """The sources of modules of the package one after the other, without what they import of each other."""
    found = []
    for path in paths:
        lines = path.read_text(encoding="utf-8").splitlines()
        for node in ast.parse("\n".join(lines)).body:
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("scree."):
                lines[node.lineno - 1 : node.end_lineno] = [""] * (node.end_lineno - node.lineno + 1)
        found.append("\n".join(lines).strip())
    return "\n\n\n".join(found) + "\n"


def literal(text):
    """In Python, in lines where that is possible."""
    return repr(text) if "'''" in text or text.endswith(("'", "\\")) else f"r'''{text}'''"


def bundle(folder, deck):
    """The text of one file that shows a folder. deck: of its run, with every default, as JSON;
    None where nothing tells it yet."""
    sources = {name: (HERE / f"{name}.py").read_text(encoding="utf-8") for name in MODULES}
    told = ast.get_docstring(ast.parse(sources["view"]), clean=False)
    modules = "".join(f"    {name!r}: {literal(text)},\n" for name, text in sources.items())
    return f'"""{told}"""\n\nimport sys\nimport types\n\nFOLDER = {folder!r}\nDECK = {deck!r}\n' \
           f"DRAWING = {literal(joined(DRAWING_FILES))}\nMODULES = {{\n{modules}}}\n{START}"
