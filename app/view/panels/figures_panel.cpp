#include "app/view/panels/controls.h"
#include "app/view/panels/widgets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora::view {
namespace {

const double* factOf(const std::vector<Fact>& facts, const std::string& name) {
  for (const Fact& fact : facts)
    if (fact.name == name) return std::get_if<double>(&fact.value);
  return nullptr;
}

// A figure before and after the plan.
void change(const std::vector<Fact>& facts, const char* label, const std::string& name, const char* unit, int digits) {
  const double *before = factOf(facts, name + "_before"), *after = factOf(facts, name);
  if (!before || !after || !std::isfinite(*after)) return;
  row(label, fmt::format("{:.{}f} → {:.{}f}{}", *before, digits, *after, digits, unit));
}

// How far the energy is from its end over the iterations, logarithmic over eight decades.
void energyCurve(const Motion& motion, float scale) {
  const auto& history = motion.energyHistory;
  if (history.size() < 3) return;
  heading("Energy, from its end");
  const ImVec2 low = ImGui::GetCursorScreenPos(), size{ImGui::GetContentRegionAvail().x, 70 * scale};
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(low, {low.x + size.x, low.y + size.y}, IM_COL32(24, 28, 33, 255), 4);
  double most = 1e-300;
  for (double e : history) most = std::max(most, std::abs(e - history.back()));
  const auto height = [&](double e) { return std::max(0.0, 1 + std::log10(std::max(1e-300, std::abs(e - history.back()) / most)) / 8); };
  std::vector<ImVec2> line;
  const std::size_t step = std::max<std::size_t>(1, history.size() / 400);
  for (std::size_t i = 0; i < history.size(); i += step)
    line.push_back({low.x + 6 + (size.x - 12) * float(i) / float(history.size() - 1), low.y + size.y - 6 - (size.y - 12) * float(height(history[i]))});
  list->AddPolyline(line.data(), int(line.size()), ImGui::GetColorU32(kAccent), 0, 1.5f * scale);
  ImGui::Dummy(size);
  hint(fmt::format("From {:.4g} to {:.4g} N mm over {} iterations; the height is the distance to the end, over eight decades. Load steps raise it again.", history.front(), history.back(), motion.iterations));
}

// At the beginning of a line; what follows stands beside it.
void progressBar(double fraction) {
  const float width = 14 * ImGui::GetFontSize(), top = ImGui::GetCursorScreenPos().y + ImGui::GetFrameHeight() * 0.35f, height = ImGui::GetFrameHeight() * 0.3f;
  const float left = ImGui::GetCursorScreenPos().x, done = std::max(height, width * float(std::clamp(fraction, 0.0, 1.0)));
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled({left, top}, {left + width, top + height}, IM_COL32(50, 57, 65, 255), height / 2);
  list->AddRectFilled({left, top}, {left + done, top + height}, ImGui::GetColorU32(kAccent), height / 2);
  ImGui::Dummy({width, ImGui::GetFrameHeight()});
  ImGui::SameLine();
}

// A line that is cut where it does not fit; its tooltip has all of it.
void cutLine(const std::string& text, float room, const ImVec4& color) {
  std::string shown = text.substr(0, text.find('\n'));
  const auto isWide = [&] { return ImGui::CalcTextSize((shown + "…").c_str()).x > room; };
  const bool isCut = shown != text || isWide();
  // Letter by letter, which in UTF-8 end with their first byte.
  for (bool isWhole = true; !shown.empty() && (!isWhole || isWide());) {
    isWhole = (static_cast<unsigned char>(shown.back()) & 0xC0) != 0x80;
    shown.pop_back();
  }
  ImGui::TextColored(color, "%s%s", shown.c_str(), isCut ? "…" : "");
  if (isCut) hint(text);
}

}  // namespace

