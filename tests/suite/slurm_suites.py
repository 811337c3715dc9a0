"""The same workflow through a real Slurm of one node, which the test starts and stops. Needs root.

Everything of it lies in a folder under the build folder: configuration, key, sockets, states. The ports are free
ones; the daemons are the test's own children and end with it, on every way out.
"""
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from suite_case import OURS, PATIENCE, SuiteCase, wait_for

BUILD = os.environ["CELLOCUT_BUILD"]
DAEMONS = ("munged", "slurmctld", "slurmd")


def free_ports(count):
    """Ports that nobody listens on now, all different."""
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class Cluster:
    """munged, slurmctld and slurmd of a folder."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.host = socket.gethostname().split(".")[0]
        self.controller_port, self.node_port = free_ports(2)
        self.processes = {}
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        self.key = self.folder / "munge.key"
        self.key.write_bytes(os.urandom(1024))
        self.key.chmod(0o400)
        self.configuration = self.folder / "slurm.conf"
        self.configuration.write_text(self.text(), encoding="ascii")
        self.environment = {**os.environ, "SLURM_CONF": str(self.configuration)}

    def text(self):
        place = self.folder
        return f"""ClusterName=cellocut
SlurmctldHost={self.host}(127.0.0.1)
SlurmctldPort={self.controller_port}
SlurmdPort={self.node_port}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={place}/munge.socket
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout=10
JobRequeue=1
MinJobAge=600
StateSaveLocation={place}/state
SlurmdSpoolDir={place}/spool
SlurmctldPidFile={place}/slurmctld.pid
SlurmdPidFile={place}/slurmd.pid
SlurmctldLogFile={place}/slurmctld.log
SlurmdLogFile={place}/slurmd.log
NodeName={self.host} NodeAddr=127.0.0.1 Port={self.node_port} CPUs=2 RealMemory=64000 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""

    def command_of(self, daemon):
        if daemon == "munged":
            place = self.folder
            return ["munged", "--foreground", "--force", f"--key-file={self.key}", f"--socket={place}/munge.socket",
                    f"--pid-file={place}/munged.pid", f"--log-file={place}/munged.log",
                    f"--seed-file={place}/munged.seed"]
        return [daemon, "-D", *(["-N", self.host] if daemon == "slurmd" else ["-i"])]

    def start(self, daemon):
        with open(self.folder / f"{daemon}.out", "ab") as log:
            self.processes[daemon] = subprocess.Popen(  # pylint: disable=consider-using-with
                self.command_of(daemon), env=self.environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                start_new_session=True)

    def ask(self, *command):
        return subprocess.run(command, env=self.environment, check=False, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=PATIENCE).stdout

    def is_up(self):
        return self.ask("sinfo", "--noheader", "--format=%T").strip() in ("idle", "mixed", "allocated")

    def start_all(self):
        self.start("munged")
        wait_for((self.folder / "munge.socket").exists, "munged")
        self.start("slurmctld")
        self.start("slurmd")
        wait_for(self.is_up, f"the node; {self.ask('sinfo')}")

    def workers(self):
        """The node's daemon and, each of its own session, the steps that it started."""
        found = [self.processes["slurmd"].pid]
        for entry in pathlib.Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            try:
                words = (entry / "cmdline").read_bytes().split(b"\0")
                settings = (entry / "environ").read_bytes().split(b"\0")
            except OSError:
                continue
            ours = f"SLURM_CONF={self.configuration}".encode() in settings
            in_job = any(setting.startswith(b"SLURM_JOB_ID=") for setting in settings)
            if ours and (in_job or words[0].startswith(b"slurmstepd")):
                found.append(int(entry.name))
        return found

    def kill_node(self):
        """What a machine that dies does: its daemon, its steps and their processes are gone at once."""
        for pid in self.workers():
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        self.processes["slurmd"].wait()

    def stop_all(self):
        if "slurmctld" in self.processes:
            self.ask("scancel", "--full", "--user=root")
        if "slurmd" in self.processes:
            self.kill_node()
        for process in self.processes.values():
            if process.poll() is None:
                process.terminate()
            try:
                process.wait(timeout=15)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


class Slurm(SuiteCase):
    FOLDER = BUILD

    @classmethod
    def setUpClass(cls):
        # A signal that ends this program ends the daemons too: as an exception it runs what is registered.
        for number in (signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, lambda *_: sys.exit(1))
        place = tempfile.TemporaryDirectory(prefix="slurm-", dir=BUILD)  # pylint: disable=consider-using-with
        cls.addClassCleanup(place.cleanup)
        cls.cluster = Cluster(place.name)
        cls.addClassCleanup(cls.cluster.stop_all)
        cls.cluster.start_all()

    def slurm_command(self):
        return ["--profile", "slurm", "--snakemake=--jobs=2", "--snakemake=--latency-wait=10"]

    def states(self):
        return self.cluster.ask("scontrol", "--oneliner", "show", "jobs")

    def test_the_same_results_as_on_the_local_cores(self):
        self.write_suite({"ours": [f"command: {OURS}"], "failing": ["command: 'false'"]})
        self.bench(*self.slurm_command(), env=self.cluster.environment)
        there = self.results()
        self.assertIn("JobState=COMPLETED", self.states())
        self.out = self.folder / "local"
        self.bench()
        for case, here in self.results().items():
            for key in ("status", "exit_code", "check", "output_sha256"):
                self.assertEqual(there[case].get(key), here.get(key))

    def test_a_worker_killed_in_the_middle(self):
        self.write_suite({"gated": self.gated()})
        os.environ["SLURM_CONF"] = str(self.cluster.configuration)
        self.addCleanup(os.environ.pop, "SLURM_CONF")
        process = self.start(*self.slurm_command())
        wait_for((self.folder / "blocked").exists, "the second job")
        self.cluster.kill_node()
        (self.folder / "go").touch()
        time.sleep(1)
        self.cluster.start("slurmd")
        self.assertEqual(process.wait(timeout=PATIENCE), 0, (self.folder / "log").read_text(encoding="utf-8"))
        self.assertEqual({result["status"] for result in self.results().values()}, {"ok"})
        starts = [self.starts("holed"), self.starts("tetrahedron")]
        self.assertGreaterEqual(sum(starts), 3)  # at least one of them was begun again


if __name__ == "__main__":
    unittest.main()
