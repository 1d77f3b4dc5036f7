#include "app/view/render/renderer.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pectora::view {
namespace {

constexpr float kOverlap = 1.8f;       // points of a cloud are as wide as so many of their spacings: it closes
constexpr float kUnknown = -1e30f;   // a value that is not known, for the shader

// What a program is made for. What one does not need it does not pay for: a renderer in software takes every branch.
constexpr unsigned kCut = 1;      // of what lies before a plane nothing is drawn
constexpr unsigned kMapped = 2;   // coloured by its values
constexpr unsigned kGlass = 4;
constexpr unsigned kDense = 8;    // lit at its points: triangles are about as small as pixels
constexpr unsigned kPrograms = 16;
constexpr std::size_t kDenseTriangles = 60000;   // from so many on a surface is dense

// A key light over the viewer's shoulder, a soft one from below, and a little gloss.
constexpr const char* kLight = R"(uniform vec3 keyLight;
vec4 litBy(vec3 base, vec3 across, vec3 toEye) {
  vec3 n = dot(across, across) > 0.0 ? normalize(across) : toEye;
  float facing = dot(n, toEye);
  float back = facing < 0.0 ? 0.75 : 1.0;
  if (facing < 0.0) n = -n;
  facing = abs(facing);
  float key = max(dot(n, keyLight), 0.0);
  // To the power of 40.
  float g = max(dot(n, normalize(keyLight + toEye)), 0.0);
  g *= g; g *= g; g *= g;
  float g2 = g * g;
  g *= g2 * g2;
#ifdef MAPPED
  vec3 lit = base * (0.30 + 0.22 * facing + 0.55 * key) * back + 0.04 * g;
#else
  vec3 lit = base * (0.30 + 0.22 * facing + 0.55 * key) * back + 0.12 * g;
#endif
#ifdef GLASS
  float rim = 1.0 - facing;
  return vec4(mix(lit, vec3(0.78, 0.84, 0.88), 0.6), 0.10 + 0.60 * rim * rim);
#else
  return vec4(lit, 1.0);
#endif
}
)";

constexpr const char* kVertex = R"(layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float value;
uniform mat4 matrix;
uniform vec4 clip;
uniform vec3 eye, color, stops[9];
uniform float pointSize, pointsBefore, low, high;
#ifdef DENSE
out vec4 light;
#else
out vec3 base, across, toEye;
#endif
void main() {
  gl_Position = matrix * vec4(position, 1);
  gl_PointSize = max(pointSize, pointsBefore / gl_Position.w);
#ifdef CUT
  gl_ClipDistance[0] = clip.w - dot(clip.xyz, position);
#endif
#ifdef MAPPED
  float x = clamp((value - low) / (high - low), 0.0, 1.0) * 8.0;
  int i = min(7, int(x));
  vec3 own = value < -1e29 ? vec3(0.55) : mix(stops[i], stops[i + 1], x - float(i));
#else
  vec3 own = color;
#endif
#ifdef DENSE
  light = litBy(own, normal, normalize(eye - position));
#else
  base = own;
  across = normal;
  toEye = normalize(eye - position);
#endif
}
)";

constexpr const char* kFragment = R"(out vec4 shade;
#ifdef DENSE
in vec4 light;
void main() { shade = light; }
#else
in vec3 base, across, toEye;
void main() { shade = litBy(base, across, toEye); }
#endif
)";

Program makeProgram(unsigned use) {
  std::string head = "#version 330 core\n";
  if (use & kCut) head += "#define CUT\n";
  if (use & kMapped) head += "#define MAPPED\n";
  if (use & kGlass) head += "#define GLASS\n";
  if (use & kDense) head += "#define DENSE\n";
  return {head + ((use & kDense) ? kLight : "") + kVertex, head + ((use & kDense) ? "" : kLight) + kFragment};
}

