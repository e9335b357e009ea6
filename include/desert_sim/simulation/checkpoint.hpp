#pragma once
/// Public header: saving and loading the state of a simulation.

#include "src/simulation/checkpoint.hpp"
