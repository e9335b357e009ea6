"""Builds maps from keyframes and updates, and detects missing messages, as src/client/layer_assembler.cpp does.

Keyframes and updates arrive over separate connections, so an update can arrive before its keyframe, and the last update of
a keyframe after the next keyframe.
"""
import collections
import dataclasses

from .layer_map import NO_CELLS, LayerMap, Rectangle
from .layer_messages import (changed_cells, check_fit, check_update, differing_cells, map_of, value_count,
                             with_update)

# Limits of the updates that are kept until their keyframe arrives. Beyond them a new keyframe costs less.
MAX_QUEUED_UPDATES, MAX_QUEUED_VALUES = 256, 1 << 24

# Whether a keyframe is needed to continue: the first one, or that of waiting updates, should arrive soon (EXPECTED), or the
# sender has begun anew with the first update of a keyframe, which should arrive soon (RESTARTED), or messages are missing,
# and the map cannot be continued without a keyframe (LOST).
NONE, EXPECTED, RESTARTED, LOST = "none", "expected", "restarted", "lost"


@dataclasses.dataclass(frozen=True)
class MapChange:
    """What a message has changed."""
    map: LayerMap = None         # the new map; None if the message changed nothing
    cells: Rectangle = NO_CELLS  # the cells that may differ from the map before; empty if only the map's time changed
    replaced: bool = False       # the map before had another frame, size or place, or there was none


@dataclasses.dataclass
class Counts:
    """Counts of the messages of a layer since it was subscribed to."""
    keyframes: int = 0      # that became the map
    updates: int = 0        # that were written into the map
    late: int = 0           # messages older than the map, which were ignored without loss
    unusable: int = 0       # ignored updates: after a gap, or without their keyframe
    refused: int = 0        # malformed messages, which were ignored
    gaps: int = 0           # how often messages were missing, so that a keyframe was needed
    restarts: int = 0       # how often the numbers of keyframes began again
    last_refusal: str = ""  # reason for the last refusal; empty if there was none
    last_gap: str = ""      # reason for the last gap; empty if there was none


NOTHING = MapChange()


