#include "app/view/app.h"

#include "app/view/panels/controls.h"
#include "app/view/panels/widgets.h"

#include <fmt/format.h>

#include <algorithm>

namespace pectora::view {
namespace {

constexpr ImGuiWindowFlags kPanelFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
constexpr const char* kTabNames[kTabs] = {"Patient", "Anatomy", "Bar", "Tissue", "Compare", "Accuracy", "Script"};
constexpr const char* kTabMarks[kTabs] = {"tab.patient", "tab.anatomy", "tab.bar", "tab.tissue", "tab.compare", "tab.accuracy", "tab.script"};

}  // namespace

ImGuiHolder::ImGuiHolder() {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;   // the layout is kept by Layout
  ImGui::GetIO().ConfigWindowsMoveFromTitleBarOnly = true;
}

ImGuiHolder::~ImGuiHolder() {
  forgetMarks();
  ImGui::DestroyContext();
}

App::App(Target& target, Registry& registry, std::function<void()> wake) : target_(target), context_(registry, std::move(wake)) {
  applyTheme(target.scale());
  context_.scale = target.scale();
}

void App::keepLayout() {
  std::tie(context_.layout.width, context_.layout.height) = target_.size();
  context_.layout.save();
}

bool App::wantsFrame() const { return settling_ > 0 || isCoarse_ || context_.turntable; }

double App::untilFrame() const { return wantsFrame() ? 0 : untilHint(); }

void App::frame() {
  // What happened since the last one.
  const auto before = context_.results;
  const bool wasBusy = context_.activity.isBusy;
  context_.refresh();
  for (const std::string& path : target_.takeDropped()) context_.open(path);
  settling_ = std::max(0, settling_ - 1);
  if (context_.results != before || wasBusy != context_.activity.isBusy) settling_ = std::max(settling_, 1);

  target_.begin();
  forgetMarks();
  shortcuts();
  const ImGuiIO& io = ImGui::GetIO();
  const float s = context_.scale, width = io.DisplaySize.x, height = io.DisplaySize.y;
  const float top = std::round(44 * s), bottom = std::round(38 * s), middle = height - top - bottom;
  Layout& layout = context_.layout;
  layout.left = std::clamp(layout.left, 240.f, std::max(240.f, (width / s - 300) / 2));
  layout.right = std::clamp(layout.right, 200.f, std::max(200.f, width / s - layout.left - 320));
  const bool isOpen = context_.choices.source != Source::none;
  const float left = std::round(layout.left * s), right = isOpen ? std::round(layout.right * s) : 0, gap = std::round(5 * s);

  const auto panel = [&](const char* name, float x, float y, float w, float h, const ImVec4& color, int flags = 0) {
    ImGui::SetNextWindowPos({x, y});
    ImGui::SetNextWindowSize({w, h});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, color);
    ImGui::Begin(name, nullptr, kPanelFlags | flags);
    ImGui::PopStyleColor();
  };
  constexpr int kFixed = ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;
  const ImVec4 kDark{0.098f, 0.110f, 0.125f, 1}, kPanel{0.125f, 0.141f, 0.161f, 1};
  panel("##top", 0, 0, width, top, kDark, kFixed);
  topBar(width, top);
  ImGui::End();
  panel("##left", 0, top, left, middle, kPanel);
  leftColumn(left, middle);
  ImGui::End();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {6 * s, 6 * s});
  panel("##center", left + gap, top, width - left - right - gap - (isOpen ? gap : 0), middle, kDark, kFixed);
  ImGui::PopStyleVar();
  center(ImGui::GetContentRegionAvail().x, ImGui::GetContentRegionAvail().y);
  ImGui::End();
  if (isOpen) {
    panel("##right", width - right, top, right, middle, kPanel);
    figuresPanel(context_);
    ImGui::End();
  }
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {14 * s, 6 * s});
  panel("##status", 0, height - bottom, width, bottom, kDark, kFixed);
  ImGui::PopStyleVar();
  statusLine(context_);
  ImGui::End();
  splitter("##split.left", left, top, middle, layout.left, 1);
  if (isOpen) splitter("##split.right", width - right - gap, top, middle, layout.right, -1);

  ImGui::Render();
  // What input changed shows fully in the next frame or the one after.
  const bool hasKeys = std::any_of(std::begin(io.KeysDown), std::end(io.KeysDown), [](bool isDown) { return isDown; });
  if (ImGui::IsAnyMouseDown() || ImGui::IsMouseReleased(0) || io.MouseWheel != 0 || hasKeys) settling_ = std::max(settling_, 2);
  target_.end();

  takePictures();
}

