#include "app/view/panels/widgets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pectora::view {
namespace {

std::map<std::string, ImVec4> marks;

// The item under the mouse that has a tooltip.
constexpr double kRest = 0.4;   // s, until it is shown
struct Hovered {
  std::string text;
  ImVec2 at;                    // its upper left corner
  int frame = 0;                // in which it was last hovered
  double since = 0;             // the mouse has rested on it
  bool isPressed = false, isShown = false;
} hovered;

// The text field grows with its text.
int growText(ImGuiInputTextCallbackData* data) {
  auto& text = *static_cast<std::string*>(data->UserData);
  if (data->EventFlag == ImGuiInputTextFlags_CallbackResize) {
    text.resize(std::size_t(data->BufTextLen));
    data->Buf = text.data();
  }
  return 0;
}

// Constants over decades are set on a logarithmic slider.
bool isLogarithmic(const Parameter& p) {
  if (p.usual.low > 0) return p.usual.high / p.usual.low >= 50;
  return p.unit == "N/mm" && p.usual.low == 0;
}

// So many digits as the slider's range calls for, and those that the value has beyond.
std::string numberFormat(const Parameter& p, double value) {
  const double span = p.usual.high - p.usual.low;
  int digits = p.type == "integer" || span > 50 ? 0 : span > 5 ? 1 : 2;
  const auto shows = [&] { return std::abs(value - std::round(value * std::pow(10, digits)) / std::pow(10, digits)) < 1e-9; };
  while (p.type != "integer" && digits < 2 && !shows()) ++digits;
  std::string format = isLogarithmic(p) ? "%.3g" : fmt::format("%.{}f", digits);
  if (p.unit.empty()) return format;
  std::string unit = p.unit;
  for (std::size_t at = 0; (at = unit.find('%', at)) != std::string::npos; at += 2) unit.insert(at, "%");
  return format + " " + unit;
}

}  // namespace

void mark(const std::string& name) {
  const ImVec2 low = ImGui::GetItemRectMin(), size = ImGui::GetItemRectSize();
  if (ImGui::IsItemVisible()) marks[name] = {low.x, low.y, size.x, size.y};
}
void markPlace(const std::string& name, ImVec2 low, ImVec2 size) { marks[name] = {low.x, low.y, size.x, size.y}; }
const std::map<std::string, ImVec4>& markedItems() { return marks; }
void forgetMarks() { marks.clear(); }

void heading(const char* text) {
  ImGui::Dummy({0, ImGui::GetFontSize() * 0.15f});
  ImGui::PushFont(fonts().bold);
  ImGui::TextUnformatted(text);
  ImGui::PopFont();
}

void note(const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, kMuted);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

std::string readable(const std::string& name) {
  std::string text = name;
  std::replace(text.begin(), text.end(), '_', ' ');
  if (text == "bmi" || text == "fov") return text == "bmi" ? "BMI" : "Field of view";
  if (text == "lbfgs") return "L-BFGS";
  if (const auto at = text.find(" haller"); at != std::string::npos) text[at + 1] = 'H';
  if (text.starts_with("youngs")) text = "young's" + text.substr(6);
  if (text.starts_with("poissons")) text = "poisson's" + text.substr(8);
  if (!text.empty()) text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string figure(double value) {
  const double size = std::abs(value);
  if (!std::isfinite(value)) return "–";
  if (size != 0 && (size < 1e-3 || size >= 1e6)) return fmt::format("{:.1e}", value);
  return size >= 100 ? fmt::format("{:.0f}", value) : size >= 10 ? fmt::format("{:.1f}", value) : size >= 0.1 || size == 0 ? fmt::format("{:.2f}", value) : fmt::format("{:.3f}", value);
}

void row(const char* name, const std::string& value, const ImVec4* color) {
  ImGui::TextColored(kMuted, "%s", name);
  const float width = ImGui::CalcTextSize(value.c_str()).x;
  ImGui::SameLine(std::max(ImGui::GetCursorPosX(), ImGui::GetWindowContentRegionMax().x - width));
  if (color) ImGui::TextColored(*color, "%s", value.c_str());
  else ImGui::TextUnformatted(value.c_str());
}

void hint(const std::string& text) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  const double now = ImGui::GetTime();
  const int frame = ImGui::GetFrameCount();
  const ImVec2 at = ImGui::GetItemRectMin();
  const bool wasHovered = hovered.frame == frame || hovered.frame + 1 == frame;
  if (!wasHovered || hovered.text != text || hovered.at.x != at.x || hovered.at.y != at.y) hovered = {text, at, frame, now};
  hovered.frame = frame;
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  if (!hovered.isShown && (moved.x != 0 || moved.y != 0)) hovered.since = now;
  hovered.isPressed = hovered.isPressed || ImGui::IsAnyMouseDown();
  hovered.isShown = !hovered.isPressed && now - hovered.since >= kRest;
  if (!hovered.isShown) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  markPlace("tooltip", ImGui::GetWindowPos(), ImGui::GetWindowSize());
  ImGui::EndTooltip();
}