class LayerAssembler:
    """Uses no threads, no clock and no ROS graph, and is not thread-safe."""

    def __init__(self):
        self.map = None  # the last valid map, which stays after a gap; None before the first keyframe
        self.counts = Counts()
        self._keyframe_stamp = None     # of the keyframe on which the map is built
        self._complete = True           # no update is missing after those in the map
        self._sender_restarted = False  # and its keyframe is missing
        self._last_received = (0, 0)    # number of the last update, whether used or not
        self._last_stamp = None         # and its stamp
        self._time_went_back = False    # the last update is older than the one before
        self._repeated = None           # a map of the keyframe on which the map is built, if that was sent again
        self._base = None               # a map of that keyframe, if updates that waited for it are in the map
        self._queue = collections.deque()  # updates without their keyframe, in order of arrival
        self._queued_values = 0

    def need(self):
        """NONE, EXPECTED, RESTARTED or LOST."""
        if self._sender_restarted and self._queue and self._queue[0].sequence == 1:
            return RESTARTED
        if not self._complete:
            return LOST
        return NONE if self.map and not self._queue else EXPECTED

    def keyframe_overdue(self):
        """Reports that the expected keyframe did not arrive in time. If there is a map, that counts as a gap."""
        if self.map and self._queue:
            self._record_gap("keyframe %d, on which received updates are based, has not arrived" % self._queue[-1].keyframe)

    # ---- keyframes

    def take_keyframe(self, keyframe):
        """Takes an ElevationGrid or LayerGrid; a MapChange."""
        try:
            new = map_of(keyframe)
        except ValueError as error:
            return self._refuse(error)
        if self._is_repeated(new):
            self._repeated = new
            self.counts.late += 1
            return NOTHING
        self._keyframe_stamp = new.stamp
        return self._replace_map(new)

    def _is_repeated(self, new):
        """A latching publisher repeats its last message on every new connection."""
        held = self.map
        return (held is not None and not self._sender_restarted and new.keyframe == held.keyframe and
                new.step <= held.step and not new.stamp.is_zero() and new.stamp == self._keyframe_stamp)

    def _replace_map(self, new, cells=None):
        before, self.map = self.map, new
        if before and new.keyframe <= before.keyframe:
            self.counts.restarts += 1
        replaced = before is None or not new.same_geometry(before)
        if cells is None:
            cells = Rectangle(0, 0, new.width, new.height) if replaced else differing_cells(new.values, before.values)
        self._repeated = None
        self._complete, self._sender_restarted = True, False
        self.counts.keyframes += 1
        waited = bool(self._queue)
        cells = cells.union(self._apply_queued())
        self._base = new if waited else None
        return MapChange(self.map, cells, replaced)

    def _apply_queued(self):
        """Writes the waiting updates that build on the keyframe just taken; the cells that they change. Updates of a later
        keyframe keep waiting."""
        waiting, self._queue, self._queued_values = self._queue, collections.deque(), 0
        cells = NO_CELLS
        for update in waiting:
            of_a_node_before = update.header.stamp < self._keyframe_stamp
            if of_a_node_before or update.keyframe < self.map.keyframe:
                self.counts.unusable += 1
            else:
                cells = cells.union(self._apply_in_order(update).cells)
        return cells

    # ---- updates

    def take_update(self, update):
        """Takes an ElevationUpdate or LayerUpdate; it is kept until its keyframe arrives if that is not here yet. A
        MapChange."""
        try:
            check_update(update)
        except ValueError as error:
            return self._refuse(error)
        before, self._last_received = self._last_received, (update.keyframe, update.sequence)
        self._time_went_back = self._last_stamp is not None and update.header.stamp < self._last_stamp
        self._last_stamp = update.header.stamp
        if self.map is None:
            self._enqueue(update)
            return NOTHING
        of_another_run = (not self._sender_restarted and update.keyframe == self.map.keyframe and
                          update.step < self.map.step)
        if self._last_received > before and not of_another_run:
            return self._apply_in_order(update)
        while self._queue:
            self._drop_oldest_queued()
        return self._apply(update) if self._is_next(update) else self._handle_restart(update, before)

    def _is_late(self, update):
        """Whether an update is older than the map. A restarted node also counts from 1, but its stamps are later."""
        return ((update.keyframe, update.sequence) <= (self.map.keyframe, self.map.sequence) and
                update.header.stamp <= self.map.stamp)

    def _is_next(self, update):
        return (self._complete and update.keyframe == self.map.keyframe and update.sequence == self.map.sequence + 1 and
                update.step >= self.map.step)

    def _apply_in_order(self, update):
        if self._sender_restarted:
            self._enqueue(update)
            return NOTHING
        if self._is_late(update):
            self.counts.late += 1
            return NOTHING
        held = self.map.keyframe, self.map.sequence
        if update.keyframe > held[0]:
            self._enqueue(update)
            return NOTHING
        if (update.keyframe, update.sequence) <= held:
            return self._handle_restart(update, held)
        if update.sequence != held[1] + 1:
            self._record_gap("%s is missing: update %d arrived instead" % (_name((held[0], held[1] + 1)), update.sequence))
        if not self._complete:
            self.counts.unusable += 1
            return NOTHING
        return self._apply(update)

    def _handle_restart(self, update, before):
        """Handles an update whose number is not above the previous one. A connection preserves the order of its messages,
        so the sender has restarted or replays a recording. If its keyframe arrived before this update and was taken for a
        repetition, the map begins again with that keyframe; so it does if time went back, because updates of the recording's
        turn before had waited for its keyframe. Otherwise its keyframe is missing."""
        self._enqueue(update)
        again = self._repeated
        if again is None and self._time_went_back:
            again = self._base
        if again and again.keyframe == update.keyframe:
            return self._replace_map(again, Rectangle(0, 0, again.width, again.height))
        self._record_gap("%s arrived after %s: the sender has restarted" % (
            _name((update.keyframe, update.sequence)), _name(before)))
        self._sender_restarted = True
        return NOTHING

    def _apply(self, update):
        try:
            check_fit(update, self.map)
        except ValueError as error:
            return self._refuse(error)
        self.map = with_update(self.map, update)
        self._repeated = self._base = None  # it was only a repetition, and what waited belongs to it
        self.counts.updates += 1
        return MapChange(self.map, changed_cells(update))

    def _enqueue(self, update):
        self._queue.append(update)
        self._queued_values += value_count(update)
        while (len(self._queue) > MAX_QUEUED_UPDATES or
               len(self._queue) > 1 and self._queued_values > MAX_QUEUED_VALUES):
            self._drop_oldest_queued()

    def _drop_oldest_queued(self):
        self._queued_values -= value_count(self._queue.popleft())
        self.counts.unusable += 1

    # ---- errors

    def _refuse(self, error):
        """A refused message leaves a gap: the map may lack the changes that it contained."""
        self.counts.refused += 1
        self.counts.last_refusal = str(error)
        self._record_gap("a message was rejected: %s" % error)
        return NOTHING

    def _record_gap(self, why):
        if self.map is None or not self._complete:
            return
        self._complete = False
        self.counts.gaps += 1
        self.counts.last_gap = why


def _name(number):
    return "update %d of keyframe %d" % (number[1], number[0])
