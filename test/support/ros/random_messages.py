"""Random requests and messages: fields by their names, plausible most of the time, and sometimes extreme or wrong."""
import math
import re

import genpy
import roslib.message

EXTREMES = [math.nan, math.inf, -math.inf, 1e300, -1e300, 1e39, 0.0, -1.0, 5e-324, 1e6]
LIMITS = {"int8": (-2**7, 2**7 - 1), "uint8": (0, 2**8 - 1), "int16": (-2**15, 2**15 - 1), "uint16": (0, 2**16 - 1),
          "int32": (-2**31, 2**31 - 1), "uint32": (0, 2**32 - 1), "int64": (-2**63, 2**63 - 1), "uint64": (0, 2**64 - 1)}
WORDS = {
    "layer": ["sand", "soil", "bedrock", "water", "obstacle", "looseness"], "stroke": ["", "a", "b"], "data": ["sand_depth", "no_such_layer"], "layers": ["elevation", "slope", "plants", "moisture", "traversability"],
    "shape": ["circle", "ellipse", "rectangle", "capsule", "polygon", "patch"], "species": ["tree", "bush"],
    "merge": ["add", "sub", "replace", "min", "max", "avg", "smooth"], "image_use": ["", "heights", "mask"],
    "encoding": ["mono8", "mono16", "32FC1"], "sea": ["none", "border", "everywhere"], "format": ["geotiff", "png16", "rosbag"],
    "change": ["rain_rate", "rain_share", "evaporation", "ground_evaporation", "sea", "sea_level", "wave_strength", "springs"],
    "wind_kind": ["timeline", "rose", "constant"], "frame_id": ["", "", "", "map", "map", "rover"], "child_frame_id": ["rover", "map", "other"]}
OPERATIONS = {"EditPlantsRequest": ["plant", "clear"], "EditWindRequest": ["add", "change", "remove", "clear"]}
KINDS = {"EditWindRequest": ["vortex", "jet", "turbulence", "sink"], "SetWindScheduleRequest": ["timeline", "rose"]}
RANGES = {"x": (-6, 40), "y": (4, 40), "z": (0, 0), "position_x": (0, 30), "position_y": (10, 30), "length_x": (1, 6),
          "length_y": (1, 6), "speed": (0, 12), "direction_deg": (-180, 180), "angle_deg": (-180, 180), "inner": (0, 1),
          "density": (0, 0.3), "size": (0.01, 1), "rain_rate": (0, 1e-3), "rain_share": (0, 1), "evaporation": (0, 0.1),
          "ramp": (0, 3), "duration": (3, 20), "discharge": (0, 0.1), "wave_strength": (0, 0.1), "sea_level": (-2, 3),
          "value": (0, 1.5), "image_scale": (0, 2), "smooth_radius": (1, 4), "smooth_passes": (1, 4), "steps": (0, 3),
          "width": (1, 4), "height": (1, 4), "id": (1, 5), "begin": (0, 5), "end": (5, 20), "time": (0, 20), "seed": (0, 99), "w": (1, 1),
          "horizon": (0, 30), "moments": (1, 4), "members": (0, 3), "gust_speed": (0, 1), "gust_direction_deg": (0, 90)}


class RandomMessages:
    def __init__(self, draw):
        self.draw = draw

    def rarely(self):
        return self.draw.random() < 0.01

    def filled(self, message):
        for name, kind in zip(message.__slots__, message._slot_types):
            setattr(message, name, self.value(type(message).__name__.lstrip("_"), name, kind))
        if hasattr(message, "encoding") and not self.rarely():
            self.fit(message)
        if hasattr(message, "path") and not self.rarely():
            self.fit_path(message)
        return message

    def value(self, owner, name, kind):
        array = re.fullmatch(r"(.*)\[(\d*)\]", kind)
        if array:
            if array.group(1) in ("uint8", "int8"):
                return bytes(self.draw.randrange(256) for _ in range(self.draw.randrange(9)))
            count = 600 if self.rarely() else self.draw.choice([0, 1, 2, 2, 3, 4])
            return [self.value(owner, name, array.group(1)) for _ in range(count)]
        if kind == "string":
            return self.word(owner, name)
        if kind == "bool":
            return self.draw.random() < 0.5
        if kind == "time":
            return genpy.Time(self.draw.randrange(2**32)) if self.rarely() else genpy.Time()
        if kind.startswith("float"):
            return self.number(name, kind)
        if kind in LIMITS:
            return self.integer(name, kind)
        return self.filled(roslib.message.get_message_class(kind)())

    def number(self, name, kind):
        if self.rarely():
            extreme = self.draw.choice(EXTREMES)
            return extreme if kind == "float64" or not math.isfinite(extreme) or abs(extreme) < 1e38 else 1e38
        return self.draw.uniform(*RANGES.get(name, (0.1, 5)))

    def integer(self, name, kind):
        lowest, highest = LIMITS[kind]
        if self.rarely():
            return self.draw.choice([lowest, highest]) if name != "steps" else 0
        return int(min(max(round(self.draw.uniform(*RANGES.get(name, (0, 3)))), lowest), highest))

    def word(self, owner, name):
        if self.rarely():
            return self.draw.choice(["", "x", "\n", "a: [", "x" * 3000, "nowhere"])
        words = {"operation": OPERATIONS, "kind": KINDS}.get(name, {}).get(owner) or WORDS.get(name) or ["x"]
        return self.draw.choice(words)

    def fit_path(self, request):
        """Leaves a request for a feature of the wind either its path or its place."""
        if len(request.path) < 2 or self.draw.random() < 0.5:
            request.path = []
            return
        request.center, request.velocity = type(request.center)(), type(request.velocity)()
        request.path.sort(key=lambda point: point.time)

    def fit(self, image):
        """Makes step and data of an image fit its size."""
        bytes_per_pixel = {"mono8": 1, "mono16": 2}.get(image.encoding, 4)
        image.step = min(image.width * bytes_per_pixel, 2**32 - 1)
        if image.step * image.height < 10000:
            image.data = bytes(self.draw.randrange(60) for _ in range(image.step * image.height))
