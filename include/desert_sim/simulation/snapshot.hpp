#pragma once
/// Public header: layers at one moment, on the host.

#include "src/simulation/views/snapshot.hpp"
