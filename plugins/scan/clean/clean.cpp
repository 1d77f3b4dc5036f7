#include "plugins/scan/clean/clean.h"

#include "plugins/scan/common/normals.h"

#include "kernel/physics/workers.h"
#include "kernel/stage/error.h"

#include <algorithm>
#include <cmath>

namespace pectora {
namespace {

Points keep(const Points& from, const std::vector<char>& isKept) {
  Points kept;
  for (std::size_t i = 0; i < from.points.size(); ++i) {
    if (!isKept[i]) continue;
    kept.points.push_back(from.points[i]);
    if (!from.normals.empty()) kept.normals.push_back(from.normals[i]);
    if (!from.sweeps.empty()) kept.sweeps.push_back(from.sweeps[i]);
  }
  return kept;
}

std::size_t dropNotFinite(Points& scan) {
  std::vector<char> isKept(scan.points.size());
  for (std::size_t i = 0; i < isKept.size(); ++i) {
    const Vec3 p = scan.points[i];
    isKept[i] = isFinite(p) && std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 1e9;
  }
  const std::size_t before = scan.points.size();
  scan = keep(scan, isKept);
  return before - scan.points.size();
}

// Of points closer together than a distance, the first one stays.
std::size_t dropDuplicates(Points& scan, double nearer) {
  const Neighbours tree(scan.points);
  std::vector<char> isKept(scan.points.size(), 1);
  std::vector<std::int32_t> near;
  for (std::size_t i = 0; i < isKept.size(); ++i) {
    if (!isKept[i]) continue;
    tree.within(scan.points[i], nearer, near);
    for (std::int32_t j : near)
      if (std::size_t(j) > i) isKept[j] = 0;
  }
  const std::size_t before = scan.points.size();
  scan = keep(scan, isKept);
  return before - scan.points.size();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::size_t dropOutliers(Points& scan, int neighbours, double factor) {
  const Neighbours tree(scan.points);
  std::vector<double> mean(scan.points.size());
  constexpr std::size_t kBlock = 1024;
  parallelFor((mean.size() + kBlock - 1) / kBlock, [&](std::size_t b) {
    std::vector<std::int32_t> near;
    std::vector<double> squared;
    for (std::size_t i = b * kBlock; i < std::min(mean.size(), (b + 1) * kBlock); ++i) {
      tree.nearest(scan.points[i], neighbours + 1, near, squared);
      for (double s : squared) mean[i] += std::sqrt(s) / std::max(1.0, double(squared.size()) - 1);
    }
  });
  // Robust centre and spread: outliers must not raise their own limit. In an even scan the spread is nearly nothing, and the corners of
  // its border lie up to 1.7 times as far from their neighbours as points inside: a quarter of the centre is the least spread.
  const double center = median(mean);
  std::vector<double> deviations;
  for (double m : mean) deviations.push_back(std::abs(m - center));
  const double limit = center + factor * std::max(1.4826 * median(deviations), 0.25 * center);
  std::vector<char> isKept(mean.size());
  for (std::size_t i = 0; i < mean.size(); ++i) isKept[i] = mean[i] <= limit;
  const std::size_t before = scan.points.size();
  scan = keep(scan, isKept);
  return before - scan.points.size();
}

}  // namespace

Cleaned clean(const Points& scan, const CleanSettings& settings, const std::function<void(double)>& poll) {
  Cleaned result;
  result.points = scan;
  result.notFinite = dropNotFinite(result.points);
  poll(0.1);
  if (settings.duplicateDistance > 0 && !result.points.points.empty()) result.duplicates = dropDuplicates(result.points, settings.duplicateDistance);
  poll(0.4);
  if (settings.outlierFactor > 0 && result.points.points.size() > std::size_t(settings.neighbours))
    result.outliers = dropOutliers(result.points, settings.neighbours, settings.outlierFactor);
  poll(0.7);
  if (result.points.points.size() < 4) throw Error("fewer than 4 points stay of the scan").given(std::to_string(result.points.points.size())).advise("Check the file and its units");
  if (settings.estimateNormals && result.points.normals.empty()) {
    result.points.normals = estimateNormals(result.points.points, Neighbours(result.points.points)).normals;
    result.estimatedNormals = true;
  }
  result.points.fields.clear();
  return result;
}

}  // namespace pectora