void App::takePictures() {
  auto& turn = context_.turntable;
  if (context_.wantedPicture || turn) settling_ = std::max(settling_, 1);   // to tell what became of it
  try {
    if (context_.wantedPicture) {
      const std::string path = *std::exchange(context_.wantedPicture, std::nullopt);
      savePicture(path);
      context_.notice = "The picture is " + path;
    }
    if (!turn) return;
    const int side = int(900 * context_.scale);
    scene_.turntable(context_, turn->folder, turn->drawn++, Turntable::kPictures, side, side);
    if (turn->drawn < Turntable::kPictures) return;
    context_.notice = "The turntable is in " + turn->folder;
    turn.reset();
  } catch (const std::exception& error) {
    // Such as a folder that cannot be written.
    context_.message = error.what();
    turn.reset();
  }
}

void App::savePicture(const std::string& path) const {
  const auto [width, height] = target_.size();
  writePng(path, width, height, target_.pixels());
}

void App::shortcuts() {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantTextInput || !io.KeyCtrl) return;
  // Once a press, however slow the frames are while it lasts.
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Z), false)) io.KeyShift ? context_.redo() : context_.undo();
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Y), false)) context_.redo();
}

void App::topBar(float width, float) {
  const float s = context_.scale;
  ImGui::SetCursorPosY(8 * s);
  ImGui::PushFont(fonts().bold);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Pectora");
  ImGui::PopFont();
  ImGui::SameLine(0, 28 * s);
  const bool isOpen = context_.choices.source != Source::none;
  for (int i = 0; i < kTabs; ++i) {
    const bool isHere = int(context_.tab) == i;
    ImGui::PushStyleColor(ImGuiCol_Button, isHere ? kChosen : ImVec4{0, 0, 0, 0});
    ImGui::PushStyleColor(ImGuiCol_Text, isHere ? ImVec4{1, 1, 1, 1} : isOpen || i == 0 ? ImVec4{0.78f, 0.82f, 0.86f, 1} : kMuted);
    if (button(kTabNames[i], kTabMarks[i])) context_.tab = Tab(i);
    ImGui::PopStyleColor(2);
    ImGui::SameLine(0, 3 * s);
  }

  // Back and forth, and what is open: a folder's name may be a patient's, so it is not shown.
  ImGui::SameLine(0, 24 * s);
  ImGui::BeginDisabled(!context_.history.canUndo());
  if (button("↶", "undo")) context_.undo();
  ImGui::EndDisabled();
  hint("Undo (Ctrl+Z)");
  ImGui::SameLine(0, 3 * s);
  ImGui::BeginDisabled(!context_.history.canRedo());
  if (button("↷", "redo")) context_.redo();
  ImGui::EndDisabled();
  hint("Redo (Ctrl+Y)");
  ImGui::SameLine(0, 12 * s);
  if (button("Screenshot", "screenshot")) context_.takeScreenshot();
  hint("Writes what the window shows into the folder " + context_.outFolder + ", which is chosen under Script");
  std::string what = context_.choices.source == Source::phantom ? "Phantom" : context_.choices.source == Source::result ? "Result" : isOpen ? "CT" : "";
  if (const Volume* volume = context_.results->volume(); volume && isOpen)
    what += fmt::format(" · {} × {} × {}", volume->grid.size[0], volume->grid.size[1], volume->grid.size[2]);
  ImGui::SameLine(width - ImGui::CalcTextSize(what.c_str()).x - 14 * s);
  ImGui::TextColored(kMuted, "%s", what.c_str());
}

void App::leftColumn(float, float) {
  switch (context_.tab) {
    case Tab::patient: patientControls(context_); break;
    case Tab::anatomy:
      if (const auto place = anatomy_.controls(context_)) scene_.camera().target = *place;
      break;
    case Tab::bar: barControls(context_); break;
    case Tab::tissue: tissueControls(context_); break;
    case Tab::compare: compare_.controls(context_); break;
    case Tab::accuracy: accuracyControls(context_); break;
    case Tab::script: script_.controls(context_); break;
  }
}

