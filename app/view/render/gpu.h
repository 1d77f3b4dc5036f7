// OpenGL objects with owners, counted so that a test sees a leak.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace pectora::view {

/// How many OpenGL objects the window holds at present, ImGui's own left aside.
int liveGpuObjects();

/// How many errors OpenGL has noted since the last call.
int openGlErrors();

enum class GpuKind { buffer, vertexArray, texture, framebuffer, renderbuffer, program };

/// One OpenGL object, made by its constructor and deleted by its destructor.
class GpuObject {
 public:
  explicit GpuObject(GpuKind kind);
  ~GpuObject();
  GpuObject(GpuObject&& other) noexcept : kind_(other.kind_), id_(std::exchange(other.id_, 0)) {}
  GpuObject& operator=(GpuObject&& other) noexcept {
    std::swap(kind_, other.kind_), std::swap(id_, other.id_);
    return *this;
  }
  unsigned id() const { return id_; }

 private:
  GpuKind kind_;
  unsigned id_ = 0;
};

/// A linked shader program. Throws std::logic_error with the log if it does not compile: the source is ours.
class Program {
 public:
  Program(const std::string& vertexSource, const std::string& fragmentSource);
  void use() const;
  int uniform(const char* name) const;

 private:
  GpuObject object_{GpuKind::program};
};

/// Colour and depth to draw into; the colour is a texture.
class Frame {
 public:
  /// Makes room for a picture of that size. `isFine`: drawn twice as large each way, and brought into the texture by resolve(); in
  /// software that takes half the time of four samples a pixel.
  void resize(int width, int height, bool isFine);
  /// Pixels that are drawn along one of the texture's.
  int fineness() const { return isFine_ ? kFineness : 1; }
  void bind() const;
  void resolve() const;
  unsigned texture() const { return color_.id(); }
  unsigned framebuffer() const { return plain_.id(); }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  static constexpr int kFineness = 2;   // resolve() takes the mean of so many each way
  void addRoom(const GpuObject& buffer, unsigned format, unsigned attachment, int fineness) const;
  GpuObject plain_{GpuKind::framebuffer}, color_{GpuKind::texture}, depth_{GpuKind::renderbuffer};
  GpuObject fine_{GpuKind::framebuffer}, fineColor_{GpuKind::renderbuffer}, fineDepth_{GpuKind::renderbuffer};
  int width_ = 0, height_ = 0;
  bool isFine_ = false, hasFine_ = false;
};

/// Pixels of a framebuffer, RGBA, rows from the top.
std::vector<unsigned char> readPixels(unsigned framebuffer, int width, int height);

/// An RGBA picture as a texture; `isSmooth`: interpolated between pixels.
class Picture {
 public:
  void upload(int width, int height, const unsigned char* rgba, bool isSmooth);
  unsigned texture() const { return texture_.id(); }

 private:
  GpuObject texture_{GpuKind::texture};
};

}  // namespace pectora::view
