// The window's work as a script, a console beside it, and what leaves the window as files.
#pragma once

#include "app/view/context.h"

#include <imgui.h>

namespace pectora::view {

class ScriptPanel {
 public:
  /// The left column: files that can be written.
  void controls(Context& context);
  void draw(Context& context, float width, float height);

 private:
  void console(Context& context, float height);
  static int editLine(ImGuiInputTextCallbackData* data);
  std::string line_;
  std::vector<std::string> entered_;
  int recalled_ = -1;             // index into entered_, -1: a new line
  std::size_t shownLines_ = 0;
  bool wantsFocus_ = false;
};

}  // namespace pectora::view
