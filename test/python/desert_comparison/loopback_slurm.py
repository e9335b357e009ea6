"""A Slurm of one node on this machine: munged, slurmctld and slurmd of its own, without systemd."""
import getpass
import os
import shutil
import socket
import subprocess
import time

CONFIGURATION = """\
ClusterName=loopback
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
SlurmctldPort={controller_port}
SlurmdPort={daemon_port}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MailProg=/bin/true
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for s in sockets:
        s.bind(("localhost", 0))
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


class LoopbackSlurm:
    """Runs from the start to stop(). `environment` lets programs find it."""

    def __init__(self, folder, patience=1):
        self.folder, self.processes = folder, []
        os.chmod(folder, 0o755)  # munged refuses sockets that others could not reach
        for name in ("state", "spool"):
            os.mkdir(os.path.join(folder, name))
        controller_port, daemon_port = free_ports(2)
        with open(os.path.join(folder, "slurm.conf"), "w") as file:
            file.write(CONFIGURATION.format(
                host=socket.gethostname().split(".")[0], user=getpass.getuser(), folder=folder,
                cpus=len(os.sched_getaffinity(0)), controller_port=controller_port, daemon_port=daemon_port))
        self.environment = {**os.environ, "SLURM_CONF": os.path.join(folder, "slurm.conf")}
        try:
            self._start(patience)
        except BaseException:
            self.stop()
            raise

    def _start(self, patience):
        key = os.path.join(self.folder, "munge.key")
        with open(os.open(key, os.O_WRONLY | os.O_CREAT, 0o400), "wb") as file:
            file.write(os.urandom(128))
        self._daemon("munged", "--foreground", "--force", "--key-file=" + key, *(
            "--%s=%s" % (option, os.path.join(self.folder, name)) for option, name in
            (("socket", "munge.socket"), ("pid-file", "munged.pid"), ("log-file", "munged.log"), ("seed-file", "munge.seed"))))
        self._wait(lambda: os.path.exists(os.path.join(self.folder, "munge.socket")), "munged", patience)
        self._daemon("slurmctld", "-D")
        self._daemon("slurmd", "-D")
        self._wait(lambda: "idle" in self._ask("sinfo", "--noheader", "--format=%t"), "slurmd", patience)

    def _daemon(self, name, *arguments):
        path = shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")
        with open(os.path.join(self.folder, name + ".out"), "w") as log:
            self.processes.append(subprocess.Popen([path, *arguments], stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                                   env=self.environment))

    def _ask(self, *words):
        return subprocess.run(words, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              universal_newlines=True).stdout

    def _wait(self, condition, name, patience):
        deadline = time.monotonic() + 100 * patience
        while not condition():
            ended = [p.args[0] for p in self.processes if p.poll() is not None]
            if ended or time.monotonic() > deadline:
                with open(os.path.join(self.folder, name + ".out")) as log:
                    why = "%s has ended" % ended if ended else "does not get ready"
                    raise RuntimeError("%s: %s\n%s" % (name, why, log.read()))
            time.sleep(0.1)

    def states(self):
        """The states of all jobs."""
        jobs = self._ask("scontrol", "--oneliner", "show", "job").splitlines()
        return [word[len("JobState="):] for job in jobs for word in job.split() if word.startswith("JobState=")]

    def stop(self):
        for process in reversed(self.processes):
            process.terminate()
        for process in self.processes:
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
