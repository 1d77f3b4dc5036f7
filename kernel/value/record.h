// Where a value came from: the stage that made it, its settings and its inputs.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pectora {

struct Record {
  std::string stage;                                          ///< "segmenter.thorax"
  std::string version;
  /// Every parameter in canonical text. A path that is read appears as the hash of its bytes, a path that is written
  /// not at all: paths may hold a patient's name.
  std::vector<std::pair<std::string, std::string>> settings;
  std::vector<std::pair<std::string, std::shared_ptr<const Record>>> inputs;
  std::vector<std::string> warnings;                          ///< what the stage wants its user to know
  std::string key;                                            ///< cache key: hash of the stage, its plugin's file, settings and inputs' keys
  double seconds = 0;                                         ///< wall time of the run that made it
  double cpuSeconds = 0;                                      ///< of all threads
  double prepareSeconds = 0;                                  ///< of `seconds`, what a solver took before it solved: terms, coarse grids, factors
  double heldMegabytes = 0;                                   ///< heap that a solver, its system and its result held at the end; 0 for other stages
  double peakMegabytes = 0;                                   ///< peak resident memory of the process by then
};

}  // namespace pectora
