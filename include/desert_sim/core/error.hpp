#pragma once
/// Public header: the exceptions that the libraries throw.

#include "src/core/error.hpp"
