#include "plugins/report/plot/plot.h"

#include "plugins/report/common/gnuplot.h"

#include "kernel/stage/plugin.h"

#include <cstdlib>
namespace {
using namespace pectora;

// "name;cost;error"
WorkPoint parsePoint(const std::string& text) {
  const std::size_t second = text.rfind(';'), first = second == std::string::npos ? second : text.rfind(';', second - 1);
  const auto number = [&](const std::string& part) {
    char* end = nullptr;
    const double value = std::strtod(part.c_str(), &end);
    if (part.empty() || *end != '\0') throw Error("a point is given as name;cost;error").of("points").given(text);
    return value;
  };
  if (first == std::string::npos || second == 0) throw Error("a point is given as name;cost;error").of("points").given(text);
  return {text.substr(0, first), number(text.substr(first + 1, second - first - 1)), number(text.substr(second + 1))};
}

class Plot final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.text("path", path_, TextRole::outputPath, "PNG file to write");
    v.text("title", picture_.title, TextRole::plain, "What is seen");
    v.text("cost", picture_.costLabel, TextRole::plain, "Name and unit of the axis to the right");
    v.text("error", picture_.errorLabel, TextRole::plain, "Name and unit of the axis upwards");
    v.texts("points", points_, TextRole::plain, "The runs, each as name;cost;error");
    v.flag("lines", picture_.isJoined, "Join the runs of one name, in their order");
    v.real("floor", picture_.floor, "", {0, 1e9}, {0, 10}, "Error below which nothing is gained, drawn as a line; 0: none");
    v.text("floor_name", picture_.floorLabel, TextRole::plain, "What that line is");
  }

  Outputs run(const Inputs&, Host&) override {
    if (path_.empty()) throw Error("a file to write is needed").of("path");
    for (const std::string& text : points_) picture_.points.push_back(parsePoint(text));
    return {drawPicture(path_, [&](const std::string& png) { return gnuplotCommands(picture_, png); })};
  }

 private:
  std::string path_;
  WorkPrecision picture_{"", "time, s", "error, mm", {}, true, 0, ""};
  std::vector<std::string> points_;
};

}  // namespace

PECTORA_STAGE(Plot, {.id = "report.plot", .version = "1.0", .summary = "Draws error against cost, with the front that no other run beats",
                     .outputs = {{"report", {"Report"}}}, .isCacheable = false})
