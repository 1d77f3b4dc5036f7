// A window of the desktop, by GLFW.
#include "app/view/platform/target.h"

#include "kernel/stage/error.h"

// Before GLFW, which otherwise brings OpenGL's own header.
#include <epoxy/gl.h>
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

namespace pectora::view {
namespace {

class Window final : public Target {
 public:
  Window(int width, int height, float scale) {
    glfwSetErrorCallback([](int, const char* text) { lastError() = text; });
    if (!glfwInit()) throw Error("no display can be opened").given(lastError()).advise("Run it on a desktop, or with DISPLAY set");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    window_ = glfwCreateWindow(width, height, "Pectora", nullptr, nullptr);
    if (!window_) {
      glfwTerminate();
      throw Error("no window with OpenGL 3.3 can be made").given(lastError()).advise("Install a driver or Mesa's software renderer");
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    scale_ = scale > 0 ? scale : std::max(1.f, x);
    glfwSetWindowSizeLimits(window_, int(kLeastWidth * scale_), int(kLeastHeight * scale_), GLFW_DONT_CARE, GLFW_DONT_CARE);
    glfwSetWindowUserPointer(window_, this);
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
      static_cast<Window*>(glfwGetWindowUserPointer(window))->drop({paths, paths + count});
    });
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int modifiers) {
      if (key == GLFW_KEY_Q && action == GLFW_PRESS && (modifiers & GLFW_MOD_CONTROL)) glfwSetWindowShouldClose(window, GLFW_TRUE);
    });
    ImGui_ImplGlfw_InitForOpenGL(window_, true);   // calls the one above, too
    ImGui_ImplOpenGL3_Init("#version 330 core");
    frame_ = std::make_unique<Frame>();
  }
  ~Window() override {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    frame_.reset();
    glfwDestroyWindow(window_);
    glfwTerminate();
  }

  std::pair<int, int> size() const override {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {width, height};
  }
  float scale() const override { return scale_; }
  void begin() override {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
  }
  void end() override {
    const auto [width, height] = size();
    // Into a frame of our own, which can be read whenever a picture is wanted: what a display has shown cannot.
    frame_->resize(width, height, false);
    frame_->bind();
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_->framebuffer());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glfwSwapBuffers(window_);
  }
  bool wait(double seconds) override {
    if (seconds > 0) glfwWaitEventsTimeout(seconds);
    else glfwPollEvents();
    return !glfwWindowShouldClose(window_);
  }

 protected:
  unsigned readFramebuffer() const override { return frame_->framebuffer(); }

 private:
  static std::string& lastError() {
    static std::string text;
    return text;
  }
  GLFWwindow* window_ = nullptr;
  float scale_ = 1;
  std::unique_ptr<Frame> frame_;
};

}  // namespace

std::unique_ptr<Target> makeWindow(int width, int height, float scale) { return std::make_unique<Window>(width, height, scale); }

void wakeWindow() { glfwPostEmptyEvent(); }

}  // namespace pectora::view
