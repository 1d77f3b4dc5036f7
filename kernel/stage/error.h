// The one error that users can cause, and the cancel signal.
#pragma once

#include <exception>
#include <string>

namespace pectora {

enum class ErrorKind {
  badInput,   ///< a setting, file or script is wrong: exit code 2
  runFailed,  ///< the input was right but no trustworthy result came out: exit code 1
};

/// Something that the user can mend. The message says what was wrong; the rest says where and what to do.
/// Build it with the fluent setters: throw Error("the slice is truncated").at(file).advise("copy it again").
class Error : public std::exception {
 public:
  explicit Error(std::string message, ErrorKind kind = ErrorKind::badInput);

  Error& inStage(std::string stage);          ///< "loader.dicom"; only the first one given is kept
  Error& of(std::string parameter);           ///< the parameter at fault
  Error& given(std::string value);            ///< what was given
  Error& allowed(std::string what);           ///< what would have been right
  Error& at(std::string where);               ///< a file name, or script line
  Error& inScript(std::string line);          ///< "correction.lua:31"; only the first one given is kept
  Error& advise(std::string advice);          ///< what to do next

  ErrorKind kind() const { return kind_; }
  const std::string& stage() const { return stage_; }
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  void compose();
  ErrorKind kind_;
  std::string message_, stage_, parameter_, given_, allowed_, where_, script_, advice_, text_;
};

/// Thrown by Host::checkCancel; never an error.
struct Cancelled : std::exception {
  const char* what() const noexcept override { return "cancelled"; }
};

}  // namespace pectora
