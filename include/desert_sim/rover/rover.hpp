#pragma once
/// Public header: a rover on living ground.

#include "src/rover/rover.hpp"
