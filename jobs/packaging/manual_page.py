#!/usr/bin/env python3
"""Writes the manual page of Scree from what the program says of itself: manual_page.py PROGRAM PAGE. The installation
runs it; commands and options are those of --help, so that there is no second list of them."""

import pathlib
import re
import subprocess
import sys

PAGE = """.TH SCREE 1 "" "{version}" "User Commands"
.SH NAME
scree \\- collisions between a constrained multibody system and very many particles
.SH SYNOPSIS
{synopsis}
.SH DESCRIPTION
A batch code. An input deck (TOML) says everything about a case; the results are HDF5 files for ParaView and for the
Python package of Scree. Under
.BR mpirun (1)
or srun the particles are spread over the ranks, each with a core of a CPU or with a GPU.
{commands}
.SH NOTES
{notes}
.SH EXAMPLES
.nf
scree check deck.toml
scree run deck.toml \\-\\-set time.end=0.5 \\-\\-output results/short
mpirun \\-n 4 scree run deck.toml
scree keys | less
.fi
.SH FILES
Beside the folder
.I bin
of the program, in
.IR share/scree :
.I README.md
and the pages that it names,
.I input
(decks to begin with),
.I jobs
(sbatch files for SLURM),
.I postprocess
(the Python package, for pip).
.SH SEE ALSO
.BR mpirun (1),
.BR sbatch (1)
"""
LEFT = 30  # [columns] where descriptions begin in the help of CLI11


def said(*words):
    return subprocess.run(words, capture_output=True, encoding="utf-8", check=True).stdout


def plain(text):
    """Text as roff takes it: nothing in it is a request or an escape."""
    text = text.strip().replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def section(title, body):
    """The lines of a help without usage and last part; a name and its description make an item."""
    lines = [f".SH {title}"]
    for line in body:
        item = re.match(r" {2}(\S.*?)(?: {2,}(.*))?$", line)
        if item and not line.startswith(" " * LEFT):
            lines += [".TP", f".B {plain(item[1])}", *filter(None, [plain(item[2] or "")])]
        elif re.match(r"[A-Z]\w*:$", line):
            lines.append(f".SS {line.rstrip(':')}")
        elif line.strip():
            lines.append(plain(line))
    return lines


def help_of(program, *command):
    """Usage, what stands between it and the last part, and the last part, which all commands share."""
    text = said(program, *command, "--help")
    usage = re.search(r"^Usage: (.*)$", text, re.M)
    body, _, last = text[usage.end():].partition("\nExit codes:")
    return usage[1], body.splitlines(), f"Exit codes:{last}".splitlines()


def page(program):
    usage, body, notes = help_of(program)
    names = re.findall(r"^  ([a-z]\S*) ", "\n".join(body).partition("Subcommands:")[2], re.M)
    if not names:
        raise SystemExit(f"{program} --help names no commands")
    synopsis, commands = [usage], section("COMMANDS", body)
    for name in names:
        usage, body, _ = help_of(program, name)
        synopsis.append(usage)
        commands += section(f"SCREE {name.upper()}", body)
    version = said(program, "--version").split(" (")[0]
    return PAGE.format(version=version, synopsis="\n.br\n".join(map(plain, synopsis)), commands="\n".join(commands),
                       notes="\n".join(map(plain, notes)))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: manual_page.py PROGRAM PAGE")
    pathlib.Path(sys.argv[2]).write_text(page(sys.argv[1]), encoding="utf-8")
