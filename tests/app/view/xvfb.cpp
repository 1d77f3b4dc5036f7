#include "tests/app/view/xvfb.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace pectora::view {

Xvfb::Xvfb(int width, int height) {
  if (std::system("command -v Xvfb > /dev/null && command -v xdotool > /dev/null") != 0) return;
  // Xvfb chooses a free number, and writes it when it is ready.
  int ends[2];
  if (pipe(ends) != 0) return;
  const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24", number = std::to_string(ends[1]);
  process_ = fork();
  if (process_ == 0) {
    close(ends[0]);
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, 1);
    dup2(nowhere, 2);
    execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", screen.c_str(), "-nolisten", "tcp", nullptr);
    _exit(1);
  }
  close(ends[1]);
  std::string told;
  for (char c; read(ends[0], &c, 1) == 1 && c != '\n';) told += c;
  close(ends[0]);
  setenv("DISPLAY", (":" + told).c_str(), 1);
}

Xvfb::~Xvfb() {
  if (process_ <= 0) return;
  unsetenv("DISPLAY");
  kill(process_, SIGTERM);
  waitpid(process_, nullptr, 0);
}

void DisplayHand::act(const std::string& words, const std::function<bool()>& isSeen) {
  if (std::system(("xdotool " + words).c_str()) != 0) throw std::runtime_error("xdotool " + words);
  using Clock = std::chrono::steady_clock;
  for (const auto start = Clock::now(); !isSeen(); step())
    if (Clock::now() - start > std::chrono::minutes(2)) throw std::runtime_error("the window did not see: xdotool " + words);
  frames(2);
}

void DisplayHand::step() {
  target_.wait(0);
  app_.frame();
}

void DisplayHand::moveTo(ImVec2 at) {
  const ImVec2 whole{std::floor(at.x + 0.5f), std::floor(at.y + 0.5f)};
  act("mousemove " + std::to_string(int(whole.x)) + " " + std::to_string(int(whole.y)), [&] {
    const ImVec2 now = ImGui::GetIO().MousePos;
    return now.x == whole.x && now.y == whole.y;
  });
}

void DisplayHand::press(bool isDown) {
  act(isDown ? "mousedown 1" : "mouseup 1", [&] { return ImGui::GetIO().MouseDown[0] == isDown; });
}

void DisplayHand::type(const std::string& text, bool enter) {
  // Keys come in the order in which they were pressed: when the last one is seen, so is the text.
  const ImGuiIO& io = ImGui::GetIO();
  const auto isDown = [&] { return enter ? io.KeysDown[io.KeyMap[ImGuiKey_Enter]] : io.KeyShift; };
  const std::string last = enter ? "Return" : "Shift_L";
  act("type --delay 25 '" + text + "'", [] { return true; });
  act("keydown " + last, isDown);
  act("keyup " + last, [&] { return !isDown(); });
}

void DisplayHand::control(char letter) {
  // One by one: a key that goes down and up between two frames is not seen.
  const ImGuiIO& io = ImGui::GetIO();
  const std::string name(1, letter);
  const int key = keyOf(letter);
  act("keydown Control_L", [&] { return io.KeyCtrl; });
  act("keydown " + name, [&] { return io.KeysDown[key]; });
  act("keyup " + name, [&] { return !io.KeysDown[key]; });
  act("keyup Control_L", [&] { return !io.KeyCtrl; });
}

}  // namespace pectora::view
