// What accuracy costs in time, in the present scene: errors of solvers against their time, both logarithmic.
#include "app/view/panels/controls.h"
#include "app/view/panels/widgets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora::view {
namespace {

constexpr double kScannerNoise = 0.6;   // mm, what a scan repeats to: below it nothing is gained
const ImVec4 kColors[] = {{0.36f, 0.70f, 0.72f, 1}, {0.95f, 0.70f, 0.35f, 1}, {0.62f, 0.58f, 0.90f, 1}, {0.55f, 0.80f, 0.45f, 1}, {0.93f, 0.50f, 0.55f, 1}};

// Solvers in the order in which the study has them.
std::vector<std::string> solversOf(const Study& study) {
  std::vector<std::string> names;
  for (const StudyPoint& p : study.points)
    if (std::find(names.begin(), names.end(), p.solver) == names.end()) names.push_back(p.solver);
  return names;
}

ImU32 colorOf(const std::vector<std::string>& solvers, const std::string& solver) {
  const auto at = std::find(solvers.begin(), solvers.end(), solver) - solvers.begin();
  return ImGui::ColorConvertFloat4ToU32(kColors[std::size_t(at) % std::size(kColors)]);
}

std::string shortName(const std::string& id) { return id.substr(id.find('.') + 1); }

// "0.01", "1e-04".
std::string power(int exponent) { return exponent >= -2 && exponent <= 4 ? fmt::format("{:g}", std::pow(10.0, exponent)) : fmt::format("1e{}", exponent); }

// A logarithmic axis: whole decades that hold all values.
struct Decades {
  int low = 99, high = -99;
  void hold(double value) {
    low = std::min(low, int(std::floor(std::log10(value))));
    high = std::max({high, low + 1, int(std::ceil(std::log10(value)))});
  }
  float part(double value) const { return float((std::log10(value) - low) / (high - low)); }
};

double seen(double error) { return std::max(error, 1e-4); }   // what is nearer than that lies on the edge

}  // namespace

void accuracyControls(Context& context) {
  heading("Accuracy and time");
  note("Solves the present scene with four solvers at several tolerances, and measures each skin against one that is solved far finer. "
       "Of the solver alone: what the model leaves out is not in it.");
  ImGui::BeginDisabled(!context.results->motionValue() || context.activity.isBusy);
  if (button("Study this scene", "study", {-1, 0})) context.studyScene();
  ImGui::EndDisabled();
  if (!context.study) return;

  const Study& study = *context.study;
  note("Reference: " + study.reference);
  for (const std::string& solver : solversOf(study)) {
    heading(readable(shortName(solver)).c_str());
    for (const StudyPoint& p : study.points) {
      if (p.solver != solver) continue;
      const bool isGood = p.status == SolveStatus::converged;
      row(fmt::format("{}{:.0e}", p.isPresent ? "this run, " : "", p.tolerance).c_str(),
          fmt::format("{} ms   {} mm{}", figure(p.milliseconds), figure(p.rms), isGood ? "" : std::string("   ") + statusName(p.status)), isGood ? nullptr : &kWarm);
    }
  }
  for (const auto& [solver, why] : study.refused) {
    heading(readable(shortName(solver)).c_str());
    note(why.substr(0, why.find('\n')));
  }
}

