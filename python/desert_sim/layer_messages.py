"""Keyframes and updates of a layer, whichever messages bring them: ElevationGrid and ElevationUpdate, or LayerGrid and
LayerUpdate. The messages may come from rospy as they are, or from rospy.numpy_msg, which is much faster."""
import dataclasses
import math

import numpy

from .layer_map import NO_CELLS, LayerMap, Rectangle


# What a desert can have, as its node does: what draws or measures a map can count on it.
LARGEST_VALUE = 1e7  # of any layer, in its unit
SMALLEST_CELL, LARGEST_CELL, LARGEST_ORIGIN = 0.999e-3, 1.001e4, 1.001e8  # [m]
LARGEST_RESOLUTION = 1e4


def layer_of(message):
    """Name of the message's layer; messages of the elevation do not say it."""
    return getattr(message, "layer", "elevation")


def map_of(keyframe):
    """The LayerMap of a keyframe. Raises ValueError with what is wrong with it."""
    where = "keyframe %d: " % keyframe.keyframe
    data = keyframe.data if hasattr(keyframe, "layer") else keyframe.elevation
    values = numpy.array(data, numpy.float32)
    if keyframe.width == 0 or keyframe.height == 0 or values.size != keyframe.width * keyframe.height:
        raise ValueError(where + "%d values for %d x %d cells" % (values.size, keyframe.width, keyframe.height))
    if not SMALLEST_CELL <= keyframe.cell_size <= LARGEST_CELL:
        raise ValueError(where + "cell_size is %g: must be 0.001 to 1e+04 m" % keyframe.cell_size)
    position, turn = keyframe.origin.position, keyframe.origin.orientation
    if not (abs(position.x) <= LARGEST_ORIGIN and abs(position.y) <= LARGEST_ORIGIN and position.z == 0):
        raise ValueError(where + "origin is (%g, %g, %g): must be within 1e+08 m with z = 0" % (
            position.x, position.y, position.z))
    if (turn.x, turn.y, turn.z, turn.w) != (0, 0, 0, 1):
        raise ValueError(where + "origin's orientation is (%g, %g, %g, %g): must be identity (0, 0, 0, 1)" % (
            turn.x, turn.y, turn.z, turn.w))
    if not math.isfinite(keyframe.sim_time):
        raise ValueError(where + "sim_time is not finite")
    _check_values(values, where)
    values = values.reshape(keyframe.height, keyframe.width)
    values.setflags(write=False)
    return LayerMap(layer_of(keyframe), getattr(keyframe, "unit", "m"), keyframe.header.frame_id, keyframe.header.stamp,
                    keyframe.step, keyframe.sim_time, keyframe.cell_size, position.x, position.y, values, keyframe.keyframe)


def check_update(update):
    """Raises ValueError with what is wrong with an update, whatever map it is for."""
    where = _place(update)
    if update.sequence == 0:
        raise ValueError(where + "sequence counts from 1")
    if not math.isfinite(update.sim_time):
        raise ValueError(where + "sim_time is not finite")
    for n, tile in enumerate(update.tiles):
        _check_tile(tile, where + "tile %d: " % n)


def check_fit(update, held):
    """Raises ValueError with why an update cannot be applied to this map."""
    where = _place(update)
    if layer_of(update) != held.layer:
        raise ValueError(where + "its layer is '%s', that of the keyframe '%s'" % (layer_of(update), held.layer))
    if update.header.frame_id != held.frame:
        raise ValueError(where + "its frame is '%s', that of the keyframe '%s'" % (update.header.frame_id, held.frame))
    for n, tile in enumerate(update.tiles):
        right, top = tile.x + tile.width, tile.y + tile.height
        if right > held.width or top > held.height:
            raise ValueError(where + "tile %d reaches to cell (%d, %d) of a grid of %d x %d" % (
                n, right, top, held.width, held.height))


def with_update(held, update):
    """The map after an update that check_update() and check_fit() find nothing wrong with."""
    values = held.values
    if update.tiles:
        values = values.copy()
        for tile in update.tiles:
            _write_tile(tile, values)
        values.setflags(write=False)
    return dataclasses.replace(held, values=values, stamp=update.header.stamp, step=update.step, sim_time=update.sim_time,
                               sequence=update.sequence)