void App::center(float width, float height) {
  // Each step has a look of the scene of its own, and keeps what was set there. One without a scene leaves it as it was last seen.
  const bool hasScene = context_.tab != Tab::accuracy && context_.tab != Tab::script;
  if (hasScene && context_.tab != lastTab_) {
    const auto swapLook = [this](TabLook& look) {
      std::swap(look.skin, context_.scene.skin);
      std::swap(look.hasBones, context_.scene.hasBones);
      std::swap(look.hasBar, context_.scene.hasBar);
      std::swap(look.hasScan, context_.scene.hasScan);
      std::swap(look.part, context_.scene.part);
    };
    swapLook(looks_[int(lastTab_)]);
    swapLook(looks_[int(context_.tab)]);
    lastTab_ = context_.tab;
    settling_ = std::max(settling_, 2);
  }
  const bool isOpen = context_.choices.source != Source::none;
  isCoarse_ = false;
  if (context_.tab == Tab::script) {
    script_.draw(context_, width, height);
  } else if (!isOpen) {
    opening(width, height);
  } else if (context_.tab == Tab::accuracy) {
    accuracyPicture(context_, width, height);
  } else if (context_.tab == Tab::anatomy && context_.results->volume() && !anatomy_.isSolid()) {
    anatomy_.drawSlices(context_, width, height);
  } else if (context_.tab == Tab::compare && (compare_.isPlacing() || !context_.results->scan.value)) {
    compare_.draw(context_, width, height);
    isCoarse_ = compare_.isCoarse();
  } else {
    scene_.draw(context_, width, height, context_.tab == Tab::anatomy && context_.results->volume() ? &anatomy_.corrections() : nullptr);
    isCoarse_ = scene_.isCoarse();
  }
}

void App::opening(float width, float height) {
  const float s = context_.scale;
  const auto line = [&](ImFont* font, const char* text, const ImVec4& color) {
    ImGui::PushFont(font);
    ImGui::SetCursorPosX(std::max(0.f, (width - ImGui::CalcTextSize(text).x) / 2));
    ImGui::TextColored(color, "%s", text);
    ImGui::PopFont();
  };
  ImGui::SetCursorPosY(height * 0.30f);
  line(fonts().title, "The chest after a Nuss operation", {0.92f, 0.94f, 0.96f, 1});
  ImGui::Dummy({0, 6 * s});
  line(fonts().text, "Drop a folder of DICOM files, a script or a result folder here, or open one on the left.", kMuted);
  line(fonts().text, "No CT at hand? Make a phantom patient.", kMuted);
  ImGui::Dummy({0, 10 * s});
  ImGui::SetCursorPosX((width - 180 * s) / 2);
  if (button("Make a phantom", "opening.phantom", {180 * s, 34 * s})) context_.openPhantom();
  ImGui::Dummy({0, 34 * s});
  line(fonts().text, "Patient → Anatomy → Bar → Tissue → Compare → Accuracy → Script", {0.78f, 0.82f, 0.86f, 1});
  line(fonts().text, "See what was found, move the bar, tune the springs, measure against a scan; all of it is a script.", kMuted);
}

void App::splitter(const char* name, float x, float y, float height, float& value, float sign) {
  const float wide = std::round(5 * context_.scale);
  ImGui::SetNextWindowPos({x, y});
  ImGui::SetNextWindowSize({wide, height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::Begin(name, nullptr, kPanelFlags | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoBackground);
  ImGui::PopStyleVar(2);
  ImGui::InvisibleButton("bar", {wide, height});
  mark(name + 2);
  const bool isUsed = ImGui::IsItemHovered() || ImGui::IsItemActive();
  if (isUsed) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (ImGui::IsItemActive()) value += sign * ImGui::GetIO().MouseDelta.x / context_.scale;
  ImGui::GetWindowDrawList()->AddRectFilled({x, y}, {x + wide, y + height}, ImGui::GetColorU32(isUsed ? ImGuiCol_SeparatorHovered : ImGuiCol_Separator, isUsed ? 1 : 0.5f));
  ImGui::End();
}

}  // namespace pectora::view
