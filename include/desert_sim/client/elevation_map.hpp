#pragma once
/// Public header: the elevation at one moment.

#include "src/client/layer_map.hpp"
