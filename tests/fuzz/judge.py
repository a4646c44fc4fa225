"""Runs scree on one case and says what is wrong with how it ended."""

import collections
import dataclasses
import json
import os
import re
import signal
import subprocess
import time
import unicodedata

DONE, BAD_INPUT, FAILED, IO_FAILED, STOPPED = 0, 2, 3, 4, 5
TROUBLES = ("crash", "hang", "wrong code", "no place", "bad message")

STOP_AFTER, HANG_AFTER = 8, 20  # CPU seconds: a run is told to stop; a program is taken to hang
PATIENCE = 15  # wall seconds per CPU second on a busy machine, before waiting is taken for a hang, too
LARGEST_RUN = 5000  # particles and bodies
STEPS = 5  # of a run
NAMES_STAGE = r"^error: (the .* at t = \S+ s: )?(stage \w+|mbs_\w+, rank \d+): .*\w"  # of a run that failed

Ended = collections.namedtuple("Ended", "code text errors cpu memory hung stopped")


@dataclasses.dataclass
class Case:
    """files: name -> bytes, put into the case's folder. kinds: of its mutations."""
    kinds: tuple
    files: dict
    words: list = dataclasses.field(default_factory=list)
    restart: str = ""
    state_hash: str = ""  # that a restart from the undamaged checkpoint ends with


@dataclasses.dataclass
class Verdict:
    troubles: list  # (one of TROUBLES, what it was)
    accepted: bool = False
    cpu: float = 0
    memory: int = 0  # [bytes]


def cpu_seconds(pid):
    try:
        with open(f"/proc/{pid}/stat") as stat:
            fields = stat.read().rpartition(")")[2].split()
    except (FileNotFoundError, ProcessLookupError):
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Program:
    def __init__(self, path, memory):
        """memory: address space that it may take [bytes]; a build with sanitizers takes what it wants."""
        self.path = str(path)
        self.environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
        version = subprocess.run([self.path, "--version"], env=self.environment, capture_output=True, text=True,
                                 check=True).stdout
        limits = ["prlimit", "--core=0"] + ([] if "-fsanitize" in version else [f"--as={memory}"])
        self.command = [*limits, self.path]

    def execute(self, folder, words, may_stop=False):
        """may_stop: whether a long run is told to end by a signal."""
        output, errors = folder / "stdout.txt", folder / "stderr.txt"
        # What MPI leaves behind after a crash goes with the case's folder.
        environment = dict(self.environment, TMPDIR=str(folder))
        with open(output, "wb") as out, open(errors, "wb") as err:
            process = subprocess.Popen([*self.command, *words], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                       stdout=out, stderr=err)
        hung, stopped, cpu, start = False, False, 0.0, time.monotonic()
        while True:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            if pid:
                break
            cpu = cpu_seconds(process.pid)
            wall = time.monotonic() - start
            if not hung and (cpu > HANG_AFTER or wall > HANG_AFTER * PATIENCE):
                hung = True
                process.kill()
            if may_stop and not stopped and cpu > STOP_AFTER:
                stopped = True
                process.send_signal(signal.SIGTERM)
            time.sleep(0.01 if wall < 2 else 0.1)
        process.returncode = os.waitstatus_to_exitcode(status)
        return Ended(process.returncode, output.read_bytes(), errors.read_bytes(), usage.ru_utime + usage.ru_stime,
                     1024 * usage.ru_maxrss, hung, stopped)


def first_line(data):
    lines = data.decode(errors="replace").strip().splitlines()
    return next((line for line in lines if line.startswith("error")), lines[0] if lines else "")[:300]


def has_place(message, case):
    """Whether a refusal says where: file and line, file and key, a word of the command line, or file and dataset."""
    if "--set" in message and any(word.startswith("--set") for word in case.words):
        return True
    for name in case.files:
        if re.search(re.escape(name) + r":\d+", message):
            return True  # a line
        key = re.search(re.escape(name) + r": (?:[^:=]*\.)?(\w+)(: | = )", message)
        if key and (key.group(1).encode() not in case.files[name] or ": missing" in message):
            return True  # a key that stands nowhere
        if re.search(re.escape(name) + r": [^:]*'.+'", message):
            return True  # a body or joint by its name
        if not name.endswith(".toml") and name in message:
            return True  # a file that is no text
    return "deck.toml: cannot be read" in message