def changed_cells(update):
    """The smallest rectangle that contains all tiles of an update."""
    cells = NO_CELLS
    for tile in update.tiles:
        cells = cells.union(Rectangle(tile.x, tile.y, tile.width, tile.height))
    return cells


def differing_cells(after, before):
    """The smallest rectangle that contains all cells in which two arrays differ; NaN equals NaN."""
    different = (after != before) & ~(numpy.isnan(after) & numpy.isnan(before))
    rows, columns = numpy.flatnonzero(different.any(1)), numpy.flatnonzero(different.any(0))
    if not rows.size:
        return NO_CELLS
    return Rectangle(int(columns[0]), int(rows[0]), int(columns[-1] - columns[0]) + 1, int(rows[-1] - rows[0]) + 1)


def value_count(update):
    """Number of values that the tiles of an update have."""
    return sum(len(tile.data) + len(tile.changes) * (2 if tile.bits == 4 else 1) for tile in update.tiles)


# ---- tiles: msg/LayerTile.msg describes their format

def _mask(tile):
    """Which cells of the tile changed: bool [height, width]; None if all did."""
    if not len(tile.changed):
        return None
    bits = numpy.unpackbits(numpy.frombuffer(bytes(tile.changed), numpy.uint8))
    return bits[:tile.width * tile.height].astype(bool).reshape(tile.height, tile.width)


def _steps(tile, count):
    """The first `count` changes of a tile, unpacked."""
    packed = numpy.asarray(tile.changes, numpy.int8)
    if tile.bits == 8:
        return packed[:count]
    return numpy.stack((packed >> 4, (packed << 4) >> 4), 1).reshape(-1)[:count]


def _write_tile(tile, values):
    cells = values[tile.y:tile.y + tile.height, tile.x:tile.x + tile.width]
    mask = _mask(tile)
    chosen = cells.reshape(-1) if mask is None else cells[mask]
    if len(tile.changes):
        # In float64, as the node computes what its subscribers have.
        resolution = float(numpy.float32(tile.resolution))
        new = (chosen.astype(float) + _steps(tile, chosen.size) * resolution).astype(numpy.float32)
    else:
        new = numpy.asarray(tile.data, numpy.float32)
    if mask is None:
        cells[...] = new.reshape(cells.shape)
    else:
        cells[mask] = new


def _check_tile(tile, where):
    changes, data, cells = len(tile.changes), len(tile.data), tile.width * tile.height
    size = "%d x %d cells" % (tile.width, tile.height)
    if changes and data:
        raise ValueError(where + "has changes and absolute values")
    if changes and tile.bits not in (4, 8):
        raise ValueError(where + "has changes of %d bits: must be 8 or 4" % tile.bits)
    selected = cells
    if len(tile.changed):
        if len(tile.changed) != (cells + 7) // 8:
            raise ValueError(where + "%d bytes of mask for %s" % (len(tile.changed), size))
        bits = numpy.unpackbits(numpy.frombuffer(bytes(tile.changed), numpy.uint8))
        if bits[cells:].any():
            raise ValueError(where + "bit %d of its mask is set, and it has %s" % (cells + bits[cells:].argmax(), size))
        selected = int(bits.sum())
        size = "%d cells that changed" % selected
    values = data + changes
    if changes and tile.bits == 4:
        values = selected if changes == (selected + 1) // 2 else 2 * changes
    if values != selected or values == 0:
        raise ValueError(where + "%d values for %s" % (values, size))
    if changes and not 0 < tile.resolution <= LARGEST_RESOLUTION:
        raise ValueError(where + "resolution is %g: must be above 0, up to 1e+04" % tile.resolution)
    _check_values(numpy.asarray(tile.data, numpy.float32), where)


def _check_values(values, where):
    """Values that no desert has are refused; NaN means unknown."""
    extreme = numpy.abs(values) > LARGEST_VALUE
    if extreme.any():
        at = int(extreme.argmax())
        raise ValueError(where + "value %d is %g: must be within 1e+07, or NaN if unknown" % (at, values.flat[at]))


def _place(update):
    return "update %d of keyframe %d: " % (update.sequence, update.keyframe)
