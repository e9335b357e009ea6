"""Means and standard deviations over seeds."""
import math


def linear(values):
    """Mean, and standard deviation of the sample (n - 1; None of one value)."""
    n = len(values)
    mean = math.fsum(values) / n
    return mean, math.sqrt(math.fsum((v - mean) ** 2 for v in values) / (n - 1)) if n > 1 else None


def circular(values, turn=360.0):
    """Of directions [deg] that repeat after `turn`: that of the mean vector, and sqrt(-2 ln R) of its length R.

    Mardia & Jupp, Directional Statistics (2000), section 2.3. The mean is in [0, turn); it is None where the
    directions cancel.
    """
    scale = 2 * math.pi / turn
    x = math.fsum(math.cos(v * scale) for v in values) / len(values)
    y = math.fsum(math.sin(v * scale) for v in values) / len(values)
    length = min(1.0, math.hypot(x, y))
    if length < 1e-9:
        return None, None
    mean = math.atan2(y, x) / scale % turn
    return mean, math.sqrt(max(0.0, -2 * math.log(length))) / scale if len(values) > 1 else None


def axial(values):
    """Of undirected lines, which repeat after 180 degrees."""
    return circular(values, 180.0)


def decimals_of(mean, deviation):
    """To show: two digits of the deviation, but no more than four of the mean; three of it without a deviation."""
    def decimals(value, digits):
        return digits - 1 - math.floor(math.log10(abs(value)))
    if not deviation:
        return max(0, decimals(mean, 3)) if mean else 2
    wanted = decimals(deviation, 2)
    return max(0, min(wanted, decimals(mean, 4)) if abs(mean) > deviation else wanted)


def text(values, kind=linear):
    """'12.3 ± 0.4' of the values that are known, '–' of none; says how many are known if some are not."""
    known = [v for v in values if v is not None]
    mean, deviation = kind(known) if known else (None, None)
    if mean is None:
        return "–"
    # Tenths of a degree are enough, and 359.97 degrees are 0.
    decimals = decimals_of(mean, deviation) if kind is linear else 1
    turn = {circular: 360.0, axial: 180.0}.get(kind)
    form = "%.2e" if kind is linear and 0 < abs(mean) < 1e-4 else "%%.%df" % decimals
    shown = form % (round(mean, decimals) % turn if turn else mean)
    if deviation is not None:
        shown += " ± " + form % deviation
    return shown + (" (%d of %d runs)" % (len(known), len(values)) if len(known) < len(values) else "")
