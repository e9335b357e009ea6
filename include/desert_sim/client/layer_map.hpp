#pragma once
/// Public header: the map of a layer at one moment.

#include "src/client/layer_map.hpp"
