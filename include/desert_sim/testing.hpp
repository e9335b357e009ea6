#pragma once
/// Public header: for tests of programs that drive over a desert, with GoogleTest and rostest.

#include "src/testing/desert.hpp"
