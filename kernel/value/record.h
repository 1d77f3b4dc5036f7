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
  std::vector<std::pair<std::string, std::string>> settings;  ///< every parameter, in canonical text
  std::vector<std::pair<std::string, std::string>> files;     ///< name (no folder) and hash of each file read
  std::vector<std::pair<std::string, std::shared_ptr<const Record>>> inputs;
  std::vector<std::string> warnings;                          ///< what the stage wants its user to know
  std::string key;                                            ///< cache key: hash of all of the above but warnings
  double seconds = 0;                                         ///< wall time of the run that made it
  double peakMegabytes = 0;                                   ///< peak resident memory of the process by then
};

}  // namespace pectora
