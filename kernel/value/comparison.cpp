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
  facts.insert(facts.end(), details.begin(), details.end());
  return facts;
}

DistanceStatistics statistics(std::vector<double> d) {
  DistanceStatistics s;
  s.count = d.size();
  if (d.empty()) return s;
  double sum = 0, squares = 0, absolute = 0;
  for (double x : d) sum += x, squares += x * x, absolute += std::abs(x);
  const double n = double(d.size());
  s.mean = sum / n;
  s.rms = std::sqrt(squares / n);
  s.meanAbsolute = absolute / n;
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

SymmetricDistances symmetric(const DistanceStatistics& there, const DistanceStatistics& back) {
  if (there.count == 0 || back.count == 0) return {};
  return {(there.meanAbsolute + back.meanAbsolute) / 2, std::sqrt((there.rms * there.rms + back.rms * back.rms) / 2),
          std::max(there.p95, back.p95), std::max(there.maxAbsolute(), back.maxAbsolute())};
}

namespace {

double skillOf(const DistanceStatistics& distances, const DistanceStatistics& baseline) {
  return baseline.rms > 0 ? 1 - distances.rms / baseline.rms : std::numeric_limits<double>::quiet_NaN();
}

double skillOf(const DistanceStatistics& overlap, const DistanceStatistics& pit, const DistanceStatistics& baselineOverlap, const DistanceStatistics& baselinePit) {
  return baselinePit.count > 0 ? skillOf(pit, baselinePit) : skillOf(overlap, baselineOverlap);
}

void addStatistics(std::vector<Fact>& facts, const std::string& region, const DistanceStatistics& s) {
  facts.push_back({region + "_points", double(s.count), ""});
  if (s.count == 0) return;
  facts.push_back({region + "_mean", s.mean, "mm"});
  facts.push_back({region + "_sd", s.sd, "mm"});
  facts.push_back({region + "_min", s.min, "mm"});
  facts.push_back({region + "_max", s.max, "mm"});
  facts.push_back({region + "_rms", s.rms, "mm"});
  facts.push_back({region + "_mean_absolute", s.meanAbsolute, "mm"});
  facts.push_back({region + "_median", s.median, "mm"});
  facts.push_back({region + "_p95_absolute", s.p95, "mm"});
}

// The way back, and what follows from both ways.
void addReverse(std::vector<Fact>& facts, const std::string& region, const DistanceStatistics& there, const DistanceStatistics& back) {
  addStatistics(facts, "reverse_" + region, back);
  if (there.count == 0 || back.count == 0) return;
  const SymmetricDistances both = symmetric(there, back);
  facts.push_back({"symmetric_" + region + "_mean", both.meanAbsolute, "mm"});
  facts.push_back({"symmetric_" + region + "_rms", both.rms, "mm"});
  facts.push_back({"symmetric_" + region + "_hd95", both.hd95, "mm"});
  facts.push_back({"symmetric_" + region + "_hausdorff", both.hausdorff, "mm"});
}

}  // namespace

double ComparedRegion::skill() const { return skillOf(distances, unchanged); }
double ComparedRegion::skillAgainstCopy() const { return skillOf(distances, copied); }

double Comparison::skill() const { return skillOf(overlap, pit, baselineOverlap, baselinePit); }
double Comparison::skillAgainstCopy() const { return skillOf(overlap, pit, copiedOverlap, copiedPit); }

std::vector<Fact> Comparison::facts() const {
  std::vector<Fact> facts{{"name", name, ""}, {"excluded_points", double(excluded), ""}};
  addStatistics(facts, "overlap", overlap);
  addStatistics(facts, "pit", pit);
  addReverse(facts, "overlap", overlap, reverseOverlap);
  addReverse(facts, "pit", pit, reversePit);
  // The rows of the paper's Table 1.
  if (everywhere.count > 0) {
    facts.push_back({"paper_points", double(everywhere.count), ""});
    facts.push_back({"paper_mean", everywhere.mean, "mm"});
    facts.push_back({"paper_sd", everywhere.sd, "mm"});
    facts.push_back({"paper_min", everywhere.min, "mm"});
    facts.push_back({"paper_max", everywhere.max, "mm"});
  }
  for (const ComparedRegion& r : regions) {
    addStatistics(facts, r.name, r.distances);
    addReverse(facts, r.name, r.distances, r.reverse);
    if (r.unchanged.count > 0) {
      addStatistics(facts, "unchanged_" + r.name, r.unchanged);
      facts.push_back({r.name + "_skill", r.skill(), ""});
    }
    if (r.copied.count > 0) {
      addStatistics(facts, "copied_" + r.name, r.copied);
      facts.push_back({r.name + "_skill_against_copy", r.skillAgainstCopy(), ""});
    }
  }
  if (baselineOverlap.count > 0) {
    addStatistics(facts, "unchanged_overlap", baselineOverlap);
    addStatistics(facts, "unchanged_pit", baselinePit);
    facts.push_back({"skill", skill(), ""});
  }
  if (copiedOverlap.count > 0) {
    addStatistics(facts, "copied_overlap", copiedOverlap);
    addStatistics(facts, "copied_pit", copiedPit);
    facts.push_back({"skill_against_copy", skillAgainstCopy(), ""});
  }
  return facts;
}

std::vector<std::pair<std::string, std::shared_ptr<const Value>>> Comparison::parts() const {
  if (!reference) return {{"sample", sample}};
  return {{"sample", sample}, {"reference", reference}};
}

std::vector<Fact> Report::facts() const {
  return {{"folder", folder, ""}, {"files", double(files.size()), ""}};
}

}  // namespace pectora
