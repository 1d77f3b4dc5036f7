#include "app/view/render/renderer.h"

#include <epoxy/gl.h>

#include <cmath>

namespace pectora::view {
namespace {

constexpr float kUnknown = -1e30f;   // a value that is not known, for the shader

// Cut: of what lies before a plane nothing is drawn. A program of its own, as the others pay for it, too.
constexpr const char* kPlain = "#version 330 core\n";
constexpr const char* kCut = "#version 330 core\n#define CUT\n";

constexpr const char* kSurfaceVertex = R"(layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float value;
uniform mat4 matrix;
uniform vec4 clip;
uniform float pointSize;
out vec3 place, across;
out float figure;
void main() {
  gl_Position = matrix * vec4(position, 1);
  gl_PointSize = pointSize;
#ifdef CUT
  gl_ClipDistance[0] = clip.w - dot(clip.xyz, position);
#endif
  place = position;
  across = normal;
  figure = value;
})";

// A key light over the viewer's shoulder, a soft one from below, and a little gloss.
constexpr const char* kSurfaceFragment = R"(in vec3 place, across;
in float figure;
uniform vec3 eye, keyLight, color, stops[9];
uniform float low, high;
uniform int isMapped, isGlass;
out vec4 shade;
void main() {
  vec3 base = color;
  if (isMapped == 1) {
    float x = clamp((figure - low) / (high - low), 0.0, 1.0) * 8.0;
    int i = min(7, int(x));
    base = figure < -1e29 ? vec3(0.55) : mix(stops[i], stops[i + 1], x - float(i));
  }
  vec3 toEye = normalize(eye - place);
  vec3 n = dot(across, across) > 0.0 ? normalize(across) : toEye;
  float facing = dot(n, toEye);
  float back = facing < 0.0 ? 0.75 : 1.0;
  if (facing < 0.0) n = -n;
  facing = abs(facing);
  float key = max(dot(n, keyLight), 0.0);
  float gloss = pow(max(dot(n, normalize(keyLight + toEye)), 0.0), 40.0) * (isMapped == 1 ? 0.04 : 0.12);
  vec3 lit = base * (0.30 + 0.22 * facing + 0.55 * key) * back + gloss;
  float rim = 1.0 - facing;
  shade = isGlass == 1 ? vec4(mix(lit, vec3(0.78, 0.84, 0.88), 0.6), 0.10 + 0.60 * rim * rim) : vec4(lit, 1.0);
})";

}  // namespace

void GpuSurface::uploadPoints(const Surface& surface) {
  const std::size_t count = surface.points.size();
  staging_.resize(count * 7);
  for (std::size_t i = 0; i < count; ++i) {
    float* v = &staging_[i * 7];
    const Vec3 p = surface.points[i], n = surface.normals.empty() ? Vec3{} : surface.normals[i];
    const double value = surface.values.empty() ? 0 : surface.values[i];
    v[0] = float(p.x), v[1] = float(p.y), v[2] = float(p.z);
    v[3] = float(n.x), v[4] = float(n.y), v[5] = float(n.z);
    v[6] = std::isfinite(value) ? float(value) : kUnknown;
  }
  points_ = count;
  glBindVertexArray(array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(staging_.size() * sizeof(float)), staging_.data(), GL_DYNAMIC_DRAW);
  const int sizes[3] = {3, 3, 1};
  std::size_t offset = 0;
  for (unsigned k = 0; k < 3; ++k) {
    glEnableVertexAttribArray(k);
    glVertexAttribPointer(k, sizes[k], GL_FLOAT, GL_FALSE, 7 * sizeof(float), reinterpret_cast<const void*>(offset));
    offset += std::size_t(sizes[k]) * sizeof(float);
  }
  glBindVertexArray(0);
}

void GpuSurface::upload(const Surface& surface) {
  uploadPoints(surface);
  glBindVertexArray(array_.id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_.id());
  indices_ = surface.triangles.size() * 3;
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(indices_ * sizeof(int)), surface.triangles.data(), GL_STATIC_DRAW);
  glBindVertexArray(0);
}

Renderer::Renderer()
    : plain_(std::string(kPlain) + kSurfaceVertex, std::string(kPlain) + kSurfaceFragment),
      cut_(std::string(kCut) + kSurfaceVertex, std::string(kCut) + kSurfaceFragment) {}

void Renderer::drawItem(const Program& program, const Item& item) const {
  const Look& look = item.look;
  program.use();
  glUniform3fv(program.uniform("color"), 1, look.color.data());
  glUniform1i(program.uniform("isMapped"), look.map != ColorMap::none);
  glUniform1i(program.uniform("isGlass"), look.isGlass);
  glUniform1f(program.uniform("low"), float(look.low));
  glUniform1f(program.uniform("high"), float(look.high));
  if (look.map != ColorMap::none) glUniform3fv(program.uniform("stops"), kColorStops, colorStops(look.map)[0].data());
  glBindVertexArray(item.surface->array_.id());
  if (item.surface->indices_ > 0) glDrawElements(GL_TRIANGLES, GLsizei(item.surface->indices_), GL_UNSIGNED_INT, nullptr);
  else glDrawArrays(GL_POINTS, 0, GLsizei(item.surface->points_));
}

void Renderer::draw(const Frame& frame, const Camera& camera, const std::vector<Item>& items, const ClipPlane& clip, float pointSize) const {
  frame.bind();
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glClearColor(0.165f, 0.185f, 0.208f, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);

  glEnable(GL_DEPTH_TEST);
  glEnable(GL_PROGRAM_POINT_SIZE);
  const Vec3 eye = camera.eye(), toEye = normalized(eye - camera.target);
  const Vec3 key = normalized(toEye * 0.75 + camera.up() * 0.55 - camera.right() * 0.45);
  for (const Program* program : {&plain_, &cut_}) {
    if (program == &cut_ && !clip.isOn) continue;
    program->use();
    glUniformMatrix4fv(program->uniform("matrix"), 1, GL_FALSE, camera.matrix().data());
    glUniform3f(program->uniform("eye"), float(eye.x), float(eye.y), float(eye.z));
    glUniform3f(program->uniform("keyLight"), float(key.x), float(key.y), float(key.z));
    glUniform1f(program->uniform("pointSize"), pointSize);
    if (program == &cut_) glUniform4f(program->uniform("clip"), float(clip.normal.x), float(clip.normal.y), float(clip.normal.z), float(clip.offset));
  }
  const auto drawOne = [&](const Item& item) {
    const bool isCut = clip.isOn && item.look.isClipped;
    isCut ? glEnable(GL_CLIP_DISTANCE0) : glDisable(GL_CLIP_DISTANCE0);
    drawItem(isCut ? cut_ : plain_, item);
  };
  for (const Item& item : items) {
    if (item.look.isGlass || item.surface->isEmpty()) continue;
    drawOne(item);
  }
  // Glass: what is behind first, and nothing hides what is seen through it.
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glEnable(GL_CULL_FACE);
  for (const Item& item : items) {
    if (!item.look.isGlass || item.surface->isEmpty()) continue;
    glCullFace(GL_FRONT);
    drawOne(item);
    glCullFace(GL_BACK);
    drawOne(item);
  }
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CLIP_DISTANCE0);
  glBindVertexArray(0);
  frame.resolve();
}

}  // namespace pectora::view
