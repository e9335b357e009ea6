"""What a client says of topics that do not come: one that has another name than the client thinks never comes, and nothing
else would say so."""
FIRST_NOTICE, NEXT_NOTICE = 3.0, 30.0  # [s] of waiting


def waiting_text(awaited, published):
    """What to say of topics on which nothing has come yet.

    awaited    (name, whether it has a publisher) of each
    published  topics of the same types that somebody publishes; those that end in the same name are told, since the wanted
               one may be among them"""
    # What has just been subscribed to may not be connected yet.
    silent = [name for name, has_publisher in awaited if has_publisher or name in published]
    without = [name for name, _ in awaited if name not in silent]
    ends = {name.rsplit("/", 1)[-1] for name in without}
    instead = [name for name in published if name.rsplit("/", 1)[-1] in ends]
    text = "The terrain client waits."
    if without:
        text += " Nobody publishes " + ", ".join(without)
        text += " (somebody does %s)." % ", ".join(instead) if instead else "."
    if silent:
        text += " Nothing has come yet of %s." % ", ".join(silent)
    return text


class WaitingNotice:
    """When to say it: after three seconds of waiting, and every half minute from then on."""

    def __init__(self):
        self._waits, self._next = False, 0.0

    def due(self, waits, now):
        """Whether to tell at `now` [s], given whether something is awaited now."""
        if waits and not self._waits:
            self._next = now + FIRST_NOTICE
        self._waits = waits
        if not waits or now < self._next:
            return False
        self._next = now + NEXT_NOTICE
        return True
