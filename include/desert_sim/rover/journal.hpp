#pragma once
/// Public header: what a rover was told, and its repetition.

#include "src/rover/journal.hpp"
