// How one surface was aligned with another, and how far they are apart.
#pragma once

#include "kernel/value/mesh.h"

namespace pectora {

/// An affine map p -> A p + b.
struct AffineMap {
  std::array<std::array<double, 3>, 3> linear{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 translation;

  Vec3 operator()(Vec3 p) const;
  Vec3 rotate(Vec3 d) const;      ///< the linear part alone
};

struct LandmarkResidual {
  std::string name;
  double residual = 0;            ///< distance after alignment, mm
  double leaveOneOut = 0;         ///< the same when this landmark was not used for the fit, mm; NaN if impossible
};

struct Registration : Value {
  static constexpr const char* kName = "Registration";
  std::string method;             ///< "rigid", "similarity", "affine"
  AffineMap map;                  ///< from the moving surface to the fixed one
  double scale = 1;
  std::vector<LandmarkResidual> residuals;
  double rms = 0;                 ///< of the residuals, mm
  std::vector<Fact> details;      ///< further figures of the method: iterations, condition ...

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
};

/// Statistics of signed distances, mm.
struct DistanceStatistics {
  std::size_t count = 0;
  double mean = 0;      ///< signed
  double sd = 0;        ///< of the signed distances, about their mean, divided by count
  double min = 0, max = 0;
  double rms = 0;
  double meanAbsolute = 0;
  double median = 0;    ///< signed
  double p95 = 0;       ///< 95th percentile of the absolute distance
  double maxAbsolute() const { return -min > max ? -min : max; }
};
/// Statistics of a list; all zero if it is empty.
DistanceStatistics statistics(std::vector<double> distances);

/// Distances both ways, each way with the same weight, mm.
struct SymmetricDistances {
  double meanAbsolute = 0;
  double rms = 0;
  double hd95 = 0;        ///< the larger of the two 95th percentiles
  double hausdorff = 0;   ///< the largest distance of all
};
/// All zero if either way is empty.
SymmetricDistances symmetric(const DistanceStatistics& there, const DistanceStatistics& back);

/// A part of the surface: the hollow, or one that somebody asked for.
struct ComparedRegion {
  std::string name;
  DistanceStatistics distances;
  DistanceStatistics reverse;    ///< as Comparison::reverseOverlap
  DistanceStatistics unchanged;  ///< the same points against "nothing changed"; count 0 if not asked
  DistanceStatistics copied;     ///< the same points against "the skin copies the bone"; count 0 if not asked

  /// 1 - RMS / RMS of "nothing changed", or of "the skin copies the bone"; NaN without it.
  double skill() const;
  double skillAgainstCopy() const;
};

struct Histogram {
  double low = 0, binWidth = 1;        ///< mm
  std::vector<std::size_t> counts;
};

/// Signed distances from the points of `sample` to a reference surface; positive outside of it.
struct Comparison : Value {
  static constexpr const char* kName = "Comparison";
  std::string name;                              ///< "scan_vs_simulated"
  std::shared_ptr<const Value> sample;           ///< Mesh or Points with the field "distance" (mm; NaN where excluded)
  std::shared_ptr<const Mesh> reference;         ///< the same for the other way; null if the sample is a cloud
  DistanceStatistics overlap;                    ///< all points with a counterpart
  DistanceStatistics pit;                        ///< points where the reference differs from "nothing changed", so that this region
                                                 ///< depends on the prediction; count 0 if there is none
  DistanceStatistics baselineOverlap, baselinePit;  ///< the same points against "nothing changed"; count 0 if not asked
  DistanceStatistics copiedOverlap, copiedPit;   ///< the same points against "the skin copies the bone"; count 0 if not asked
  DistanceStatistics reverseOverlap, reversePit; ///< from the reference's points to the sample, with the sign turned so that positive
                                                 ///< still means that the sample lies outside; count 0 if the sample is a cloud
  DistanceStatistics everywhere;                 ///< every point, also beyond borders and however far: the paper's Table 1
  std::vector<ComparedRegion> regions;           ///< first "hollow", if "nothing changed" was given: the hollow of that surface, the
                                                 ///< same for every prediction; then those that were asked for
  std::size_t excluded = 0;                      ///< points without a counterpart: beyond a border or too far
  Histogram histogram;

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
  std::vector<std::pair<std::string, std::shared_ptr<const Value>>> parts() const override;
  /// 1 - RMS / RMS of "nothing changed" in the pit (overlap if there is no pit); NaN without a baseline.
  double skill() const;
  /// The same against "the skin copies the bone".
  double skillAgainstCopy() const;
};

/// Files that a report wrote, relative to its folder.
struct Report : Value {
  static constexpr const char* kName = "Report";
  std::string folder;
  std::vector<std::string> files;

  const char* kind() const override { return kName; }
  std::vector<Fact> facts() const override;
};

}  // namespace pectora
