"""Processes that end with their parent, and what they leave if they are killed."""
import ctypes
import functools
import glob
import os
import shutil
import signal
import tempfile

_PR_SET_PDEATHSIG = 1
_LIBC = ctypes.CDLL(None, use_errno=True)


def end_with(parent):
    """The calling process is killed when its parent, the process of this number, ends, also one that was killed; at once if
    that has ended already."""
    if _LIBC.prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL), 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "prctl(PR_SET_PDEATHSIG) failed")
    if os.getppid() != parent:
        os.kill(os.getpid(), signal.SIGKILL)


def ends_with_this():
    """For preexec_fn: the new process ends with the calling one."""
    return functools.partial(end_with, os.getpid())


def begin_attempt(home):
    """A new folder for the files of a run, in the folder of the run."""
    return tempfile.mkdtemp(prefix="attempt-", dir=home)


def remove_attempts(home):
    """Removes what a run that was killed has left."""
    for folder in glob.glob(os.path.join(glob.escape(home), "attempt-*")):
        shutil.rmtree(folder)
