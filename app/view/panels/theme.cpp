#include "app/view/panels/widgets.h"

#include <filesystem>

namespace pectora::view {
namespace {

Fonts loaded;

ImFont* load(const char* file, float pixels) {
  // Latin, Greek, the signs of units, arrows and the few marks that the panels use.
  static const ImWchar ranges[] = {0x20, 0xFF, 0x370, 0x3FF, 0x2010, 0x2027, 0x2190, 0x21FF, 0x2212, 0x2212, 0x25A0, 0x25FF, 0x2713, 0x2717, 0};
  const std::string path = std::string("/usr/share/fonts/truetype/dejavu/") + file;
  ImGuiIO& io = ImGui::GetIO();
  if (std::filesystem::exists(path)) return io.Fonts->AddFontFromFileTTF(path.c_str(), pixels, nullptr, ranges);
  ImFontConfig plain;
  plain.SizePixels = pixels;
  return io.Fonts->AddFontDefault(&plain);
}

}  // namespace

const Fonts& fonts() { return loaded; }

void applyTheme(float scale) {
  loaded.text = load("DejaVuSans.ttf", std::round(14.5f * scale));
  loaded.bold = load("DejaVuSans-Bold.ttf", std::round(14.f * scale));
  loaded.title = load("DejaVuSans.ttf", std::round(24.f * scale));
  loaded.mono = load("DejaVuSansMono.ttf", std::round(13.f * scale));

  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  ImGui::StyleColorsDark(&style);
  style.WindowRounding = 0;
  style.FrameRounding = style.GrabRounding = style.PopupRounding = 4;
  style.ChildRounding = 0;
  style.WindowBorderSize = 0;
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 7};
  style.WindowPadding = {14, 12};
  style.GrabMinSize = 12;
  style.ScrollbarSize = 12;
  const auto set = [&](int index, float r, float g, float b, float a = 1) { style.Colors[index] = {r, g, b, a}; };
  set(ImGuiCol_Text, 0.90f, 0.92f, 0.94f);
  set(ImGuiCol_TextDisabled, kMuted.x, kMuted.y, kMuted.z);
  set(ImGuiCol_WindowBg, 0.125f, 0.141f, 0.161f);
  set(ImGuiCol_ChildBg, 0, 0, 0, 0);
  set(ImGuiCol_PopupBg, 0.16f, 0.18f, 0.205f);
  set(ImGuiCol_Border, 0.25f, 0.28f, 0.31f);
  set(ImGuiCol_FrameBg, 0.20f, 0.225f, 0.255f);
  set(ImGuiCol_FrameBgHovered, 0.24f, 0.27f, 0.305f);
  set(ImGuiCol_FrameBgActive, 0.26f, 0.30f, 0.34f);
  set(ImGuiCol_SliderGrab, 0.22f, 0.43f, 0.46f);   // dark enough for the value that is written over it
  set(ImGuiCol_SliderGrabActive, 0.26f, 0.52f, 0.55f);
  set(ImGuiCol_CheckMark, kAccent.x, kAccent.y, kAccent.z);
  set(ImGuiCol_Button, 0.235f, 0.268f, 0.305f);
  set(ImGuiCol_ButtonHovered, 0.28f, 0.33f, 0.37f);
  set(ImGuiCol_ButtonActive, 0.24f, 0.45f, 0.48f);
  set(ImGuiCol_Header, 0.20f, 0.24f, 0.275f);
  set(ImGuiCol_HeaderHovered, 0.24f, 0.30f, 0.34f);
  set(ImGuiCol_HeaderActive, 0.24f, 0.36f, 0.40f);
  set(ImGuiCol_Separator, 0.22f, 0.25f, 0.28f);
  set(ImGuiCol_SeparatorHovered, kAccent.x, kAccent.y, kAccent.z, 0.6f);
  set(ImGuiCol_SeparatorActive, kAccent.x, kAccent.y, kAccent.z);
  set(ImGuiCol_ScrollbarBg, 0, 0, 0, 0);
  set(ImGuiCol_PlotLines, kAccent.x, kAccent.y, kAccent.z);
  set(ImGuiCol_PlotHistogram, kAccent.x, kAccent.y, kAccent.z);
  set(ImGuiCol_TextSelectedBg, kAccent.x, kAccent.y, kAccent.z, 0.4f);
  style.ScaleAllSizes(scale);
}

ImU32 structureColor(const std::string& structure) {
  if (structure == "rib") return IM_COL32(240, 200, 110, 255);
  if (structure == "sternum") return IM_COL32(240, 130, 110, 255);
  if (structure == "skin") return IM_COL32(120, 205, 210, 255);
  if (structure == "pleura") return IM_COL32(150, 215, 130, 255);
  if (structure == "cartilage") return IM_COL32(140, 170, 240, 255);
  return IM_COL32(150, 155, 165, 255);
}

}  // namespace pectora::view
