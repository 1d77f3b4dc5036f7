// A list of named figures, where a stage's result is nothing else.
#pragma once

#include "kernel/value/value.h"

namespace pectora {

struct Figures : Value {
  static constexpr const char* kName = "Figures";
  std::vector<Fact> list;

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override { return list; }
};

}  // namespace pectora
