"""Markdown tables, one row per kernel, from the files that profile.sh writes.

    profile_table.py --copy-bandwidth GB/s FILE.csv ...
    profile_table.py --metrics      # what profile.sh asks Nsight Compute for

copy-bandwidth: what copy_bandwidth prints for the device, bytes read and written. Rates are sums over the kernel's
calls; registers, occupancy, hit rates, throughputs and stalls are means over them, weighted by time. Stalls: the
reasons for which warps did not issue an instruction, by Nsight Compute's names, in percent of the warps' time; those
of 10 % and more.
"""
import argparse
import csv
import math
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import measured  # noqa: E402

TIME, READ, WRITE = "gpu__time_duration.sum", "dram__bytes_read.sum", "dram__bytes_write.sum"
MEANS = {
    "registers": "launch__registers_per_thread",
    "occupancy [%]": "sm__warps_active.avg.pct_of_peak_sustained_active",
    "L1 hits [%]": "l1tex__t_sector_hit_rate.pct",
    "L2 hits [%]": "lts__t_sector_hit_rate.pct",
    "L1 throughput [%]": "l1tex__throughput.avg.pct_of_peak_sustained_active",
    "L2 throughput [%]": "lts__throughput.avg.pct_of_peak_sustained_elapsed",
}
# Warps in each state per issued instruction; LATENCY is the sum over all states, also those not asked for.
LATENCY = "smsp__average_warp_latency_per_inst_issued.ratio"
STALLS = {reason.replace("_", " "): f"smsp__average_warps_issue_stalled_{reason}_per_issue_active.ratio" for reason in (
    "long_scoreboard", "lg_throttle", "short_scoreboard", "mio_throttle", "math_pipe_throttle", "wait", "not_selected",
    "barrier", "membar", "drain", "no_instruction", "branch_resolving", "imc_miss")}
NEEDED = (TIME, READ, WRITE)
METRICS = (*NEEDED, *MEANS.values(), LATENCY, *STALLS.values())
LEAST_STALL = 10  # [%]
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
    missing = [name for name in NEEDED if name not in header]
    if missing:
        raise SystemExit(f"error: {path}: no metric {missing[0]}; profile.sh asks for it")
    launches = []
    for row in rows[2:]:
        launch = {"kernel": row[header.index("Kernel Name")]}
        for name in METRICS:
            column = header.index(name) if name in header else None
            launch[name] = math.nan if column is None else number(row[column]) * factor(path, name, units[column])
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
        return math.nan  # ncu's "n/a": not measured for this kernel


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


def mean(group, metric):
    """Over the launches that have the metric, weighted by time; NaN without one."""
    known = [launch for launch in group if not math.isnan(launch[metric])]
    time = sum(launch[TIME] for launch in known)
    return sum(launch[metric] * launch[TIME] for launch in known) / time if time > 0 else math.nan


def whole(value):
    return "-" if math.isnan(value) else f"{value:.0f}"


def stalls(group):
    shares = {reason: 100 * mean(group, metric) / mean(group, LATENCY) for reason, metric in STALLS.items()}
    largest = sorted((item for item in shares.items() if item[1] >= LEAST_STALL), key=lambda item: -item[1])
    return ", ".join(f"{reason} {share:.0f}" for reason, share in largest) or "-"


def plain_name(kernel):
    """Of the work of items their name, of other kernels theirs, without template arguments."""
    name = short_name(kernel)
    item = re.search(r"\w+Item\b", name)
    return item[0] if item else name.split("<")[0]


def note(case, kernels, copy_bandwidth):
    """kernels: {name: launches}, those of a plain name that take longest first."""
    first = {}
    for kernel, group in kernels:
        first.setdefault(plain_name(kernel), group)
    for name, group in first.items():
        time = sum(launch[TIME] for launch in group)
        moved = sum(launch[READ] + launch[WRITE] for launch in group)
        cells = [("time", 1e6 * time / len(group), "us"), ("bytes", 1e-6 * moved / len(group), "MB"),
                 ("of copy", 1e-7 * moved / time / copy_bandwidth, "%"),
                 *((column.removesuffix(" [%]"), mean(group, metric), "%" if "[%]" in column else "")
                   for column, metric in MEANS.items()),
                 ("waits", 100 * mean(group, STALLS["long scoreboard"]) / mean(group, LATENCY), "%")]
        for column, value, unit in cells:
            if not math.isnan(value):
                measured.note(f"profile/{case}, {name}/{column}", float(value), unit, machine=measured.gpu(),
                              backend="cuda")


def table(path, copy_bandwidth):
    kernels = {}
    for launch in read_launches(path):
        kernels.setdefault(launch["kernel"], []).append(launch)
    total = sum(launch[TIME] for group in kernels.values() for launch in group)
    columns = ["kernel", "calls", "time [us]", "of all time [%]", "MB per call", "GB/s", "of copy [%]", *MEANS,
               "stalls [%]"]
    lines = [f"### {path.stem}", "", "| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    longest_first = sorted(kernels.items(), key=lambda item: -sum(launch[TIME] for launch in item[1]))
    note(path.stem, longest_first, copy_bandwidth)
    for kernel, group in longest_first:
        time = sum(launch[TIME] for launch in group)
        moved = sum(launch[READ] + launch[WRITE] for launch in group)
        cells = [f"`{short_name(kernel)}`", str(len(group)), f"{1e6 * time / len(group):.1f}",
                 f"{100 * time / total:.1f}",
                 f"{1e-6 * moved / len(group):.2f}", f"{1e-9 * moved / time:.0f}",
                 f"{1e-7 * moved / time / copy_bandwidth:.0f}",
                 *(whole(mean(group, name)) for name in MEANS.values()), stalls(group)]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=pathlib.Path, metavar="FILE.csv")
    parser.add_argument("--copy-bandwidth", type=float, metavar="GB/s")
    parser.add_argument("--metrics", action="store_true", help="print the metrics that the tables are made of")
    arguments = parser.parse_args()
    if arguments.metrics:
        print(",".join(METRICS))
        return
    if not arguments.files or arguments.copy_bandwidth is None:
        parser.error("--copy-bandwidth GB/s and FILE.csv are needed, or --metrics")
    if not arguments.copy_bandwidth > 0:
        parser.error(f"--copy-bandwidth {arguments.copy_bandwidth:g}: must be positive")
    print(f"Time per call; GB/s: device memory read and written; of copy: over {arguments.copy_bandwidth:.0f} GB/s.\n")
    print("\n\n".join(table(path, arguments.copy_bandwidth) for path in arguments.files))


if __name__ == "__main__":
    sys.exit(main())
