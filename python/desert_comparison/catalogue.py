"""The metrics of the table, in order: doc/comparing.md says the same at length."""
import collections

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
           "Speed of the whole pattern between the last two snapshots; none where it changed too much to be followed."),
    Metric("migration_direction_deg", "Direction of migration", "°", 1, scatter.circular,
           "Where the pattern moves to: 0° east, 90° north."),
    Metric("flux_m2_s", "Sand flux", "", 1, scatter.linear,
           "What the wind carries through a metre of width, mean over the terrain; slab models do not count it."),
    Metric("flux_direction_deg", "Direction of the flux", "°", 1, scatter.circular, "Where it is carried to."),
    Metric("bare_share", "Bare ground", "% of area", 100, scatter.linear, "Ground with less than 2 cm of sand."),
]

# Of rates, by how long a run lasts: per second for hops and slabs, per year for sand in real units.
RATES = {"migration_speed_m_s": ("m/s", "m/a"), "flux_m2_s": ("m²/s", "m²/a")}
YEARS_FROM = 0.1 * EARTH_YEAR  # simulated time [s]


def time_unit(longest_time):
    """Name and length [s] of the unit that suits runs of so many seconds."""
    return ("a", EARTH_YEAR) if longest_time >= YEARS_FROM else ("s", 1)


def metrics_for(longest_time):
    """The metrics with units that suit runs of so many seconds."""
    years = longest_time >= YEARS_FROM
    return [m._replace(unit=RATES[m.key][years], scale=EARTH_YEAR if years else 1) if m.key in RATES else m
            for m in METRICS]