void figuresPanel(Context& context) {
  const Results& r = *context.results;
  if (r.planValue()) {
    const std::vector<Fact>& facts = context.planFacts;
    heading("Plan");
    change(facts, "Haller index", "haller_index", "", 2);
    change(facts, "Correction index", "correction_index", " %", 1);
    change(facts, "Depression", "depression", " mm", 1);
    hint("How far the sternum's back lies behind the most forward inner wall, at the deepest level");
    row("Lift of the sternum", fmt::format("{:.1f} mm", r.planValue()->lift()));
    if (const double* strain = factOf(facts, "worst_cartilage_strain"))
      row("Worst cartilage strain", fmt::format("{:+.1f} %", *strain), std::abs(*strain) > 5 ? &kWarm : nullptr);
  } else if (const Anatomy* anatomy = r.anatomyValue()) {
    heading("Patient");
    if (const LevelMetrics* level = anatomy->deepestLevel()) {
      row("Haller index", fmt::format("{:.2f}", level->haller()));
      row("Correction index", fmt::format("{:.1f} %", level->correctionIndex()));
      row("Depression", fmt::format("{:.1f} mm", level->depression()));
    }
  }

  // Of a result folder there are its skins.
  const Mesh *before = Results::as<Mesh>(r.before), *after = Results::as<Mesh>(r.after);
  if (before && after) {
    heading("A result folder");
    double most = 0;
    for (std::size_t i = 0; i < before->points.size(); ++i) most = std::max(most, distance(before->points[i], after->points[i]));
    row("Greatest movement", fmt::format("{:.1f} mm", most));
    row("Skin points", std::to_string(before->points.size()));
    note("To move the bar, open the script that made it.");
  }

  if (const Motion* motion = r.motionValue()) {
    heading("Predicted skin");
    const bool isGood = motion->status == SolveStatus::converged;
    row("Solver", std::string(statusName(motion->status)), r.isPreview ? &kMuted : isGood ? &kGood : &kBad);
    if (!motion->message.empty()) note(motion->message);
    if (const double* moved = factOf(context.motionFacts, "greatest_skin_displacement")) row("Greatest movement", fmt::format("{:.1f} mm", *moved));
    if (r.planValue()) {
      const bool isLess = motion->lift < r.planValue()->lift() - 0.05;
      row("Lift reached", isLess ? fmt::format("{:.1f} of {:.1f} mm", motion->lift, r.planValue()->lift()) : fmt::format("{:.1f} mm", motion->lift), isLess ? &kWarm : nullptr);
      hint("How far the bar brings the deepest point of the sternum: less than planned where effect.bar_compliance lets it bend");
    }
    std::string forces;
    for (const double force : motion->barForces) forces += fmt::format("{}{:.0f} N", forces.empty() ? "" : ", ", force);
    row(motion->barForces.size() > 1 ? "Force on the bars" : "Force on the bar", forces.empty() ? "–" : forces);
    hint("Of the chest on each bar; effect.cartilage_bending knows it");
    row("Residual", fmt::format("{:.1e}", motion->relativeResidual));
    row("Iterations", std::to_string(motion->iterations));
    if (motion->invertedPrisms > 0) row("Cells inside out", std::to_string(motion->invertedPrisms), &kBad);
    if (r.sceneValue()) row("Skin points", std::to_string(r.sceneValue()->points()));
    if (r.motion.record) row("Time from rest", fmt::format("{:.0f} ms", 1000 * r.motion.record->seconds));
    if (r.liveMs > 0) {
      row("Time while moving", fmt::format("{:.0f} ms", r.liveMs));
      hint(fmt::format("From the change to the new skin; {:.1f} ms of it are the solver's", r.solveMs));
    }
    if (r.settled >= 0) {
      row("Live against rest", fmt::format("{:.2f} mm", r.settled), r.settled > 0.5 ? &kWarm : nullptr);
      hint("How far the skin that was shown while you moved something lay, at most, from the one that a script finds from rest. "
           "At large lifts the wall can settle in more than one way.");
    }
    energyCurve(*motion, context.scale);
  }

  if (const Comparison* c = r.comparisonValue()) {
    heading("Against the scan");
    const DistanceStatistics& s = c->pit.count > 0 ? c->pit : c->overlap;
    row(c->pit.count > 0 ? "RMS in the pit" : "RMS", fmt::format("{:.2f} mm", s.rms));
    row("Mean (signed)", fmt::format("{:+.2f} mm", s.mean));
    if (std::isfinite(c->skill())) row("Skill", fmt::format("{:.2f}", c->skill()));
    hint("1: as the scan; 0: no better than the unchanged chest");
    if (r.isLive) note("of the skin before it was moved");
  }
}

void statusLine(Context& context) {
  const Activity& activity = context.activity;
  const Results& r = *context.results;
  const bool isUnfinished = !activity.isBusy && r.ct.value && (!r.motion.value || r.isPreview);
  const char* disclaimer = "Research software, not a medical device";
  const float end = ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(disclaimer).x;
  const auto room = [&] { return end - ImGui::GetCursorPosX() - 2 * ImGui::GetFontSize(); };
  ImGui::AlignTextToFramePadding();
  if (context.turntable) {
    progressBar(double(context.turntable->drawn) / Turntable::kPictures);
    if (button("Cancel", "cancel")) context.turntable.reset();
    ImGui::SameLine();
    ImGui::TextColored(kMuted, "turntable");
  } else if (activity.isBusy && activity.seconds > (activity.isLive ? 0.5 : 0.15)) {
    progressBar(activity.fraction);
    if (activity.seconds > 0.5) {
      if (button("Cancel", "cancel")) context.worker().cancel();
      ImGui::SameLine();
    }
    cutLine(activity.what.empty() ? activity.stage : activity.stage + ": " + activity.what, room(), kMuted);
  } else if (!r.error.empty() || !context.message.empty()) {
    cutLine(context.message.empty() ? r.error : context.message, room(), kBad);
  } else {
    cutLine(isUnfinished ? "Not finished" : !context.notice.empty() ? context.notice : r.motion.value || r.after.value ? "Ready" : "", room(), kMuted);
    if (isUnfinished) {
      ImGui::SameLine();
      if (button("Go on", "resume")) context.changed(false);
    }
  }
  ImGui::SameLine(end);
  ImGui::TextColored(kMuted, "%s", disclaimer);
}

}  // namespace pectora::view
