#pragma once
/// Public header: the elevation of a running node, kept up to date in another program.

#include "src/client/terrain_client.hpp"
