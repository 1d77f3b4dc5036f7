// What plugins there are and what can be set, for the window's own thread.
#pragma once

#include "kernel/host/runner.h"

#include <map>

namespace pectora::view {

class Catalog {
 public:
  explicit Catalog(Registry& registry);
  /// Ids "stage.name" of one stage, sorted.
  std::vector<std::string> ids(const std::string& stage) const;
  /// Every parameter with its default; read once. None if the plugin cannot be opened.
  const std::vector<Parameter>& parameters(const std::string& id);
  /// The value of a number among a plugin's settings, or its default; 0 if it has no such parameter.
  double number(const std::string& id, const Settings& settings, const std::string& name);
  /// Whether it has an input of that name. False if the plugin cannot be opened.
  bool takes(const std::string& id, const std::string& input);
  /// The one-line summary.
  std::string summary(const std::string& id);

 private:
  Registry& registry_;
  Messages silent_;
  std::atomic<bool> cancel_{false};
  Runner runner_{registry_, silent_, cancel_};
  std::map<std::string, std::vector<Parameter>> known_;
};

}  // namespace pectora::view
