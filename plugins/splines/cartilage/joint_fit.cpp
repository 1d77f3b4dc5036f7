#include "plugins/splines/cartilage/joint_fit.h"

#include "plugins/splines/cartilage/fit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>

namespace pectora {
namespace {

constexpr double kSectionMm = 2;             // between a curve's sections
constexpr double kReachMm = 4.5;             // from a tube's surface, what is looked at
constexpr double kSharpen = 0.85, kEdgeMm = 1.4;   // of the picture's edges from step to step; of the sharpest
constexpr int kStepsABackground = 3;
constexpr int kSectors = 24;
constexpr int kWays = 5;                     // in which a section can change
constexpr double kRingFromMm = 1, kRingToMm = 2.5;                 // around a tube, where its surroundings are measured
constexpr double kBoneHu = 180;                                  // more than that counts neither as cartilage nor as surroundings
// What is darker counts as that: fat behind a thin muscle would make the muscle look like cartilage, and draw the tube into it.
constexpr double kDarkestHu = 20;
constexpr double kLeastContrastHu = 36;      // of cartilage to its surroundings
constexpr double kMuscleBelowHu = 45;        // what cartilage is brighter than muscle
constexpr double kModelError = 0.3;          // of the picture, against 1
constexpr double kControlMm = 15;
constexpr int kMostControls = 10;
constexpr double kLongestMoveMm = 2, kWidestTurn = 0.2;            // of a control point, of a section (radians) in one step
// Prices, in the squared differences of the picture times mm^3.
constexpr double kBendPrice = 1e5;           // mm^7, of the squared third derivative by arc length, for each mm
constexpr double kStartPrice = 40, kEndPrice = 25, kGivenPrice = 1e4;   // for each mm^2 off the rib's end, the place of the joint
constexpr double kSizePrice = 100, kTurnPrice = 40, kFixedPrice = 1e9;  // of a size by e times too large; of a turn by a radian
constexpr double kMovePrice = 2;             // for each mm^2 of a control point, in one step

// A plane across a tube, and the ellipse of the tube in it.
struct Section {
  Vec3 centre, along, high, thin;     // mm; unit vectors: along the tube, along the longer and the shorter axis
  double halfHighMm = 0, halfThinMm = 0;
  BasisWeights basis;                 // of the centre in the control points
};

struct Tube {
  Course* course = nullptr;
  Curve curve;
  Vec3 start;                         // where its rib ends
  int first = 0, firstSection = 0;    // of its control points, of its sections, among all
  std::array<double, 3> turn{};       // of its sections against the wall, radians: Bernstein coefficients along it
  std::vector<Section> sections;      // equally spaced in u, always as many
  std::vector<float> around;          // what surrounds it, HU: sections x sectors
  double hu = 0;                      // its own median
};

// A block near a tube.
struct Near {
  int block, tube, next;              // next: another one of that block, or -1
  int section, sector;
  float u, outside;                   // along the tube; distance to its surface, mm, negative inside
  float thicker, turned;              // how far the surface there moves outwards if the tube is thicker by e, turned by a radian
  Vec3 normal;
  bool isBeyondEnd;
};

std::array<double, 3> bernstein(double u) { return {(1 - u) * (1 - u), 2 * u * (1 - u), u * u}; }

double medianOf(std::vector<float>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class JointFit {
 public:
  JointFit(const WallVoxels& voxels, const WallNormal& wall, std::vector<Course>& courses, double scale, double cartilageHu)
      : usualScale_(scale), usualHu_(cartilageHu), wall_(wall), voxels_(voxels), heads_(voxels.count(), -1), nearest_(voxels.count(), {1e300, -1}) {
    for (Course& c : courses) {
      Tube tube;
      tube.course = &c;
      tube.curve = fitCurve(resamplePolyline(c.line, 40), std::clamp(int(polylineLength(c.line) / kControlMm) + 3, 5, kMostControls));
      tube.start = tube.curve.at(0);
      tube.first = controls_;
      tube.hu = cartilageHu;
      tube.sections.resize(std::max(6, int(std::lround(tube.curve.length() / kSectionMm)) + 1));
      tube.firstSection = sections_;
      sections_ += int(tube.sections.size());
      controls_ += int(tube.curve.controls.size());
      tubes_.push_back(std::move(tube));
    }
  }

  void run(int steps, bool isShapeFree) {
    for (int step = 0; step < steps; ++step) {
      findNear();
      if (step % kStepsABackground == 0) measureTissue();
      move(isShapeFree);
      for (Tube& tube : tubes_) tube.course->edgeMm = std::max(kEdgeMm, kSharpen * tube.course->edgeMm);
    }
    findNear();
    measureLikeness();
    for (Tube& tube : tubes_) tube.course->line = tube.curve.sample(60);
  }

 private:
  // The sections of a tube where it now lies.
  void cutSections(Tube& tube) {
    const int count = int(tube.sections.size());
    const std::vector<Vec3> line = tube.curve.sample(count);
    for (int n = 0; n < count; ++n) {
      Section& s = tube.sections[n];
      const double u = double(n) / (count - 1);
      s.basis = basis(tube.curve.knots, tube.curve.degree, u);
      s.centre = line[n];
      s.along = normalized(line[std::min(n + 1, count - 1)] - line[std::max(n - 1, 0)]);
      const Vec3 out = wall_(line[n]);
      const std::array<double, 3> part = bernstein(u);
      const double turn = tube.turn[0] * part[0] + tube.turn[1] * part[1] + tube.turn[2] * part[2];
      const Vec3 thin = normalized(out - s.along * dot(out, s.along));
      s.thin = thin * std::cos(turn) + cross(s.along, thin) * std::sin(turn);
      s.high = cross(s.along, s.thin);
      const SectionSize size = sectionSize(u, usualScale_ * std::exp(growth_));
      s.halfHighMm = size.halfHighMm, s.halfThinMm = size.halfThinMm;
    }
  }

  // Where a block lies in a tube, of which `section` is the nearest.
  Near place(int block, int t, int section) const {
    const Tube& tube = tubes_[t];
    const Section& s = tube.sections[section];
    const int last = int(tube.sections.size()) - 1;
    const Vec3 p = voxels_.position(block);
    // Its foot lies between two sections.
    const double along = dot(p - s.centre, s.along);
    const int other = std::clamp(along > 0 ? section + 1 : section - 1, 0, last);
    const double step = distance(tube.sections[other].centre, s.centre), part = step > 0 ? std::min(1.0, std::abs(along) / step) : 0;
    const Vec3 q = p - lerp(s.centre, tube.sections[other].centre, part);
    // First-order distance to the ellipse, and its normal.
    const double x = dot(q, s.high), y = dot(q, s.thin), a = s.halfHighMm, b = s.halfThinMm;
    const double u = x / a, v = y / b, k = std::sqrt(u * u + v * v), slope = std::max(1e-6, std::sqrt(u * u / (a * a) + v * v / (b * b)));
    const Vec3 normal = (s.high * (x / (a * a)) + s.thin * (y / (b * b))) / slope;
    Near near{block, t, -1, section, 0, float((section + part * (other - section)) / last), float(k > 1e-3 ? k * (k - 1) / slope : -b),
              float(dot(q, normal)), float(dot(normal, cross(s.along, q))), normal, false};
    near.isBeyondEnd = other == section && std::abs(along) > 0.5;
    near.sector = int((std::atan2(v, u) / (2 * M_PI) + 1) * kSectors) % kSectors;
    return near;
  }

  // All blocks near tubes; those of one block are chained from its head.
  void findNear() {
    for (int block : blocks_) heads_[block] = -1;
    blocks_.clear(), near_.clear();
    std::vector<int> touched;
    for (int t = 0; t < int(tubes_.size()); ++t) {
      cutSections(tubes_[t]);
      touched.clear();
      for (int n = 0; n < int(tubes_[t].sections.size()); ++n)
        voxels_.around(tubes_[t].sections[n].centre, tubes_[t].sections[n].halfHighMm + kReachMm, [&](int block, double square) {
          if (!voxels_.isKnown(block)) return;
          auto& [least, section] = nearest_[block];
          if (section < 0) touched.push_back(block);
          if (square < least) least = square, section = n;
        });
      for (int block : touched) {
        Near near = place(block, t, nearest_[block].second);
        nearest_[block] = {1e300, -1};
        if (near.outside > kReachMm) continue;
        near.next = heads_[block];
        if (near.next < 0) blocks_.push_back(block);
        heads_[block] = int(near_.size());
        near_.push_back(near);
      }
    }
  }

  // Every tube's own value and what surrounds it; the noise.
  void measureTissue() {
    std::vector<float> noises;
    for (int t = 0; t < int(tubes_.size()); ++t) {
      Tube& tube = tubes_[t];
      const int count = int(tube.sections.size());
      std::vector<double> sum(std::size_t(count) * kSectors), weight(sum.size());
      std::vector<float> core;
      for (const Near& near : near_) {
        if (near.tube != t || near.isBeyondEnd) continue;
        const float hu = voxels_.hu(near.block);
        if (hu > kBoneHu) continue;
        if (near.outside < -2) core.push_back(hu);
        if (near.outside < kRingFromMm || near.outside > kRingToMm || voxels_.isAir(near.block)) continue;
        bool isInOther = false;
        for (int o = heads_[near.block]; o >= 0; o = near_[o].next) isInOther = isInOther || (near_[o].tube != t && near_[o].outside < kRingFromMm);
        if (isInOther) continue;
        sum[near.section * kSectors + near.sector] += std::max(hu, float(kDarkestHu)), weight[near.section * kSectors + near.sector] += 1;
      }
      if (core.size() > 50) {
        const double middle = medianOf(core);
        tube.hu = std::clamp(middle, usualHu_ - 25, usualHu_ + 40);
        for (float& hu : core) hu = std::abs(hu - float(middle));
        noises.push_back(float(1.48 * medianOf(core)));   // a normal distribution's SD
      }
      // Averaged with the sections and directions beside it.
      tube.around.assign(sum.size(), float(tube.hu - kLeastContrastHu));
      for (int n = 0; n < count; ++n)
        for (int m = 0; m < kSectors; ++m) {
          double total = 0, weights = 0;
          for (int dn = -3; dn <= 3; ++dn)
            for (int dm = -1; dm <= 1; ++dm) {
              const int at = std::clamp(n + dn, 0, count - 1) * kSectors + (m + dm + kSectors) % kSectors;
              const double part = 1.0 / ((1 + dn * dn) * (1 + dm * dm));
              total += part * sum[at], weights += part * weight[at];
            }
          float& around = tube.around[n * kSectors + m];
          if (weights > 0.5) around = std::min(around, float(total / weights));
        }
    }
    if (!noises.empty()) noise_ = std::max(3.0, medianOf(noises));
  }

  // How much each looks like cartilage: 1 if it is as bright, and as much brighter than what surrounds it, as cartilage in muscle.
  void measureLikeness() {
    for (int t = 0; t < int(tubes_.size()); ++t) {
      double inside = 0, insides = 0, around = 0, arounds = 0;
      for (const Near& near : near_) {
        if (near.tube != t || near.isBeyondEnd) continue;
        const double hu = std::clamp(double(voxels_.hu(near.block)), usualHu_ - 2 * kMuscleBelowHu, usualHu_ + kMuscleBelowHu);
        if (near.outside < -1) inside += hu, ++insides;
        bool isAlone = near.outside > kRingFromMm && near.outside < kRingToMm;
        for (int o = heads_[near.block]; o >= 0 && isAlone; o = near_[o].next) isAlone = near_[o].tube == t || near_[o].outside > kRingFromMm;
        if (isAlone) around += hu, ++arounds;
      }
      double& likeness = tubes_[t].course->likeness;
      likeness = insides > 0 ? (inside / insides - usualHu_) / kMuscleBelowHu + 1 : 0;
      if (arounds > 0) likeness = std::min(likeness, (inside / insides - around / arounds) / kMuscleBelowHu);
    }
  }

  // One step of Gauss and Newton. Unknown: control points, growth, turns.
  void move(bool isShapeFree) {
    const int growth = 3 * controls_, turns = growth + 1, all = turns + 3 * int(tubes_.size());
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(all, all);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(all);
    const Vec3 block = voxels_.spacing();
    const double volume = block.x * block.y * block.z;

    struct Part {
      double in, slope;
      const Near* near;
      std::array<double, kWays> change;
    };
    struct SectionSum {
      std::array<double, kWays> right{};
      std::array<double, kWays * kWays> normal{};
    };
    std::vector<Part> parts;
    std::vector<SectionSum> sums(sections_);
    for (int b : blocks_) {
      // The picture: in any of the tubes. Beyond a tube's end nobody knows.
      parts.clear();
      bool isBeyondEnd = false, isAtEdge = false;
      double empty = 1;
      const Near* nearest = nullptr;
      for (int o = heads_[b]; o >= 0; o = near_[o].next) {
        const Near& near = near_[o];
        const double width = tubes_[near.tube].course->edgeMm + std::abs(near.normal.z) * voxels_.sliceMm(), in = std::clamp(0.5 - near.outside / width, 0.0, 1.0);
        isBeyondEnd = isBeyondEnd || (near.isBeyondEnd && in > 0);
        isAtEdge = isAtEdge || (in > 0 && in < 1);
        parts.push_back({in, in > 0 && in < 1 ? 1 / width : 0, &near, {}});
        empty *= 1 - in;
        if (!nearest || near.outside < nearest->outside) nearest = &near;
      }
      if (isBeyondEnd || !isAtEdge) continue;

      // The CT, and the difference.
      const Tube& tube = tubes_[nearest->tube];
      const double around = tube.around[nearest->section * kSectors + nearest->sector], contrast = tube.hu - around;
      const double seen = voxels_.isAir(b) ? 0 : std::clamp((voxels_.hu(b) - around) / contrast, -0.5, 1.5);
      const double noise = noise_ / contrast, weight = volume * kModelError * kModelError / (kModelError * kModelError + noise * noise);
      const double difference = seen - (1 - empty);

      // How the picture changes there, summed up for each section; where tubes overlap, also between them.
      for (Part& p : parts) {
        double change = p.slope;
        for (const Part& q : parts)
          if (&q != &p) change *= 1 - q.in;
        const Near& near = *p.near;
        p.change = {change * near.normal.x, change * near.normal.y, change * near.normal.z, change * near.turned, change * near.thicker};
        p.slope = change;
        if (change == 0) continue;
        SectionSum& sum = sums[tubes_[near.tube].firstSection + near.section];
        for (int i = 0; i < kWays; ++i) {
          sum.right[i] += weight * p.change[i] * difference;
          for (int j = 0; j < kWays; ++j) sum.normal[i * kWays + j] += weight * p.change[i] * p.change[j];
        }
      }
      for (const Part& p : parts)
        for (const Part& q : parts) {
          if (&p == &q || p.slope * q.slope < 1e-8) continue;
          std::array<double, kWays * kWays> product;
          for (int i = 0; i < kWays; ++i)
            for (int j = 0; j < kWays; ++j) product[i * kWays + j] = weight * p.change[i] * q.change[j];
          addProduct(*p.near, *q.near, product, normal);
        }
    }
    for (int t = 0; t < int(tubes_.size()); ++t)
      for (int n = 0; n < int(tubes_[t].sections.size()); ++n) {
        Near here{};
        here.tube = t, here.section = n;
        const SectionSum& sum = sums[tubes_[t].firstSection + n];
        addProduct(here, here, sum.normal, normal);
        for (const auto& [way, unknown, part] : unknownsOf(here)) right[unknown] += part * sum.right[way];
      }

    for (const Tube& tube : tubes_) holdTube(tube, normal, right);
    for (int i = 0; i < growth; ++i) normal(i, i) += kMovePrice;
    normal(growth, growth) += isShapeFree ? kSizePrice : kFixedPrice;
    right[growth] -= kSizePrice * growth_;
    for (std::size_t t = 0; t < tubes_.size(); ++t)
      for (int i = 0, at = turns + 3 * int(t); i < 3; ++i, ++at) {
        normal(at, at) += isShapeFree ? kTurnPrice : kFixedPrice;
        right[at] -= kTurnPrice * tubes_[t].turn[i];
      }

    const Eigen::VectorXd by = normal.ldlt().solve(right);
    growth_ += by[growth];
    for (std::size_t t = 0; t < tubes_.size(); ++t) {
      Tube& tube = tubes_[t];
      for (int i = 0; i < 3; ++i) tube.turn[i] += std::clamp(by[turns + 3 * int(t) + i], -kWidestTurn, kWidestTurn);
      for (std::size_t i = 0; i < tube.curve.controls.size(); ++i) {
        const int at = 3 * (tube.first + int(i));
        const Vec3 d{by[at], by[at + 1], by[at + 2]};
        tube.curve.controls[i] += d * std::min(1.0, kLongestMoveMm / std::max(1e-12, norm(d)));
      }
    }
  }

  // A section's ways to change (its centre's three coordinates, turn, size) as parts of the unknowns.
  struct Unknown {
    int way, unknown;
    double part;
  };
  std::array<Unknown, 16> unknownsOf(const Near& near) const {
    const Tube& tube = tubes_[near.tube];
    const Section& section = tube.sections[near.section];
    const std::array<double, 3> turn = bernstein(double(near.section) / double(tube.sections.size() - 1));
    std::array<Unknown, 16> list;
    for (int i = 0; i < 4; ++i)
      for (int a = 0; a < 3; ++a) list[3 * i + a] = {a, 3 * (tube.first + section.basis.first + i) + a, section.basis.weights[i]};
    for (int i = 0; i < 3; ++i) list[12 + i] = {3, 3 * controls_ + 1 + 3 * near.tube + i, turn[i]};
    list[15] = {4, 3 * controls_, 1};
    return list;
  }
  void addProduct(const Near& p, const Near& q, const std::array<double, kWays * kWays>& product, Eigen::MatrixXd& normal) const {
    const std::array<Unknown, 16> rows = unknownsOf(p), columns = unknownsOf(q);
    for (const Unknown& column : columns)
      for (const Unknown& row : rows) normal(row.unknown, column.unknown) += row.part * column.part * product[row.way * kWays + column.way];
  }

  // What keeps a tube smooth and its ends in place.
  void holdTube(const Tube& tube, Eigen::MatrixXd& normal, Eigen::VectorXd& right) const {
    const int count = int(tube.curve.controls.size());
    std::array<double, kMostControls> row;
    // price * |sum of row * controls - target|^2
    const auto hold = [&](Vec3 target, double price) {
      for (int i = 0; i < count; ++i) target -= tube.curve.controls[i] * row[i];
      for (int i = 0; i < count; ++i)
        for (int a = 0; a < 3 && row[i] != 0; ++a) {
          right[3 * (tube.first + i) + a] += price * row[i] * target[a];
          for (int j = 0; j < count; ++j) normal(3 * (tube.first + i) + a, 3 * (tube.first + j) + a) += price * row[i] * row[j];
        }
    };
    // Third differences of 40 equal pieces.
    constexpr int kPieces = 40;
    static constexpr double kThird[4] = {-1, 3, -3, 1};
    const double h = tube.curve.length() / kPieces;
    for (int n = 0; n + 3 <= kPieces; ++n) {
      row.fill(0);
      for (int m = 0; m < 4; ++m) {
        const BasisWeights b = basis(tube.curve.knots, tube.curve.degree, double(n + m) / kPieces);
        for (int i = 0; i < 4; ++i) row[b.first + i] += kThird[m] * b.weights[i];
      }
      hold({}, kBendPrice / std::pow(h, 5));
    }
    row.fill(0), row[0] = 1;
    hold(tube.start, kStartPrice);
    row.fill(0), row[count - 1] = 1;
    hold(endOf(tube), tube.course->isEndGiven ? kGivenPrice : kEndPrice);
  }

  // Where a tube should end: at the notch, or anywhere on the cartilage that it joins.
  Vec3 endOf(const Tube& tube) const {
    for (const Tube& upper : tubes_)
      if (tube.course->joins > 0 && upper.course->rib == tube.course->joins) return upper.curve.at(upper.curve.closest(tube.curve.at(1)));
    return tube.course->end;
  }

  double usualScale_, usualHu_, growth_ = 0, noise_ = 18;   // growth: of all tubes, as a logarithm
  const WallNormal& wall_;
  const WallVoxels& voxels_;
  std::vector<Tube> tubes_;
  int controls_ = 0, sections_ = 0;                // of all tubes
  std::vector<Near> near_;
  std::vector<int> blocks_, heads_;                // those near a tube; the first one of near_ of each, or -1
  std::vector<std::pair<double, int>> nearest_;    // while searching: squared distance, section
};

}  // namespace

void fitJointly(const WallVoxels& voxels, const WallNormal& wall, std::vector<Course>& courses, double scale, double cartilageHu, int steps,
                bool isShapeFree) {
  JointFit(voxels, wall, courses, scale, cartilageHu).run(steps, isShapeFree);
}

}  // namespace pectora
