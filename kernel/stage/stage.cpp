#include "kernel/stage/stage.h"

#include <cstring>
#include <stdexcept>

namespace pectora {

const std::vector<Handle>& Inputs::handles(const char* name) const {
  for (std::size_t i = 0; i < ports_.size(); ++i)
    if (std::strcmp(ports_[i].name, name) == 0) return handles_[i];
  throw std::logic_error(std::string("the stage has no input \"") + name + "\"");
}

void Host::checkCancel() const {
  if (cancelled()) throw Cancelled();
}

}  // namespace pectora
