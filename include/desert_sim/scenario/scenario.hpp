#pragma once
/// Public header: all that defines a run, and reading it from YAML.

#include "src/scenario/scenario.hpp"
