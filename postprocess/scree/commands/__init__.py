"""A module for each command: `describe` adds its arguments to a parser, `run` does it and returns the exit code. What
takes long to import is imported when it runs."""

from scree.commands import animate, compare, draw, export, paraview, picture, plot, report, settle, urdf

COMMANDS = {name: (module.describe, module.run) for name, module in
            (("plot", plot), ("draw", draw), ("picture", picture), ("animate", animate), ("compare", compare),
             ("export", export), ("report", report), ("paraview", paraview), ("settle", settle),
             ("urdf", urdf))}
