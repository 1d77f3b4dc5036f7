// What the program offers to a running stage.
#pragma once

#include <string>

namespace pectora {

struct NodeVectors;

class Host {
 public:
  virtual ~Host() = default;
  /// Fraction done, 0 to 1, and what is being done. Cheap enough to call a thousand times a second.
  virtual void progress(double fraction, const std::string& what) = 0;
  virtual bool cancelled() const = 0;
  /// Something that the user must know about the result: printed, and kept in its record.
  virtual void warn(const std::string& message) = 0;
  /// A detail for the log.
  virtual void info(const std::string& message) = 0;
  /// A solver shows where its nodes are on the way, finite and every 100 ms of work or more often: a window draws them.
  virtual void preview(const NodeVectors& /*positions*/) {}
  /// The folder in which the running plugin's file lies (for helper programs beside it).
  virtual std::string pluginFolder() const = 0;

  /// Throws Cancelled if the user asked to stop. Call it at least every 100 ms of work.
  void checkCancel() const;
};

}  // namespace pectora
