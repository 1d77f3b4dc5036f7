// Finds the deformity that gives the asked Haller index, and places the patient in the scanner.
#include "phantom.h"

#include "smooth.h"
#include "kernel/stage/error.h"

#include <cstdio>

namespace pectora::phantom {
namespace {

constexpr double kSmallestGap = 16;  // between sternum and vertebra, mm of the unscaled body

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

PitType pitType(const std::string& name) {
  if (name == "saucer") return PitType::saucer;
  if (name == "trench") return PitType::trench;
  if (name == "asymmetric") return PitType::asymmetric;
  return PitType::cup;
}

/// Sternal length grows with age: (60.4 + 5.616 age) / 155, boys up to 18.
double ageScale(double age) { return (60.4 + 5.616 * std::min(age, 18.0)) / 155; }

PitShape pitShape(const Settings& settings, double scale) {
  PitShape shape;
  shape.type = pitType(settings.type);
  shape.eccentricity = settings.eccentricity / scale;
  shape.asymmetry = settings.asymmetry;
  shape.torsionDeg = settings.torsion;
  // What makes the two special types: defaults that the settings are added to.
  if (shape.type == PitType::trench) shape.eccentricity -= 18;
  if (shape.type == PitType::asymmetric) shape.eccentricity -= 14, shape.asymmetry += 0.25, shape.torsionDeg -= 12;
  return shape;
}

Grid makeGrid(const Settings& settings, const Pose& pose, const SternumPlan& sternum) {
  const double top = pose.levelToCt(25);
  const double bottom = pose.levelToCt(settings.coverage == "torso" ? navelLevel(sternum) - 15 : -325);
  Grid grid;
  grid.size = {settings.matrix, settings.matrix, int((top - bottom) / settings.sliceSpacing) + 1};
  const double pixel = settings.fov / settings.matrix;
  grid.spacing = {pixel, pixel, settings.sliceSpacing};
  const double first = -settings.fov / 2 + pixel / 2;
  grid.origin = {first, first + kTurnCenter.y * pose.scale, bottom};
  return grid;
}

/// Haller index at the level of the CT with the smallest sternum-to-vertebra distance; `gap` in the unscaled body.
double hallerIndex(const Body& body, const Grid& grid, double* gap = nullptr) {
  LevelMetrics deepest;
  for (int k = 0; k < grid.size[2]; ++k) {
    const double z = body.pose.levelToBody(grid.origin.z + k * grid.spacing.z);
    if (z < body.sternalBodyBottom() || z > body.sternalBodyTop()) continue;
    const LevelMetrics metrics = body.measure(z);
    if (deepest.transverse == 0 || metrics.sternumToVertebra < deepest.sternumToVertebra) deepest = metrics;
  }
  if (gap) *gap = deepest.sternumToVertebra / body.pose.scale;
  return deepest.haller();
}

}  // namespace

double navelLevel(const SternumPlan& sternum) { return sternum.at(sternum.bottom()).z - 160; }

Patient makePatient(const Settings& settings) {
  Pose pose{ageScale(settings.age), settings.turn, {settings.shiftX, settings.shiftY, 0}};
  PitShape shape = pitShape(settings, pose.scale);
  double depthScale = 1 - settings.flattening;
  auto torso = std::make_shared<const Torso>(buildTorso(depthScale, settings.bmi));
  const Grid grid = makeGrid(settings, pose, torso->skeleton.sternum);
  const auto bodyWith = [&](double depth) {
    shape.depth = depth;
    return Body{torso, Deformity(torso->skeleton, shape), pose};
  };

  const double flat = hallerIndex(bodyWith(0), grid);
  if (settings.haller <= flat) {
    // No pit: a rounder chest. The index falls as the depth grows; secant steps on its reciprocal.
    double reciprocal = 1 / flat, slope = (1 / flat + 0.04) / depthScale;
    for (int i = 0; i < 12 && std::abs(1 / reciprocal - settings.haller) > 0.002; ++i) {
      const double next = depthScale + (1 / settings.haller - reciprocal) / slope;
      torso = std::make_shared<const Torso>(buildTorso(next, settings.bmi));
      const double value = 1 / hallerIndex(bodyWith(0), grid);
      slope = (value - reciprocal) / (next - depthScale);
      reciprocal = value, depthScale = next;
    }
  } else {
    double low = 0.01, high = 100, gap = 0;
    // The deepest pit that leaves room between sternum and vertebra.
    for (int i = 0; i < 40; ++i) {
      const double middle = (low + high) / 2;
      hallerIndex(bodyWith(middle), grid, &gap);
      (gap > kSmallestGap ? low : high) = middle;
    }
    const double deepest = low, greatest = hallerIndex(bodyWith(deepest), grid);
    const double least = hallerIndex(bodyWith(0.01), grid);
    if (settings.haller > greatest || settings.haller < least)
      throw Error("this body cannot have that Haller index")
          .of("haller").given(text(settings.haller))
          .allowed(text(least) + " to " + text(greatest) + " for type \"" + settings.type + "\" with these settings")
          .advise(settings.haller > greatest ? "ask for a lower index, or bring the pit nearer to the midline"
                                             : "ask for a higher index, or for less torsion");
    for (low = 0.01, high = deepest; high - low > 1e-4;) {
      const double middle = (low + high) / 2;
      (hallerIndex(bodyWith(middle), grid) < settings.haller ? low : high) = middle;
    }
    shape.depth = (low + high) / 2;
  }

  const double depth = shape.depth;
  Patient patient{bodyWith(depth), bodyWith(depth), depth * pose.scale, grid};
  shape.lift = settings.lift / pose.scale;
  patient.after.deformity = Deformity(torso->skeleton, shape);
  return patient;
}

}  // namespace pectora::phantom
