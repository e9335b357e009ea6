#pragma once
/// Help with names that are nearly right.

#include <string>

namespace desert_sim {

/// "; did you mean 'width'?" where `given` is a typing error away from one of the names in `known`, which are
/// separated by ", "; else empty. A typing error is up to two letters that are wrong, missing, too many or
/// exchanged (one in short names), or letters in the other case.
std::string did_you_mean(const std::string& given, const std::string& known);

}  // namespace desert_sim
