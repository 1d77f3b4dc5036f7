// A display of a test's own, and a hand that works the real mouse and keyboard on it.
#pragma once

#include "app/view/hand.h"

#include <sys/types.h>

#include <functional>

namespace pectora::view {

/// Starts Xvfb on a free display and sets DISPLAY to it; ends it. One at a time.
class Xvfb {
 public:
  Xvfb(int width, int height);
  ~Xvfb();
  /// False if Xvfb or xdotool is not installed.
  bool isThere() const { return process_ > 0; }

 private:
  pid_t process_ = 0;
};

/// Moves the pointer, presses its button and types by xdotool: what the window sees comes from the X server. Each deed is done when the
/// window has seen it, however long that takes a busy machine.
class DisplayHand final : public Hand {
 public:
  DisplayHand(App& app, Target& target) : Hand(app), target_(target) {}
  void type(const std::string& text, bool enter) override;
  void control(char letter) override;

 protected:
  void step() override;
  void moveTo(ImVec2 at) override;
  void press(bool isDown) override;

 private:
  void act(const std::string& words, const std::function<bool()>& isSeen);
  Target& target_;
};

}  // namespace pectora::view
