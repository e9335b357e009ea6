"""The services of a desert_sim node as functions."""
import dataclasses

import numpy
import rospy
from dynamic_reconfigure.srv import Reconfigure
from geometry_msgs.msg import Point, Vector3
from std_srvs.srv import Trigger

from .did_you_mean import not_one_of
from .forecast import request_forecast
from .layer_map import LayerMap
from .live_parameters import config_of, parameters_of
from .msg import SimulationStatus, WaterSpring, WindFeaturePoint, WindScheduleSegment
from .services import SimulationError, call
from .srv import (ApplySettings, EditPlants, EditPlantsRequest, EditTerrain, EditTerrainRequest, EditWind,
                  EditWindRequest, ExportTerrain, GetScenario, GetSubmap, GetSubmapRequest, LoadCheckpoint, LoadScenario,
                  LoadTerrain, NewScenario, QueryTerrain, QueryTerrainRequest, SaveCheckpoint, SaveScenario, SaveTerrain,
                  SetWeather, SetWeatherRequest, SetWind, SetWindRequest, SetWindSchedule, Step, Undo)


@dataclasses.dataclass(frozen=True)
class Samples:
    """The terrain at n points: arrays [n], in the order of the points. Off the grid all but x and y are NaN."""
    step: int
    sim_time: float            # the desert's own time [s]
    in_bounds: numpy.ndarray   # bool
    x: numpy.ndarray           # of the points in the terrain's frame [m]
    y: numpy.ndarray
    elevation: numpy.ndarray   # of the solid surface [m]
    normal: numpy.ndarray      # [n, 3], upward unit normal
    slope: numpy.ndarray       # angle to the horizontal [rad]
    sand: numpy.ndarray        # depth [m]
    soil: numpy.ndarray        # depth below the sand [m]
    water: numpy.ndarray       # depth [m]
    moisture: numpy.ndarray    # water in the ground, as a depth [m]
    vegetation: numpy.ndarray  # density of plants, 0 ... 1
    bedrock: numpy.ndarray     # elevation of the rock [m]
    wind: numpy.ndarray        # [n, 2], at the surface, to where the air moves [m/s]


def _point(place):
    """A Point of (x, y), (x, y, z), or a Point."""
    return place if hasattr(place, "x") else Point(*place, *[0.0] * (3 - len(place)))


def _brush(request, frame, fields):
    """A request for a shape: `center` and `points` may be tuples (x, y) or (x, y, z) [m], `velocity` (x, y) [m/s],
    and each point of `path` (time, x, y) [s, m]."""
    for name, value in fields.items():
        if name not in request.__slots__:
            raise TypeError(not_one_of(name, request.__slots__))
        if name == "center":
            value = _point(value)
        if name == "points":
            value = [_point(place) for place in value]
        if name == "velocity" and not hasattr(value, "x"):
            value = Vector3(value[0], value[1], 0.0)
        if name == "path":
            value = [place if hasattr(place, "x") else WindFeaturePoint(*place) for place in value]
        setattr(request, name, value)
    request.header.frame_id = frame
    return request


