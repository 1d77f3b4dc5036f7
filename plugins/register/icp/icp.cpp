#include "plugins/register/icp/icp.h"

#include "plugins/common/surface/changed.h"
#include "plugins/register/icp/normal_equations.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace pectora {
namespace {

constexpr std::size_t kBlock = 1024;
constexpr std::size_t kHoldOut = 20;       // every twentieth point is held out,
constexpr std::size_t kHeldOut = 10000;    // but about so many at the most: they give an RMS to a hundredth
constexpr std::size_t kFewest = 30; // points that an alignment needs at least
constexpr double kStill = 1e-3;     // points that moved less than this part of the radius are looked for near their last counterpart

enum class Search { whole, nearby };

enum Pair : char { kPaired, kFar, kBorder, kNormal, kChanged, kKinds };

// What is known of one moving point in the present iteration.
struct Sample {
  Vec3 start, startNormal;   // before any iteration
  Vec3 direction;            // normal of its counterpart's triangle
  double distance = 0;
  int near = -1;
  Pair pair = kFar;
};

class Alignment {
 public:
  Alignment(const MovingPoints& moving, const Mesh& fixed, const Mesh* changed, const IcpSettings& settings, const std::function<void(double)>& poll)
      : settings_(settings), tree_(fixed), poll_(poll) {
    if (changed) changed_ = changedPoints(fixed.points, SurfaceTree(*changed).closest(fixed.points, [](double) {}), settings.changeThreshold, settings.changeMargin);
    // Along a curve that fills space, so that every n-th point is spread evenly and neighbours share their way through the tree.
    const std::vector<std::int32_t> order = spatialOrder(moving.points);
    all_.reserve(order.size());
    const std::size_t stride = std::max(kHoldOut, order.size() / kHeldOut);
    for (std::size_t i = 0; i < order.size(); ++i) {
      Sample sample;
      sample.start = moving.points[order[i]];
      if (!moving.normals.empty()) sample.startNormal = moving.normals[order[i]];
      (i % stride == stride - 1 ? heldOut_ : all_).push_back(sample);
    }
    for (const Sample& s : all_) equations_.center += s.start / double(all_.size());
    double squares = 0;
    for (const Sample& s : all_) squares += dot(s.start - equations_.center, s.start - equations_.center);
    equations_.radius = std::max(1e-9, std::sqrt(squares / double(all_.size())));
  }

  Registration run() {
    const std::size_t finest = std::min(all_.size(), std::size_t(settings_.finePoints));
    for (std::size_t wanted = std::size_t(settings_.coarsePoints);; wanted *= 10) {
      // No level is worth its while that has more than a third of the last one's points.
      const bool isLast = 3 * wanted >= finest;
      std::vector<Sample> level;
      const std::size_t count = isLast ? finest : wanted;
      if (count == all_.size()) level = std::move(all_);
      else
        for (std::size_t i = 0; i < count; ++i) level.push_back(all_[i * all_.size() / count]);
      // A coarse level only has to come near: the scatter of its points is what it can see.
      runLevel(level, isLast ? settings_.tolerance : std::max(settings_.tolerance, 0.1));
      if (isLast) return report(level);
    }
  }

 private:
  void runLevel(std::vector<Sample>& samples, double tolerance) {
    converged_ = false;
    double moved = std::numeric_limits<double>::infinity();   // since the whole surface was searched
    while (!converged_ && iterations_ < settings_.maxIterations) {
      ++iterations_;
      const Search search = moved < kStill * equations_.radius ? Search::nearby : Search::whole;
      if (search == Search::whole) moved = 0;
      pairAll(samples, search);
      sums_ = accumulate(samples);
      solved_ = solve(sums_);
      map_ = compose(rigidStep(sums_, solved_.step), map_);
      // The furthest that a point can move: twice the radius holds nearly all of them.
      const double reach = solved_.step.tail<3>().norm() + 2 * solved_.step.head<3>().norm();
      moved += reach;
      converged_ = reach < tolerance;
    }
  }

  void pairAll(std::vector<Sample>& samples, Search search) const {
    constexpr std::size_t kRound = 64;
    const std::size_t blocks = (samples.size() + kBlock - 1) / kBlock;
    for (std::size_t first = 0; first < blocks; first += kRound) {
      poll_(double(iterations_) / settings_.maxIterations);
      parallelFor(std::min(kRound, blocks - first), [&](std::size_t b) {
        const std::size_t begin = (first + b) * kBlock, count = std::min(samples.size() - begin, kBlock);
        pairBlock({&samples[begin], count}, search);
      });
    }
  }

