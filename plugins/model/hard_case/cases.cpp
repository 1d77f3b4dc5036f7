// The table of cases.
#include "plugins/model/hard_case/wall.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

namespace pectora {
namespace {

constexpr double kSpacing = 8, kThickness = 20, kSkin = 200, kWall = 10;

struct Draft {
  HardWall wall;
  HardCase& hard;
  std::mt19937& random;
};

struct Entry {
  const char* name;
  Must must;
  const char* text;
  double lift;                              // mm
  std::function<void(Draft&)> change;
};

void remake(Draft& d, int rows, int columns, double spacing, double thickness, double lift) {
  d.wall = HardWall(rows, columns, spacing, thickness, lift);
  d.wall.callSprings(kSkin, kWall);
}

// Springs through the wall of one modulus on skin of another.
std::function<void(Draft&)> contrast(double skinOverWall) {
  return [skinOverWall](Draft& d) {
    d.wall.scene->effects.clear();
    d.wall.callSprings(std::clamp(kWall * skinOverWall, 1e-6, 1e9), std::max(kWall, 1e-6));
  };
}

// One effect with a constant that is none.
std::function<void(Draft&)> constant(double stiffness) {
  return [stiffness](Draft& d) { d.wall.callEffect("effect.stretch", {{"stiffness", stiffness}}); };
}

// Every point of the start away from rest by up to `part` of the spacing.
void shake(Draft& d, double part) {
  std::uniform_real_distribution<double> by(-part * kSpacing, part * kSpacing);
  Motion& start = d.wall.startAtRest();
  for (auto* layer : {&start.outer, &start.inner})
    for (Vec3& p : *layer) p += Vec3{by(d.random), by(d.random), by(d.random)};
}

void moveEverything(Draft& d, Vec3 by) {
  Scene& scene = *d.wall.scene;
  for (auto* layer : {&scene.outer, &scene.inner})
    for (Vec3& p : *layer) p += by;
  for (Anchor& anchor : scene.anchors) anchor.rest += by;
  d.wall.plan->motion.pivot += by;
}

const std::vector<Entry>& table() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN(), kEndless = std::numeric_limits<double>::infinity();
  static const std::vector<Entry> entries{
      {"coincident_pair", Must::tell, "two skin points lie in one place", 10,
       [](Draft& d) { Scene& s = *d.wall.scene; s.outer[s.index(s.rows / 2, 1)] = s.outer[s.index(s.rows / 2, 0)]; }},
      {"zero_length", Must::settle, "every attachment has no length at rest", 10,
       [](Draft& d) { for (Anchor& a : d.wall.scene->anchors) a.rest = d.wall.scene->inner[a.point]; }},
      {"inverted_prism", Must::flag, "a skin point lies behind the pleura at rest", 0,
       [](Draft& d) { Scene& s = *d.wall.scene; s.outer[s.index(s.rows / 2, s.columns / 2)].y = 0.5 * kThickness; }},
      {"contrast_1e-3", Must::settle, "the wall is a thousand times stiffer than the skin", 10, contrast(1e-3)},
      {"contrast_1e3", Must::settle, "the skin is a thousand times stiffer than the wall", 10, contrast(1e3)},
      {"contrast_1e6", Must::tell, "the skin is a million times stiffer than the wall", 10, contrast(1e6)},
      {"contrast_1e9", Must::tell, "the skin is 1e8 times stiffer than the wall, as far as settings go", 10, contrast(1e9)},
      {"mass_contrast", Must::tell, "one point weighs a million times as much as another", 10,
       [](Draft& d) { Scene& s = *d.wall.scene; s.outerMass[0] *= 1e3; s.outerMass[1] *= 1e-3; }},
      {"zero_mass", Must::refuse, "a point weighs nothing", 10, [](Draft& d) { d.wall.scene->outerMass[3] = 0; }},
      {"negative_mass", Must::refuse, "a point weighs less than nothing", 10, [](Draft& d) { d.wall.scene->innerMass[2] = -1e-3; }},
      {"mass_not_a_number", Must::refuse, "a mass is not a number", 10, [kNone](Draft& d) { d.wall.scene->outerMass[1] = kNone; }},
      {"long_time_step", Must::settle, "steps in time a thousand times too long: explicit solvers refuse them, implicit ones do not mind", 10,
       [](Draft& d) { d.hard.timeStep = 5; }},
      {"noise", Must::recover, "the start is rest, its skin shaken by half a spacing", 0, [](Draft& d) { shake(d, 0.5); d.wall.start->inner = d.wall.scene->inner; }},
      {"noise_of_a_spacing", Must::tell, "the same by a whole spacing, from where a corner may settle elsewhere", 0, [](Draft& d) { shake(d, 1); d.wall.start->inner = d.wall.scene->inner; }},
      {"strong_noise", Must::tell, "the start is rest, shaken by four spacings", 0, [](Draft& d) { shake(d, 4); }},
      {"shuffle", Must::tell, "the start has the skin's points in any order", 0,
       [](Draft& d) { Motion& start = d.wall.startAtRest(); std::shuffle(start.outer.begin(), start.outer.end(), d.random); }},
      {"collapse_to_plane", Must::tell, "the start has the skin in the pleura", 0, [](Draft& d) { Motion& m = d.wall.startAtRest(); m.outer = m.inner; }},
      {"collapse_to_line", Must::tell, "the start has every point on one line", 0,
       [](Draft& d) { Motion& m = d.wall.startAtRest(); for (auto* l : {&m.outer, &m.inner}) for (Vec3& p : *l) p = {p.x, 0, 0}; }},
      {"collapse_to_point", Must::tell, "the start has every point in one place", 0,
       [](Draft& d) { Motion& m = d.wall.startAtRest(); for (auto* l : {&m.outer, &m.inner}) for (Vec3& p : *l) p = {1, 2, 3}; }},
      {"mirror", Must::flag, "the start is the mirror image of rest, which springs alone cannot tell from it", 0,
       [](Draft& d) { for (Vec3& p : d.wall.startAtRest().outer) p.y = -p.y; }},
      {"far_start", Must::tell, "the start lies a metre away", 0,
       [](Draft& d) { Motion& m = d.wall.startAtRest(); for (auto* l : {&m.outer, &m.inner}) for (Vec3& p : *l) p.x += 1000; }},
      {"one_row", Must::tell, "a single row of points", 5, [](Draft& d) { remake(d, 1, d.wall.scene->columns, kSpacing, kThickness, 5); }},
      {"one_point", Must::tell, "a single point", 5, [](Draft& d) { remake(d, 1, 1, kSpacing, kThickness, 5); }},
      {"island", Must::refuse, "the skin hangs together, but on nothing", 10,
       [](Draft& d) { d.wall.scene->effects.clear(); d.wall.callEffect("effect.stretch"); d.wall.callEffect("effect.attachment"); }},
      {"no_anchors", Must::refuse, "nothing holds the wall", 10, [](Draft& d) { d.wall.scene->anchors.clear(); }},
      {"no_effects", Must::refuse, "the scene calls no effect", 10, [](Draft& d) { d.wall.scene->effects.clear(); }},
      {"lift_80_ramp", Must::tell, "the sternum goes 80 mm forwards", 80, [](Draft&) {}},
      {"lift_80_at_once", Must::tell, "the same in a single step", 80, [](Draft& d) { d.hard.loadStep = 1e6; }},
      {"sunk_80", Must::tell, "the sternum goes 80 mm backwards", -80, [](Draft&) {}},
      {"no_lift", Must::recover, "nothing moves", 0, [](Draft&) {}},
      {"turned_60", Must::tell, "the sternum turns by 60 degrees", 10,
       [](Draft& d) {
         const Scene& s = *d.wall.scene;
         d.wall.plan->motion.pivot = s.inner[s.index(s.rows / 2, s.columns / 2)];
         d.wall.plan->motion.axis = {0, 0, 1};
         d.wall.plan->motion.angle = std::numbers::pi / 3;
       }},
      {"constant_negative", Must::refuse, "a spring constant is negative", 10, constant(-1)},
      {"constant_not_a_number", Must::refuse, "a spring constant is not a number", 10, constant(kNone)},
      {"constant_endless", Must::refuse, "a spring constant is infinite", 10, constant(kEndless)},
      {"place_not_a_number", Must::refuse, "a point has no place", 10, [kNone](Draft& d) { d.wall.scene->outer[2].y = kNone; }},
      {"lift_not_a_number", Must::refuse, "the sternum's way is not a number", 10, [kNone](Draft& d) { d.wall.plan->motion.translation.y = kNone; }},
      {"start_not_a_number", Must::refuse, "the start has a point without a place", 10, [kNone](Draft& d) { d.wall.startAtRest().outer[2].y = kNone; }},
      {"identical_attachments", Must::tell, "the three attachments of a point are one, and are pushed through it", 10,
       [](Draft& d) { auto& a = d.wall.scene->anchors; for (std::size_t j = 0; j < a.size(); ++j) a[j].rest = a[j - j % 3].rest; }},
      {"collinear_attachments", Must::tell, "the three attachments of a point lie on one line, and are pushed through it", 10,
       [](Draft& d) { auto& a = d.wall.scene->anchors; for (std::size_t j = 0; j < a.size(); ++j) a[j].rest = a[j - j % 3].rest + Vec3{0, double(j % 3), 0}; }},
      {"torn_between_bones", Must::tell, "of the three bones that carry a point, and hold it by struts, one goes 80 mm away", 80,
       [](Draft& d) {
         d.wall.callEffect("effect.attachment", {{"youngs_modulus", 1000.0}});
         auto& a = d.wall.scene->anchors;
         for (std::size_t j = 0; j < a.size(); ++j) a[j].body = j % 3 == 0 ? BodyKind::sternum : BodyKind::rib;
       }},
      {"bar_through_skin", Must::tell, "one pleura point is pushed through the skin", 60,
       [](Draft& d) {
         Scene& s = *d.wall.scene;
         for (Anchor& a : s.anchors) a.body = a.point == s.index(s.rows / 2, s.columns / 2) ? BodyKind::sternum : BodyKind::rib;
       }},
      {"far_from_origin", Must::settle, "the patient lies ten metres from the origin", 10, [](Draft& d) { moveEverything(d, {1e4, -1e4, 1e4}); }},
      {"compressed_skin", Must::tell, "the wall is pushed together by 15 %", 0,
       [](Draft& d) {
         Scene& s = *d.wall.scene;
         for (Anchor& a : s.anchors) a.body = 2 * (a.point % s.columns) >= s.columns ? BodyKind::sternum : BodyKind::rib;
         d.wall.plan->motion.translation = {-0.15 * s.columns * kSpacing, 0, 0};
       }},
      {"thick_wall", Must::settle, "the wall is eight times as thick as the points are apart", 10,
       [](Draft& d) { const int n = d.wall.scene->rows; remake(d, n, n, kSpacing, 8 * kSpacing, 10); }},
      {"tiny", Must::tell, "the whole wall is a micrometre wide, so that skin of its usual thickness is 1e8 times stiffer than it", 0,
       [](Draft& d) { const int n = d.wall.scene->rows; remake(d, n, n, 1e-4, 2.5e-4, 1e-4); }},
      {"huge", Must::settle, "the whole wall is kilometres wide, as light as makes it no slower", 0,
       [](Draft& d) {
         const int n = d.wall.scene->rows;
         remake(d, n, n, 1e6, 2.5e6, 1e6);
         for (auto* masses : {&d.wall.scene->outerMass, &d.wall.scene->innerMass})
           for (double& m : *masses) m *= std::pow(kSpacing / 1e6, 2);
         d.hard.loadStep = 1e6;
       }},
      {"keeps_volume", Must::tell, "the cells hardly change their volume: Poisson's ratio 0.4999", 5,
       [](Draft& d) { d.hard.isSpringsAlone = false; d.wall.callEffect("effect.volume", {{"poissons_ratio", 0.4999}}); }},
      {"cell_without_volume", Must::refuse, "a cell that should keep its volume has none", 5,
       [](Draft& d) {
         d.hard.isSpringsAlone = false;
         Scene& s = *d.wall.scene;
         for (int r = 0; r < 2; ++r) for (int c = 0; c < 2; ++c) s.outer[s.index(r, c)] = s.inner[s.index(r, c)];
         d.wall.callEffect("effect.volume");
       }},
      {"heavy", Must::tell, "the wall weighs a hundred times its weight, across what the CT shows", 0,
       [](Draft& d) { d.wall.callEffect("effect.gravity", {{"acceleration", 100.0}, {"posture", std::string("upright")}}); for (auto* masses : {&d.wall.scene->outerMass, &d.wall.scene->innerMass}) for (double& m : *masses) m *= 10; }},
      {"stiffening", Must::tell, "skin that becomes a million times stiffer within a strain of 14 %", 15,
       [](Draft& d) { d.hard.isSpringsAlone = false; d.wall.callEffect("effect.j_curve", {{"exponent", 100.0}, {"most", 1e6}}); }},
      {"behind_the_ribs", Must::tell, "the start has the pleura on the wrong side of the bodies that it must not pass", 10,
       [](Draft& d) {
         d.hard.isSpringsAlone = false;
         d.wall.callEffect("effect.rib_contact", {{"stiffness", 1e4}});
         Motion& start = d.wall.startAtRest();
         for (Vec3& p : start.inner) p.y += 30;
       }},
      {"bar_at_once", Must::settle, "the bar is there at once, and the wall swings undamped for a twentieth of a second", 5,
       [](Draft& d) {
         d.hard.isInTime = true;
         d.wall.callEffect("effect.inertia", {{"duration", 0.05}, {"lifting", 0.0}, {"damping", 0.0}, {"interval", 0.005}});
       }},
      {"swings_through_itself", Must::tell, "the bar is thrown through the wall in a hundredth of a second, and the wall after it", 60,
       [](Draft& d) {
         d.hard.isInTime = true;
         d.wall.callEffect("effect.inertia", {{"duration", 0.1}, {"lifting", 0.01}, {"damping", 5.0}, {"interval", 0.005}});
       }},
      {"all_effects", Must::tell, "every effect at once on a lift of 40 mm", 40,
       [](Draft& d) {
         d.hard.isSpringsAlone = false;
         for (const char* effect : {"effect.volume", "effect.gravity", "effect.j_curve", "effect.rib_contact", "effect.bar_contact", "effect.cartilage_bending",
                                    "effect.bar_compliance", "effect.respiration"})
           d.wall.callEffect(effect);
       }},
  };
  return entries;
}

}  // namespace

