#include "app/view/hand.h"

#include "app/view/panels/widgets.h"

#include <chrono>
#include <map>
#include <stdexcept>
#include <thread>

namespace pectora::view {

bool Hand::rest(double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  int quiet = 0;
  // The worker may be between two pieces of work: it rests when it does for a while.
  while (quiet < 3) {
    step();
    const bool isBusy = app_.context().activity.isBusy;
    quiet = isBusy || app_.wantsFrame() ? 0 : quiet + 1;
    // Drawn in software, frames would take the time of the work.
    std::this_thread::sleep_for(std::chrono::milliseconds(isBusy ? 50 : 10));
    if (std::chrono::duration<double>(Clock::now() - start).count() > seconds) return false;
  }
  return true;
}

void Hand::frames(int count) {
  for (int i = 0; i < count; ++i) step();
}

bool Hand::sees(const std::string& name) const { return markedItems().contains(name); }

ImVec2 Hand::place(const std::string& name, float x, float y) const {
  const auto found = markedItems().find(name);
  if (found == markedItems().end()) throw std::runtime_error("the window does not show \"" + name + "\"");
  const ImVec4 r = found->second;
  return {r.x + x * r.z, r.y + y * r.w};
}

void Hand::click(const std::string& name, float x, float y) {
  moveTo(place(name, x, y));
  press(true);
  press(false);
}

void Hand::drag(const std::string& name, ImVec2 from, ImVec2 to, int steps) {
  const ImVec2 a = place(name, from.x, from.y), b = place(name, to.x, to.y);
  moveTo(a);
  press(true);
  for (int i = 1; i <= steps; ++i) {
    const float t = float(i) / float(steps);
    moveTo({a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t});
  }
  press(false);
}

void Hand::type(const std::string& text, bool enter) {
  ImGuiIO& io = ImGui::GetIO();
  for (char c : text) io.AddInputCharacter(static_cast<unsigned char>(c));
  step();
  if (!enter) return;
  io.KeysDown[io.KeyMap[ImGuiKey_Enter]] = true;
  step();
  io.KeysDown[io.KeyMap[ImGuiKey_Enter]] = false;
  step();
}

int Hand::keyOf(char letter) {
  // The letters that ImGui knows.
  static const std::map<char, ImGuiKey> keys{{'a', ImGuiKey_A}, {'c', ImGuiKey_C}, {'v', ImGuiKey_V}, {'x', ImGuiKey_X}, {'y', ImGuiKey_Y}, {'z', ImGuiKey_Z}};
  return ImGui::GetIO().KeyMap[keys.at(letter)];
}

void Hand::control(char letter) {
  ImGuiIO& io = ImGui::GetIO();
  const int key = keyOf(letter);
  io.KeyCtrl = true;
  io.KeysDown[key] = true;
  step();
  io.KeyCtrl = false;
  io.KeysDown[key] = false;
  step();
}

void Hand::moveTo(ImVec2 at) {
  ImGui::GetIO().MousePos = at;
  frames(2);
}

void Hand::press(bool isDown) {
  ImGui::GetIO().MouseDown[0] = isDown;
  frames(2);
}

}  // namespace pectora::view
