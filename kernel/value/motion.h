// What a solver returns: where the layers went, and whether that can be trusted.
#pragma once

#include "kernel/value/scene.h"

#include <limits>

namespace pectora {

enum class SolveStatus {
  converged,   ///< the residual is below the tolerance
  stalled,     ///< it stopped getting smaller
  diverged,    ///< it grew, or turned into something that is not a number
  cancelled,
};
const char* statusName(SolveStatus status);

/// The wall at one time on its way.
struct Moment {
  double time = 0;             ///< s from the beginning
  double energy = 0;           ///< potential, N mm
  double kineticEnergy = 0;    ///< N mm
  double fastest = 0;          ///< the largest speed of a point, mm/s
  std::vector<Vec3> outer;     ///< the skin, as in Scene
};

struct Motion : Value {
  static constexpr const char* kName = "Motion";
  std::shared_ptr<const Scene> scene;
  std::vector<Vec3> outer, inner;           ///< positions after, as in Scene
  std::vector<std::vector<Vec3>> between;   ///< the same of the layers between
  std::vector<Vec3> anchors;                ///< where the plan brought the scene's anchors, and then what effects guide
  double lift = 0;                          ///< how far the point over the first bar came, mm: less than planned if the bar gives way
  std::vector<double> barForces;            ///< of the chest on each of the plan's bars, N; empty if no effect knows it
  SolveStatus status = SolveStatus::stalled;
  std::string message;                      ///< what is wrong, and where, if not converged
  int iterations = 0;
  int forceEvaluations = 0;
  double residual = 0;                      ///< largest force on a free point, N
  double relativeResidual = 0;              ///< the same over the largest spring force
  double energy = 0;                        ///< N mm
  std::vector<double> energyHistory;        ///< N mm, at equal distances of iterations
  double energyGrowth = 0;                  ///< largest rise in an accepted step with the bar at rest, over the energy before it
  int invertedPrisms = 0;                   ///< cells between two layers that turned inside out
  int invertedAt = -1;                      ///< index of the first such point in its layer
  std::vector<Moment> moments;              ///< how it came there, if the scene asks for its motion in time; `outer` is the end of it

  const char* kind() const override { return kName; }
  /// Of the chest on all bars together, N; NaN if no effect knows it.
  double barForce() const;
  /// Among them "overshoot": how much farther from its place at rest a point of the skin came on its way in time than in the end.
  std::vector<Fact> facts() const override;
  /// As Scene::layer.
  const std::vector<Vec3>& layer(int l) const { return l == 0 ? outer : l == int(between.size()) + 1 ? inner : between[l - 1]; }
  std::size_t bytes() const override { return ((2 + between.size() + moments.size()) * outer.size() + anchors.size()) * sizeof(Vec3); }
  /// `before` and `after`: the skin as meshes; `after` has the field "displacement". `copied`: the skin if it copied the bone.
  std::vector<std::pair<std::string, std::shared_ptr<const Value>>> parts() const override;
};

/// The skin of `motion.scene` if every point moved as the bones behind it: by the mean displacement of the anchors of its pleura point,
/// weighted by one over the squared distance. What a prediction must be better than. A point without anchors stays.
std::vector<Vec3> skinThatCopiesBone(const Motion& motion);

/// Counts the prisms between two layers whose signed volume is not positive; `first` gets the index of the first.
int countInvertedPrisms(int rows, int columns, const std::vector<Vec3>& outer, const std::vector<Vec3>& inner,
                        int& first);

}  // namespace pectora
