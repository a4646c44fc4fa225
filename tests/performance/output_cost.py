"""What output costs: the same explicit steps of moving.py's column without output on the way, with snapshots, and with
a checkpoint. Prints a markdown table.

    output_cost.py SCREE [--particles N] [--backend cuda|cpu] [--steps N] [--snapshots N]

The times are wall seconds of the step loop, from the run record; a snapshot's or checkpoint's is what it adds to them.
On a GPU a snapshot adds what steps wait for it, and should take less to write than the steps up to the next one. The
results go to a temporary folder (TMPDIR), which is removed.
"""
import argparse
import pathlib
import sys
import tempfile

import moving
from moving import measured


def measure(arguments, settings, file):
    """Loop seconds, the run record, and bytes of the file of results, 0 without one."""
    with tempfile.TemporaryDirectory(prefix="scree_output_") as name:
        folder = pathlib.Path(name)
        moving.write_deck(folder / "moving.toml", arguments.particles, arguments.steps * moving.STEP)
        record = moving.run(arguments.scree, folder / "moving.toml", folder / "out", arguments.backend,
                            settings=settings)
        return record["cost"]["loop_seconds"], record, (folder / "out" / file).stat().st_size if file else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scree")
    parser.add_argument("--particles", type=float, default=4e6, help="about so many (default 4e6)")
    parser.add_argument("--backend", choices=["cuda", "cpu"], default="cuda")
    parser.add_argument("--steps", type=int, default=8000, help="of each run (default 8000)")
    parser.add_argument("--snapshots", type=int, default=3, help="on the way (default 3)")
    arguments = parser.parse_args()
    if arguments.snapshots < 1 or arguments.steps < 1 or arguments.steps % (arguments.snapshots + 1) != 0:
        parser.error(f"--steps {arguments.steps} --snapshots {arguments.snapshots}: the steps must be a multiple of "
                     "the snapshots, which are at least 1, and the last state together")
    every = arguments.steps // (arguments.snapshots + 1)
    # Past the middle, so that there is one.
    checkpoint = arguments.steps // 2 + 1
    print("| | particles | steps | us per step | written on the way | MB each | s more for each |\n|" + "---|" * 7)

    def note(name, value, unit, record):
        size = f"{arguments.backend}, {arguments.particles:g} particles"
        measured.note(f"output_cost/{size}/{name}", value, unit, record=record)

    def row(name, seconds, record, *written):
        counts = record["counts"]
        per_step = 1e6 * seconds / counts["steps"]
        cells = [name, f"{counts['particles']:,}", f"{counts['steps']:,}", f"{per_step:.1f}", *written]
        print("| " + " | ".join(cells) + " |", flush=True)

    bare, record, _ = measure(arguments, [], None)
    row("no output", bare, record, "", "", "")
    note("step", 1e6 * bare / record["counts"]["steps"], "us", record)
    ends = record["counts"]["snapshots"]  # the first and the last state, outside the loop
    seconds, record, size = measure(arguments, [f"output.snapshot_interval={every * moving.STEP}"], "particles.vtkhdf")
    added = record["counts"]["snapshots"] - ends
    each = 1e-6 * size / record["counts"]["snapshots"]
    row(f"snapshot every {every:,} steps", seconds, record, f"{added} snapshots", f"{each:.0f}",
        f"{(seconds - bare) / added:.3f}")
    note("snapshot", (seconds - bare) / added, "s", record), note("snapshot size", each, "MB", record)
    interval = f"output.checkpoint_interval={checkpoint * moving.STEP}"
    seconds, record, size = measure(arguments, [interval], "checkpoint.h5")
    note("checkpoint", seconds - bare, "s", record), note("checkpoint size", 1e-6 * size, "MB", record)
    row("a checkpoint", seconds, record, "1 checkpoint", f"{1e-6 * size:.0f}", f"{seconds - bare:.3f}")


if __name__ == "__main__":
    sys.exit(main())
