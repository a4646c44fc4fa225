#!/usr/bin/env python3
"""What a snapshot asks of the file system: system calls and bytes, counted by strace, and the disk space of a run.

    output_calls.py SCREE [--snapshots N] [--particles N] [--spread] [--links]

A run of the paper's net (20 bodies) and N particles with few snapshots is taken from one with N more; what is left is
divided by N. Calls and bytes count where they concern files in the folder of the results. The last line is the largest
disk space while the run goes on, over that of the files which it leaves; --spread adds a table by file, --links the
lines of the net's 21 pins and springs. Prints markdown.
"""
import argparse
import collections
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import measured  # noqa: E402

DECK = pathlib.Path(__file__).resolve().parents[2] / "input" / "paper" / "net_400.toml"
STEP = 1e-4  # [s]
FEW = 20     # snapshots of the run that is taken off
# What the table calls them; the rest is left out.
NAMES = {"openat": "open", "creat": "open", "fsync": "sync", "fdatasync": "sync", "rename": "rename",
         "renameat": "rename", "renameat2": "rename", "link": "link", "linkat": "link", "unlink": "unlink",
         "unlinkat": "unlink", "write": "write", "pwrite64": "write", "writev": "write", "pwritev": "write",
         "sendfile": "copy", "copy_file_range": "copy", "fallocate": "reserve", "ftruncate": "truncate",
         "read": "read", "pread64": "read"}
CALL = re.compile(r"^(?:\d+ +)?(\w+)\((.*)\) += (-?\d+)")
SHOWN = ("open", "sync", "rename", "link", "unlink", "write", "copy", "reserve", "truncate", "read")


def disk_space(folder):
    """Bytes on disk of each file; a file that has two names counts once."""
    found = {}
    for path in folder.glob("*"):
        try:
            status = path.stat()
        except FileNotFoundError:  # a temporary one
            continue
        found[status.st_ino] = 512 * status.st_blocks
    return sum(found.values())


def run(arguments, snapshots, folder, traced):
    """Counts {(call, file): calls}, bytes {(call, file): bytes}, and the largest disk space on the way and the last."""
    trace, out = folder / "trace", folder / "out"
    strace = ["strace", "-f", "-y", "-s", "0", "-o", str(trace), "-e", "trace=" + ",".join(NAMES)] if traced else []
    end = snapshots * STEP
    command = [*strace, arguments.scree, "run", str(DECK), "--output", str(out), "--backend", "cpu",
               "--set", "time.control=fixed", "--set", f"time.end={end}",
               "--set", f"particles.block.count={arguments.particles}",
               "--set", f"output.links={str(arguments.links).lower()}",
               "--set", f"output.snapshot_interval={STEP}", "--set", f"output.history_interval={STEP}"]
    largest, done = [0], threading.Event()

    def watch():
        while not done.is_set():
            largest[0] = max(largest[0], disk_space(out))
            time.sleep(0.001)
    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        subprocess.run(command, check=True, capture_output=True, text=True)
    except subprocess.CalledProcessError as error:
        sys.exit(f"{' '.join(command)}\n{error.stderr}")
    finally:
        done.set()
        watcher.join()
    calls, sizes = collections.Counter(), collections.Counter()
    for line in trace.read_text().splitlines() if traced else ():
        match = CALL.match(line)
        if not match or str(out) not in match[2] or int(match[3]) < 0:
            continue
        call = NAMES[match[1]]
        # With a rename, what it makes; the two copies of a growing file are one.
        name = re.sub(r"\.(spare|old|tmp)$", "", re.findall(re.escape(str(out)) + r"/?([\w.]*)", match[2])[-1])
        calls[call, name or "(folder)"] += 1
        if call in ("write", "copy", "read"):
            sizes[call, name] += int(match[3])
    last = disk_space(out)
    shutil.rmtree(out)
    return calls, sizes, largest[0] / last


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scree")
    parser.add_argument("--snapshots", type=int, default=400, help="(default 400)")
    parser.add_argument("--particles", type=int, default=400, help="(default 400)")
    parser.add_argument("--spread", action="store_true", help="by file, too")
    parser.add_argument("--links", action="store_true", help="with these")
    arguments = parser.parse_args()
    if shutil.which("strace") is None:
        sys.exit("output_calls.py: needs strace")
    n, commit = arguments.snapshots, measured.commit_of(arguments.scree)
    with tempfile.TemporaryDirectory(prefix="scree_calls_") as name:
        folder = pathlib.Path(name)
        few = run(arguments, FEW, folder, True)
        many = run(arguments, FEW + n, folder, True)
        _, _, space = run(arguments, FEW + n, folder, False)
    calls, sizes = ({key: (many[k][key] - few[k][key]) / n for key in many[k]} for k in (0, 1))

    def row(title, chosen):
        cells = [f"{sum(v for k, v in calls.items() if k[0] == call and chosen(k[1])):.2f}" for call in SHOWN]
        cells += [f"{1e-3 * sum(v for k, v in sizes.items() if k[0] in kinds and chosen(k[1])):.1f}"
                  for kinds in (("write", "copy"), ("read",))]
        print(f"| {title} | " + " | ".join(cells) + " |")

    for call in SHOWN:
        measured.note(f"output_calls/{arguments.particles} particles/{call}",
                      float(f"{sum(v for k, v in calls.items() if k[0] == call):.4g}"), commit=commit)
    measured.note(f"output_calls/{arguments.particles} particles/disk space", space, commit=commit)
    print(f"per snapshot, of {n} of 20 bodies and {arguments.particles} particles:\n")
    print("| | " + " | ".join(SHOWN) + " | kB written | kB read |\n|" + "---|" * (len(SHOWN) + 3))
    row("all files", lambda name: True)
    if arguments.spread:
        for name in sorted({name for _, name in calls}):
            row(name, lambda other, name=name: other == name)
    print(f"\nlargest disk space on the way: {space:.2f} times that of the files left")


if __name__ == "__main__":
    sys.exit(main())
