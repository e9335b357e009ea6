#pragma once
/// Public header: ground for rovers from a simulation in the same program.

#include "src/rover/simulated_ground.hpp"
