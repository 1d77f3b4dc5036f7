#include "app/view/panels/corrections_panel.h"

#include "app/view/panels/widgets.h"

#include <cmath>

namespace pectora::view {
namespace {

constexpr double kRibReach = 12;   // from a rib's middle line to a click that means it, mm

const Notch* notchOf(const Anatomy& anatomy, const RibName& rib) {
  for (const Notch& notch : anatomy.sternum.notches)
    if (rib.number > 0 && notch.side == rib.side && notch.rib == rib.number) return &notch;
  return nullptr;
}

// Its number, as a list of those that are free on its side.
void numberList(Context& context, const Anatomy& anatomy, std::optional<RibName>& rib) {
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.45f);
  if (ImGui::BeginCombo("Number", rib->number > 0 ? std::to_string(rib->number).c_str() : "?", ImGuiComboFlags_HeightLargest)) {
    for (int n = 1; n <= 12; ++n) {
      const bool isHere = n == rib->number, isTaken = !isHere && anatomy.rib(rib->side, n);
      const std::string text = std::to_string(n) + (isTaken ? " (taken)" : "");
      if (ImGui::Selectable(text.c_str(), isHere, isTaken ? ImGuiSelectableFlags_Disabled : 0) && !isHere) {
        addCorrection(context.choices, ribRenumbered(*rib, n));
        rib->number = n;
        context.changed(false);
      }
      mark("correct.number." + std::to_string(n));
    }
    ImGui::EndCombo();
  } else {
    mark("correct.number");
  }
}

}  // namespace

void drawJoint(const JointHandle& joint, ImVec2 at, float scale, const std::string& picture) {
  const float em = ImGui::GetFontSize(), radius = 0.36f * em;
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddCircleFilled(at, radius, joint.isHeld ? IM_COL32(255, 220, 130, 255) : IM_COL32(250, 160, 70, 255));
  list->AddCircle(at, radius, IM_COL32(20, 22, 26, 255), 0, 1.5f * scale);
  const ImVec2 text{at.x + radius + 0.4f * em, at.y - 0.5f * em}, wide = ImGui::CalcTextSize(joint.name.c_str());
  list->AddRectFilled({text.x - 0.2f * em, text.y}, {text.x + wide.x + 0.2f * em, text.y + wide.y}, IM_COL32(24, 28, 33, 210), 3);
  list->AddText(text, IM_COL32(255, 200, 130, 255), joint.name.c_str());
  markPlace(picture + "." + joint.name, {at.x - radius, at.y - radius}, {2 * radius, 2 * radius});
}

std::optional<Vec3> CorrectionsPanel::controls(Context& context) {
  const Anatomy* anatomy = context.results->anatomyValue();
  if (!anatomy) return {};
  std::optional<Vec3> goTo;
  heading("Correct by hand");
  ImGui::Checkbox("Ribs and their joints", &isOn_);
  mark("correct");
  if (isOn_) {
    const Rib* rib = rib_ ? findRib(*anatomy, *rib_) : nullptr;
    if (!rib && !context.activity.isBusy) rib_.reset();
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("##rib", rib_ ? ribText(*rib_).c_str() : "Choose a rib", ImGuiComboFlags_HeightLargest)) {
      for (const Rib& one : anatomy->ribs) {
        const RibName name = nameOf(one);
        const std::string text = ribText(name);
        if (ImGui::Selectable((text + "##" + std::to_string(name.near.z)).c_str(), rib_ == name)) {
          rib_ = name;
          if (!one.centerline.empty()) goTo = one.centerline.back();
        }
        mark("correct." + text);
      }
      ImGui::EndCombo();
    } else {
      mark("correct.rib");
    }
    if (!rib) note("Click a rib in the picture, or choose it here. Its joints can then be drawn to where they belong.");
    if (rib) {
      numberList(context, *anatomy, rib_);
      const ImVec2 half{(ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2, 0};
      const auto place = [&](const char* label, const char* name, const Vec3* at) {
        ImGui::BeginDisabled(!at);
        if (button(label, name, half)) goTo = *at;
        ImGui::EndDisabled();
      };
      const Notch* notch = notchOf(*anatomy, *rib_);
      place("Its junction", "correct.junction", rib->centerline.empty() ? nullptr : &rib->centerline.back());
      hint("Where the rib ends and its cartilage begins: shows it in the picture, to be drawn with the mouse");
      ImGui::SameLine();
      place("Its notch", "correct.notch", notch ? &notch->position : nullptr);
      hint("Where its cartilage joins the sternum: shows it in the picture, to be drawn with the mouse");
      if (button("It is no rib: leave it out", "correct.drop", {-1, 0})) {
        addCorrection(context.choices, ribDropped(*rib_));
        rib_.reset();
        context.changed(false);
      }
    }
  }

  // What was corrected; each can be taken back, and undo does so step by step.
  auto& made = context.choices.corrections;
  for (std::size_t i = 0; i < made.size(); ++i) {
    ImGui::PushID(int(i));
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(correctionText(made[i]).c_str());
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::GetFrameHeight());
    const bool isForgotten = button("×", "correct.forget." + std::to_string(i), {ImGui::GetFrameHeight(), 0});
    hint("Take this correction back");
    ImGui::PopID();
    if (!isForgotten) continue;
    made.erase(made.begin() + std::ptrdiff_t(i));
    context.changed(false);
    break;
  }
  return goTo;
}

const Rib* CorrectionsPanel::chosen(const Context& context) const {
  const Anatomy* anatomy = context.results->anatomyValue();
  return isOn_ && rib_ && anatomy ? findRib(*anatomy, *rib_) : nullptr;
}

std::vector<JointHandle> CorrectionsPanel::handles(const Context& context) const {
  std::vector<JointHandle> list;
  const Rib* rib = chosen(context);
  if (!rib) return list;
  const auto add = [&](const char* name, Joint joint, Vec3 at) {
    const bool isHeld = held_ == joint;
    list.push_back({name, joint, isHeld ? heldAt_ : at, isHeld});
  };
  if (rib->number > 0 && !rib->centerline.empty()) add("junction", Joint::junction, rib->centerline.back());
  if (const Notch* notch = notchOf(*context.results->anatomyValue(), *rib_)) add("notch", Joint::notch, notch->position);
  return list;
}

void CorrectionsPanel::take(const JointHandle& joint, Vec3 at) {
  isMoved_ = false;
  held_ = joint.joint;
  heldAt_ = joint.at;
  grabbedBy_ = at - joint.at;
}

void CorrectionsPanel::chooseAt(const Context& context, Vec3 at) {
  const Anatomy* anatomy = context.results->anatomyValue();
  if (!anatomy) return;
  double nearest = kRibReach;
  for (const Rib& rib : anatomy->ribs)
    for (const Vec3& p : rib.centerline)
      if (distance(p, at) < nearest) nearest = distance(p, at), rib_ = nameOf(rib);
}

void CorrectionsPanel::hold(Vec3 at) {
  if (!held_) return;
  const Vec3 now = at - grabbedBy_;
  isMoved_ = isMoved_ || distance(now, heldAt_) > 1e-6;
  heldAt_ = now;
}

void CorrectionsPanel::release(Context& context) {
  if (held_ && isMoved_ && rib_) {
    addCorrection(context.choices, jointMoved(*held_, *rib_, heldAt_));
    context.changed(false);
  }
  held_.reset();
}

}  // namespace pectora::view
