"""The metrics of the table, in order: doc/science/comparing.md says the same at length."""
import collections
import math

from . import scatter

# key: of a snapshot of desert_metrics; scale: what its value is multiplied by for this unit.
Metric = collections.namedtuple("Metric", "key name unit scale kind what")

EARTH_YEAR = 31557600.0  # 365.25 d [s]

METRICS = [
    Metric("crest_orientation_deg", "Crest orientation", "°", 1, scatter.axial,
           "Direction along the crests: 0° runs east to west, 90° north to south, counter-clockwise."),
    Metric("crest_coherence", "Coherence of the crests", "", 1, scatter.linear,
           "1: all crests are parallel; 0: they have no common direction, as in a field of star dunes."),
    Metric("wavelength_m", "Wavelength", "m", 1, scatter.linear,
           "Distance from crest to crest, at right angles to the crests; none where nothing repeats."),
    Metric("mean_height_m", "Mean height of dunes", "m", 1, scatter.linear,
           "From the lows before and after a crest up to the crest, mean over all profiles across the crests."),
    Metric("highest_m", "Highest dune", "m", 1, scatter.linear, "The greatest of these heights."),
    Metric("rms_relief_m", "Relief (rms)", "m", 1, scatter.linear,
           "Standard deviation of the surface about its mean: also counts what is no dune."),
    Metric("deepest_sand_m", "Deepest sand", "m", 1, scatter.linear, "Greatest depth of sand above rock."),
    Metric("highest_stack_slabs", "Highest stack", "slabs", 1, scatter.linear,
           "The deepest sand in slabs, where a slab model moves the sand."),
    Metric("slip_face_share", "Slip faces", "% of area", 100, scatter.linear,
           "Sandy ground steeper than 30°, on which sand slides."),
    Metric("slip_face_lee_share", "... of them in the lee", "%", 100, scatter.linear,
           "Slip faces that fall away from the wind of that moment."),
    Metric("slip_face_direction_deg", "Direction of slip faces", "°", 1, scatter.circular,
           "Where slip faces fall to on average: 0° east, 90° north."),
    Metric("slip_face_directions", "Directions with slip faces", "", 1, scatter.linear,
           "Number of distinct directions that slip faces fall to: one for barchans, three or more for star dunes."),
    Metric("terminations_per_m", "Defects", "per km of crest", 1000, scatter.linear,
           "Ends of crest lines: tips of dunes, and places where a crest ends between others or joins one."),
    Metric("migration_speed_m_s", "Migration", "", 1, scatter.linear,
           "Mean velocity of the whole pattern over the last half of the run; none where it changes too much to be followed."),
    Metric("migration_direction_deg", "Direction of migration", "°", 1, scatter.circular,
           "Where the pattern moves to: 0° east, 90° north."),
    Metric("flux_m2_s", "Sand flux", "", 1, scatter.linear,
           "What the wind carries through a metre of width: mean over the terrain and the snapshots of the last half of "
           "the run; slab models do not count it."),
    Metric("flux_direction_deg", "Direction of the flux", "°", 1, scatter.circular, "Where it is carried to."),
    Metric("bare_share", "Bare ground", "% of area", 100, scatter.linear, "Ground with less than 2 cm of sand."),
]

# Amount and direction of what is not that of the end, but a mean over the last half of a run: winds come and go.
MOTIONS = (("migration_speed_m_s", "migration_direction_deg"), ("flux_m2_s", "flux_direction_deg"))

# Of rates, by how long a run lasts: per second for hops and slabs, per year for sand in real units.
RATES = {"migration_speed_m_s": ("m/s", "m/a"), "flux_m2_s": ("m²/s", "m²/a")}
DAY = 86400.0  # [s]; runs of real sand last longer, those of hops and slabs do not


def time_unit(longest_time):
    """Name and length [s] of the unit that suits runs of so many seconds."""
    if longest_time >= 2 * EARTH_YEAR:
        return "a", EARTH_YEAR
    return ("d", DAY) if longest_time >= 2 * DAY else ("s", 1)


def metrics_for(longest_time):
    """The metrics with units that suit runs of so many seconds."""
    years = longest_time >= 2 * DAY
    return [m._replace(unit=RATES[m.key][years], scale=EARTH_YEAR if years else 1) if m.key in RATES else m
            for m in METRICS]


def mean_motion(snapshots, amount, direction):
    """Amount and direction of the mean vector over the last half of the time; None if less than half of it is known.

    A snapshot stands for the time since the one before.
    """
    half = 0.5 * snapshots[-1]["time_s"]
    spans = [(b["time_s"] - a["time_s"], b) for a, b in zip(snapshots, snapshots[1:]) if b["time_s"] > half]
    known = [(time, s) for time, s in spans if s[amount] is not None]
    total = sum(time for time, _ in known)
    if not known or total < 0.5 * sum(time for time, _ in spans):
        return None
    x, y = (sum(time * s[amount] * f(math.radians(s[direction])) for time, s in known) / total for f in (math.cos, math.sin))
    return math.hypot(x, y), math.degrees(math.atan2(y, x))


def value_of(snapshots, key):
    """Of a metric, for a run."""
    for pair in MOTIONS:
        if key in pair:
            mean = mean_motion(snapshots, *pair)
            return mean and mean[pair.index(key)]
    return snapshots[-1][key]
