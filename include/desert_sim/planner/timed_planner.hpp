#pragma once
/// Public header: paths of rovers over living terrain.

#include "src/planner/timed_planner.hpp"
