"""The desert of a running desert_sim node, for other programs.

TerrainClient    the live terrain as numpy arrays: keyframes and updates put together, from any thread
LayerMap         one layer at one moment, as TerrainClient and Simulation.submap() return it
Simulation       the node's services as functions: step, pause, edit, set_wind, query, submap, forecast, ...
Rover            a rover of desert_rover_node: drive, pose, status
SimulationError  what is raised when a node refuses a request or does not answer, with the reason
testing          start a paused desert for a test, step, expect (import desert_sim.testing)

Units are SI, angles radians except where a name ends in _deg; x is east, y north, z up. Arrays of cells are
[height, width] with row 0 in the south, so that values[row, column] is the cell whose centre is at
(origin_x + (column + 1/2) * cell_size, origin_y + (row + 1/2) * cell_size). Unknown values are NaN.
"""
import importlib

# Loaded when they are used: who imports only desert_sim.msg does not wait for rospy and OpenCV.
_HOMES = {
    "Forecast": "forecast", "LAYERS": "layer_map", "LayerMap": "layer_map", "Rover": "rover",
    "Simulation": "simulation", "SimulationError": "services", "TerrainClient": "terrain_client",
}
__all__ = sorted(_HOMES)


def __getattr__(name):
    if name not in _HOMES:
        raise AttributeError("module 'desert_sim' has no attribute '%s'" % name)
    return getattr(importlib.import_module("desert_sim." + _HOMES[name]), name)


def __dir__():
    return sorted(list(globals()) + __all__)
