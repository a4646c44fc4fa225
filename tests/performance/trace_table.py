#!/usr/bin/env python3
"""Where the time of a step goes, of timelines that scree run --trace wrote: per rank and stage, microseconds per step,
of these those in which the host waits for the GPU, and calls per step; "between": of a step in no stage. Then the same
of kernels and copies, which may run side by side. Prints a markdown table; with --step N all that rank 0 does in the
N-th recorded batch of steps and the next 50 us, by time.

    trace_table.py [--step N] TRACE.json ...
"""
import argparse
import json
import pathlib

COLUMNS = ["timeline", "rank", "stage", "us per step", "waiting [us]", "calls per step"]


def ranks_of(path):
    """{rank: its events, outer ones first and those of its device}"""
    ranks = {}
    for event in json.loads(path.read_text())["traceEvents"]:
        if event["ph"] == "X":
            ranks.setdefault(event["pid"], []).append(event)
    if not ranks:
        raise SystemExit(f"error: {path}: has no events; is the run shorter than --trace-from?")
    return {rank: sorted(events, key=lambda event: (event["ts"], -event["dur"])) for rank, events in ranks.items()}


def stages_of(events):
    """Of a rank the number of steps, {stage: [us, of these waiting, calls]} of its host, {kernel: [us, calls]}."""
    steps, stages, kernels = 0, {"between": [0.0, 0.0, 0]}, {}
    stage = None
    for event in events:
        if event["cat"] == "device":
            of = kernels.setdefault(event["name"], [0.0, 0])
            of[0] += event["dur"]
            of[1] += 1
            continue
        if event["cat"] == "steps":
            steps += event["args"]["steps"]
            stages["between"][0] += event["dur"]
            stage = None
            continue
        within = stage is not None and event["ts"] < stage["ts"] + stage["dur"]
        if event["cat"] == "wait":
            stages[stage["name"] if within else "between"][1] += event["dur"]
            continue
        of = stages.setdefault(event["name"], [0.0, 0.0, 0])
        of[0] += event["dur"]
        of[2] += 1
        if not within:  # a stage in another counts there, too
            stages["between"][0] -= event["dur"]
            stage = event
    return steps, stages, kernels


def list_step(events, number):
    """What happens in a batch of steps, by time."""
    batch = [event for event in events if event["cat"] == "steps"][number]
    print("| begin [us] | us | lane | what |\n|---|---|---|---|")
    for event in events:
        begin = event["ts"] - batch["ts"]
        if begin + event["dur"] > 0 and begin < batch["dur"] + 50:
            print(f"| {begin:.1f} | {event['dur']:.1f} | {event['tid']} | {event['name']} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("traces", nargs="+", type=pathlib.Path)
    parser.add_argument("--step", type=int, metavar="N")
    arguments = parser.parse_args()
    if arguments.step is not None:
        for path in arguments.traces:
            list_step(ranks_of(path)[0], arguments.step)
        return
    print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS))
    for path in arguments.traces:
        for rank, events in sorted(ranks_of(path).items()):
            steps, stages, kernels = stages_of(events)
            for name, (us, waiting, calls) in sorted(stages.items(), key=lambda item: -item[1][0]):
                print(f"| {path.stem} | {rank} | {name} | {us / steps:.1f} | {waiting / steps:.1f} | "
                      f"{calls / steps:.2f} |")
            for name, (us, calls) in sorted(kernels.items(), key=lambda item: -item[1][0]):
                print(f"| {path.stem} | {rank} | {name} | {us / steps:.1f} | - | {calls / steps:.2f} |")


if __name__ == "__main__":
    main()
