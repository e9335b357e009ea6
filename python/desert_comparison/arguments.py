"""The command line of desert_compare."""
import argparse
import os
import re

from . import ComparisonError

DESCRIPTION = """\
Runs several scenarios with several seeds each, measures their dunes, and writes one page (HTML, with all pictures in
it): pictures of each scenario, a table of metrics with their scatter over seeds, mass balance, and time per step.

Each scenario keeps its own terrain, grid and number of steps; run k of every scenario has the same seed.
--same-start lets all scenarios begin with the terrain of the first one; their grids must then be the same.
"""
EPILOG = """\
The runs go through Snakemake. Finished runs are kept in --work: after a kill the same command goes on with the others,
and a run is made anew only if its scenario, a file that this names, an option or the program has changed.
doc/science/comparing.md defines the metrics.
Exit status: 0; 1 if a run lost or gained material (the page says which); 2 for invalid input; 3 if a run failed;
130 after Ctrl-C, SIGTERM or SIGHUP.
"""


def whole(lowest, highest):
    """A parser of whole numbers in a range."""
    def parse(text):
        try:
            number = int(text)
        except ValueError:
            number = None
        if number is None or not lowest <= number <= highest:
            raise argparse.ArgumentTypeError("'%s' must be a whole number from %d to %d" % (text, lowest, highest))
        return number
    return parse


def parse(arguments):
    """Returns the options. Ends the program for --help and what argparse refuses; raises ComparisonError."""
    p = argparse.ArgumentParser(prog="desert_compare", description=DESCRIPTION, epilog=EPILOG, allow_abbrev=False,
                                usage="%(prog)s [OPTIONS] --out PAGE.html SCENARIO SCENARIO...",
                                formatter_class=lambda prog: argparse.RawDescriptionHelpFormatter(prog, width=100))
    p.add_argument("scenarios", nargs="+", metavar="SCENARIO",
                   help="a YAML file, or the name of an installed scenario, such as barchan")
    p.add_argument("--out", required=True, metavar="PAGE.html", help="the page")
    p.add_argument("--seeds", type=whole(1, 1000), default=3, metavar="N", help="runs of each scenario (default 3)")
    p.add_argument("--first-seed", type=whole(0, 2 ** 31), default=1, metavar="S", help="the first of the seeds S, S + 1, ... (default 1)")
    length = p.add_mutually_exclusive_group()
    length.add_argument("--steps", type=whole(1, 2 ** 40), metavar="N", help="steps of each run (default: the scenario's)")
    length.add_argument("--duration", metavar="T", help="in their place: simulated time, such as 24a")
    p.add_argument("--set", action="append", default=[], metavar="PATH=VALUE",
                   help="override a key of every scenario; may be repeated")
    p.add_argument("--same-start", action="store_true", help="all scenarios begin with the terrain of the first one")
    p.add_argument("--snapshots", type=whole(2, 10000), default=40, metavar="N",
                   help="times at which a run is measured (default 40)")
    p.add_argument("--layer", choices=["sand", "elevation"], default="sand",
                   help="dunes are measured on the depth of sand (default), or on the elevation")
    p.add_argument("--film", action="store_true", help="film the first seed of each scenario (needs ffmpeg)")
    p.add_argument("--view", action="append", default=[], metavar="KEY=VALUE",
                   help="of the film; desert_run --describe-view lists them; may be repeated")
    p.add_argument("--backend", choices=["auto", "cpu", "cuda"], default="auto", help="as of desert_run (default auto)")
    p.add_argument("--cores", type=whole(1, 4096), metavar="N", help="processors to use (default: all of this machine)")
    p.add_argument("--threads", type=whole(1, 4096), metavar="N",
                   help="of each run (default: such that all runs together use the cores; 1 with --profile)")
    p.add_argument("--profile", metavar="P",
                   help="a Snakemake profile, name or folder, for a cluster; config/snakemake/slurm is one for Slurm")
    p.add_argument("--work", metavar="DIR", help="folder of the runs (default: PAGE.runs)")
    p.add_argument("--keep-terrain", action="store_true", help="keep terrain.nc of each run, too")
    options = p.parse_args(arguments)
    if len(options.scenarios) < 2:
        raise ComparisonError("%s: is one scenario (allowed: two or more)" % options.scenarios[0])
    if options.duration is not None and not re.search("[1-9]", options.duration):
        raise ComparisonError("--duration '%s': is no time longer than 0 (allowed: such as 24a)" % options.duration)
    if options.view and not options.film:
        raise ComparisonError("--view: --film is required too")
    options.out = os.path.abspath(options.out)
    options.work = os.path.abspath(options.work or os.path.splitext(options.out)[0] + ".runs")
    folder = os.path.dirname(options.out)
    if not os.path.isdir(folder) or not os.access(folder, os.W_OK):
        raise ComparisonError("--out %s: the folder %s is missing or cannot be written" % (options.out, folder))
    if os.path.lexists(options.out) and (os.path.islink(options.out) or not os.path.isfile(options.out)):
        raise ComparisonError("--out %s: is a folder, a link or a device (allowed: a file that is new, or that is to be "
                              "replaced)" % options.out)
    return options
