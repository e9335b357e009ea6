"""Help with names that are nearly right."""
import difflib


def not_one_of(given, known):
    """"'widht' is not one of: width, height; did you mean 'width'?" """
    near = difflib.get_close_matches(given, known, 1)
    return "'%s' is not one of: %s%s" % (given, ", ".join(known), "; did you mean '%s'?" % near[0] if near else "")
