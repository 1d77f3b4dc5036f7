// A framebuffer without a display, by EGL: for tests, benchmarks and pictures.
#include "app/view/platform/target.h"

#include "kernel/stage/error.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <imgui.h>
#include <backends/imgui_impl_opengl3.h>

#include <chrono>
#include <thread>

namespace pectora::view {
namespace {

class Offscreen final : public Target {
 public:
  Offscreen(int width, int height, float scale) : width_(width), height_(height), scale_(scale > 0 ? scale : 1) {
    display_ = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    EGLint major = 0, minor = 0;
    if (!display_ || !eglInitialize(display_, &major, &minor)) throw Error("EGL without a surface is not there").advise("Install libegl1 and Mesa");
    eglBindAPI(EGL_OPENGL_API);
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint found = 0;
    eglChooseConfig(display_, wanted, &config, 1, &found);
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, attributes);
    if (!context_ || !eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
      eglTerminate(display_);
      throw Error("EGL gives no OpenGL 3.3").advise("Install Mesa's software renderer (libgl1-mesa-dri)");
    }
    frame_ = std::make_unique<Frame>();
    frame_->resize(width, height, false);
    for (int key = 0; key < ImGuiKey_COUNT; ++key) ImGui::GetIO().KeyMap[key] = key;   // there is no keyboard but the hand's
    ImGui_ImplOpenGL3_Init("#version 330 core");
  }
  ~Offscreen() override {
    ImGui_ImplOpenGL3_Shutdown();
    frame_.reset();
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
    eglTerminate(display_);
  }

  std::pair<int, int> size() const override { return {width_, height_}; }
  float scale() const override { return scale_; }
  void begin() override {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {float(width_), float(height_)};
    io.DeltaTime = 1.f / 60;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
  }
  void end() override {
    frame_->bind();
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }
  bool wait(double seconds) override {
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(seconds, 0.005)));
    return true;
  }

 protected:
  unsigned readFramebuffer() const override { return frame_->framebuffer(); }

 private:
  int width_, height_;
  float scale_;
  EGLDisplay display_ = nullptr;
  EGLContext context_ = nullptr;
  std::unique_ptr<Frame> frame_;
};

}  // namespace

std::unique_ptr<Target> makeOffscreen(int width, int height, float scale) { return std::make_unique<Offscreen>(width, height, scale); }

}  // namespace pectora::view
