// The phantom's post-operative scan and landmarks.
#include "plugins/loader/phantom/phantom.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

using namespace pectora;
using namespace pectora::phantom;

namespace {

Settings exact() {
  Settings settings;
  settings.landmarkNoise = 0;
  settings.scanMisregistration = 0;
  settings.scanSpacing = 4;
  return settings;
}

Eigen::Vector3d vector(Vec3 p) { return {p.x, p.y, p.z}; }

/// Least-squares rigid transform from the scan's landmarks to those of the skin (Umeyama, without scale).
Eigen::Matrix4d back(const Landmarks& scan, const Landmarks& skin) {
  Eigen::Matrix3Xd from(3, scan.points.size()), to(3, scan.points.size());
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    from.col(Eigen::Index(i)) = vector(scan.points[i].position);
    to.col(Eigen::Index(i)) = vector(skin.find(scan.points[i].name)->position);
  }
  return Eigen::umeyama(from, to, false);
}

TEST(PhantomScan, liesOnTheSkinAfterTheOperationWithinItsNoise) {
  const Settings settings = exact();
  const Patient patient = makePatient(settings);
  const Scan scan = scanSkin(patient, settings);
  const Landmarks skin = skinLandmarks(patient.after);
  const Eigen::Matrix4d transform = back(*scan.landmarks, skin);
  ASSERT_GT(scan.points->points.size(), 5000u);
  ASSERT_EQ(scan.points->points.size(), scan.points->normals.size());
  ASSERT_EQ(scan.points->points.size(), scan.points->sweeps.size());
  double squares = 0;
  for (std::size_t i = 0; i < scan.points->points.size(); ++i) {
    const Eigen::Vector3d moved = (transform * vector(scan.points->points[i]).homogeneous()).head<3>();
    Vec3 p = patient.after.pose.toBody({moved.x(), moved.y(), moved.z()});
    p.y = patient.after.level(p.z).undeformedY(p.x, p.y);
    const double angle = polarAngle(p.x, p.y, p.z), r = std::hypot(p.x, p.y - polarCenterY(p.z));
    const PolarTable& surface = patient.after.torso->skin;
    const double d = (r - surface.radius(angle, p.z)) * surface.normalFactor(angle, p.z) * patient.after.pose.scale;
    squares += d * d;
  }
  // First-order distances are some per cent off on the pit's slopes.
  EXPECT_NEAR(std::sqrt(squares / double(scan.points->points.size())), settings.scanNoise, 0.1);
}

TEST(PhantomScan, hasUnitNormalsThatPointOutOfTheBody) {
  const Settings settings = exact();
  const Patient patient = makePatient(settings);
  const Scan scan = scanSkin(patient, settings);
  const Eigen::Matrix4d transform = back(*scan.landmarks, skinLandmarks(patient.after));
  int forwards = 0, front = 0;
  for (std::size_t i = 0; i < scan.points->points.size(); ++i) {
    const Vec3 normal = scan.points->normals[i];
    EXPECT_NEAR(norm(normal), 1, 1e-9);
    const Eigen::Vector3d p = (transform * vector(scan.points->points[i]).homogeneous()).head<3>();
    const Eigen::Vector3d n = transform.topLeftCorner<3, 3>() * vector(normal);
    if (p.y() < -60) ++front, forwards += n.y() < 0;
  }
  EXPECT_GT(forwards, int(0.98 * front));
}

TEST(PhantomScan, isTheSameForTheSameSeedAndMovesWithAnother) {
  Settings settings = exact();
  const Patient patient = makePatient(settings);
  const Scan first = scanSkin(patient, settings), again = scanSkin(patient, settings);
  EXPECT_EQ(first.points->points, again.points->points);
  settings.seed = 9;
  EXPECT_NE(scanSkin(patient, settings).points->points, first.points->points);
}

TEST(PhantomScan, leavesTheArmpitsOut) {
  const Settings settings = exact();
  const Patient patient = makePatient(settings);
  const Scan scan = scanSkin(patient, settings);
  const Eigen::Matrix4d transform = back(*scan.landmarks, skinLandmarks(patient.after));
  for (double side : {-1.5708, 1.5708}) {
    const Body& body = patient.after;
    const Vec3 armpit = body.surfacePoint(body.torso->skin, body.level(-45), side);
    double nearest = 1e9;
    for (const Vec3& p : scan.points->points)
      nearest = std::min(nearest, ((transform * vector(p).homogeneous()).head<3>() - vector(armpit)).norm());
    EXPECT_GT(nearest, 15);
  }
}

TEST(PhantomLandmarks, areNamedAndLieOnTheSkinWithinTheTorsoCoverage) {
  const Settings settings = exact();
  const Patient patient = makePatient(settings);
  const Landmarks landmarks = skinLandmarks(patient.before);
  for (const char* name : {"neck", "navel", "nipple_right", "nipple_left"}) {
    const Landmark* landmark = landmarks.find(name);
    ASSERT_NE(landmark, nullptr) << name;
    const Vec3 voxel = patient.grid.toVoxel(landmark->position);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(voxel[axis], 0) << name;
      EXPECT_LT(voxel[axis], patient.grid.size[axis] - 1) << name;
    }
  }
  // The patient's right is at smaller x.
  EXPECT_LT(landmarks.find("nipple_right")->position.x, landmarks.find("nipple_left")->position.x);
  EXPECT_GT(landmarks.find("neck")->position.z, landmarks.find("navel")->position.z);
}

}  // namespace