double untilHint() {
  const bool isWaiting = hovered.frame == ImGui::GetFrameCount() && !hovered.isShown && !hovered.isPressed;
  return isWaiting ? std::max(0.01, kRest - (ImGui::GetTime() - hovered.since)) : 1e9;
}

void emptyPlace(const char* text, float width, float height) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddText({corner.x + (width - ImGui::CalcTextSize(text).x) / 2, corner.y + height * 0.45f}, ImGui::GetColorU32(kMuted), text);
  ImGui::Dummy({width, height});
}

bool textField(const char* label, const char* ghost, std::string& text, ImGuiInputTextFlags flags) {
  return ImGui::InputTextWithHint(label, ghost, text.data(), text.capacity() + 1, flags | ImGuiInputTextFlags_CallbackResize, growText, &text);
}

bool button(const std::string& label, const std::string& name, ImVec2 size) {
  const bool isPressed = ImGui::Button(label.c_str(), size);
  mark(name);
  return isPressed;
}

void parameterControl(Context& context, const Parameter& p, Settings& settings, const std::string& name) {
  const SettingValue* changed = find(settings, p.name);
  SettingValue value = changed ? *changed : p.value;
  ImGui::PushID(name.c_str());
  const float width = ImGui::GetContentRegionAvail().x, labelWidth = width * 0.42f, resetWidth = ImGui::GetFrameHeight();
  const float controlWidth = width - labelWidth - resetWidth - ImGui::GetStyle().ItemSpacing.x * 0.5f;

  // The name, cut where it is too long; the tooltip has the rest.
  ImGui::AlignTextToFramePadding();
  const ImVec2 start = ImGui::GetCursorScreenPos();
  ImGui::PushClipRect(start, {start.x + labelWidth - 6, start.y + ImGui::GetFrameHeight()}, true);
  ImGui::TextUnformatted(readable(p.name).c_str());
  ImGui::PopClipRect();
  const std::string allowed = allowedText(p);
  hint(p.doc + (allowed.empty() ? "" : "\n" + allowed) + "\nDefault: " + canonicalText(p.value) + (p.unit.empty() ? "" : " " + p.unit));
  ImGui::SameLine(ImGui::GetCursorPosX() + labelWidth);
  ImGui::SetCursorScreenPos({start.x + labelWidth, start.y});
  ImGui::SetNextItemWidth(controlWidth);

  bool isEdited = false, isDragged = false;
  if (auto* flag = std::get_if<bool>(&value)) {
    isEdited = ImGui::Checkbox("##control", flag);
  } else if (auto* number = std::get_if<double>(&value)) {
    const bool hasRange = std::isfinite(p.usual.low) && std::isfinite(p.usual.high);
    const double low = hasRange ? std::min(p.usual.low, *number) : 0, high = hasRange ? std::max(p.usual.high, *number) : 0;
    const int flags = isLogarithmic(p) ? ImGuiSliderFlags_Logarithmic : 0;
    isEdited = ImGui::SliderScalar("##control", ImGuiDataType_Double, number, &low, &high, numberFormat(p, *number).c_str(), flags);
    isDragged = ImGui::IsItemActive();
    if (p.type == "integer") *number = std::round(*number);
    *number = std::clamp(*number, p.hard.low, p.hard.high);
  } else if (auto* text = std::get_if<std::string>(&value)) {
    if (p.type == "choice") {
      if (ImGui::BeginCombo("##control", text->empty() ? "(default)" : text->c_str())) {
        for (const std::string& option : p.allowed) {
          if (ImGui::Selectable(option.empty() ? "(default)" : option.c_str(), option == *text)) *text = option, isEdited = true;
          mark(name + "." + option);
        }
        ImGui::EndCombo();
      }
    } else {
      textField("##control", "", *text);
      isEdited = ImGui::IsItemDeactivatedAfterEdit();
      if (!isEdited && ImGui::IsItemActive()) assign(settings, p.name, *text);   // keeps what is being typed
    }
  } else {
    note("set in scripts");
  }
  mark(name);
  if (ImGui::IsItemHovered() && !isDragged) hint(p.doc + (p.type == "number" ? "\nCtrl+click to type a value." : ""));
  const bool hasEnded = ImGui::IsItemDeactivatedAfterEdit();
  if (isEdited && value != p.value) assign(settings, p.name, value);
  if (isEdited && value == p.value) reset(settings, p.name);
  if (isEdited || hasEnded) context.changed(isDragged && !hasEnded);

  // Back to the default.
  if (find(settings, p.name)) {
    ImGui::SameLine(0, ImGui::GetStyle().ItemSpacing.x * 0.5f);
    if (button("\u21BA", name + ".reset", {resetWidth, 0})) {
      reset(settings, p.name);
      context.changed(false);
    }
    hint("Back to the default");
  }
  ImGui::PopID();
}

void parameterControls(Context& context, PluginChoice& plugin, const std::string& name, const std::vector<std::string>& hidden) {
  for (const Parameter& p : context.catalog.parameters(plugin.id)) {
    if (p.role != TextRole::plain || p.name == kAcceptUnconverged || std::find(hidden.begin(), hidden.end(), p.name) != hidden.end()) continue;
    parameterControl(context, p, plugin.settings, name + "." + p.name);
  }
}

}  // namespace pectora::view