void accuracyPicture(Context& context, float width, float height) {
  const float em = ImGui::GetFontSize();
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (!context.study) {
    emptyPlace(context.results->motionValue() ? "Study this scene, at the left, shows here what accuracy costs in time." : "Open a patient first.", width, height);
    return;
  }
  const Study& study = *context.study;
  const std::vector<std::string> solvers = solversOf(study);
  Decades time, error{-2, 0};
  for (const StudyPoint& p : study.points) time.hold(std::max(p.milliseconds, 0.01)), error.hold(seen(p.rms));

  // The axes, a line for each decade.
  const ImVec2 low{corner.x + 5.5f * em, corner.y + 4.8f * em}, high{corner.x + width - 2 * em, corner.y + height - 4 * em};
  const auto x = [&](double ms) { return low.x + (high.x - low.x) * time.part(std::max(ms, 0.01)); };
  const auto y = [&](double mm) { return high.y - (high.y - low.y) * error.part(seen(mm)); };
  const ImU32 grid = IM_COL32(58, 65, 74, 255), ink = IM_COL32(200, 206, 212, 255);
  for (int d = time.low; d <= time.high; ++d) {
    const float at = x(std::pow(10.0, d));
    list->AddLine({at, low.y}, {at, high.y}, grid);
    const std::string text = power(d);
    list->AddText({at - ImGui::CalcTextSize(text.c_str()).x / 2, high.y + 0.4f * em}, ink, text.c_str());
  }
  for (int d = error.low; d <= error.high; ++d) {
    const float at = y(std::pow(10.0, d));
    list->AddLine({low.x, at}, {high.x, at}, grid);
    const std::string text = power(d);
    list->AddText({low.x - ImGui::CalcTextSize(text.c_str()).x - 0.5f * em, at - em / 2}, ink, text.c_str());
  }
  const char *across = "time from rest, ms", *title = "Distance from the finest skin, RMS over the pit, mm (0.0001 or less on the lower edge)";
  list->AddText({(low.x + high.x - ImGui::CalcTextSize(across).x) / 2, high.y + 1.9f * em}, ink, across);
  list->AddText({low.x, corner.y + 0.8f * em}, ink, title);

  // The scanner's noise: what is below it no scan can tell.
  const float noise = y(kScannerNoise);
  for (float at = low.x; at < high.x; at += em) list->AddLine({at, noise}, {std::min(at + em / 2, high.x), noise}, ImGui::GetColorU32(kMuted), 1.5f * context.scale);
  const char* told = "noise of a scanner, 0.6 mm";
  list->AddText({low.x + 0.4f * em, noise - 1.3f * em}, ImGui::GetColorU32(kMuted), told);

  // A line for each solver, from coarse to fine, named at its finest.
  for (const std::string& solver : solvers) {
    std::vector<ImVec2> line;
    for (const StudyPoint& p : study.points)
      if (p.solver == solver && !p.isPresent) line.push_back({x(p.milliseconds), y(p.rms)});
    list->AddPolyline(line.data(), int(line.size()), colorOf(solvers, solver), 0, 2 * context.scale);
  }
  for (const StudyPoint& p : study.points) {
    const ImVec2 at{x(p.milliseconds), y(p.rms)};
    const float radius = 0.33f * em;
    const ImU32 color = colorOf(solvers, p.solver);
    if (p.isPresent) {
      list->AddCircle(at, 2.1f * radius, IM_COL32(255, 255, 255, 255), 0, 2 * context.scale);
      const char* name = "this run";
      const float wide = ImGui::CalcTextSize(name).x, beside = at.x + 2.6f * radius;   // on the left where the right is too near
      list->AddText({beside + wide < corner.x + width ? beside : at.x - 2.6f * radius - wide, at.y - 1.6f * em}, IM_COL32(255, 255, 255, 255), name);
    } else if (p.status == SolveStatus::converged) {
      list->AddCircleFilled(at, radius, color);
    } else {
      list->AddCircle(at, radius, color, 0, 2 * context.scale);
    }
    if (ImGui::IsMouseHoveringRect({at.x - radius, at.y - radius}, {at.x + radius, at.y + radius}))
      ImGui::SetTooltip("%s to %.0e: %.3g ms, %.3g mm, %s", p.solver.c_str(), p.tolerance, p.milliseconds, p.rms, statusName(p.status));
  }

  // The legend.
  float at = high.x;
  for (auto solver = solvers.rbegin(); solver != solvers.rend(); ++solver) {
    const std::string name = readable(shortName(*solver));
    at -= ImGui::CalcTextSize(name.c_str()).x;
    list->AddText({at, corner.y + 2.4f * em}, ink, name.c_str());
    at -= 0.8f * em;
    list->AddCircleFilled({at, corner.y + 2.9f * em}, 0.33f * em, colorOf(solvers, *solver));
    at -= 1.2f * em;
  }
  ImGui::Dummy({width, height});
  mark("accuracy.picture");
}

}  // namespace pectora::view
