"""Pictures of a terrain with what drives on it. Needs OpenCV."""
import math

import cv2
import numpy

WHITE, BLUE, GREEN, RED = (255, 255, 255), (255, 120, 30), (80, 220, 80), (40, 40, 230)  # blue, green, red

_ROCK, _WATER = (112.0, 118.0, 124.0), (200.0, 120.0, 40.0)
_WET = 0.02  # depth of water that is seen [m]
_LONG_SIDE = 800  # [pixels], at least
_LINE_HEIGHT = 26  # [pixels] of the text below a framed picture


def hillshade(ground, azimuth_deg=315.0, altitude_deg=30.0, bare=None):
    """Shaded terrain, north up: sand tint by height, lit from the north-west.

    ground   LayerMap of the elevation; unknown cells are drawn at the lowest known height
    bare     None, or bool [height, width] from the south: cells without sand, which are drawn as rock
    Returns uint8 [height, width, 3], blue, green, red.
    """
    z = ground.values[::-1]
    z = numpy.nan_to_num(z, nan=numpy.nanmin(z) if numpy.isfinite(z).any() else 0.0)
    dz_dx = numpy.gradient(z, ground.cell_size, axis=1) if z.shape[1] > 1 else numpy.zeros_like(z)
    dz_dy = -numpy.gradient(z, ground.cell_size, axis=0) if z.shape[0] > 1 else numpy.zeros_like(z)  # rows run south
    azimuth, altitude = numpy.radians([90.0 - azimuth_deg, altitude_deg])
    light = numpy.array([numpy.cos(azimuth) * numpy.cos(altitude), numpy.sin(azimuth) * numpy.cos(altitude),
                         numpy.sin(altitude)])
    shade = (-dz_dx * light[0] - dz_dy * light[1] + light[2]) / numpy.sqrt(dz_dx**2 + dz_dy**2 + 1.0)
    height = (z - z.min()) / max(float(numpy.ptp(z)), 1e-6)
    low, high = numpy.array([92.0, 142.0, 190.0]), numpy.array([170.0, 214.0, 244.0])
    colour = low + (high - low) * height[..., None]
    if bare is not None:
        colour[bare[::-1]] = _ROCK
    return numpy.clip(colour * (0.25 + 0.95 * numpy.clip(shade, 0.0, 1.0))[..., None], 0, 255).astype(numpy.uint8)


class Picture:
    """A hillshade on which paths, a rover and text can be drawn; coordinates are those of the terrain [m].

    ground   LayerMap of the elevation
    costs    None, or int8 [height, width] as LayerMap.cost(): lethal cells are tinted red
    bare     as of hillshade()
    water    None, or depth of water [m], float [height, width]; it is blue, lethal or not
    """

    def __init__(self, ground, costs=None, bare=None, water=None):
        self._ground = ground
        image = hillshade(ground, bare=bare)
        depth = numpy.zeros(image.shape[:2]) if water is None else numpy.nan_to_num(water[::-1])
        if costs is not None:
            lethal = (costs[::-1] >= 100) & (depth < _WET)
            image[lethal] = (0.6 * image[lethal] + 0.4 * numpy.array([40, 40, 220])).astype(numpy.uint8)
        share = numpy.where(depth < _WET, 0.0, numpy.clip(0.4 + depth, 0.0, 0.9))[..., None]
        image = (image + share * (numpy.array(_WATER) - image)).astype(numpy.uint8)
        self._scale = max(1, -(-_LONG_SIDE // max(image.shape[:2])))
        self.image = cv2.resize(image, None, fx=self._scale, fy=self._scale, interpolation=cv2.INTER_NEAREST)

    def _pixel(self, x, y):
        m = self._ground
        east, north = (x - m.origin_x) / m.cell_size, (y - m.origin_y) / m.cell_size
        return int(round(east * self._scale)), int(round((m.height - north) * self._scale))

    def line(self, points, colour, thickness=2):
        """A path through points [(x, y), ...]; colour: (blue, green, red)."""
        if len(points) > 1:
            pixels = numpy.array([self._pixel(x, y) for x, y in points], numpy.int32)
            cv2.polylines(self.image, [pixels], False, colour, thickness, cv2.LINE_AA)

    def cross(self, x, y, colour):
        cv2.drawMarker(self.image, self._pixel(x, y), colour, cv2.MARKER_TILTED_CROSS, 16, 3)

    def arrow(self, x, y, yaw, colour, length=24):
        """A rover: its place, and its heading [rad]."""
        column, row = self._pixel(x, y)
        tip = (int(column + length * math.cos(yaw)), int(row - length * math.sin(yaw)))
        cv2.circle(self.image, (column, row), 6, colour, -1, cv2.LINE_AA)
        cv2.arrowedLine(self.image, (column, row), tip, colour, 3, cv2.LINE_AA, tipLength=0.4)

    def text(self, lines):
        """Lines of text at the upper left."""
        for n, line in enumerate(lines):
            for colour, thickness in (((30, 30, 30), 3), ((255, 255, 255), 1)):
                cv2.putText(self.image, line, (8, 20 + 20 * n), cv2.FONT_HERSHEY_SIMPLEX, 0.5, colour, thickness, cv2.LINE_AA)

    def framed(self, size, legend, lines):
        """The picture as large as it fits, and below it a legend and lines of text.

        size     (width, height) [pixels]
        legend   [(text, colour), ...]
        Returns uint8 [height, width, 3], blue, green, red.
        """
        width, height = size
        bar = _LINE_HEIGHT * (len(lines) + 1) + 8
        scale = min(width / self.image.shape[1], (height - bar) / self.image.shape[0])
        picture = cv2.resize(self.image, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_CUBIC)
        frame = numpy.full((height, width, 3), 30, numpy.uint8)
        left = (width - picture.shape[1]) // 2
        frame[:picture.shape[0], left:left + picture.shape[1]] = picture
        top = height - bar + _LINE_HEIGHT - 4
        column = 12
        for text, colour in legend:
            cv2.rectangle(frame, (column, top - 12), (column + 22, top), colour, -1)
            _write(frame, text, column + 30, top)
            column += 60 + cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, 0.55, 1)[0][0]
        for n, line in enumerate(lines):
            _write(frame, line, 12, top + _LINE_HEIGHT * (n + 1))
        return frame

    def write(self, path):
        """Writes a file by the ending of its name. Raises OSError if that fails."""
        write_image(path, self.image)


def write_image(path, image):
    """Writes a file by the ending of its name. Raises OSError if that fails."""
    if not cv2.imwrite(path, image):
        raise OSError("the picture %s cannot be written" % path)


def _write(image, text, column, row):
    cv2.putText(image, text, (column, row), cv2.FONT_HERSHEY_SIMPLEX, 0.55, WHITE, 1, cv2.LINE_AA)
