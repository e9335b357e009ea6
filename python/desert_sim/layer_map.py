"""One layer of the terrain at one moment."""
import collections
import dataclasses

import numpy
import rospy

# The layers that every node of this version has; config/node_parameters.md says what they are, and in which unit. A
# layer that the terrain does not have is 0 everywhere.
# <!-- table: map layers -->
LAYERS = (
    "elevation", "bedrock", "water_surface", "sand_depth", "water_depth", "soil_depth", "vegetation", "plants",
    "canopy_height", "illumination", "humus", "moisture", "suspended_sediment", "airborne_sand", "water_velocity_x",
    "water_velocity_y", "erosion_resistance", "obstacle", "looseness", "grass", "mesquite", "shrub", "burial",
    "snow_density", "wind_x", "wind_y", "wind_shadow", "echo", "flux_x", "flux_y", "slope", "roughness", "step_height",
    "slip", "slip_downhill", "slip_across", "sinkage", "traversability", "normal_x", "normal_y", "normal_z",
)
# <!-- end of table -->


class Rectangle(collections.namedtuple("Rectangle", "x y width height")):
    """Cells x ... x + width - 1, y ... y + height - 1; (0, 0) is the south-west cell of the grid."""
    __slots__ = ()

    @property
    def empty(self):
        return self.width == 0 or self.height == 0

    @property
    def slices(self):
        """Index of these cells in an array [height, width]: values[rectangle.slices]."""
        return slice(self.y, self.y + self.height), slice(self.x, self.x + self.width)

    def union(self, other):
        """The smallest rectangle that contains both."""
        if self.empty or other.empty:
            return other if self.empty else self
        x, y = min(self.x, other.x), min(self.y, other.y)
        return Rectangle(x, y, max(self.x + self.width, other.x + other.width) - x,
                         max(self.y + self.height, other.y + other.height) - y)


NO_CELLS = Rectangle(0, 0, 0, 0)


