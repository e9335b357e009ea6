"""The live terrain of a desert_sim node."""
import dataclasses
import threading
import time

import numpy
import rosgraph
import rospy
from rospy.numpy_msg import numpy_msg
from std_msgs.msg import Empty, String

from .did_you_mean import not_one_of
from .layer_assembler import EXPECTED, LOST, NONE, NOTHING, RESTARTED, Counts, LayerAssembler
from .layer_map import LAYERS
from .msg import ElevationGrid, ElevationUpdate, LayerGrid, LayerUpdate
from .waiting_notice import WaitingNotice, waiting_text

_POLL_PERIOD = 0.1  # [s], how often a client checks whether it needs a keyframe
_LARGEST_MESSAGE = 1 << 28  # [bytes], the buffer of a connection; rospy's usual one holds messages back


class KeyframeRequests:
    """Decides when to request a keyframe: immediately after a loss, then with exponential backoff while requests do not
    help for long. `shortest`, `longest`: pause between requests [s]. An expected keyframe is requested only after twice
    the present pause, because the transfer of a large one takes time."""

    def __init__(self, shortest, longest):
        self._shortest, self._longest, self._pause = shortest, longest, shortest
        self._last_request = self._since = 0.0
        self._stable = True  # no request yet, or no need for longer than a pause since the last one
        self._need = NONE

    def due(self, need, now):
        """Whether to send a request at `now` [s]; if so, it counts as sent."""
        if need != self._need:
            self._need, self._since = need, now
        if need == NONE:
            if now - self._since > self._pause:
                self._stable, self._pause = True, self._shortest
            return False
        # The transfer of a large keyframe takes time, and a new subscription would lose one that is on its way.
        if need != LOST and now - self._since < 2 * self._pause:
            return False
        if not self._stable and now - self._last_request < self._pause:
            return False
        self._pause = self._shortest if self._stable else min(2 * self._pause, self._longest)
        self._stable, self._last_request = False, now
        return True


@dataclasses.dataclass
class Statistics(Counts):
    """Counts of one layer since it was subscribed to, and the way of its updates."""
    requests: int = 0  # for keyframes
    # From the stamp of a state to the map that contains it [s of ROS time]: of the last update, and the largest.
    latency: float = 0.0
    largest_latency: float = 0.0


class _Stream:
    """One layer of a client: its subscriptions, the map that they make, and requests for keyframes."""

    def __init__(self, client, layer, options):
        folder = "/".join((client.node, "layers"))
        self._client, self._layer = client, layer
        self._elevation = layer == "elevation"
        self._topic = client.node + "/elevation" if self._elevation else folder + "/" + layer
        self._assembler, self._requests = LayerAssembler(), KeyframeRequests(options["shortest"], options["longest"])
        self.map, self.need, self.statistics, self.closed = None, EXPECTED, Statistics(), False  # by the client's lock
        self._by_message = False  # whether the last request was
        self._request_publisher = rospy.Publisher(
            client.node + "/request_keyframe" if self._elevation else folder + "/request_keyframe",
            Empty if self._elevation else String, queue_size=10)
        self._keyframes = self._subscribe_to_keyframes()
        self._updates = rospy.Subscriber(
            self._topic + "_updates", numpy_msg(ElevationUpdate if self._elevation else LayerUpdate),
            lambda update: self._process(self._assembler.take_update, update, update.header.stamp),
            queue_size=options["queue"], buff_size=_LARGEST_MESSAGE, tcp_nodelay=True)

    def _subscribe_to_keyframes(self):
        return rospy.Subscriber(
            self._topic, numpy_msg(ElevationGrid if self._elevation else LayerGrid),
            lambda keyframe: self._process(self._assembler.take_keyframe, keyframe, None),
            queue_size=1, buff_size=_LARGEST_MESSAGE, tcp_nodelay=True)

    def _process(self, take, message, stamp):
        client = self._client
        with client._processing:
            change = take(message)
            told = self._publish(change, stamp)
            if told and client.on_change:
                client.on_change(change)

    def _publish(self, change, stamp):
        """Lets queries see a change; whether on_change is to be told of it."""
        with self._client._changed:
            if self.closed:
                return False
            statistics, counts = self.statistics, self._assembler.counts
            refused, gap = counts.refused != statistics.refused, counts.gaps != statistics.gaps
            for field in dataclasses.fields(counts):
                setattr(statistics, field.name, getattr(counts, field.name))
            if change.map and stamp:
                statistics.latency = (rospy.Time.now() - stamp).to_sec()
                statistics.largest_latency = max(statistics.largest_latency, statistics.latency)
            self.map, self.need = change.map or self.map, self._assembler.need()
            self._client._changed.notify_all()
        if refused:
            rospy.logwarn_throttle(5, "The terrain client rejected a message of the layer %s: %s" % (
                self._layer, counts.last_refusal))
        if gap:
            rospy.logwarn_throttle(5, "The terrain client needs a new keyframe of the layer %s: %s" % (
                self._layer, counts.last_gap))
        return change.map is not None and (change.replaced or not change.cells.empty or self._client.tell_each_step)

    def request_keyframe_if_due(self):
        if not self._client._processing.acquire(blocking=False):
            return  # a message is being processed, which may be the keyframe
        try:
            # Without a publisher there is nobody to ask, and a new publisher sends a keyframe anyway.
            if self.connected and self._requests.due(self._assembler.need(), time.monotonic()):
                self._assembler.keyframe_overdue()
                self._publish(NOTHING, None)
                self._request_keyframe()
        finally:
            self._client._processing.release()

    def _request_keyframe(self):
        """By a message and by a new subscription in turn: rospy makes no new connection while another subscriber in the
        process uses the same topic, and a bag that is played takes no requests. Where nobody listens to requests, the
        next one has a chance."""
        with self._client._changed:
            by_message = self._request_publisher.get_num_connections() > 0 and not self._by_message
            self._by_message = by_message  # what comes next is the other
            self.statistics.requests += 1
        if by_message:
            self._request_publisher.publish(*([] if self._elevation else [self._layer]))
        elif rosgraph.is_master_online():  # subscribing without a master would block
            if self._request_publisher.get_num_connections() == 0:
                self._announce_requests()
            self._keyframes.unregister()
            self._keyframes = self._subscribe_to_keyframes()

    def _announce_requests(self):
        """Makes the master tell the node anew who publishes requests. A node connects once when it is told so; if that
        fails, because publishers of this process had just come and gone, it is not told again by itself."""
        topic = self._request_publisher.resolved_name
        try:
            rosgraph.Master(rospy.get_name()).registerPublisher(topic, self._request_publisher.type, rospy.get_node_uri())
        except (rosgraph.MasterError, OSError) as fault:
            rospy.logwarn_throttle(5, "The terrain client cannot tell the master that it publishes %s: %s" % (topic, fault))

    @property
    def connected(self):
        impl = self._keyframes.impl  # None once it is unregistered
        return impl is not None and impl.get_num_connections() > 0

    @property
    def awaited(self):
        """The topic of keyframes, and whether it has a publisher."""
        return self._topic, self.connected

    def close(self):
        """By a thread that holds the client's `_processing`."""
        with self._client._changed:
            self.closed = True
        for end in (self._updates, self._keyframes, self._request_publisher):
            end.unregister()


