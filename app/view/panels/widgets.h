// What panels are built of, in one look.
#pragma once

#include "app/view/context.h"

#include <imgui.h>

#include <map>
#include <string>

namespace pectora::view {

struct Fonts {
  ImFont *text = nullptr, *bold = nullptr, *title = nullptr, *mono = nullptr;
};
/// Loads the fonts and sets colours and distances for a scale. Once, after ImGui's context was made.
void applyTheme(float scale);
const Fonts& fonts();

inline const ImVec4 kAccent{0.36f, 0.70f, 0.72f, 1}, kMuted{0.60f, 0.65f, 0.70f, 1}, kWarm{0.95f, 0.70f, 0.35f, 1}, kBad{0.94f, 0.45f, 0.42f, 1},
    kGood{0.48f, 0.78f, 0.55f, 1}, kChosen{0.20f, 0.34f, 0.37f, 1};
/// Colours of structures in slices and legends, by name: "rib", "sternum", "skin", "pleura" ...
ImU32 structureColor(const std::string& structure);

/// Remembers where the last item is, by a name that does not change: for scripted input, in tests and tours.
void mark(const std::string& name);
/// The same for what is drawn without an item of its own.
void markPlace(const std::string& name, ImVec2 low, ImVec2 size);
/// Rectangles of the items that the last frame showed: x, y, width, height in pixels.
const std::map<std::string, ImVec4>& markedItems();
void forgetMarks();

/// A headline within a panel.
void heading(const char* text);
/// A line of muted text that wraps.
void note(const std::string& text);
/// "Young's modulus" of "youngs_modulus".
std::string readable(const std::string& name);
/// "12.3", with the digits that its size calls for.
std::string figure(double value);
/// Name on the left, value on the right of a panel's width.
void row(const char* name, const std::string& value, const ImVec4* color = nullptr);
/// A tooltip of the last item, wrapped. It waits until the mouse rests there, and is gone once a button is pressed: it would cover what
/// comes next.
void hint(const std::string& text);
/// Seconds until a tooltip that waits is due, for a window that draws nothing meanwhile; 1e9: none waits.
double untilHint();
/// Muted text in the middle of a place that is empty.
void emptyPlace(const char* text, float width, float height);
/// A text field over a string.
bool textField(const char* label, const char* ghost, std::string& text, ImGuiInputTextFlags flags = 0);
bool button(const std::string& label, const std::string& name, ImVec2 size = {});

/// A control for one parameter of a plugin, made from its description: slider, check box, choice or text, with unit, doc
/// and reset. Tells the context of every change. `name` begins its mark.
void parameterControl(Context& context, const Parameter& parameter, Settings& settings, const std::string& name);
/// All parameters of a plugin but those in `hidden`.
void parameterControls(Context& context, PluginChoice& plugin, const std::string& name, const std::vector<std::string>& hidden = {});

}  // namespace pectora::view
