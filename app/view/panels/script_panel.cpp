#include "app/view/panels/script_panel.h"

#include "app/view/panels/widgets.h"
#include "app/view/session/script_text.h"

#include <algorithm>
#include <fstream>

namespace pectora::view {

void ScriptPanel::controls(Context& context) {
  heading("What you did, as a script");
  note("Everything that the window shows follows from this script. pectora run does the same.");
  if (button("Copy as Lua", "script.copy", {-1, 0})) ImGui::SetClipboardText(scriptOf(context.choices).c_str());

  heading("Files");
  ImGui::SetNextItemWidth(-1);
  textField("##folder", "Folder to write into", context.outFolder);
  mark("export.folder");
  if (button("Save the script", "script.save", {-1, 0})) {
    const std::string path = context.outPath("session.lua");
    std::ofstream file(path);
    file << scriptOf(context.choices) << std::flush;
    if (file.good()) context.notice = "The script is " + path;
    else context.message = "The script cannot be written to " + path;
  }
  ImGui::BeginDisabled(!context.results->motionValue());
  if (button("Turntable of 36 pictures", "turntable", {-1, 0})) context.turntable = Turntable{context.outPath("turntable")};
  hint("Around the chest as it was last shown: its colours, bones and bar");
  if (button("Export all results", "export", {-1, 0}))
    context.worker().run("export", [folder = context.outFolder, worker = &context.worker()](Pipeline& pipeline) {
      pipeline.exportTo(folder);
      worker->log(LogLine::Kind::print, "Results are in " + folder);
    });
  hint("Summary, meshes, slices, distance maps and their provenance, as scripts write them");
  ImGui::EndDisabled();

  heading("In the console");
  note("The results are there by name: ct, anatomy, cage, scene, plan, motion, aligned, comparison. Every plugin can be called, such as\n"
       "planner.nuss(cage, { lift = 25 })\nLocals last for one line, globals until the window closes.");
}

void ScriptPanel::draw(Context& context, float width, float height) {
  const float consoleHeight = std::min(context.layout.console * context.scale, height - 120 * context.scale);
  std::string text = scriptOf(context.choices);
  ImGui::PushFont(fonts().mono);
  ImGui::InputTextMultiline("##script", text.data(), text.size() + 1, {width, height - consoleHeight - ImGui::GetStyle().ItemSpacing.y}, ImGuiInputTextFlags_ReadOnly);
  ImGui::PopFont();
  mark("script.text");
  console(context, consoleHeight);
}

void ScriptPanel::console(Context& context, float height) {
  const float below = ImGui::GetFrameHeightWithSpacing();
  ImGui::PushFont(fonts().mono);
  ImGui::PushStyleColor(ImGuiCol_ChildBg, {0.09f, 0.10f, 0.115f, 1});
  ImGui::BeginChild("log", {0, height - below});
  ImGui::Indent(6 * context.scale);
  for (const LogLine& entry : context.log) {
    static const ImVec4 colors[] = {kMuted, kWarm, kBad, {0.90f, 0.92f, 0.94f, 1}, kAccent};
    ImGui::PushStyleColor(ImGuiCol_Text, colors[int(entry.kind)]);
    ImGui::TextWrapped("%s", entry.text.c_str());
    ImGui::PopStyleColor();
  }
  if (shownLines_ != context.log.size()) ImGui::SetScrollHereY(1);
  shownLines_ = context.log.size();
  ImGui::EndChild();
  ImGui::PopStyleColor();

  ImGui::SetNextItemWidth(-1);
  if (wantsFocus_) ImGui::SetKeyboardFocusHere();
  wantsFocus_ = false;
  const int flags = ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory | ImGuiInputTextFlags_CallbackResize;
  const bool isEntered = ImGui::InputTextWithHint("##line", "A line of Lua", line_.data(), line_.capacity() + 1, flags, editLine, this);
  mark("console.line");
  if (isEntered && !line_.empty()) {
    context.worker().log(LogLine::Kind::input, "> " + line_);
    context.worker().run("console", [code = line_](Pipeline& pipeline) { pipeline.evaluate(code); });
    entered_.push_back(line_);
    recalled_ = -1;
    line_.clear();
    wantsFocus_ = true;
  }
  ImGui::PopFont();
}

int ScriptPanel::editLine(ImGuiInputTextCallbackData* data) {
  auto& panel = *static_cast<ScriptPanel*>(data->UserData);
  if (data->EventFlag == ImGuiInputTextFlags_CallbackResize) {
    panel.line_.resize(std::size_t(data->BufTextLen));
    data->Buf = panel.line_.data();
    return 0;
  }
  // Up and down bring back earlier lines.
  const int count = int(panel.entered_.size());
  if (count == 0) return 0;
  int& at = panel.recalled_;
  if (data->EventKey == ImGuiKey_UpArrow) at = at < 0 ? count - 1 : std::max(0, at - 1);
  else at = at < 0 || at + 1 >= count ? -1 : at + 1;
  data->DeleteChars(0, data->BufTextLen);
  if (at >= 0) data->InsertChars(0, panel.entered_[std::size_t(at)].c_str());
  return 0;
}

}  // namespace pectora::view
