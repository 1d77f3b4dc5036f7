// From thin slices to the CT: slice thickness, point spread, texture and noise.
#include "phantom.h"

#include "noise.h"
#include "raster.h"
#include "smooth.h"
#include "kernel/physics/workers.h"

#include <mutex>

namespace pectora::phantom {
namespace {

constexpr double kPointSpreadMm = 0.55;    // SD of the point spread in the slice
constexpr double kNoiseCutoffPerMm = 0.5;  // fc of the noise's spectrum, cycles per mm
constexpr double kGrainMm = 2.5;           // size of the tissues' own texture

/// Thin slices that make up one slice of that thickness: odd, so that one lies in the middle.
int thinSlices(double spacing) { return spacing <= 1.3 ? 1 : spacing <= 4 ? 3 : 5; }

/// Separable Gaussian, in place.
void blur(std::vector<float>& image, int size, double sigma) {
  std::vector<float> kernel;
  const int reach = int(std::ceil(3 * sigma));
  float sum = 0;
  for (int i = -reach; i <= reach; ++i) kernel.push_back(float(std::exp(-i * i / (2 * sigma * sigma)))), sum += kernel.back();
  for (float& k : kernel) k /= sum;
  std::vector<float> rows(image.size(), 0.0f);
  for (int j = 0; j < size; ++j) {
    const float* in = &image[std::size_t(j) * size];
    float* out = &rows[std::size_t(j) * size];
    for (int k = -reach; k <= reach; ++k)
      for (int i = 0; i < size; ++i) out[i] += kernel[k + reach] * in[std::clamp(i + k, 0, size - 1)];
  }
  std::fill(image.begin(), image.end(), 0.0f);
  for (int j = 0; j < size; ++j)
    for (int k = -reach; k <= reach; ++k) {
      const float* in = &rows[std::size_t(std::clamp(j + k, 0, size - 1)) * size];
      float* out = &image[std::size_t(j) * size];
      for (int i = 0; i < size; ++i) out[i] += kernel[k + reach] * in[i];
    }
}

/// The noise-free slice k in `mean`, its labels in `labels`.
void drawSlice(const Drawing& drawing, int k, Canvas& canvas, std::vector<float>& mean, std::uint8_t* labels) {
  const Grid& grid = drawing.patient.grid;
  const double z = grid.origin.z + k * grid.spacing.z;
  const int count = thinSlices(grid.spacing.z);
  std::vector<float> texture(mean.size(), 0.0f);
  std::fill(mean.begin(), mean.end(), 0.0f);
  for (int thin = 0; thin < count; ++thin) {
    drawThinSlice(drawing, z + grid.spacing.z * ((thin + 0.5) / count - 0.5), canvas);
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += canvas.hu[i] / float(count);
    for (std::size_t i = 0; i < mean.size(); ++i) texture[i] += canvas.texture[i] / float(count);
    if (thin == count / 2) std::copy(canvas.label.begin(), canvas.label.end(), labels);
  }
  if (drawing.settings.texture > 0) {
    const int extent = int(drawing.settings.fov / kGrainMm) + 1;
    const GrainSlice grains(z / kGrainMm, extent, hash(std::uint64_t(drawing.settings.seed), 21));
    const float perPixel = float(grid.spacing.x / kGrainMm);
    for (int j = 0; j < grid.size[1]; ++j)
      for (int i = 0; i < grid.size[0]; ++i) {
        const std::size_t index = std::size_t(j) * grid.size[0] + i;
        if (texture[index] > 0)
          mean[index] += float(drawing.settings.texture) * texture[index] * grains.at(float(i) * perPixel, float(j) * perPixel);
      }
  }
  blur(mean, grid.size[0], kPointSpreadMm / grid.spacing.x);
}

}  // namespace

Images rasterise(const Patient& patient, const Settings& settings, const Progress& progress) {
  const Grid& grid = patient.grid;
  auto ct = std::make_shared<Volume>();
  auto labels = std::make_shared<Labels>();
  ct->grid = labels->grid = grid;
  ct->hu.resize(grid.voxels());
  labels->label.resize(grid.voxels());
  labels->names = labelNames();
  const Drawing drawing(patient, settings);

  std::mutex guard;
  std::size_t done = 0;
  const std::size_t pairs = std::size_t(grid.size[2] + 1) / 2;
  // Two slices a piece, for noise comes in pairs; each pair has a random stream of its own.
  parallelFor(pairs, [&](std::size_t pair) {
    {
      const std::lock_guard lock(guard);
      progress(double(done++) / double(pairs));
    }
    Canvas canvas(grid);
    std::vector<float> mean(grid.sliceVoxels());
    NoisePair noise;
    if (settings.noise > 0)
      noise = ctNoise(grid.size[0], kNoiseCutoffPerMm * grid.spacing.x, hash(std::uint64_t(settings.seed), 31, pair));
    for (int half = 0; half < 2; ++half) {
      const int k = int(2 * pair) + half;
      if (k >= grid.size[2]) break;
      const std::size_t first = grid.index(0, 0, k);
      drawSlice(drawing, k, canvas, mean, &labels->label[first]);
      const std::vector<float>& grain = half ? noise.second : noise.first;
      for (std::size_t i = 0; i < mean.size(); ++i) {
        const float value = mean[i] + (grain.empty() ? 0.0f : float(settings.noise) * grain[i]);
        ct->hu[first + i] = std::int16_t(std::lround(std::clamp(value, -1024.0f, 3071.0f)));
      }
    }
  });
  return {ct, labels};
}

}  // namespace pectora::phantom
