"""desert_compare from the command line to the page."""
import os
import sys

from . import ComparisonError, RunError
from .arguments import parse
from .plan import Planner
from .workflow import Interrupted, Lock, Workflow, write_whole

LOST_MATERIAL, INVALID, FAILED, INTERRUPTED = 1, 2, 3, 130


def tell(text):
    print("desert_compare: %s" % text, file=sys.stderr)


def main(arguments, beside):
    """Returns the exit status."""
    try:
        options = parse(arguments)
        lock = Lock(options.work)  # held until the program ends
        return compare(options, beside, lock)
    except ComparisonError as error:
        tell(error)
        return INVALID
    except (RunError, OSError) as error:
        tell(error)
        return FAILED
    except Interrupted as signal:
        tell("%s: the same command goes on with what is left" % signal)
        return INTERRUPTED
    except KeyboardInterrupt:
        return INTERRUPTED


def compare(options, beside, _lock):
    plan = Planner(options, beside).plan()
    cores = options.cores or (None if options.profile else len(os.sched_getaffinity(0)))
    plan["threads"] = options.threads or max(1, (cores or 1) // len(plan["runs"]) if not options.profile else 1)
    plan["run_one"] = os.path.join(os.path.dirname(os.path.realpath(__file__)), "run_one.py")
    results = Workflow(plan, cores, options.profile).run()
    backends = sorted({r["summary"]["backend"] for r in results.values()})
    if len(backends) > 1:
        raise RunError("some runs were made on the backend %s, others on %s, whose results may differ; "
                       "allowed: one backend (--backend)" % tuple(backends[:2]))
    from .page import page_of  # matplotlib takes long to load: what is refused is refused at once
    write_whole(options.out, page_of(plan, results))
    tell("wrote %s" % options.out)
    lost = [key for key, r in results.items() if any(r["summary"]["mass_residual"].values())]
    if lost:
        tell("material is not conserved in %s" % ", ".join(lost))
    return LOST_MATERIAL if lost else 0
