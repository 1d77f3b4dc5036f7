// Where frames go: a window on a display, or a framebuffer without any.
#pragma once

#include "app/view/render/gpu.h"

#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace pectora::view {

/// A current OpenGL 3.3 context with ImGui's backends. Only one at a time.
class Target {
 public:
  Target();
  virtual ~Target() = default;
  /// Width and height in pixels.
  virtual std::pair<int, int> size() const = 0;
  /// Pixels of one unit of the layout: 1 on plain displays, 2 on fine ones.
  virtual float scale() const = 0;
  /// Begins ImGui's frame; the framebuffer that is shown is bound.
  virtual void begin() = 0;
  /// Draws ImGui's frame, which has been rendered, and shows it.
  virtual void end() = 0;
  /// Waits for something to happen, at most `seconds`. False if the user has closed the window.
  virtual bool wait(double seconds) = 0;
  /// Paths are dropped on the window.
  void drop(std::vector<std::string> paths) { dropped_.insert(dropped_.end(), paths.begin(), paths.end()); }
  /// Paths dropped since the last call.
  std::vector<std::string> takeDropped() { return std::exchange(dropped_, {}); }
  /// Pixels of the last frame, rows from the top, RGBA.
  std::vector<unsigned char> pixels() const;

 protected:
  virtual unsigned readFramebuffer() const = 0;

 private:
  std::vector<std::string> dropped_;
};

/// Windows are no smaller, in units of the layout.
inline constexpr int kLeastWidth = 960, kLeastHeight = 600;
/// Throws Error without a display or OpenGL 3.3. `scale` 0: as the display says.
std::unique_ptr<Target> makeWindow(int width, int height, float scale);
/// EGL without a surface: needs no display. Throws Error if there is no such EGL.
std::unique_ptr<Target> makeOffscreen(int width, int height, float scale);
/// Wakes a window that waits; from any thread.
void wakeWindow();

/// Writes RGBA pixels, rows from the top, as a PNG. Throws Error if that fails.
void writePng(const std::string& path, int width, int height, const std::vector<unsigned char>& rgba);

}  // namespace pectora::view
