#include "src/core/descriptor.hpp"

#include <unistd.h>

#include <utility>

namespace desert_sim {

Descriptor::~Descriptor() { close(); }

void Descriptor::reset(int number) {
  close();
  number_ = number;
}

bool Descriptor::close() { return number_ < 0 || ::close(std::exchange(number_, -1)) == 0; }

}  // namespace desert_sim