def message_troubles(ended, case):
    try:
        text = ended.errors.decode()
    except UnicodeDecodeError:
        return [("bad message", "not UTF-8")]
    troubles = []
    lines = text.splitlines()
    errors = [line for line in lines if line.startswith("error: ")]
    strange = [line for line in lines if not line.startswith(("error: ", "warning: "))]
    if strange:
        troubles.append(("bad message", "beside messages: " + strange[0][:200]))
    if any(unicodedata.category(letter) in ("Cc", "Cs") for letter in text.replace("\n", "")):
        troubles.append(("bad message", "control characters"))
    if max(map(len, lines), default=0) > 2000:
        troubles.append(("bad message", f"a line of {max(map(len, lines))} characters"))
    expected = 0 if ended.code in (DONE, STOPPED) else 1
    if len(errors) != expected:
        troubles.append(("bad message", f"{len(errors)} error lines with code {ended.code}"))
    elif ended.code in (BAD_INPUT, IO_FAILED) and not has_place(errors[0], case):
        troubles.append(("no place", errors[0][:300]))
    elif ended.code == FAILED and not re.search(NAMES_STAGE, errors[0]):
        troubles.append(("no place", errors[0][:300]))
    return troubles


def troubles_of(ended, case, allowed):
    if ended.hung:
        return [("hang", f"{ended.cpu:.0f} s of CPU; " + first_line(ended.errors))]
    if ended.code < 0 or b"Sanitizer" in ended.errors or b"terminate called" in ended.errors:
        return [("crash", f"code {ended.code}; " + first_line(ended.errors))]
    if ended.code not in allowed:
        return [("wrong code", f"{ended.code}: " + first_line(ended.errors))]
    return message_troubles(ended, case)


def read_hash(folder):
    return json.loads((folder / "out" / "run_record.json").read_text())["run"]["state_hash"]


def shortened(report):
    """The words that end a run after a few steps; None where it is too large to be run here."""
    numbers = {name: re.search(pattern, report) for name, pattern in (
        ("particles", r"(?m)^particles\s+(\d+)"), ("bodies", r"(?m)^bodies\s+(\d+)"),
        ("fixed", r"fixed step (\S+) s \((\d+) step"), ("end", r"(?m)^time\s+0 to (\S+) s"))}
    size = sum(int(numbers[name].group(1)) for name in ("particles", "bodies") if numbers[name])
    if size > LARGEST_RUN:
        return None
    if numbers["fixed"] and int(numbers["fixed"].group(2)) > STEPS:
        return ["--set", f"time.end={STEPS * float(numbers['fixed'].group(1))!r}"]
    return []


def judge(program, case, folder):
    for name, data in case.files.items():
        (folder / name).write_bytes(data)
    if case.restart:
        return judge_restart(program, case, folder)
    checked = program.execute(folder, ["check", "deck.toml", *case.words])
    verdict = Verdict(troubles_of(checked, case, (DONE, BAD_INPUT, IO_FAILED)), checked.code == DONE, checked.cpu,
                      checked.memory)
    end = shortened(checked.text.decode(errors="replace")) if verdict.accepted and not verdict.troubles else None
    if end is not None:
        ran = program.execute(folder, ["run", "deck.toml", "--output", "out", *case.words, *end], may_stop=True)
        allowed = (DONE, FAILED) + ((STOPPED,) if ran.stopped else ())
        verdict.troubles = [(kind, "run: " + what) for kind, what in troubles_of(ran, case, allowed)]
    return verdict


def judge_restart(program, case, folder):
    ran = program.execute(folder, ["run", "deck.toml", "--output", "out", "--restart", case.restart], may_stop=True)
    verdict = Verdict(troubles_of(ran, case, (DONE, BAD_INPUT, IO_FAILED)), ran.code == DONE, ran.cpu, ran.memory)
    if ran.code == DONE and not verdict.troubles and read_hash(folder) != case.state_hash:
        verdict.troubles.append(("wrong code", "0, but another state than from the undamaged checkpoint"))
    return verdict
