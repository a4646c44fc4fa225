"""Joins the modules for ParaView to one file, which does not need this package."""

import ast
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
PACKAGE = HERE.parent
# Modules that draw a mechanism, each after its imports.
DRAWING_FILES = [PACKAGE / "fields.py",
                 *(PACKAGE / "pictures" / f"{name}.py" for name in ("styles", "model", "mechanism")), HERE / "rods.py"]
MODULES = ("results", "colors", "view")  # modules in this folder, each after its imports

# Modules, because programmable filters replace max, all and others in the main file by those of numpy.
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
    """The concatenated sources of modules of the package, without imports of each other."""
    found = []
    for path in paths:
        lines = path.read_text(encoding="utf-8").splitlines()
        for node in ast.parse("\n".join(lines)).body:
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("scree."):
                lines[node.lineno - 1 : node.end_lineno] = [""] * (node.end_lineno - node.lineno + 1)
        found.append("\n".join(lines).strip())
    return "\n\n\n".join(found) + "\n"


def literal(text):
    """A Python literal, in readable lines if possible."""
    return repr(text) if "'''" in text or text.endswith(("'", "\\")) else f"r'''{text}'''"


def bundle(folder, deck):
    """The text of the file that shows a folder. deck: of its run, with all defaults, as JSON; None if unknown."""
    sources = {name: (HERE / f"{name}.py").read_text(encoding="utf-8") for name in MODULES}
    docstring = ast.get_docstring(ast.parse(sources["view"]), clean=False)
    modules = "".join(f"    {name!r}: {literal(text)},\n" for name, text in sources.items())
    return f'"""{docstring}"""\n\nimport sys\nimport types\n\nFOLDER = {folder!r}\nDECK = {deck!r}\n' \
           f"DRAWING = {literal(joined(DRAWING_FILES))}\nMODULES = {{\n{modules}}}\n{START}"
