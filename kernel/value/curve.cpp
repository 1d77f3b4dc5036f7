#include "kernel/value/curve.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pectora {
namespace {

constexpr int kMostDegree = 7;
using Weights = std::array<double, kMostDegree + 1>;

// As basis(), into an array of its own: curves are sampled by the hundred thousand. Returns the first control point that matters.
int findBasis(std::span<const double> knots, int degree, double u, Weights& n) {
  // The knot span that holds u; the last one also holds its right end.
  const int controls = int(knots.size()) - degree - 1;
  u = std::clamp(u, knots[degree], knots[controls]);
  int span = int(std::upper_bound(knots.begin() + degree, knots.begin() + controls, u) - knots.begin()) - 1;
  span = std::clamp(span, degree, controls - 1);

  // Cox and de Boor's recurrence, raising the degree one by one.
  n[0] = 1;
  for (int d = 1; d <= degree; ++d) {
    double saved = 0;
    for (int r = 0; r < d; ++r) {
      const double right = knots[span + r + 1] - u;
      const double left = u - knots[span + 1 - d + r];
      const double part = right + left > 0 ? n[r] / (right + left) : 0;
      n[r] = saved + right * part;
      saved = left * part;
    }
    n[d] = saved;
  }
  return span - degree;
}

// How to integrate over a knot span, -1 to 1: Gauss's rule with five points on eight equal parts, for the speed is smooth there, and how
// what is a polynomial with `count` coefficients follows at those points from its values at others.
struct SpanRule {
  struct Place {
    double weight = 0;
    std::array<double, kMostDegree> parts{};   // of each known value (Lagrange)
  };
  static constexpr int kParts = 8, kPoints = 5;
  std::array<double, kMostDegree> known{};     // where the values are known
  std::array<Place, kParts * kPoints> places;

  SpanRule() = default;
  explicit SpanRule(int count) {
    static constexpr std::array<double, kPoints> nodes{-0.906179845938664, -0.538469310105683, 0, 0.538469310105683, 0.906179845938664};
    static constexpr std::array<double, kPoints> weights{0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366, 0.236926885056189};
    for (int j = 0; j < count; ++j) known[j] = (2 * j + 1.0) / count - 1;
    for (int q = 0; q < kParts * kPoints; ++q) {
      Place& place = places[q];
      const double at = (2 * (q / kPoints) + 1 + nodes[q % kPoints]) / kParts - 1;
      place.weight = weights[q % kPoints] / kParts;
      for (int j = 0; j < count; ++j) {
        place.parts[j] = 1;
        for (int i = 0; i < count; ++i)
          if (i != j) place.parts[j] *= (at - known[i]) / (known[j] - known[i]);
      }
    }
  }
};

}  // namespace

std::vector<double> clampedKnots(int controls, int degree) {
  std::vector<double> knots(controls + degree + 1, 0.0);
  const int spans = controls - degree;
  for (int i = 1; i < spans; ++i) knots[degree + i] = double(i) / spans;
  std::fill(knots.end() - degree - 1, knots.end(), 1.0);
  return knots;
}

BasisWeights basis(std::span<const double> knots, int degree, double u) {
  Weights weights;
  const int first = findBasis(knots, degree, u, weights);
  return {first, {weights.begin(), weights.begin() + degree + 1}};
}

Vec3 Curve::at(double u) const {
  Weights weights;
  const int first = findBasis(knots, degree, u, weights);
  Vec3 p;
  for (int i = 0; i <= degree; ++i) p += controls[first + i] * weights[i];
  return p;
}

Vec3 Curve::derivative(double u) const {
  // The derivative is a spline of one degree less over the inner knots.
  const std::span<const double> inner(knots.data() + 1, knots.size() - 2);
  Weights weights;
  const int first = findBasis(inner, degree - 1, u, weights);
  Vec3 d;
  for (int i = 0; i < degree; ++i) {
    const int c = first + i;
    const double width = knots[c + degree + 1] - knots[c + 1];
    if (width > 0) d += (controls[c + 1] - controls[c]) * (weights[i] * degree / width);
  }
  return d;
}

double Curve::length() const {
  // Within a knot span the derivative is a polynomial: `degree` of its values tell all others.
  static const std::array<SpanRule, kMostDegree + 1> rules = [] {
    std::array<SpanRule, kMostDegree + 1> made;
    for (int d = 1; d <= kMostDegree; ++d) made[d] = SpanRule(d);
    return made;
  }();
  const SpanRule& rule = rules[degree];
  double total = 0;
  for (std::size_t k = degree; k + degree + 1 < knots.size(); ++k) {
    const double half = 0.5 * (knots[k + 1] - knots[k]);
    if (half <= 0) continue;
    std::array<Vec3, kMostDegree> known;
    for (int j = 0; j < degree; ++j) known[j] = derivative(knots[k] + half * (1 + rule.known[j]));
    for (const SpanRule::Place& place : rule.places) {
      Vec3 d;
      for (int j = 0; j < degree; ++j) d += known[j] * place.parts[j];
      total += half * place.weight * norm(d);
    }
  }
  return total;
}

std::vector<Vec3> Curve::sample(int count) const {
  std::vector<Vec3> points(count);
  for (int i = 0; i < count; ++i) points[i] = at(double(i) / (count - 1));
  return points;
}

double Curve::closest(Vec3 p) const {
  // The best of a fine sample, then a golden-section search between its neighbours.
  const int samples = 8 * int(controls.size());
  int best = 0;
  double bestDistance = INFINITY;
  for (int i = 0; i <= samples; ++i) {
    const double d = distance(p, at(double(i) / samples));
    if (d < bestDistance) bestDistance = d, best = i;
  }
  double low = std::max(0.0, double(best - 1) / samples), high = std::min(1.0, double(best + 1) / samples);
  const double ratio = (std::sqrt(5.0) - 1) / 2;
  while (high - low > 1e-7) {
    const double a = high - ratio * (high - low), b = low + ratio * (high - low);
    (distance(p, at(a)) < distance(p, at(b)) ? high : low) = distance(p, at(a)) < distance(p, at(b)) ? b : a;
  }
  return 0.5 * (low + high);
}

double polylineLength(std::span<const Vec3> line) {
  double total = 0;
  for (std::size_t i = 1; i < line.size(); ++i) total += distance(line[i - 1], line[i]);
  return total;
}

std::vector<Vec3> resamplePolyline(std::span<const Vec3> line, int count) {
  std::vector<Vec3> points;
  points.reserve(count);
  const double step = polylineLength(line) / (count - 1);
  double walked = 0;
  std::size_t segment = 1;
  for (int i = 0; i < count; ++i) {
    const double target = i * step;
    // Walk to the segment that holds the target length.
    double length = distance(line[segment - 1], line[segment]);
    while (segment + 1 < line.size() && walked + length < target) {
      walked += length;
      ++segment;
      length = distance(line[segment - 1], line[segment]);
    }
    points.push_back(lerp(line[segment - 1], line[segment], length > 0 ? std::min(1.0, (target - walked) / length) : 0));
  }
  return points;
}

bool isInContour(std::span<const Vec3> contour, Vec3 p) {
  bool isInside = false;
  for (std::size_t n = 0; n < contour.size(); ++n) {
    const Vec3 a = contour[n], b = contour[(n + 1) % contour.size()];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) isInside = !isInside;
  }
  return isInside;
}

}  // namespace pectora
