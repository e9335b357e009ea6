"""Help with names that are nearly right, as src/core/did_you_mean.hpp gives it."""

_LONGEST = 64


def _typing_errors(a, b):
    """Optimal string alignment: insertions, deletions, substitutions and exchanges of neighbours."""
    before, last, row = [], [], list(range(len(b) + 1))
    for i, letter in enumerate(a, 1):
        before, last, row = last, row, [i]
        for j, other in enumerate(b, 1):
            row.append(min(last[j] + 1, row[j - 1] + 1, last[j - 1] + (letter != other)))
            if i > 1 and j > 1 and letter == b[j - 2] and a[i - 2] == other:
                row[j] = min(row[j], before[j - 2] + 1)
    return row[-1]


def did_you_mean(given, known):
    """"; did you mean 'width'?" where `given` is a typing error away from one of the names `known`; else "". A typing
    error is up to two letters that are wrong, missing, too many or exchanged (one in short names), or letters in the
    other case."""
    if not 0 < len(given) <= _LONGEST:
        return ""
    least, best = 3 if len(given) > 4 else 2 if len(given) > 2 else 1, None
    for name in known:
        errors = _typing_errors(given.lower(), name.lower()) if len(name) <= _LONGEST else least
        if errors < least:
            least, best = errors, name
    return "" if best is None or best == given else "; did you mean '%s'?" % best


def not_one_of(given, known):
    """"'widht' is not one of: width, height; did you mean 'width'?" """
    return "'%s' is not one of: %s%s" % (given, ", ".join(known), did_you_mean(given, known))
