#include "kernel/value/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pectora {

Vec3 AffineMap::rotate(Vec3 d) const {
  return {linear[0][0] * d.x + linear[0][1] * d.y + linear[0][2] * d.z,
          linear[1][0] * d.x + linear[1][1] * d.y + linear[1][2] * d.z,
          linear[2][0] * d.x + linear[2][1] * d.y + linear[2][2] * d.z};
}

Vec3 AffineMap::operator()(Vec3 p) const { return rotate(p) + translation; }

std::vector<Fact> Registration::facts() const {
  std::vector<Fact> facts{{"method", method, ""}, {"rms", rms, "mm"}, {"scale", scale, ""}};
  for (const LandmarkResidual& r : residuals) {
    facts.push_back({"residual_" + r.name, r.residual, "mm"});
    facts.push_back({"leave_one_out_" + r.name, r.leaveOneOut, "mm"});
  }
  return facts;
}

DistanceStatistics statistics(std::vector<double> d) {
  DistanceStatistics s;
  s.count = d.size();
  if (d.empty()) return s;
  double sum = 0, squares = 0;
  for (double x : d) sum += x, squares += x * x;
  const double n = double(d.size());
  s.mean = sum / n;
  s.rms = std::sqrt(squares / n);
  double deviation = 0;
  for (double x : d) deviation += (x - s.mean) * (x - s.mean);
  s.sd = std::sqrt(deviation / n);
  // Ranks: linear between the two nearest.
  const auto quantile = [](std::vector<double>& sorted, double q) {
    const double position = q * double(sorted.size() - 1);
    const std::size_t low = std::size_t(position), high = std::min(low + 1, sorted.size() - 1);
    return std::lerp(sorted[low], sorted[high], position - double(low));
  };
  std::sort(d.begin(), d.end());
  s.min = d.front();
  s.max = d.back();
  s.median = quantile(d, 0.5);
  for (double& x : d) x = std::abs(x);
  std::sort(d.begin(), d.end());
  s.p95 = quantile(d, 0.95);
  return s;
}

double Comparison::skill() const {
  const bool inPit = baselinePit.count > 0;
  const double baseline = inPit ? baselinePit.rms : baselineOverlap.rms;
  if (baseline <= 0) return std::numeric_limits<double>::quiet_NaN();
  return 1 - (inPit ? pit.rms : overlap.rms) / baseline;
}

std::vector<Fact> Comparison::facts() const {
  std::vector<Fact> facts{{"name", name, ""}, {"excluded_points", double(excluded), ""}};
  const auto add = [&](const std::string& region, const DistanceStatistics& s) {
    facts.push_back({region + "_points", double(s.count), ""});
    if (s.count == 0) return;
    facts.push_back({region + "_mean", s.mean, "mm"});
    facts.push_back({region + "_sd", s.sd, "mm"});
    facts.push_back({region + "_min", s.min, "mm"});
    facts.push_back({region + "_max", s.max, "mm"});
    facts.push_back({region + "_rms", s.rms, "mm"});
    facts.push_back({region + "_median", s.median, "mm"});
    facts.push_back({region + "_p95_absolute", s.p95, "mm"});
  };
  add("overlap", overlap);
  add("pit", pit);
  if (baselineOverlap.count > 0) {
    add("unchanged_overlap", baselineOverlap);
    add("unchanged_pit", baselinePit);
    facts.push_back({"skill", skill(), ""});
  }
  return facts;
}

std::vector<std::pair<std::string, std::shared_ptr<const Value>>> Comparison::parts() const {
  return {{"sample", sample}};
}

std::vector<Fact> Report::facts() const {
  return {{"folder", folder, ""}, {"files", double(files.size()), ""}};
}

}  // namespace pectora
