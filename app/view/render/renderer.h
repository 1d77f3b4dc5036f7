// Draws surfaces into a frame.
#pragma once

#include "app/view/render/color_map.h"
#include "app/view/render/gpu.h"
#include "app/view/render/surface.h"

#include <vector>

namespace pectora::view {

/// How a surface looks.
struct Look {
  Rgb color{0.8f, 0.8f, 0.8f};
  ColorMap map = ColorMap::none;    ///< other than none: colour by values, from low to high
  double low = 0, high = 1;
  bool isGlass = false;             ///< drawn last; one sees through it
  bool isClipped = true;            ///< whether the clipping plane cuts it
};

/// A surface in the memory of the GPU.
class GpuSurface {
 public:
  void upload(const Surface& surface);
  /// The same triangles over other points, normals and values.
  void uploadPoints(const Surface& surface);
  bool isEmpty() const { return points_ == 0; }
  std::size_t triangles() const { return indices_ / 3; }

 private:
  friend class Renderer;
  GpuObject array_{GpuKind::vertexArray}, vertices_{GpuKind::buffer}, triangles_{GpuKind::buffer};
  std::size_t points_ = 0, indices_ = 0;
  float pointMm_ = 0;   // how wide a cloud's points are
  std::vector<float> staging_;
};

struct Item {
  const GpuSurface* surface;
  Look look;
};

/// What lies before the plane is left out: dot(normal, p) > offset.
struct ClipPlane {
  bool isOn = false;
  Vec3 normal{1, 0, 0};
  double offset = 0;
};

class Renderer {
 public:
  Renderer();
  /// Points of clouds are so wide that they close, and at least `pointSize` pixels of the picture.
  void draw(const Frame& frame, const Camera& camera, const std::vector<Item>& items, const ClipPlane& clip, float pointSize) const;

 private:
  /// What is the same for all items of a picture.
  struct View {
    Matrix4 matrix;
    Vec3 eye, key;   // key: the way to the key light
    ClipPlane clip;
    float pointSize;
    float pixelsAtOne;   // of a millimetre at a depth of one
  };
  void drawItem(const View& view, const Item& item) const;
  std::vector<Program> programs_;   // one for each way that a surface can look
};

}  // namespace pectora::view
