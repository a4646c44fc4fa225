"""A SLURM of this machine alone: munged, slurmctld and two slurmd, each of which plays a node with more CPUs and GPUs
than there are. It lives in a temporary folder, needs no systemd and no cgroups, and leaves nothing behind."""

import os
import pathlib
import pwd
import shutil
import signal
import socket
import subprocess
import tempfile
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "scontrol", "scancel")
NODES, CPUS, GPUS = ("n0", "n1"), 8, 2
LIMIT = 30  # [s] for starting, and for ending
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"

CONFIGURATION = """ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket,cred_expire=5
CredType=cred/munge
StateSaveLocation={folder}/slurmctld
SlurmctldPidFile={folder}/slurmctld/pid
SlurmdSpoolDir={folder}/%n
SlurmdPidFile={folder}/%n/pid
TmpFS={folder}/%n/tmp
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=2
KillWait=10
GresTypes=gpu
NodeName=n0 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs={cpus} Gres=gpu:{gpus}
NodeName=n1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs={cpus} Gres=gpu:{gpus}
PartitionName=all Nodes=n0,n1 Default=YES MaxTime=INFINITE
"""
# cred_expire [s] is also what a job waits in the queue that was put back; less than 5 is taken for 120. TmpFS has the
# sockets of PMIx: one folder per node, because names of sockets are equal on all nodes. SLURM wants devices for GPUs;
# nobody opens these.


def missing():
    """The programs that are not installed."""
    return [name for name in PROGRAMS if shutil.which(name, path=PATH) is None]


def processes():
    """Process id, name and environment of all processes of this user."""
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            yield int(entry.name), (entry / "comm").read_text().strip(), (entry / "environ").read_bytes()
        except OSError:  # it has ended, or is another user's
            continue


class Cluster:
    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="scree_slurm_"))
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("SLURM_")}
        self.environment.update(SLURM_CONF=str(self.folder / "slurm.conf"), PATH=PATH, OMPI_ALLOW_RUN_AS_ROOT="1",
                                OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                                OMPI_MCA_mpi_yield_when_idle="1",  # more ranks than cores, which srun does not tell
                                # Shared memory would take equal local ranks of the two nodes for one.
                                OMPI_MCA_pml="ob1", OMPI_MCA_btl="self,tcp", OMPI_MCA_btl_tcp_if_include="lo")
        self.user = pwd.getpwuid(os.getuid()).pw_name
        self.daemons = {}

    def start(self):
        self.configure()
        munge = self.folder / "munge"
        self.launch("munged", "--foreground", "--force", f"--key-file={munge}/key", f"--socket={munge}/socket",
                    f"--pid-file={munge}/pid", f"--seed-file={munge}/seed", f"--log-file={munge}/log")
        self.wait_for(lambda: (munge / "socket").exists(), "munged")
        self.launch("slurmctld", "-D", "-c")
        for node in NODES:
            self.launch("slurmd", "-D", "-N", node, name=node)
        self.wait_for(self.is_idle, "slurmctld and slurmd")

    def configure(self):
        self.folder.chmod(0o755)
        for name in ("munge", "slurmctld", *NODES):
            (self.folder / name).mkdir(mode=0o755)
        key = self.folder / "munge" / "key"
        key.write_bytes(os.urandom(64))
        key.chmod(0o600)
        for node in NODES:
            (self.folder / node / "tmp").mkdir()
        gpus = [self.folder / f"gpu{i}" for i in range(GPUS)]
        for gpu in gpus:
            gpu.symlink_to("/dev/null")
        (self.folder / "gres.conf").write_text(
            "".join(f"NodeName={','.join(NODES)} Name=gpu File={gpu}\n" for gpu in gpus))
        sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(1 + len(NODES))]
        ports = [each.getsockname()[1] for each in sockets]
        for each in sockets:
            each.close()
        (self.folder / "slurm.conf").write_text(
            CONFIGURATION.format(folder=self.folder, host=socket.gethostname().split(".")[0], user=self.user,
                                 ports=ports, cpus=CPUS, gpus=GPUS))

    def launch(self, program, *words, name=None):
        with open(self.folder / f"{name or program}.log", "wb") as log:
            self.daemons[name or program] = subprocess.Popen([program, *words], env=self.environment, stdout=log,
                                                             stderr=subprocess.STDOUT)

    def is_idle(self):
        nodes = self.run("sinfo", "--noheader", "--Node", "--format=%t")
        return nodes.returncode == 0 and nodes.stdout.split() == ["idle"] * len(NODES)

    def wait_for(self, condition, what):
        deadline = time.monotonic() + LIMIT
        while not condition():
            ended = [name for name, daemon in self.daemons.items() if daemon.poll() is not None]
            if ended or time.monotonic() > deadline:
                raise RuntimeError(f"{what}: not ready" + (f", {ended} have ended" if ended else "") + self.logs())
            time.sleep(0.1)

    def logs(self):
        return "".join(f"\n--- {name}\n" + (self.folder / f"{name}.log").read_text(errors="replace")[-3000:]
                       for name in self.daemons)

    def run(self, *words, **settings):
        return subprocess.run(words, env=self.environment | settings.pop("environment", {}), capture_output=True,
                              text=True, timeout=60, **settings)

    def processes_of_job(self, job, name):
        """Ids of the job's processes with this name."""
        mark = f"SLURM_JOB_ID={job}".encode()
        own = str(self.folder).encode()
        return [process for process, command, environment in processes()
                if command == name and mark in environment.split(b"\0") and own in environment]

    def left_over(self):
        """Processes that were started by this SLURM, or are it."""
        own = str(self.folder).encode()
        return {process: command for process, command, environment in processes() if own in environment}

    def stop(self):
        """Ends jobs and daemons. Returns the processes that were alive after that, which it kills."""
        if all(daemon.poll() is None for daemon in self.daemons.values()) and self.daemons:
            self.run("scancel", "--user", self.user)
            self.run("scancel", "--user", self.user, "--signal=KILL", "--full")
            deadline = time.monotonic() + LIMIT
            # Those that end steps report to slurmctld and wait for its answer: the daemons must outlive them.
            while "slurmstepd" in self.left_over().values() and time.monotonic() < deadline:
                time.sleep(0.1)
        for daemon in reversed(self.daemons.values()):
            daemon.terminate()
        for daemon in self.daemons.values():
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                pass  # it is among those left over
        left = self.left_over()
        for process in left:
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                pass
        shutil.rmtree(self.folder, ignore_errors=True)
        return left