  void pairBlock(std::span<Sample> samples, Search search) const {
    std::array<Vec3, kBlock> points;
    std::array<SurfaceHit, kBlock> hits;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      points[i] = map_(samples[i].start);
      hits[i].triangle = samples[i].near;
    }
    if (search == Search::nearby)
      for (std::size_t i = 0; i < samples.size(); ++i) hits[i] = tree_.closestNearby(points[i], hits[i].triangle);
    else
      tree_.closestInTurn({points.data(), samples.size()}, {hits.data(), samples.size()});
    for (std::size_t i = 0; i < samples.size(); ++i) {
      Sample& s = samples[i];
      s.near = hits[i].triangle;
      s.distance = hits[i].distance;
      // The face's normal. (The direction from the counterpart to the point would turn with every noise at edges and corners.)
      s.direction = tree_.normal(s.near);
      s.pair = judge(s, hits[i], s.direction);
    }
  }

  Pair judge(const Sample& s, const SurfaceHit& hit, Vec3 normal) const {
    if (std::abs(hit.distance) > settings_.maxDistance) return kFar;
    if (hit.onBorder) return kBorder;
    if (settings_.ballRadius > 0 && pectora::distance(hit.point, settings_.ballCenter) <= settings_.ballRadius) return kChanged;
    if (!changed_.empty())
      for (int corner : tree_.corners(hit.triangle))
        if (changed_[corner]) return kChanged;
    const Vec3 own = map_.rotate(s.startNormal);
    if (norm(own) > 0 && dot(own, normal) < std::cos(settings_.normalAngle * M_PI / 180)) return kNormal;
    return kPaired;
  }

  // Tukey's weights about zero, scaled by the median absolute distance; beyond the overlap's share, nothing.
  NormalEquations accumulate(const std::vector<Sample>& samples) {
    // Quantiles of so many are known to half a percent.
    constexpr std::size_t kEnough = 100000;
    const std::size_t stride = samples.size() / kEnough + 1;
    std::vector<double> distances;
    std::array<std::size_t, kKinds> kinds{};
    for (const Sample& s : samples)
      if (kinds[s.pair]++ % stride == 0 && s.pair == kPaired) distances.push_back(std::abs(s.distance));
    if (kinds[kPaired] < kFewest)
      throw Error("too few points of the moving surface have a counterpart on the fixed one").given(std::to_string(kinds[kPaired])).allowed(fmt::format("{} or more", kFewest))
          .advise(fmt::format("Of {} points, {} are too far away, {} beyond the border, {} have another normal, {} lie where the operation changes the surface: align by landmarks first, and check units and settings",
                              samples.size(), kinds[kFar], kinds[kBorder], kinds[kNormal], kinds[kChanged]));
    const auto quantile = [&](double q) {
      const auto at = distances.begin() + std::ptrdiff_t(q * double(distances.size() - 1));
      std::nth_element(distances.begin(), at, distances.end());
      return *at;
    };
    const double furthest = settings_.overlap < 1 ? quantile(settings_.overlap) : settings_.maxDistance;
    // 1.4826: from the median absolute to the standard deviation of normal noise; 4.685: Tukey's constant of 95 % efficiency.
    scale_ = std::max(1e-6, 1.4826 * quantile(0.5 * std::min(1.0, settings_.overlap)));
    const double cut = 4.685 * scale_;

    std::vector<NormalEquations> parts((samples.size() + kBlock - 1) / kBlock, equations_);
    parallelFor(parts.size(), [&](std::size_t b) {
      for (std::size_t i = b * kBlock; i < std::min(samples.size(), (b + 1) * kBlock); ++i) {
        const Sample& s = samples[i];
        const double ratio = s.distance / cut;
        if (s.pair != kPaired || std::abs(s.distance) > furthest || !(ratio * ratio < 1)) continue;
        const double root = 1 - ratio * ratio;
        parts[b].add(map_(s.start), s.direction, s.distance, root * root);
      }
    });
    NormalEquations sum = equations_;
    for (const NormalEquations& part : parts) sum.add(part);
    return sum;
  }

