// Lines of a script as a file: scripts themselves have none.
#include "plugins/report/common/atomic_file.h"
#include "plugins/report/table/table.h"

#include "kernel/stage/plugin.h"
#include "kernel/value/comparison.h"

#include <filesystem>

namespace {
using namespace pectora;

class Table final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.text("path", path_, TextRole::outputPath, "File to write, such as out/table.csv; with the ending .json the lines become an array of objects");
    v.texts("lines", lines_, TextRole::plain, "Its lines: the header first, cells separated by commas");
  }

  Outputs run(const Inputs&, Host&) override {
    if (path_.empty()) throw Error("a file to write is needed").of("path");
    std::string text;
    for (const std::string& line : lines_) text += line + "\n";
    writeFile(path_, path_.ends_with(".json") ? tableJson(lines_) : text);
    auto report = std::make_shared<Report>();
    const std::filesystem::path path = path_;
    report->folder = path.parent_path().string();
    report->files = {path.filename().string()};
    return {report};
  }

 private:
  std::string path_;
  std::vector<std::string> lines_;
};

}  // namespace

PECTORA_STAGE(Table, {.id = "report.table", .version = "1.0", .summary = "Writes lines of a script as a CSV or JSON file",
                      .outputs = {{"report", {"Report"}}}, .isCacheable = false})