class TerrainClient:
    """Keeps the surface of a running node, and layers that it is told to subscribe to, up to date.

        rospy.init_node("my_planner")
        terrain = desert_sim.TerrainClient(layers=["elevation", "traversability"])
        if not terrain.wait_for_terrain(10): ...          # wall seconds
        z = terrain.elevation(12, 34)                     # [m]; NaN off the grid or if unknown
        ground = terrain["traversability"]                # a LayerMap: all cells of one moment, which never change
        ground.values[row, column]                        # float32 [height, width], row 0 in the south

    Maps are put together from keyframes and updates; messages that are lost are noticed, and a keyframe is requested; until
    it comes, the last valid map stays. All methods may be called from any thread. A map is a copy for each update that
    changes something: on grids of millions of cells subscribe to the layers that you need only.

    node              name of the simulation's node, whose namespace has the topics
    layers            names of layers, some of desert_sim.LAYERS
    on_change         None, or a function that is called with a MapChange (map, cells, replaced) after each change of cells
                      of any layer: in order, never concurrently, on a thread of rospy. It may use the client, but must not
                      close it.
    tell_each_step    whether on_change is also called when a message says that a map is still valid at a later step
    update_queue      updates that may wait to be processed; more are lost, which is noticed
    shortest_pause, longest_pause   [s] between requests for a keyframe while they do not help; it doubles in between
    Raises ValueError for options that are not valid. rospy.init_node() has to come before.
    """

    def __init__(self, node="desert_sim", layers=("elevation",), on_change=None, tell_each_step=False, update_queue=200,
                 shortest_pause=0.5, longest_pause=10.0):
        if update_queue < 1:
            raise ValueError("TerrainClient: update_queue is %s (allowed: at least 1)" % update_queue)
        if not 0 < shortest_pause <= longest_pause <= 3600:
            raise ValueError("TerrainClient: shortest_pause and longest_pause are %s and %s s (allowed: 0 < shortest_pause "
                             "<= longest_pause <= 3600 s)" % (shortest_pause, longest_pause))
        if isinstance(layers, str):
            raise ValueError("TerrainClient: layers is the text '%s' (allowed: a list of names)" % layers)
        layers = tuple(layers)
        for layer in layers:
            _check_layer(layer)
        self.node = rospy.resolve_name(node)
        self.on_change, self.tell_each_step = on_change, tell_each_step
        self._processing = threading.RLock()   # held while a message is processed; queries do not wait for it
        self._changed = threading.Condition()  # guards what queries see; held only briefly
        self._options = {"queue": update_queue, "shortest": shortest_pause, "longest": longest_pause}
        self._streams = {}
        for layer in layers:
            self.subscribe_layer(layer)
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._watch, name="terrain_client", daemon=True)
        self._thread.start()

    # ---- queries

    @property
    def map(self):
        """The newest LayerMap of the elevation; None before the first keyframe."""
        return self.layer_map("elevation")

    def layer_map(self, layer):
        """The newest LayerMap of a layer; None before its first keyframe, and if the layer is not subscribed to.

        Raises ValueError for a name that is not known."""
        _check_layer(layer)
        with self._changed:
            return self._streams[layer].map if layer in self._streams else None

    def __getitem__(self, layer):
        """The newest LayerMap of a layer. Raises KeyError while there is none."""
        found = self.layer_map(layer)
        if found is None:
            raise KeyError("there is no map of the layer %s yet" % layer)
        return found

    def elevation(self, x, y):
        """Elevation [m] at points of the terrain's frame [m], as LayerMap.value(): NaN off the grid, where it is unknown,
        and before there is a map. Numbers or arrays."""
        return self.value("elevation", x, y)

    def value(self, layer, x, y):
        """The same of any layer, in its unit."""
        found = self.layer_map(layer)
        return found.value(x, y) if found else numpy.full(numpy.broadcast(x, y).shape, numpy.nan)[()]

    def normal(self, x, y):
        """Upward unit normal of the surface, [..., 3]. Raises KeyError while there is no map."""
        return self["elevation"].normal(x, y)

    def slope(self, x, y):
        """Angle of the surface to the horizontal [rad]. Raises KeyError while there is no map."""
        return self["elevation"].slope(x, y)

    # ---- state

    @property
    def layers(self):
        """Names of the layers that are subscribed to."""
        with self._changed:
            return sorted(self._streams)

    @property
    def up_to_date(self):
        """Whether no message is known to be missing: false before the first keyframes, and from a gap to the next
        keyframe."""
        return self._all(lambda stream: stream.map is not None and stream.need not in (LOST, RESTARTED))

    @property
    def connected(self):
        """Whether keyframes of all layers have a publisher."""
        with self._changed:
            streams = list(self._streams.values())
        return all(stream.connected for stream in streams)

    def statistics(self, layer="elevation"):
        """Statistics of a layer: numbers of keyframes, updates, gaps, refused messages, requests; reasons; latency. All 0 if
        it is not subscribed to."""
        _check_layer(layer)
        with self._changed:
            return dataclasses.replace(self._streams[layer].statistics) if layer in self._streams else Statistics()

    def wait_for_terrain(self, timeout):
        """Waits until each layer has a map, at most `timeout` seconds of wall time; whether they have. Not in on_change."""
        return self._wait(lambda stream: stream.map is not None, timeout)

    def wait_for_step(self, step, timeout):
        """Waits in the same way for maps of this step or a later one."""
        return self._wait(lambda stream: stream.map is not None and stream.map.step >= step, timeout)

    # ---- subscriptions

    def subscribe_layer(self, layer):
        """Subscribes to a layer; nothing happens if it is subscribed to already. Its map comes later."""
        _check_layer(layer)
        with self._processing:
            if layer in self._streams:
                return
            stream = _Stream(self, layer, self._options)
            with self._changed:
                self._streams[layer] = stream

    def unsubscribe_layer(self, layer):
        """Gives a layer up; nothing happens if it is not subscribed to. Maps that somebody has stay valid."""
        _check_layer(layer)
        with self._processing:
            with self._changed:
                stream = self._streams.pop(layer, None)
            if stream:
                stream.close()

    def close(self):
        """Unsubscribes from all. Maps that somebody has stay valid."""
        self._closing.set()
        self._thread.join()
        for layer in self.layers:
            self.unsubscribe_layer(layer)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _all(self, condition):
        with self._changed:
            return all(condition(stream) for stream in self._streams.values())

    def _wait(self, condition, timeout):
        end = time.monotonic() + timeout
        with self._changed:
            while not all(condition(stream) for stream in self._streams.values()):
                left = end - time.monotonic()
                if left <= 0 or rospy.is_shutdown():
                    return False
                self._changed.wait(min(left, _POLL_PERIOD))
            return True

    def _watch(self):
        notice = WaitingNotice()
        while not self._closing.wait(_POLL_PERIOD) and not rospy.is_shutdown():
            with self._changed:
                streams = list(self._streams.values())
            for stream in streams:
                stream.request_keyframe_if_due()
            awaited = [stream.awaited for stream in streams if stream.map is None]
            if notice.due(bool(awaited), time.monotonic()):
                _tell_what_is_awaited(awaited)


def _tell_what_is_awaited(awaited):
    try:
        topics = rospy.get_published_topics()
    except (rospy.ROSException, OSError):  # there is no master
        topics = []
    published = [name for name, kind in topics if kind in (ElevationGrid._type, LayerGrid._type)]
    rospy.logwarn("%s", waiting_text(awaited, published))


def _check_layer(name):
    if name not in LAYERS:
        raise ValueError("TerrainClient: layer " + not_one_of(name, LAYERS))
