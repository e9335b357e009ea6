"""Processes that end with their parent, and what they leave if they are killed."""
import ctypes
import glob
import os
import shutil
import signal
import tempfile

_PR_SET_PDEATHSIG = 1
_LIBC = ctypes.CDLL(None, use_errno=True)


def end_with_parent(number=signal.SIGKILL):
    """The calling process gets this signal when its parent ends, also one that was killed. For preexec_fn, too."""
    if _LIBC.prctl(_PR_SET_PDEATHSIG, int(number), 0, 0, 0) != 0:
        raise OSError(ctypes.get_errno(), "prctl(PR_SET_PDEATHSIG) failed")


def begin_attempt(home):
    """A new folder for the files of a run, in the folder of the run."""
    return tempfile.mkdtemp(prefix="attempt-", dir=home)


def remove_attempts(home):
    """Removes what a run that was killed has left."""
    for folder in glob.glob(os.path.join(glob.escape(home), "attempt-*")):
        shutil.rmtree(folder)
