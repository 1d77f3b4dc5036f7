// The interface of a stage plugin: typed values in, typed values out.
#pragma once

#include "kernel/stage/error.h"
#include "kernel/stage/host.h"
#include "kernel/stage/parameters.h"
#include "kernel/value/record.h"
#include "kernel/value/value.h"

#include <memory>
#include <string>
#include <vector>

namespace pectora {

/// One input or output of a stage.
struct Port {
  const char* name;                 ///< "ct"
  std::vector<const char*> kinds;   ///< accepted kinds, e.g. {"Mesh", "Points"}; for an output exactly one
  bool isOptional = false;          ///< inputs only
};

/// A value with its provenance.
struct Handle {
  std::shared_ptr<const Value> value;
  std::shared_ptr<const Record> record;
};

/// The inputs of one run, already checked against the stage's signature.
class Inputs {
 public:
  Inputs(const std::vector<Port>& ports, std::vector<Handle> handles)
      : ports_(ports), handles_(std::move(handles)) {}
  /// The input of that name; never null for a required one.
  template <class T>
  std::shared_ptr<const T> get(const char* name) const {
    return std::dynamic_pointer_cast<const T>(handle(name).value);
  }
  bool has(const char* name) const { return handle(name).value != nullptr; }
  const Handle& handle(const char* name) const;

 private:
  const std::vector<Port>& ports_;
  std::vector<Handle> handles_;
};

using Outputs = std::vector<std::shared_ptr<const Value>>;

/// A stage with its settings. One object serves one run.
class Stage {
 public:
  virtual ~Stage() = default;
  /// Visits every setting. The same order every time.
  virtual void describe(Visitor& visitor) = 0;
  /// Does the work. Returns one value for each output port. Throws Error or Cancelled; writes nothing half.
  virtual Outputs run(const Inputs& inputs, Host& host) = 0;
};

}  // namespace pectora
