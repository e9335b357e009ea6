"""What desert_compare consists of; python/desert_compare is the program.

arguments   the command line
plan        checks the scenarios, and says which runs there are
workflow    lets Snakemake make the runs, with progress
run_one     one run: desert_run, then desert_metrics
catalogue   the metrics of the table, and what they mean
scatter     means and standard deviations over seeds, of directions too
charts      metrics over time
page        the page
"""


class ComparisonError(Exception):
    """Invalid input, with the reason for the user: exit status 2."""


class RunError(Exception):
    """Runs failed, with the reason for the user: exit status 3."""
