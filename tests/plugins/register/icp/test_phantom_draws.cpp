// Four landmarks with errors, then ICP on what the operation leaves as it was: how far off is the pit?
#include "plugins/loader/phantom/phantom.h"
#include "plugins/loader/phantom/smooth.h"
#include "plugins/register/icp/icp.h"
#include "plugins/register/landmarks/fit.h"

#include "kernel/physics/workers.h"

#include <gtest/gtest.h>

#include <random>

using namespace pectora;
using namespace pectora::phantom;

namespace {

// The skin of a body as a mesh, with outward normals.
Mesh skinOf(const Body& body, double bottom, double top) {
  constexpr double kStepMm = 3, kStepDegrees = 1.5;
  const int rows = int((top - bottom) / kStepMm) + 1, columns = int(360 / kStepDegrees);
  Mesh mesh;
  for (int r = 0; r < rows; ++r) {
    const Level level = body.level(bottom + r * kStepMm);
    for (int c = 0; c < columns; ++c) mesh.points.push_back(body.surfacePoint(body.torso->skin, level, radians(c * kStepDegrees - 180)));
  }
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const int a = r * columns + c, b = r * columns + (c + 1) % columns;
      mesh.triangles.push_back({a, b, b + columns});
      mesh.triangles.push_back({a, b + columns, a + columns});
    }
  return mesh;
}

double rms(const std::vector<double>& values) {
  double squares = 0;
  for (double v : values) squares += v * v;
  return std::sqrt(squares / double(values.size()));
}

}  // namespace

TEST(IcpOnPhantom, BringsThePitWithinOneMillimetreFromLandmarksThreeMillimetresOff) {
  IcpSettings quick;
  quick.tolerance = 0.01;
  constexpr int kScans = 20, kDrawsEach = 10;
  Settings settings;
  settings.matrix = 128;
  settings.scanSpacing = 6;
  settings.landmarkNoise = 0;
  const Patient patient = makePatient(settings);
  // The prediction that masks the pit is not the truth: it lifts by 22 mm where the operation lifted by 30.
  Settings predictedSettings = settings;
  predictedSettings.lift = 22;
  const Patient predicted = makePatient(predictedSettings);
  const double bottom = navelLevel(patient.after.torso->skeleton.sternum) - 75, top = 60;
  const Mesh before = skinOf(patient.before, bottom, top), forecast = skinOf(predicted.after, bottom, top), truth = skinOf(patient.after, bottom, top);
  // Targets: the skin that the operation moved by more than 3 mm.
  std::vector<Vec3> pit;
  for (std::size_t i = 0; i < truth.points.size(); ++i)
    if (distance(truth.points[i], before.points[i]) > 3) pit.push_back(truth.points[i]);
  ASSERT_GT(pit.size(), 200u);

  const Landmarks onSkin = skinLandmarks(patient.before), afterwards = skinLandmarks(patient.after);
  std::vector<double> rigid(kScans * kDrawsEach), refined(kScans * kDrawsEach);
  for (int scanNumber = 0; scanNumber < kScans; ++scanNumber) {
    Settings own = settings;
    own.seed = scanNumber + 1;
    const Scan scan = scanSkin(patient, own);
    // The scan's true pose, from landmarks without errors.
    const AffineMap pose = fitLandmarks(pairLandmarks(afterwards, *scan.landmarks), MapKind::rigid).map;
    parallelFor(kDrawsEach, [&](std::size_t draw) {
      std::mt19937_64 random(1000 * scanNumber + draw);
      std::normal_distribution<double> noise(0, 3);
      Landmarks seen = *scan.landmarks, placed = onSkin;
      for (Landmarks* side : {&seen, &placed})
        for (Landmark& l : side->points) {
          const double x = noise(random), y = noise(random), z = noise(random);
          l.position += {x, y, z};
        }
      const AffineMap start = fitLandmarks(pairLandmarks(seen, placed), MapKind::rigid).map;
      std::vector<Vec3> points = scan.points->points, normals = scan.points->normals;
      for (Vec3& p : points) p = start(p);
      for (Vec3& n : normals) n = start.rotate(n);
      const AffineMap icp = alignSurface({points, normals}, before, &forecast, quick, [](double) {}).map;
      std::vector<double> first, second;
      for (const Vec3& target : pit) {
        first.push_back(distance(start(pose(target)), target));
        second.push_back(distance(icp(start(pose(target))), target));
      }
      rigid[scanNumber * kDrawsEach + draw] = rms(first);
      refined[scanNumber * kDrawsEach + draw] = rms(second);
    });
  }
  std::printf("pit target error over %d draws: landmarks alone %.2f mm RMS, with ICP %.2f mm RMS, worst %.2f\n", kScans * kDrawsEach, rms(rigid), rms(refined),
              *std::max_element(refined.begin(), refined.end()));
  EXPECT_GT(rms(rigid), 2);
  EXPECT_LE(rms(refined), 1);
}
