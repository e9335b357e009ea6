#pragma once
/// Public header: keyframes and updates of a running node put together, without a subscription.

#include "src/client/layer_assembler.hpp"
