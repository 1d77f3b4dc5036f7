// A hand that works the window by script: it moves the mouse to items by their names and presses keys.
#pragma once

#include "app/view/app.h"

#include <imgui.h>

namespace pectora::view {

/// Feeds ImGui's input of an offscreen target; every action draws the frames that it takes. A hand of a real window overrides what
/// the display's own mouse and keyboard do.
class Hand {
 public:
  explicit Hand(App& app) : app_(app) {}
  virtual ~Hand() = default;

  /// Draws frames until the worker rests and nothing more is due, at most `seconds`; false if that was too short.
  bool rest(double seconds = 120);
  void frames(int count);
  bool sees(const std::string& name) const;
  /// The middle of an item, or a place within it in parts of its size. Throws std::runtime_error if the last frame did not show it.
  ImVec2 place(const std::string& name, float x = 0.5f, float y = 0.5f) const;
  void click(const std::string& name, float x = 0.5f, float y = 0.5f);
  /// Presses at one place of an item, moves in steps to another, and lets go.
  void drag(const std::string& name, ImVec2 from, ImVec2 to, int steps = 12);
  virtual void type(const std::string& text, bool enter);
  /// A letter with Ctrl: "z".
  virtual void control(char letter);

 protected:
  /// One frame.
  virtual void step() { app_.frame(); }
  virtual void moveTo(ImVec2 at);
  virtual void press(bool isDown);
  /// The index of a letter's key in ImGui's KeysDown.
  static int keyOf(char letter);
  App& app_;
};

}  // namespace pectora::view
