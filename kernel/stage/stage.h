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
  const char* name = "";            ///< "ct"
  std::vector<const char*> kinds = {};   ///< accepted kinds, e.g. {"Mesh", "Points"}; for an output exactly one
  bool isOptional = false;          ///< inputs only
  bool isList = false;              ///< inputs only: takes any number of values
};

/// A value with its provenance.
struct Handle {
  std::shared_ptr<const Value> value;
  std::shared_ptr<const Record> record;
};

/// The inputs of one run, already checked against the stage's signature.
class Inputs {
 public:
  /// One list of handles for each port, in order; a port that is no list has one handle or none.
  Inputs(const std::vector<Port>& ports, std::vector<std::vector<Handle>> handles)
      : ports_(ports), handles_(std::move(handles)) {}
  /// The input of that name; null if it is optional and absent, or holds another kind than T.
  template <class T>
  std::shared_ptr<const T> get(const char* name) const {
    const std::vector<Handle>& found = handles(name);
    return found.empty() ? nullptr : std::dynamic_pointer_cast<const T>(found.front().value);
  }
  bool has(const char* name) const { return !handles(name).empty(); }
  /// All values of a port, with their records.
  const std::vector<Handle>& handles(const char* name) const;

 private:
  const std::vector<Port>& ports_;
  std::vector<std::vector<Handle>> handles_;
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
