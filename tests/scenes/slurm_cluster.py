# SPDX-License-Identifier: MIT
"""A Slurm cluster of its own on this machine: munged, slurmctld and slurmds in a private folder, with
their own socket, key and ports. It needs root, because slurmd does.

Run as a program it starts a cluster, prints how to use it, and ends it on Ctrl-C."""

import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "srun", "squeue", "scontrol", "sinfo")
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

from waiting import HANG as LIMIT, wait_until  # noqa: E402

CONF = """ClusterName=ziggurat
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CredType=cred/munge
SlurmctldPort={ports[0]}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/log/slurmctld
SlurmdLogFile={folder}/log/slurmd-%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
KillWait=2
MinJobAge=600
SchedulerParameters=sched_interval=1,sched_min_interval=0,batch_sched_delay=0
{nodes}PartitionName=test Nodes={names} Default=YES MaxTime=INFINITE State=UP
"""


def why_not():
    """Why no cluster can be started here; None if it can."""
    missing = [name for name in PROGRAMS if find(name) is None]
    if missing:
        return f"{', '.join(missing)} not installed (packages slurm-wlm and munge)"
    if os.geteuid() != 0:
        return "slurmd must be started by root"
    return None


def find(name):
    return shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class Cluster:
    """Two nodes, each a slurmd with its own name and port (--enable-multiple-slurmd, as Debian builds it)."""

    def __init__(self, nodes=2):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="zslurm", dir="/tmp"))
        self.folder.chmod(0o755)
        self.programs = []
        try:
            self.start(nodes)
        except BaseException:
            self.stop()
            raise

    def start(self, count):
        host = socket.gethostname().partition(".")[0]
        ports = free_ports(1 + count)
        names = [f"n{i + 1}" for i in range(count)]
        for name in ("munge", "state", "log", *(f"spool-{name}" for name in names)):
            (self.folder / name).mkdir()
        nodes = "".join(f"NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=1\n"
                        for name, port in zip(names, ports[1:]))
        conf = self.folder / "slurm.conf"
        conf.write_text(CONF.format(host=host, folder=self.folder, ports=ports, nodes=nodes,
                                    names=",".join(names)))
        self.environment = dict(os.environ, SLURM_CONF=str(conf),
                                PATH=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")
        key = self.folder / "munge/key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        munge = self.folder / "munge"
        self.run("munged", "--foreground", "--force", f"--socket={munge}/socket", f"--key-file={key}",
                 f"--pid-file={munge}/pid", f"--log-file={munge}/log", f"--seed-file={munge}/seed")
        self.wait(lambda: (munge / "socket").exists(), "munged")
        self.run("slurmctld", "-D", "-f", str(conf))
        for name in names:
            self.run("slurmd", "-D", "-f", str(conf), "-N", name)
        self.wait(lambda: self.ask("sinfo", "--noheader", "--Node", "--format=%T").split() == ["idle"] * count,
                  "idle nodes")

    def run(self, program, *arguments):
        with open(self.folder / "log" / f"{program}-{len(self.programs)}.out", "wb") as log:
            self.programs.append(subprocess.Popen(
                [find(program), *arguments], env=self.environment, stdin=subprocess.DEVNULL, stdout=log,
                stderr=subprocess.STDOUT))

    def ask(self, *command):
        return subprocess.run(command, env=self.environment, stdin=subprocess.DEVNULL, text=True, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=LIMIT).stdout

    def wait(self, is_so, what):
        try:
            wait_until(is_so, what)
        except AssertionError as error:
            raise RuntimeError(f"{error}:\n{self.logs()}") from None

    def logs(self):
        return "\n".join(f"--- {path.name}\n{path.read_text(errors='replace')[-2000:]}"
                         for path in sorted((self.folder / "log").iterdir()))

    def stop(self):
        """Jobs first, then the daemons in reverse order."""
        if self.programs and self.ask("squeue", "--noheader", "--partition=test").strip():
            self.ask("scancel", "--partition=test")
            self.wait(lambda: not self.ask("squeue", "--noheader", "--partition=test").strip(), "end of the jobs")
        for program in reversed(self.programs):
            program.send_signal(signal.SIGTERM)
        for program in reversed(self.programs):
            try:
                program.wait(10)
            except subprocess.TimeoutExpired:
                program.kill()
                program.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


def main():
    reason = why_not()
    if reason:
        print(f"no cluster: {reason}", file=sys.stderr)
        return 1
    cluster = Cluster()
    print(f"export SLURM_CONF={cluster.folder}/slurm.conf", flush=True)
    try:
        signal.pause()
    except KeyboardInterrupt:
        cluster.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
