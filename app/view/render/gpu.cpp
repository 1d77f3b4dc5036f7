#include "app/view/render/gpu.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <stdexcept>

namespace pectora::view {
namespace {

int live = 0;

unsigned compileShader(unsigned kind, const std::string& text) {
  const char* source = text.c_str();
  const unsigned shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  int good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  char log[2000] = "";
  glGetShaderInfoLog(shader, sizeof(log), nullptr, log);
  glDeleteShader(shader);
  throw std::logic_error(std::string("shader: ") + log);
}

}  // namespace

int liveGpuObjects() { return live; }

int openGlErrors() {
  int count = 0;
  while (glGetError() != GL_NO_ERROR) ++count;
  return count;
}

GpuObject::GpuObject(GpuKind kind) : kind_(kind) {
  switch (kind_) {
    case GpuKind::buffer: glGenBuffers(1, &id_); break;
    case GpuKind::vertexArray: glGenVertexArrays(1, &id_); break;
    case GpuKind::texture: glGenTextures(1, &id_); break;
    case GpuKind::framebuffer: glGenFramebuffers(1, &id_); break;
    case GpuKind::renderbuffer: glGenRenderbuffers(1, &id_); break;
    case GpuKind::program: id_ = glCreateProgram(); break;
  }
  ++live;
}

GpuObject::~GpuObject() {
  if (id_ == 0) return;
  switch (kind_) {
    case GpuKind::buffer: glDeleteBuffers(1, &id_); break;
    case GpuKind::vertexArray: glDeleteVertexArrays(1, &id_); break;
    case GpuKind::texture: glDeleteTextures(1, &id_); break;
    case GpuKind::framebuffer: glDeleteFramebuffers(1, &id_); break;
    case GpuKind::renderbuffer: glDeleteRenderbuffers(1, &id_); break;
    case GpuKind::program: glDeleteProgram(id_); break;
  }
  --live;
}

Program::Program(const std::string& vertexSource, const std::string& fragmentSource) {
  const unsigned vertex = compileShader(GL_VERTEX_SHADER, vertexSource), fragment = compileShader(GL_FRAGMENT_SHADER, fragmentSource);
  glAttachShader(object_.id(), vertex);
  glAttachShader(object_.id(), fragment);
  glLinkProgram(object_.id());
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  int good = 0;
  glGetProgramiv(object_.id(), GL_LINK_STATUS, &good);
  if (good) return;
  char log[2000] = "";
  glGetProgramInfoLog(object_.id(), sizeof(log), nullptr, log);
  throw std::logic_error(std::string("program: ") + log);
}

void Program::use() const { glUseProgram(object_.id()); }
int Program::uniform(const char* name) const { return glGetUniformLocation(object_.id(), name); }

void Frame::resize(int width, int height, bool isFine) {
  isFine_ = isFine;
  if (width != width_ || height != height_) {
    width_ = width, height_ = height, hasFine_ = false;
    glBindTexture(GL_TEXTURE_2D, color_.id());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, plain_.id());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.id(), 0);
    addRoom(depth_, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT, 1);
  }
  if (!isFine || hasFine_) return;
  hasFine_ = true;
  glBindFramebuffer(GL_FRAMEBUFFER, fine_.id());
  addRoom(fineColor_, GL_RGBA8, GL_COLOR_ATTACHMENT0, kFineness);
  addRoom(fineDepth_, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT, kFineness);
}

void Frame::addRoom(const GpuObject& buffer, unsigned format, unsigned attachment, int fineness) const {
  glBindRenderbuffer(GL_RENDERBUFFER, buffer.id());
  glRenderbufferStorage(GL_RENDERBUFFER, format, fineness * width_, fineness * height_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer.id());
}

void Frame::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, isFine_ ? fine_.id() : plain_.id());
  glViewport(0, 0, fineness() * width_, fineness() * height_);
}

void Frame::resolve() const {
  if (!isFine_) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, fine_.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, plain_.id());
  // Between two pixels each way: the mean of four.
  glBlitFramebuffer(0, 0, kFineness * width_, kFineness * height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

std::vector<unsigned char> readPixels(unsigned framebuffer, int width, int height) {
  const std::ptrdiff_t row = std::ptrdiff_t(width) * 4;
  std::vector<unsigned char> rgba(std::size_t(row) * height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  for (int y = 0; y < height / 2; ++y) std::swap_ranges(rgba.begin() + row * y, rgba.begin() + row * (y + 1), rgba.begin() + row * (height - 1 - y));
  return rgba;
}

void Picture::upload(int width, int height, const unsigned char* rgba, bool isSmooth) {
  glBindTexture(GL_TEXTURE_2D, texture_.id());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
  const int filter = isSmooth ? GL_LINEAR : GL_NEAREST;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

}  // namespace pectora::view