// Triangles one after the other that lie beside each other, along a Z-shaped curve (Morton 1966): points that they share are then
// transformed once.
std::vector<std::array<int, 3>> byPlace(const Surface& surface) {
  Vec3 low = surface.points.front(), high = low;
  for (const Vec3& p : surface.points)
    for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
  const double scale = 1023 / std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-9});
  const auto spread = [](std::uint32_t v) {
    v = (v | v << 16) & 0x030000FF;
    v = (v | v << 8) & 0x0300F00F;
    v = (v | v << 4) & 0x030C30C3;
    return (v | v << 2) & 0x09249249;
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order(surface.triangles.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Vec3 p = (surface.points[surface.triangles[i][0]] - low) * scale;
    order[i] = {spread(std::uint32_t(p.x)) | spread(std::uint32_t(p.y)) << 1 | spread(std::uint32_t(p.z)) << 2, std::uint32_t(i)};
  }
  std::sort(order.begin(), order.end());
  std::vector<std::array<int, 3>> sorted;
  sorted.reserve(order.size());
  for (const auto& [place, i] : order) sorted.push_back(surface.triangles[i]);
  return sorted;
}

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
  pointMm_ = surface.triangles.empty() ? kOverlap * float(pointSpacing(surface.points)) : 0;
  glBindVertexArray(array_.id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, triangles_.id());
  indices_ = surface.triangles.size() * 3;
  const bool isSorted = surface.triangles.size() < kDenseTriangles;   // near enough to it
  const std::vector<std::array<int, 3>> sorted = isSorted ? std::vector<std::array<int, 3>>{} : byPlace(surface);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(indices_ * sizeof(int)), (isSorted ? surface.triangles : sorted).data(), GL_STATIC_DRAW);
  glBindVertexArray(0);
}

Renderer::Renderer() {
  for (unsigned i = 0; i < kPrograms; ++i) programs_.push_back(makeProgram(i));
}

void Renderer::drawItem(const View& view, const Item& item) const {
  const Look& look = item.look;
  const bool isCut = view.clip.isOn && look.isClipped, isMapped = look.map != ColorMap::none;
  const bool isDense = item.surface->triangles() >= kDenseTriangles;
  const Program& program = programs_[(isCut ? kCut : 0) | (isMapped ? kMapped : 0) | (look.isGlass ? kGlass : 0) | (isDense ? kDense : 0)];
  isCut ? glEnable(GL_CLIP_DISTANCE0) : glDisable(GL_CLIP_DISTANCE0);
  program.use();
  glUniformMatrix4fv(program.uniform("matrix"), 1, GL_FALSE, view.matrix.data());
  const auto set = [&](const char* name, Vec3 v) { glUniform3f(program.uniform(name), float(v.x), float(v.y), float(v.z)); };
  set("eye", view.eye);
  set("keyLight", view.key);
  glUniform1f(program.uniform("pointSize"), view.pointSize);
  glUniform1f(program.uniform("pointsBefore"), item.surface->pointMm_ * view.pixelsAtOne);
  glUniform3fv(program.uniform("color"), 1, look.color.data());
  if (isCut) glUniform4f(program.uniform("clip"), float(view.clip.normal.x), float(view.clip.normal.y), float(view.clip.normal.z), float(view.clip.offset));
  if (isMapped) {
    glUniform1f(program.uniform("low"), float(look.low));
    glUniform1f(program.uniform("high"), float(look.high));
    glUniform3fv(program.uniform("stops"), kColorStops, colorStops(look.map)[0].data());
  }
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
  // A turn leaves a matrix row's length: the second tells how high a millimetre is at a depth of one.
  const Matrix4 m = camera.matrix();
  const float pixelsAtOne = std::hypot(m[1], m[5], m[9]) * 0.5f * float(frame.height() * frame.fineness());
  const View view{m, eye, normalized(toEye * 0.75 + camera.up() * 0.55 - camera.right() * 0.45), clip, pointSize * float(frame.fineness()), pixelsAtOne};
  for (const Item& item : items) {
    if (item.look.isGlass || item.surface->isEmpty()) continue;
    drawItem(view, item);
  }
  // Glass: what is behind first, and nothing hides what is seen through it.
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glEnable(GL_CULL_FACE);
  for (const Item& item : items) {
    if (!item.look.isGlass || item.surface->isEmpty()) continue;
    glCullFace(GL_FRONT);
    drawItem(view, item);
    glCullFace(GL_BACK);
    drawItem(view, item);
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
