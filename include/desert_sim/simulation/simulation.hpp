#pragma once
/// Public header: a simulation.

#include "src/simulation/simulation.hpp"
