"""Lets Snakemake make the runs of a plan, and shows how far they are."""
import fcntl
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time

from . import ComparisonError, RunError
from .processes import ends_with_this, remove_attempts

HERE = os.path.dirname(os.path.realpath(__file__))
STEP = re.compile(r"step (\d+) of (\d+)")
POLL = 0.2  # [s]


class Interrupted(Exception):
    """A signal has ended the work."""


class Lock:
    """Only one desert_compare works in a folder at a time. The system frees it when the process ends, however it ends."""

    def __init__(self, folder):
        os.makedirs(folder, exist_ok=True)
        self.file = open(os.path.join(folder, "lock"), "w")
        try:
            fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise ComparisonError("--work %s: another desert_compare works in this folder" % folder)


class Progress:
    """Prints the share of all steps that are done: a bar on a terminal, otherwise a plain line every few seconds."""

    def __init__(self, stream=sys.stderr):
        self.stream, self.terminal = stream, stream.isatty()
        self.begin, self.first, self.next = time.monotonic(), None, 0.0

    def show(self, share, done, total, last=False):
        now = time.monotonic()
        if self.first is None:
            self.first = share
        if now < self.next and not last:
            return
        self.next = now + (0.2 if self.terminal else 5.0)
        gained, elapsed = share - self.first, now - self.begin
        left = clock(elapsed * (1 - share) / gained) + " left" if gained > 0 else "-:-- left"
        text = "%3.0f %%  %d of %d runs  %s" % (100 * share, done, total, "in " + clock(elapsed) if last else left)
        if self.terminal:
            bar = "#" * int(32 * share)
            self.stream.write("\r[%-32s] %s \033[K%s" % (bar, text, "\n" if last else ""))
        else:
            self.stream.write(text + "\n")
        self.stream.flush()


def clock(seconds):
    s = int(seconds + 0.5)
    return "%d:%02d:%02d" % (s // 3600, s // 60 % 60, s % 60) if s >= 3600 else "%02d:%02d" % (s // 60, s % 60)


def last_bytes(path, size=4096):
    """The end of a file as text; empty if there is none yet."""
    try:
        with open(path, "rb") as file:
            file.seek(0, os.SEEK_END)
            file.seek(max(0, file.tell() - size))
            return file.read().decode(errors="replace")
    except FileNotFoundError:
        return ""


class Workflow:
    """The runs of a plan in its folder of work."""

    def __init__(self, plan, cores, profile):
        self.plan, self.cores, self.profile = plan, cores, profile
        self.process = None
        self.snakemake = shutil.which("snakemake")
        if not self.snakemake:
            raise ComparisonError("snakemake is not in $PATH (Debian's and Ubuntu's package snakemake)")

    def folder(self, key):
        return os.path.join(self.plan["work"], "runs", key)

    def result(self, key):
        return os.path.join(self.folder(key), "result.json")

    def done(self, key):
        return os.path.isfile(self.result(key))

    def share(self, key):
        """Of a run's steps, those that are done, as its log says every five seconds."""
        if self.done(key):
            return 1.0
        steps = STEP.findall(last_bytes(os.path.join(self.folder(key), "log.txt")))
        return min(0.99, int(steps[-1][0]) / max(1, int(steps[-1][1]))) if steps else 0.0

    def run(self):
        """Returns the results by key. Raises RunError with the reasons if runs failed, Interrupted after a signal."""
        pending = [key for key in self.plan["runs"] if not self.done(key)]
        for key in set(self.plan["runs"]) - set(pending):
            remove_attempts(self.folder(key))
        if pending:
            self.make(pending)
        return {key: read_json(self.result(key)) for key in self.plan["runs"]}

    def make(self, pending):
        """Snakemake learns of these runs only: a result that is there is whole, whatever Snakemake thinks of it."""
        plan_path = os.path.join(self.plan["work"], "plan.json")
        write_whole(plan_path, json.dumps({**self.plan, "pending": pending}, indent=1))
        words = [self.snakemake, "--snakefile", os.path.join(HERE, "Snakefile"), "--directory", self.plan["work"],
                 "--keep-going", "--rerun-incomplete", "--nolock"]
        words += ["--profile", self.profile] if self.profile else []
        words += ["--cores", str(self.cores)] if self.cores else []
        for key in pending:
            os.makedirs(self.folder(key), exist_ok=True)  # a cluster writes its logs there
            if os.path.exists(os.path.join(self.folder(key), "log.txt")):
                os.remove(os.path.join(self.folder(key), "log.txt"))  # of an attempt that a kill has ended
        log = os.path.join(self.plan["work"], "snakemake.log")
        handlers = {n: signal.signal(n, self.interrupt) for n in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
        try:
            with open(log, "w") as file:
                self.process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=file, stderr=file,
                                                start_new_session=True, preexec_fn=ends_with_this())
            self.wait()
        finally:
            self.end()
            for number, handler in handlers.items():
                signal.signal(number, handler)
        self.require_all(log)

    def wait(self):
        progress, keys = Progress(), list(self.plan["runs"])
        while True:
            ended = self.process.poll() is not None
            shares = [self.share(key) for key in keys]
            progress.show(sum(shares) / len(keys), sum(s == 1.0 for s in shares), len(keys), last=ended)
            if ended:
                return
            time.sleep(POLL)

    def interrupt(self, number, _frame):
        raise Interrupted(signal.Signals(number).name)

    def end(self):
        """Ends Snakemake and its jobs on this machine, if they still run; those of a cluster go on."""
        if self.process is None or self.process.poll() is not None:
            return
        os.killpg(self.process.pid, signal.SIGTERM)
        try:
            self.process.wait(2)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()

    def require_all(self, log):
        failed = [key for key in self.plan["runs"] if not self.done(key)]
        if not failed and self.process.returncode == 0:
            return
        reasons = []
        for key in failed:
            lines = last_bytes(os.path.join(self.folder(key), "log.txt")).strip().splitlines()
            reasons.append("%s: %s" % (key, lines[-1] if lines else "did not begin; %s says more" % log))
        raise RunError("%d of %d runs failed:\n  %s" % (len(failed), len(self.plan["runs"]), "\n  ".join(reasons))
                       if failed else "snakemake ended with status %d; %s says why" % (self.process.returncode, log))


def read_json(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def write_whole(path, text):
    """Under another name first, so that a file of this name is always whole."""
    part = path + ".part"
    with open(part, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(part, path)
