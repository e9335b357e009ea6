#pragma once
/// Public header: the elevation at one moment.

#include "src/client/elevation_map.hpp"
