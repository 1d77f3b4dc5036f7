#include "kernel/stage/error.h"

namespace pectora {

Error::Error(std::string message, ErrorKind kind) : kind_(kind), message_(std::move(message)) { compose(); }

Error& Error::inStage(std::string stage) {
  if (stage_.empty()) stage_ = std::move(stage), compose();
  return *this;
}
Error& Error::inScript(std::string line) {
  if (script_.empty()) script_ = std::move(line), compose();
  return *this;
}
Error& Error::of(std::string parameter) { return parameter_ = std::move(parameter), compose(), *this; }
Error& Error::given(std::string value) { return given_ = std::move(value), compose(), *this; }
Error& Error::allowed(std::string what) { return allowed_ = std::move(what), compose(), *this; }
Error& Error::at(std::string where) { return where_ = std::move(where), compose(), *this; }
Error& Error::advise(std::string advice) { return advice_ = std::move(advice), compose(), *this; }

// "correction.lua:31: loader.dicom: path: the folder is empty (given "x"; allowed: y; at z). Do this."
void Error::compose() {
  text_.clear();
  if (!script_.empty()) text_ += script_ + ": ";
  if (!stage_.empty()) text_ += stage_ + ": ";
  if (!parameter_.empty()) text_ += parameter_ + ": ";
  text_ += message_;
  std::string details;
  const auto add = [&](const char* label, const std::string& value) {
    if (!value.empty()) details += (details.empty() ? " (" : "; ") + std::string(label) + value;
  };
  add("given: ", given_);
  add("allowed: ", allowed_);
  add("at: ", where_);
  if (!details.empty()) text_ += details + ")";
  if (!advice_.empty()) text_ += ". " + advice_;
}

}  // namespace pectora
