#include "app/view/panels/controls.h"
#include "app/view/panels/widgets.h"

#include <filesystem>

namespace pectora::view {

void patientControls(Context& context) {
  std::string& path = context.typedPath;
  heading("Open");
  ImGui::SetNextItemWidth(-70 * context.scale);
  const bool isEntered = textField("##path", "Folder, script or scan", path, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  mark("open.path");
  ImGui::SameLine(0, 6 * context.scale);
  if ((button("Open", "open", {-1, 0}) || isEntered) && !path.empty()) context.open(path);
  note("A folder of DICOM files or of results, a script, a preset, a scan, or its landmarks (.csv); or drop it on the window.");

  if (!context.recent.paths().empty()) {
    heading("Recent");
    std::string chosen;
    for (const std::string& known : context.recent.paths()) {
      // With the folder that it is in: many a patient's is called "dicom".
      const std::filesystem::path whole(known);
      const std::string name = whole.filename().string(), above = whole.parent_path().filename().string();
      if (ImGui::Selectable(((above.empty() ? name : above + "/" + name) + "##" + known).c_str())) chosen = known;
      mark("recent." + name);
      hint(known);
    }
    if (!chosen.empty()) context.open(chosen);
  }

  // How it is read: which of its series, and the like.
  if (context.choices.source == Source::dicom) {
    heading("The CT");
    parameterControls(context, context.choices.loader, "ct", {"files"});
  }

  ImGui::Dummy({0, 4 * context.scale});
  ImGui::Separator();
  heading("Or make a phantom patient");
  if (context.choices.source != Source::phantom) {
    if (button("Make a phantom", "phantom", {-1, 0})) context.openPhantom();
    note("A virtual patient whose exact anatomy is known, with a scan from after the operation.");
    return;
  }
  for (const Parameter& p : context.catalog.parameters("loader.phantom")) {
    const bool isMain = p.name == "haller" || p.name == "type" || p.name == "torsion" || p.name == "eccentricity" || p.name == "age" || p.name == "bmi";
    if (isMain) parameterControl(context, p, context.choices.loader.settings, "phantom." + p.name);
  }
  const bool isOpen = ImGui::TreeNode("More about the phantom");
  mark("phantom.open");
  if (isOpen) {
    for (const Parameter& p : context.catalog.parameters("loader.phantom")) {
      const bool isMain = p.name == "haller" || p.name == "type" || p.name == "torsion" || p.name == "eccentricity" || p.name == "age" || p.name == "bmi";
      if (!isMain) parameterControl(context, p, context.choices.loader.settings, "phantom." + p.name);
    }
    ImGui::TreePop();
  }
}

}  // namespace pectora::view
