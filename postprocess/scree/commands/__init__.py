"""One module per command: `describe` adds its arguments to a parser, `run` carries it out and returns the exit code.
Modules that take long to import are imported in `run`."""

from scree.commands import animate, calibrate, compare, draw, export, paraview, picture, plot, report, settle, thin, urdf

COMMANDS = {name: (module.describe, module.run) for name, module in
            (("plot", plot), ("draw", draw), ("picture", picture), ("animate", animate), ("compare", compare),
             ("export", export), ("report", report), ("paraview", paraview), ("settle", settle),
             ("thin", thin), ("urdf", urdf), ("calibrate", calibrate))}
