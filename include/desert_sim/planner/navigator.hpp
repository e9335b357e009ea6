#pragma once
/// Public header: paths of rovers over living terrain.

#include "src/planner/navigator.hpp"
