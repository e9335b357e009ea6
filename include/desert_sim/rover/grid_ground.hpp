#pragma once
/// Public header: ground for rovers from arrays.

#include "src/rover/grid_ground.hpp"
