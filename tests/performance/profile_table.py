"""Markdown tables, one row per kernel, from the files that profile.sh writes.

    profile_table.py --copy-bandwidth GB/s FILE.csv ...

copy-bandwidth: what copy_bandwidth prints for the device, bytes read and written. Rates are sums over the kernel's
calls; registers, occupancy and hit rates are means over them, weighted by time.
"""
import argparse
import csv
import pathlib
import re
import sys

TIME, READ, WRITE = "gpu__time_duration.sum", "dram__bytes_read.sum", "dram__bytes_write.sum"
MEANS = {
    "registers": "launch__registers_per_thread",
    "occupancy [%]": "sm__warps_active.avg.pct_of_peak_sustained_active",
    "L1 hits [%]": "l1tex__t_sector_hit_rate.pct",
    "L2 hits [%]": "lts__t_sector_hit_rate.pct",
    "L2 throughput [%]": "lts__t_sectors.avg.pct_of_peak_sustained_elapsed",
}
TIME_UNITS = {"ns": 1e-9, "nsecond": 1e-9, "us": 1e-6, "usecond": 1e-6, "ms": 1e-3, "msecond": 1e-3, "s": 1.0,
              "second": 1.0}
BYTE_UNITS = {"byte": 1.0, "Kbyte": 1e3, "Mbyte": 1e6, "Gbyte": 1e9}


def read_launches(path):
    """[{"kernel": name, metric: value in s, bytes or the metric's own unit}], one per launch."""
    lines = path.read_text().splitlines()
    first = next((k for k, line in enumerate(lines) if line.startswith('"ID"')), None)
    if first is None:
        raise SystemExit(f"error: {path}: no table of launches; must be written by profile.sh")
    rows = list(csv.reader(line for line in lines[first:] if line.startswith('"')))
    header, units = rows[0], rows[1]
    missing = [name for name in (TIME, READ, WRITE, *MEANS.values()) if name not in header]
    if missing:
        raise SystemExit(f"error: {path}: no metric {missing[0]}; profile.sh asks for it")
    launches = []
    for row in rows[2:]:
        launch = {"kernel": row[header.index("Kernel Name")]}
        for name in (TIME, READ, WRITE, *MEANS.values()):
            column = header.index(name)
            launch[name] = number(row[column]) * factor(path, name, units[column])
        launches.append(launch)
    if not launches:
        raise SystemExit(f"error: {path}: no launches; the program made fewer than profile.sh skips (SKIP)")
    return launches


def factor(path, metric, unit):
    table = TIME_UNITS if metric == TIME else BYTE_UNITS if metric in (READ, WRITE) else None
    if table is None:
        return 1.0
    if unit not in table:
        raise SystemExit(f"error: {path}: {metric} in \"{unit}\"; allowed: {', '.join(table)}")
    return table[unit]


def number(text):
    try:
        return float(text.replace(",", ""))
    except ValueError:
        return float("nan")  # ncu's "n/a": not measured for this kernel


def short_name(kernel):
    """Without namespaces, return type and arguments; template arguments stay, they tell kernels apart."""
    name = re.sub(r"\(anonymous namespace\)::|<unnamed>::|\b\w+::", "", kernel)
    name = re.sub(r"^void ", "", name)
    depth = 0
    for k, letter in enumerate(name):
        depth += (letter == "<") - (letter == ">")
        if letter == "(" and depth == 0:
            name = name[:k]
            break
    name = re.sub(r"\s+", " ", name).replace("|", "\\|")
    return name if len(name) <= 90 else name[:87] + "..."


def table(path, copy_bandwidth):
    kernels = {}
    for launch in read_launches(path):
        kernels.setdefault(launch["kernel"], []).append(launch)
    total = sum(launch[TIME] for group in kernels.values() for launch in group)
    columns = ["kernel", "calls", "time [us]", "of all time [%]", "MB per call", "GB/s", "of copy [%]", *MEANS]
    lines = [f"### {path.stem}", "", "| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    for kernel, group in sorted(kernels.items(), key=lambda item: -sum(launch[TIME] for launch in item[1])):
        time = sum(launch[TIME] for launch in group)
        moved = sum(launch[READ] + launch[WRITE] for launch in group)
        means = [sum(launch[name] * launch[TIME] for launch in group) / time for name in MEANS.values()]
        cells = [f"`{short_name(kernel)}`", str(len(group)), f"{1e6 * time / len(group):.1f}",
                 f"{100 * time / total:.1f}",
                 f"{1e-6 * moved / len(group):.2f}", f"{1e-9 * moved / time:.0f}",
                 f"{1e-7 * moved / time / copy_bandwidth:.0f}", *(f"{mean:.0f}" for mean in means)]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", type=pathlib.Path, metavar="FILE.csv")
    parser.add_argument("--copy-bandwidth", type=float, required=True, metavar="GB/s")
    arguments = parser.parse_args()
    if not arguments.copy_bandwidth > 0:
        parser.error(f"--copy-bandwidth {arguments.copy_bandwidth:g}: must be positive")
    print(f"Time per call; GB/s: device memory read and written; of copy: over {arguments.copy_bandwidth:.0f} GB/s.\n")
    print("\n\n".join(table(path, arguments.copy_bandwidth) for path in arguments.files))


if __name__ == "__main__":
    sys.exit(main())
