"""A self-contained HTML page of a run."""

from __future__ import annotations

import base64
import html
import io
import re
from fnmatch import fnmatch
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from scree.errors import ScreeError
from scree.pictures.render import DrawnRun, PictureOptions, counted, make_picture
from scree.plots import column_panels, energy_panels, history_figure
from scree.run import Run

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #202020; max-width: 60rem; margin: 2rem auto; padding: 0 1rem }
h1 { margin-bottom: 0 } h2 { margin-top: 2.5rem; border-bottom: 1px solid #dddddd }
table { border-collapse: collapse } td, th { padding: 0.15rem 1.5rem 0.15rem 0; text-align: left; vertical-align: top }
th { font-weight: normal; color: #606060; white-space: nowrap } img { max-width: 100% }
pre { background: #f6f6f6; padding: 1rem; overflow: auto }
a { color: #0072b2; text-decoration: none } nav a { margin-right: 1.2rem } .status { color: #606060 }
.warning { background: #fff3d6; padding: 0.3rem 1rem; margin: 0.4rem 0 }
.bar { background: #0072b2; height: 0.8rem; min-width: 1px }
"""
LEAST_STAGE = 0.005  # fraction of the time from which on a stage has a row
MECHANISM = ("efforts/*/effort", "contacts/*/f[xyz]")  # columns with the forces on bodies and in joints
REACTIONS = ("reactions/{}/f[xyz]", "reactions/{}/torque*")
MOST_JOINTS = 6  # joints whose reactions are shown
STEPS = ("step/contacts", "step/length")  # columns about the course of the run


def escaped(value: object) -> str:
    return html.escape(str(value))


def image(figure: Figure, text: str) -> str:
    data = io.BytesIO()
    figure.savefig(data, format="png")
    plt.close(figure)
    return f'<img alt="{escaped(text)}" src="data:image/png;base64,{base64.b64encode(data.getvalue()).decode()}">'


def heading(title: str) -> str:
    """Heading of a section, a target of links()."""
    return f'<h2 id="{title.lower().replace(" ", "-")}">{title}</h2>'


def links(body: str) -> str:
    """Links to all sections of the page."""
    found = re.findall(r'<h2 id="([^"]+)">([^<]+)</h2>', body)
    return "<nav>" + "".join(f'<a href="#{anchor}">{title}</a>' for anchor, title in found) + "</nav>"


def table(rows: list[tuple[str, str]]) -> str:
    """rows: names and HTML values."""
    return "<table>" + "".join(f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows) + "</table>"


def duration(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.3g} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 120 else f"{minutes // 60} h {minutes % 60} min"


def start_row(start: dict[str, Any]) -> str:
    """One start of the run, in one line."""
    ranks = f"{start['ranks']} {'rank' if start['ranks'] == 1 else 'ranks'}"
    return f"t = {float(start['from']):.6g} to {float(start['to']):.6g} s, {start['steps']:,} steps in " \
           f"{duration(float(start['loop_seconds']))}; {ranks}, {escaped(start['backend'])}, " \
           f"{escaped(start['host'])}, {escaped(start['started'])}"


def facts(record: dict[str, Any]) -> list[tuple[str, str]]:
    """Rows of the summary. Steps and seconds are sums over all starts of the run."""
    run, build, cost, counts = record["run"], record["build"], record["cost"], record["counts"]
    total, starts = record["total"], record["starts"]
    steps, particles, loop = counts["steps"], counts["particles"], float(total["loop_seconds"])
    taken = total["steps"] * counts["substeps"] * particles
    pace = f", {taken / loop:.3g} particle-steps per second" if loop > 0 and taken else ""
    several = f" in {len(starts)} starts" if len(starts) > 1 else ""
    # Records of earlier versions have the count under its former name.
    escaped_particles = counts["particles_escaped"] if "particles_escaped" in counts else counts["left"]
    rejected = counts["rejected_error"] + counts["rejected_newton"]
    memory, on_gpus = f"{cost['peak_memory_kib'] / 1024:,.0f} MiB", cost.get("device_memory_kib", 0) / 1024
    if on_gpus:
        memory += f", {on_gpus:,.0f} MiB on GPUs"
    rows = [
        ("simulated", f"{record['measures']['simulated_time']:.6g} s in {steps:,} steps, {rejected:,} rejected steps"),
        ("model", f"{counted(particles, 'particle', 'particles')}, {counted(counts['bodies'], 'body', 'bodies')}, "
                  f"{counted(escaped_particles, 'escaped particle', 'escaped particles')}"),
        ("wall time", f"{duration(float(total['wall_seconds']))}{several}{pace}; {memory}"),
        ("hardware", f"{run['ranks']} {'rank' if run['ranks'] == 1 else 'ranks'}, {escaped(run['backend'])}, "
               f"{escaped(record['host']['name'])} ({escaped(record['host']['processor'])})"),
        ("program", f"Scree {escaped(build['version'])}, commit {escaped(build['commit'])}"),
        ("started, ended", f"{escaped(run['started'])}, {escaped(run['ended'])}"),
        ("state hash", f"<code>{escaped(run['state_hash'])}</code>"),
        ("command", f"<code>{escaped(run['command_line'])}</code>"),
    ]
    if run["restarted_from"]:
        rows.append(("continued from", escaped(run["restarted_from"])))
    if len(starts) > 1:
        rows += [(f"start {number}", start_row(start)) for number, start in enumerate(starts, 1)]
    rows += [("change of the deck", escaped(change)) for change in run["changes"]]
    return rows


def stages(record: dict[str, Any]) -> str:
    """Bars of the time per stage, longest first."""
    total = sum(float(stage["seconds"]) for stage in record["stages"])
    if total <= 0:
        return ""
    rows = ""
    for stage in sorted(record["stages"], key=lambda stage: -float(stage["seconds"])):
        fraction = float(stage["seconds"]) / total
        if fraction >= LEAST_STAGE:
            name, seconds = escaped(stage["stage"].replace("_", " ")), duration(float(stage["seconds"]))
            rows += f"<tr><th>{name}</th><td>{seconds}</td><td>{100 * fraction:.1f} %</td><td style=\"width: 20rem\">" \
                    f'<div class="bar" style="width: {100 * fraction:.1f}%"></div></td></tr>'
    last = "<p>Times of the last start.</p>" if len(record["starts"]) > 1 else ""
    return f"{heading('Time per stage')}{last}<table>{rows}</table>"


def pictures(run: Run, options: PictureOptions) -> str:
    """The last state, or the reason why there is no picture; the rest of the page does not need one."""
    try:
        return last_state(run, options)
    except ScreeError as error:
        return f'{heading("The last state")}<p class="warning">No picture: {escaped(error)}</p>'


def last_state(run: Run, options: PictureOptions) -> str:
    if not len(run.snapshots):
        return "<p>The run has no snapshots.</p>"
    drawn = DrawnRun(run)
    numbers = sorted({0, len(run.snapshots) - 1})
    options.fit(drawn, numbers)
    picture = make_picture(drawn, numbers, options, fine=True)
    picture.draw(numbers[-1])
    last = image(picture.figure, f"the run at t = {run.snapshots[-1].time:g} s")
    return heading("The last state") + last


def reactions(run: Run) -> str:
    """Reactions of the first joints."""
    joints = list(dict.fromkeys(name.split("/")[1] for name in run.history if name.startswith("reactions/")))
    patterns = [pattern.format(joint) for joint in joints[:MOST_JOINTS] for pattern in REACTIONS]
    names = [name for name in run.history if any(fnmatch(name, pattern) for pattern in patterns)]
    if not names:
        return ""
    more = f"<p>The first {MOST_JOINTS} of {len(joints)} joints.</p>" if len(joints) > MOST_JOINTS else ""
    return heading("Joint reactions") + more + image(history_figure(run.history, "", names, energies=False),
                                                     "forces and torques in joints over time")


def plots(run: Run) -> str:
    found = ""
    if energy_panels(run.history):
        found += heading("Energy") + image(history_figure(run.history, ""), "energies over time")
    acting = [name for name in run.history if any(fnmatch(name, pattern) for pattern in MECHANISM)]
    if acting:
        found += heading("Efforts and contact forces") + image(history_figure(run.history, "", acting, energies=False),
                                                               "efforts and contact forces over time")
    found += reactions(run)
    steps = [name for name in STEPS if name in run.history]
    if steps and column_panels(run.history, steps):
        found += heading("Contacts and steps") + image(history_figure(run.history, "", steps, energies=False),
                                                       "contacts and length of the steps over time")
    return found


def warnings(run: Run) -> str:
    if not run.warnings:
        return "<p>No warnings.</p>" if run.record else ""
    return "".join(f'<p class="warning">{escaped(warning)}</p>' for warning in run.warnings)


def deck(run: Run) -> str:
    """The resolved deck, if there is a record."""
    if run.record is None:
        return ""
    return f"{heading('Deck')}<details><summary>with all defaults</summary>" \
           f"<pre>{escaped(run.record['run']['resolved_deck'])}</pre></details>"


def page(run: Run, options: PictureOptions) -> str:
    """The HTML text. Throws ScreeError if the run has neither snapshots nor history."""
    if not len(run.snapshots) and not run.history.rows:
        raise ScreeError(f"{run.folder}: has neither history nor snapshots yet")
    ended = f", by the stop condition {run.stop_condition}" if run.stop_condition else ""
    head = f"<h1>{escaped(run.title)}</h1><p class=\"status\">{escaped(run.folder)}: {escaped(run.status + ended)}</p>"
    summary = table(facts(run.record)) if run.record else ""
    history = plots(run) if run.history.rows else ""
    timing = stages(run.record) if run.record else ""
    sections = pictures(run, options) + history + timing + deck(run)
    body = head + links(sections) + warnings(run) + summary + sections
    return f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escaped(run.title)}</title>' \
           f"<style>{STYLE}</style></head><body>{body}</body></html>\n"