const char* mustName(Must must) {
  static constexpr const char* kNames[] = {"recover", "settle", "tell", "flag", "refuse"};
  return kNames[int(must)];
}

std::vector<Fact> HardCase::facts() const {
  return {{"name", name, ""}, {"next", next, ""}, {"text", text, ""}, {"must", mustName(must), ""},
          {"springs_alone", isSpringsAlone ? 1.0 : 0.0, ""}, {"in_time", isInTime ? 1.0 : 0.0, ""}, {"time_step", timeStep, "s"}, {"load_step", loadStep, "mm"}, {"extent", extent, "mm"}};
}

std::vector<std::pair<std::string, std::shared_ptr<const Value>>> HardCase::parts() const {
  return {{"scene", scene}, {"plan", plan}, {"start", start}};
}

std::vector<std::string> hardCaseNames() {
  std::vector<std::string> names;
  for (const Entry& entry : table()) names.push_back(entry.name);
  return names;
}

std::shared_ptr<HardCase> makeHardCase(const std::string& name, int size, unsigned seed) {
  const auto& entries = table();
  const auto entry = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return name == e.name; });
  if (entry == entries.end()) throw std::out_of_range(name);
  auto hard = std::make_shared<HardCase>();
  hard->name = entry->name;
  hard->next = entry + 1 == entries.end() ? "" : (entry + 1)->name;
  hard->text = entry->text;
  hard->must = entry->must;
  std::mt19937 random(seed);
  Draft draft{HardWall(size, size, kSpacing, kThickness, entry->lift), *hard, random};
  draft.wall.callSprings(kSkin, kWall);
  entry->change(draft);
  hard->extent = draft.wall.extent();
  hard->scene = draft.wall.scene;
  hard->plan = draft.wall.plan;
  hard->start = draft.wall.start;
  return hard;
}

}  // namespace pectora
