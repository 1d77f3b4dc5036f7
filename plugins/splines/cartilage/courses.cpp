#include "plugins/splines/cartilage/courses.h"

#include "plugins/splines/cartilage/fit.h"
#include "plugins/splines/cartilage/guess.h"
#include "plugins/splines/cartilage/joint_fit.h"

#include <algorithm>
#include <optional>

namespace pectora {
namespace {

constexpr int kControls = 8, kSamples = 40;      // of a cartilage
constexpr double kGuessedJoin = 0.6;             // where a false rib's cartilage joins the one above, before it is fitted
constexpr double kLeastLikeness = 0.25;          // of a fitted cartilage: halfway to muscle, with some room for noise
constexpr double kMostGrowth = 1.3;              // of a fitted cartilage over the guess: more is a loop
constexpr int kFirstSteps = 12, kStepsForEach = 6, kLastSteps = 8;   // of fitting: those of the sternum, one more, all
constexpr int kLastTrueRib = 7, kLastFalseRib = 10;
constexpr double kMarginMm = 30;                 // around the guesses, what is looked at in a chest of usual size
constexpr double kRibMm = 9;                     // around a rib's line, what is not

class CourseFinder {
 public:
  CourseFinder(Side side, const std::vector<RibCurve>& ribs, const Anatomy& anatomy, const Volume* ct, const WallNormal& wall,
               const CageSettings& settings, const std::function<void()>& poll)
      : side_(side), ribs_(ribs), anatomy_(anatomy), ct_(ct), wall_(wall), settings_(settings), poll_(poll),
        scale_(chestScale(anatomy.pleura)) {}

  SideCourses find() {
    addTrueRibs();
    fit(kFirstSteps, false);
    for (int number = kLastTrueRib + 1; number <= kLastFalseRib; ++number)
      if (addFalseRib(number)) fit(kStepsForEach, false);
    fit(kLastSteps, true);
    SideCourses found{{}, missing_};
    for (std::size_t n = 0; n < courses_.size(); ++n) {
      if (courses_[n].isEndGiven) courses_[n].line.back() = courses_[n].end;
      found.courses.push_back({courses_[n].rib, courses_[n].joins, curveOf(n), isSeen(n)});
    }
    return found;
  }

 private:
  // The curve of a rib whose junction was found.
  const Curve* ribCurve(int number) const {
    const Rib* rib = anatomy_.rib(side_, number);
    if (!rib || !rib->reachesJunction) return nullptr;
    const auto curve = std::find_if(ribs_.begin(), ribs_.end(), [&](const RibCurve& r) { return r.side == side_ && r.number == number; });
    return curve == ribs_.end() ? nullptr : &curve->curve;
  }

  // Those that reach the sternum, of the shape that fits the CT best.
  void addTrueRibs() {
    std::vector<Ends> ends;
    for (int number = 1; number <= kLastTrueRib; ++number) {
      const auto notch = std::find_if(anatomy_.sternum.notches.begin(), anatomy_.sternum.notches.end(),
                                      [&](const Notch& n) { return n.side == side_ && n.rib == number; });
      const Curve* rib = ribCurve(number);
      if (!rib || notch == anatomy_.sternum.notches.end()) {
        missing_.push_back(number);
        continue;
      }
      ends.push_back({rib->at(1), normalized(rib->derivative(1)), notch->position, arrivalAtSternum(side_, number)});
      courses_.push_back({.rib = number, .joins = 0, .isEndGiven = notch->isGiven, .line = {}, .end = notch->position});
      addGuess(ends.back(), {});
    }
    if (!ct_ || courses_.empty()) return;
    lookAround();
    const SideShape shape = bestShape(ends, settings_.handle, anatomy_, *voxels_, settings_.cartilageHu, scale_);
    guesses_.clear();
    for (std::size_t n = 0; n < courses_.size(); ++n) addGuess(ends[n], shape);
  }

  // One that joins the cartilage above; false if it cannot be built.
  bool addFalseRib(int number) {
    const Curve* rib = ribCurve(number);
    if (!rib || courses_.empty() || courses_.back().rib != number - 1) {
      missing_.push_back(number);
      return false;
    }
    const Curve upper = curveOf(courses_.size() - 1);
    const Vec3 end = upper.at(kGuessedJoin);
    courses_.push_back({.rib = number, .joins = number - 1, .line = {}, .end = end});
    addGuess({rib->at(1), normalized(rib->derivative(1)), end, normalized(upper.derivative(kGuessedJoin))}, {});
    return true;
  }

  // The guess for the next course that has none yet.
  void addGuess(const Ends& ends, const SideShape& shape) {
    std::vector<Vec3>& line = courses_[guesses_.size()].line;
    line = guessCourse(ends, shape, settings_.handle, anatomy_);
    guesses_.push_back(fitCurve(line, kControls));
  }

  // The CT around where the cartilages of this side may run.
  void lookAround() {
    std::vector<Vec3> points;
    for (const Course& course : courses_) points.insert(points.end(), course.line.begin(), course.line.end());
    for (int number = kLastTrueRib + 1; number <= kLastFalseRib; ++number)
      if (const Curve* rib = ribCurve(number)) points.push_back(rib->at(1));
    voxels_.emplace(*ct_, anatomy_, points, kMarginMm * scale_, kRibMm * scale_);
  }

  void fit(int steps, bool isShapeFree) {
    poll_();
    if (voxels_) fitJointly(*voxels_, wall_, courses_, scale_, settings_.cartilageHu, steps, isShapeFree);
  }

  bool isSeen(std::size_t n) const {
    return voxels_ && courses_[n].likeness > kLeastLikeness && polylineLength(courses_[n].line) < kMostGrowth * guesses_[n].length();
  }
  Curve curveOf(std::size_t n) const { return isSeen(n) ? fitCurve(resamplePolyline(courses_[n].line, kSamples), kControls) : guesses_[n]; }

  Side side_;
  const std::vector<RibCurve>& ribs_;
  const Anatomy& anatomy_;
  const Volume* ct_;
  const WallNormal& wall_;
  const CageSettings& settings_;
  const std::function<void()>& poll_;
  double scale_;
  std::optional<WallVoxels> voxels_;   // with a CT and a cartilage that reaches the sternum
  std::vector<Course> courses_;
  std::vector<Curve> guesses_;           // of each course
  std::vector<int> missing_;
};

}  // namespace

SideCourses findCourses(Side side, const std::vector<RibCurve>& ribs, const Anatomy& anatomy, const Volume* ct, const WallNormal& wall,
                        const CageSettings& settings, const std::function<void()>& poll) {
  return CourseFinder(side, ribs, anatomy, ct, wall, settings, poll).find();
}

}  // namespace pectora
