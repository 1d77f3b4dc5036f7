#include "plugins/planner/nuss/bar.h"
#include "plugins/planner/nuss/motion.h"

#include "kernel/stage/plugin.h"

#include <fmt/format.h>

#include <cmath>

namespace {
using namespace pectora;

constexpr int kFrames = 11;
constexpr double kStrainWarning = 0.05;

class Nuss final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.real("lift", lift_, "mm", {0, 120}, {0, 60}, "How far the bar brings the sternum forward: its deepest point, or the one at level");
    v.real("correction", correction_, "", {0, 1.5}, {0, 1}, "Lift as a part of the pit's depth (1: level with the most forward inner wall); 0: as lift says");
    v.real("level", level_, "mm", {-150, 150}, {-40, 40}, "Height of the bar above (+) or below (-) the deepest point of the sternum");
    v.real("tilt", tilt_, "deg", {-45, 45}, {-30, 30}, "How the bar lies across the chest, seen from the front: the patient's left end higher (+) or lower (-)");
    v.real("second_level", secondLevel_, "mm", {-150, 150}, {-80, 80}, "Height of a second bar above (+) or below (-) the first; 0: there is none");
    v.real("second_lift", secondLift_, "mm", {0, 120}, {0, 60}, "How far a second bar brings the sternum forward there; the two lifts then turn and shift it, whatever the pivot");
    v.real("second_tilt", secondTilt_, "deg", {-45, 45}, {-30, 30}, "As tilt, of the second bar");
    v.choice("pivot", pivot_, {"sternoclavicular", "manubrium"}, "Axis that one bar turns the sternum about: above the sternum, as measured elevations say, or the manubrial joint of the paper");
    v.real("pivot_distance", pivotDistance_, "mm", {40, 1000}, {100, 250}, "How far the sternoclavicular axis lies above the lifted point");
    v.real("bar_width", bar_.width, "mm", {1, 40}, {10, 16}, "Width of the bar, along the body's axis");
    v.real("bar_height", bar_.height, "mm", {0.5, 20}, {2, 5}, "Thickness of the bar");
    v.real("bar_flat", bar_.flat, "mm", {0, 120}, {20, 40}, "Length of the bar's straight part behind the sternum");
  }

  Outputs run(const Inputs& inputs, Host& host) override {
    auto plan = std::make_shared<Plan>();
    plan->cage = inputs.get<RibCage>("cage");
    const Anatomy& anatomy = *plan->cage->anatomy;
    const Sternum& sternum = anatomy.sternum;
    if (sternum.contours.empty())
      throw Error("no sternum was found, so nothing can be lifted").advise("Use a CT that holds the body of the sternum");
    const Vec3 point = pointAtLevel(anatomy);

    // The lift, in mm or as a part of the pit.
    double lift = lift_;
    if (correction_ > 0) {
      const LevelMetrics* level = anatomy.deepestLevel();
      if (!level) throw Error("the pit's depth is not known, so no part of it can be lifted").of("correction").advise("Give lift in mm");
      lift = correction_ * std::max(0.0, level->deepestInnerWall - level->sternumToVertebra);
    }

    // The sternum's way: one point and the axis fix it, or two points.
    const Vec3 axis = pivotPoint(sternum, point, pivot_ == "manubrium" ? Pivot::manubrium : Pivot::sternoclavicular, pivotDistance_);
    const bool hasSecond = secondLevel_ != 0;
    const Vec3 secondPoint = hasSecond ? frontAt(sternum, point.x, point.z + secondLevel_, "second_level", secondLevel_) : point;
    plan->motion = hasSecond ? liftBoth({point, lift}, {secondPoint, secondLift_}, axis, bar_.width) : liftRotation(point, lift, axis);
    plan->frames = motionFrames(*plan->cage, plan->motion, kFrames);
    plan->bars.push_back(shapeBar(*plan->cage, point, lift, plan->motion, tilt_, bar_));
    if (hasSecond) plan->bars.push_back(shapeBar(*plan->cage, secondPoint, secondLift_, plan->motion, secondTilt_, bar_));

    std::string strained;
    for (std::size_t i = 0; i < plan->cage->cartilages.size(); ++i) {
      const Cartilage& c = plan->cage->cartilages[i];
      const double strain = plan->frames.back()[i].strain;
      if (std::abs(strain) > kStrainWarning)
        strained += fmt::format("{}{} {} by {:+.0f} %", strained.empty() ? "" : ", ", sideName(c.side), c.rib, 100 * strain);
    }
    if (!strained.empty()) host.warn("these cartilages would be strained if their ribs stood still, as they do here (in a body the upper ribs come along): " + strained);
    return {plan};
  }

 private:
  // The deepest point of the pit, or the sternum's front at the wanted level.
  Vec3 pointAtLevel(const Anatomy& anatomy) const {
    const Vec3 deepest = deepestOfPit(anatomy);
    if (level_ == 0) return deepest;
    return frontAt(anatomy.sternum, deepest.x, deepest.z + level_, "level", level_);
  }

  // The sternum's front over a bar; `parameter` with its value is what brought the bar there.
  static Vec3 frontAt(const Sternum& sternum, double x, double z, const char* parameter, double value) {
    const Vec3 front = frontOfSternum(sternum, x, z);
    if (!std::isfinite(front.y))
      throw Error("the sternum does not reach to that level").of(parameter).given(fmt::format("{:g} mm", value)).advise("Bring the bar closer to the deepest point");
    return front;
  }

  double lift_ = 30, correction_ = 0, level_ = 0, tilt_ = 0, secondLevel_ = 0, secondLift_ = 20, secondTilt_ = 0, pivotDistance_ = 160;
  std::string pivot_ = "sternoclavicular";
  BarSettings bar_;
};

}  // namespace

PECTORA_STAGE(Nuss, {.id = "planner.nuss", .version = "1.1",
                     .summary = "The Nuss operation: one bar or two behind the sternum lift it, cartilages follow",
                     .references = "Nuss 1998; Moreira et al., SPIE 2012; measured elevations PMID 33742267",
                     .inputs = {{"cage", {"RibCage"}}},
                     .outputs = {{"plan", {"Plan"}}}})