@dataclasses.dataclass(frozen=True, eq=False)
class LayerMap:
    """All cells of a layer at one moment. It never changes, so that several queries on it agree.

    Points (x, y) are in `frame` [m]; each of the two may be a number or an array, and results have their shape (that of
    both broadcast together). A query off the grid or of unknown cells gives NaN.
    """
    layer: str          # name: elevation, sand_depth, traversability, ...
    unit: str           # of the values: m, m/s, rad; 1 for a number without a unit
    frame: str          # name of the frame: x east, y north, z up
    stamp: rospy.Time   # ROS time at which this state was reached
    step: int           # steps since the scenario's start
    sim_time: float     # the desert's own time at this step [s]
    cell_size: float    # [m]
    origin_x: float     # lower left corner of the south-west cell [m]
    origin_y: float     # [m]
    values: numpy.ndarray  # float32 [height, width], row 0 in the south; read-only
    keyframe: int = 0   # number of the keyframe on which the map is built
    sequence: int = 0   # of the last update in the map; 0: none

    @property
    def width(self):
        """Cells from west to east."""
        return self.values.shape[1]

    @property
    def height(self):
        """Cells from south to north."""
        return self.values.shape[0]

    @property
    def extent(self):
        """(west, east, south, north) edges of the grid [m], as matplotlib's imshow(origin="lower") takes them."""
        return (self.origin_x, self.origin_x + self.width * self.cell_size,
                self.origin_y, self.origin_y + self.height * self.cell_size)

    def same_geometry(self, other):
        """Whether both have the same frame, size, origin and cell size, so that a cell covers the same ground."""
        return ((self.frame, self.cell_size, self.origin_x, self.origin_y, self.values.shape) ==
                (other.frame, other.cell_size, other.origin_x, other.origin_y, other.values.shape))

    # ---- cells and points

    def contains(self, x, y):
        """Whether the point lies on the grid, its outer edges included."""
        east, north = self._in_cells(x, y)
        return ((east >= 0) & (east <= self.width) & (north >= 0) & (north <= self.height))[()]

    def world_to_cell(self, x, y):
        """(column, row) of the cell in which the point lies, as integers; the cell's value is values[row, column].

        Raises IndexError for a point off the grid: contains() tells beforehand.
        """
        inside = self.contains(x, y)
        if not numpy.all(inside):
            raise IndexError("the point (%s, %s) is off the grid, which is from (%s, %s) to (%s, %s) m in %s" % (
                x, y, *self.extent[0::2], *self.extent[1::2], self.frame))
        east, north = self._in_cells(x, y)
        # The outer edges belong to the last cells.
        return (numpy.minimum(east.astype(int), self.width - 1)[()], numpy.minimum(north.astype(int), self.height - 1)[()])

    def cell_to_world(self, column, row):
        """(x, y) of a cell's centre [m]."""
        return (self.origin_x + (numpy.asarray(column) + 0.5) * self.cell_size,
                self.origin_y + (numpy.asarray(row) + 0.5) * self.cell_size)

    # ---- queries

    def value(self, x, y):
        """Value at a point: bilinear between the centres of cells, constant beyond the outermost ones."""
        z00, z10, z01, z11, fx, fy = self._cells_around(x, y)
        weighted = (((1 - fx) * (1 - fy), z00), (fx * (1 - fy), z10), ((1 - fx) * fy, z01), (fx * fy, z11))
        # A cell of weight 0 may be unknown.
        return sum(numpy.where(weight == 0, 0.0, weight * z) for weight, z in weighted)[()]

    def cell_value(self, x, y):
        """Value of the cell in which a point lies, for layers whose values are no quantities (the species of `plants`), or
        must not be blended (a traversability of 0)."""
        inside = self.contains(x, y)
        east, north = self._in_cells(x, y)
        column, row = (numpy.where(inside, numpy.minimum(n, limit - 1), 0).astype(int)
                       for n, limit in ((east, self.width), (north, self.height)))
        return numpy.where(inside, self.values[row, column].astype(float), numpy.nan)[()]

    def normal(self, x, y):
        """Upward unit normal of the surface that value() describes, for layers in metres: [..., 3]."""
        dz_dx, dz_dy = self._gradient(x, y)
        length = numpy.sqrt(1 + dz_dx ** 2 + dz_dy ** 2)
        return numpy.stack((-dz_dx / length, -dz_dy / length, 1 / length), -1)

    def slope(self, x, y):
        """Angle of that surface to the horizontal, 0 ... pi/2 [rad]."""
        return numpy.arctan(numpy.hypot(*self._gradient(x, y)))[()]

    def cost(self):
        """Cost of each cell as in ~costmap, of the layer traversability: int8 [height, width]; 0 ... 99, 100 lethal (no
        way), -1 unknown. kernels/view/held_costs.hpp has the formula. Raises ValueError for another layer."""
        if self.layer != "traversability":
            raise ValueError("cost() is for the layer traversability; this is %s" % self.layer)
        t = self.values
        costs = numpy.floor(numpy.float32(99) * (1 - numpy.clip(numpy.nan_to_num(t), 0, 1)) + numpy.float32(0.5))
        return numpy.where(numpy.isnan(t), -1, numpy.where(t <= 0, 100, costs)).astype(numpy.int8)

    # ---- in cells

    def _in_cells(self, x, y):
        """The point in cells from the south-west corner."""
        x, y = numpy.broadcast_arrays(numpy.asarray(x, float), numpy.asarray(y, float))
        return (x - self.origin_x) / self.cell_size, (y - self.origin_y) / self.cell_size

    def _cells_around(self, x, y):
        """Values of the four cells around a point, and its position between their centres, 0 ... 1; NaN off the grid."""
        inside = self.contains(x, y)
        east, north = self._in_cells(x, y)
        x0, x1, fx = _between(numpy.where(inside, east, 0), self.width)
        y0, y1, fy = _between(numpy.where(inside, north, 0), self.height)
        corners = [self.values[row, column].astype(float) for row, column in ((y0, x0), (y0, x1), (y1, x0), (y1, x1))]
        return (*[numpy.where(inside, z, numpy.nan) for z in corners], fx, fy)

    def _gradient(self, x, y):
        z00, z10, z01, z11, fx, fy = self._cells_around(x, y)
        return (((z10 - z00) * (1 - fy) + (z11 - z01) * fy) / self.cell_size,
                ((z01 - z00) * (1 - fx) + (z11 - z10) * fx) / self.cell_size)


def _between(cells, n):
    """The two cells of a row of n between whose centres a position lies, and where between them."""
    centre = numpy.clip(cells - 0.5, 0, n - 1)
    first = numpy.minimum(centre.astype(int), max(n - 2, 0))
    return first, numpy.minimum(first + 1, n - 1), centre - first