class Simulation:
    """Calls of a running node.

        desert = desert_sim.Simulation()
        desert.pause()
        desert.edit("sand", "circle", "add", 1.5, center=(40, 64), radius=4)
        print(desert.step(10).state_hash)

    Each call waits for the node's answer, and raises SimulationError with the node's reason if the request is refused, which
    then has changed nothing, or if the node is not there. Answers are those of the services (rossrv show desert_sim/Step),
    where nothing else is said. Commands act between two steps. Coordinates are in the terrain's frame [m] unless `frame`
    names another one that tf knows.

    node      name of the simulation's node
    timeout   seconds of wall time to wait for the node to come up
    """

    def __init__(self, node="desert_sim", timeout=20.0):
        self.node, self.timeout = rospy.resolve_name(node), timeout

    def call(self, service, kind, *arguments, **fields):
        """The answer of any service of the node, such as call("step", desert_sim.srv.Step, steps=3)."""
        return call(self.node + "/" + service, kind, self.timeout, *arguments, **fields)

    def status(self):
        """The present SimulationStatus: state, step, rates, volumes. While paused, state_hash is filled."""
        topic = self.node + "/status"
        try:
            return rospy.wait_for_message(topic, SimulationStatus, self.timeout)
        except rospy.ROSException as error:
            raise SimulationError(topic, "no status within %g s: does the node run?" % self.timeout) from error

    # ---- time

    def step(self, steps=1):
        """Makes exactly so many steps, paused or not, and answers when their state is published: step, sim_time [s],
        state_hash. 0 only reads the present state."""
        return self.call("step", Step, steps)

    def pause(self):
        """Pauses between two steps; step() still works."""
        return self.call("pause", Trigger)

    def resume(self):
        return self.call("resume", Trigger)

    def reset(self):
        """Back to the start of the scenario."""
        return self.call("reset", Trigger)

    # ---- edits

    def edit(self, layer, shape, merge, value=0.0, frame="", **fields):
        """A brush on the ground; srv/EditTerrain.srv has all its fields.

        layer    sand, bedrock, soil, water, moisture, airborne_sand, obstacle, vegetation, erosion_resistance, humus, grass,
                 mesquite, shrub, snow_density, looseness
        shape    circle, ellipse, rectangle, capsule, polygon, patch
        merge    add, sub, replace, min, max, avg, smooth
        value    [m], or a value of the layer that is no material, 0 ... 1 of most
        fields   center=(x, y) [m], radius, radius_y [m], angle_deg, points=[(x, y), ...] [m], inner (fraction of the shape
                 with full weight, 0 ... 1), falloff [m], conserve, ring_width [m], stroke, image, image_file, ...
        Answers with the volume added [m^3] and the cells that may have changed (x, y, width, height).
        """
        request = EditTerrainRequest(layer=layer, shape=shape, merge=merge, value=value)
        return self.call("edit_terrain", EditTerrain, _brush(request, frame, fields))

    def edit_plants(self, operation, shape, frame="", **fields):
        """Adds (`plant`) or removes (`clear`) plants of a region; fields: species, center, radius, points, density [1/m^2],
        size (0.001 ... 1), seed, ... as in srv/EditPlants.srv. Answers with the number of plants."""
        request = EditPlantsRequest(operation=operation, shape=shape)
        return self.call("edit_plants", EditPlants, _brush(request, frame, fields))

    def undo(self, stroke=""):
        """Takes back the newest stroke of edits and settings, or that of this name; where none is left, the last reset or load."""
        return self.call("undo", Undo, stroke)

    def redo(self, stroke=""):
        """Takes back an undo."""
        return self.call("redo", Undo, stroke)

    # ---- wind and weather

    def set_wind(self, speed=0.0, direction_deg=0.0, ramp=0.0, vector=None, stroke=""):
        """A constant wind high above the ground, from now on.

        speed           [m/s]
        direction_deg   to where the air moves, counter-clockwise from +x
        ramp            time of the change [s of simulated time]
        vector          (x, y) [m/s] in place of speed and direction
        stroke          calls of one name are undone together
        """
        request = SetWindRequest(speed=speed, direction_deg=direction_deg, ramp=ramp, stroke=stroke)
        if vector is not None:
            request.use_vector, request.vector = True, Vector3(vector[0], vector[1], 0.0)
        return self.call("set_wind", SetWind, request)

    def set_wind_schedule(self, segments, kind="timeline", repeat=False, hold_time=0.0, seed=0, stroke=""):
        """A timeline of winds, or (kind="rose") a wind rose.

        segments   dicts of direction_deg, speed [m/s], duration, ramp [s of simulated time] (timeline), probability (rose)
        hold_time  of a rose: time between draws [s of simulated time]
        """
        segments = [WindScheduleSegment(**segment) for segment in segments]
        return self.call("set_wind_schedule", SetWindSchedule, kind, segments, repeat, hold_time, seed, stroke)

    def edit_wind(self, operation, frame="", **fields):
        """Adds, changes, removes or clears local features of the wind; fields as in srv/EditWind.srv: id, kind, center, radius,
        speed, ..."""
        return self.call("edit_wind", EditWind, _brush(EditWindRequest(operation=operation), frame, fields))

    def set_weather(self, ramp=0.0, stroke="", **fields):
        """Rain, evaporation, springs, sea and waves from now on: the fields that are named change, and no others.

        fields   rain_rate [m/s], rain_share, evaporation [1/s], ground_evaporation, sea (none, border, everywhere), sea_level
                 [m], wave_strength [1/s], wave_period [s], springs (dicts of x, y, radius [m], discharge [m^3/s])
        ramp     time over which numbers change [s of simulated time]
        """
        if "springs" in fields:
            fields["springs"] = [WaterSpring(**spring) for spring in fields["springs"]]
        return self.call("set_weather", SetWeather, SetWeatherRequest(change=list(fields), ramp=ramp, stroke=stroke, **fields))

    def set_parameters(self, parameters):
        """Live parameters of the scenario and of topics, whole or not at all: {"saltation.lift": 0.3, "step_rate": 20}.
        config/parameters.md lists them. Answers with all present values, by the same names."""
        return parameters_of(self.call("set_parameters", Reconfigure, config_of(parameters)).config)

    # ---- looking

    def query(self, points, frame=""):
        """Samples of the terrain at points.

        points   [n, 2] or [n, 3] numbers [m]; z is used only in the transform from `frame`
        A point off the grid is not refused: its in_bounds is false.
        """
        request = QueryTerrainRequest(points=[_point(tuple(map(float, place))) for place in points])
        request.header.frame_id = frame
        answer = self.call("query_terrain", QueryTerrain, request)
        columns = {name: numpy.array([getattr(sample, name) for sample in answer.samples], float)
                   for name in ("elevation", "slope", "sand", "soil", "water", "moisture", "vegetation", "bedrock")}
        return Samples(
            step=answer.step, sim_time=answer.sim_time, in_bounds=numpy.array([s.in_bounds for s in answer.samples], bool),
            x=numpy.array([s.position.x for s in answer.samples], float),
            y=numpy.array([s.position.y for s in answer.samples], float),
            normal=numpy.array([(s.normal.x, s.normal.y, s.normal.z) for s in answer.samples], float).reshape(-1, 3),
            wind=numpy.array([(s.wind.x, s.wind.y) for s in answer.samples], float).reshape(-1, 2), **columns)

    def submap(self, center, length, layers=(), frame=""):
        """Layers in a rectangle of cells, whole cells exactly as the node has them: {name: LayerMap}.

        center   (x, y) of the rectangle [m]
        length   (along x, along y) [m], rounded to whole cells; refused where it reaches beyond the terrain
        layers   names of desert_sim.LAYERS; none: all
        """
        request = GetSubmapRequest(center=_point(center), length_x=length[0], length_y=length[1], layers=list(layers))
        request.header.frame_id = frame
        found = self.call("get_submap", GetSubmap, request).map
        maps = {}
        for layer in found.layers:
            values = numpy.array(layer.data, numpy.float32).reshape(found.height, found.width)
            values.setflags(write=False)
            maps[layer.name] = LayerMap(layer.name, layer.unit, found.header.frame_id, found.header.stamp, found.step,
                                        found.sim_time, found.cell_size, found.origin.position.x, found.origin.position.y,
                                        values)
        return maps

    def apply_settings(self, settings, ramp=0.0, stroke=""):
        """Parameters and lists that can change while it runs: ("saltation.lift=0.4", "species.0.max_radius=2")."""
        return self.call("apply_settings", ApplySettings, list(settings), ramp, stroke)

    def get_scenario(self, start=False):
        """The scenario as it is now, or at its start, with all parameters: .name and .yaml."""
        return self.call("get_scenario", GetScenario, start)

    # ---- files: names are paths below the node's ~data_dir

    def save_checkpoint(self, name):
        """Every bit of the state; answers with path, step, state_hash."""
        return self.call("save_checkpoint", SaveCheckpoint, name)

    def load_checkpoint(self, name):
        """Continues from a checkpoint."""
        return self.call("load_checkpoint", LoadCheckpoint, name)

    def save_terrain(self, name, format="geotiff"):
        """The terrain as a folder of files: geotiff, png16, or rosbag."""
        return self.call("save_terrain", SaveTerrain, name, format)

    def export_terrain(self, name):
        """The terrain for other programs, by the ending of the name (.obj, .glb, .world ...); answers with path, files, step."""
        return self.call("export_terrain", ExportTerrain, name)

    def load_terrain(self, name, fill_nodata=False):
        """The terrain of such a folder, or of a bag with a GridMap, under the present physics."""
        return self.call("load_terrain", LoadTerrain, name, fill_nodata)

    def load_scenario(self, name, settings=()):
        """Another scenario: one of config/scenarios by its name, such as "barchan", a YAML file, or a saved folder.

        settings  override its keys: ("grid.width=512", "seed=7")
        """
        return self.call("load_scenario", LoadScenario, name, list(settings))

    def new_scenario(self, yaml, settings=(), name=""):
        """A scenario by its text; files that it names are below ~data_dir."""
        return self.call("new_scenario", NewScenario, yaml, list(settings), name)

    def save_scenario(self, name):
        """The scenario as it is, with all of its state, as a folder that load_scenario goes on from, exactly."""
        return self.call("save_scenario", SaveScenario, name)

    # ---- what will be

    def forecast(self, horizon, moments=1, timeout=None, on_progress=None, **fields):
        """What the terrain will be like, as a Forecast: runs ahead on a copy, while the live run goes on.

        horizon      how far ahead [s of ROS time]
        moments      how many states to tell, evenly spaced, the last at the horizon
        timeout      seconds of wall time to wait for it; None: as long as it takes. A forecast that is late is cancelled
        on_progress  None, or a function that is called with the share that is done, 0 ... 1
        fields       wind=[segments as in set_wind_schedule()], wind_kind (constant, timeline, rose), wind_repeat,
                     wind_hold_time, wind_seed; parameters={"rain.rate": ...}; stride, for fewer and longer steps; members,
                     gust_speed, gust_direction_deg, gust_time, seed, for an ensemble: action/ForecastTerrain.action says what
                     they mean
        """
        if "parameters" in fields:
            fields["parameters"] = config_of(fields["parameters"])
        if "wind" in fields:
            fields["wind"] = [WindScheduleSegment(**segment) for segment in fields["wind"]]
        return request_forecast(self.node + "/forecast", self.timeout, timeout, on_progress, horizon=horizon,
                                moments=moments, **fields)