  Registration report(std::vector<Sample>& samples) {
    Registration result;
    result.method = "icp";
    result.map = map_;
    result.rms = std::sqrt(sums_.squares / double(sums_.count));
    auto& details = result.details;
    details.push_back({"status", std::string(!converged_ ? "stopped" : solved_.undetermined > 0 ? "undetermined" : "converged"), ""});
    details.push_back({"iterations", double(iterations_), ""});
    std::array<std::size_t, kKinds> kinds{};
    for (const Sample& s : samples) ++kinds[s.pair];
    details.push_back({"used_points", double(sums_.count), ""});
    details.push_back({"outliers", double(kinds[kPaired] - sums_.count), ""});
    details.push_back({"far_points", double(kinds[kFar]), ""});
    details.push_back({"border_points", double(kinds[kBorder]), ""});
    details.push_back({"points_with_another_normal", double(kinds[kNormal]), ""});
    details.push_back({"points_in_changed_region", double(kinds[kChanged]), ""});

    // Points that no iteration saw, where they have a counterpart and are no outliers; as many as a twentieth of the others.
    const std::size_t held = std::min(heldOut_.size(), samples.size() / kHoldOut + 1);
    for (std::size_t i = 0; i < held; ++i) heldOut_[i] = heldOut_[i * heldOut_.size() / held];
    heldOut_.resize(held);
    pairAll(heldOut_, Search::whole);
    double squares = 0;
    std::size_t count = 0;
    for (const Sample& s : heldOut_)
      if (s.pair == kPaired && std::abs(s.distance) < 4.685 * scale_) squares += s.distance * s.distance, ++count;
    details.push_back({"held_out_points", double(count), ""});
    details.push_back({"held_out_rms", count > 0 ? std::sqrt(squares / double(count)) : std::numeric_limits<double>::quiet_NaN(), "mm"});

    // How well the map is known. Covariance of the six unknowns: variance of a distance times the inverse.
    const double variance = result.rms * result.rms;
    details.push_back({"condition", solved_.condition, ""});
    const Vector6& w = solved_.weakest;
    const bool isTurn = w.head<3>().norm() > w.tail<3>().norm();
    const Eigen::Vector3d axis = (isTurn ? w.head<3>() : w.tail<3>()).normalized();
    details.push_back({"weakest_direction", fmt::format("{} ({:.2f}, {:.2f}, {:.2f})", isTurn ? "turn about" : "shift along", axis(0), axis(1), axis(2)), ""});
    details.push_back({"weakest_sd", std::sqrt(variance * w.dot(solved_.inverse * w)), "mm"});
    double expected = 0;
    const std::size_t stride = samples.size() / 5000 + 1;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < samples.size(); i += stride, ++seen)
      for (int a = 0; a < 3; ++a) {
        Vec3 unit;
        unit[a] = 1;
        const Vector6 j = equations_.row(map_(samples[i].start), unit);
        expected += variance * j.dot(solved_.inverse * j);
      }
    details.push_back({"expected_error", std::sqrt(expected / double(seen)), "mm"});
    return result;
  }

  const IcpSettings& settings_;
  SurfaceTree tree_;
  std::vector<bool> changed_;          // per point of the fixed surface; empty if not asked
  const std::function<void(double)>& poll_;
  std::vector<Sample> all_, heldOut_;
  NormalEquations equations_;          // empty, with centre and radius
  NormalEquations sums_;               // of the last iteration
  AffineMap map_;
  Solved solved_;
  double scale_ = 0;
  int iterations_ = 0;
  bool converged_ = false;
};

}  // namespace

Registration alignSurface(const MovingPoints& moving, const Mesh& fixed, const Mesh* changed, const IcpSettings& settings,
                          const std::function<void(double)>& poll) {
  for (const Vec3& p : moving.points)
    if (!isFinite(p) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > TriangleBvh::kHuge)
      throw Error("the moving surface has a coordinate that is not a finite number, or beyond any body").of("moving").advise("Clean the scan first");
  if (moving.points.size() < kFewest)
    throw Error("the moving surface has too few points").of("moving").given(std::to_string(moving.points.size())).allowed(fmt::format("{} or more", kFewest));
  return Alignment(moving, fixed, changed, settings, poll).run();
}

}  // namespace pectora
