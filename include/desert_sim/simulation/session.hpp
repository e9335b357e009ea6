#pragma once
/// Public header: a simulation with its backend, its journal and its checkpoints.

#include "src/simulation/session.hpp"
