#pragma once
/// Public header: what changes a running simulation from outside.

#include "src/simulation/commands/command.hpp"
