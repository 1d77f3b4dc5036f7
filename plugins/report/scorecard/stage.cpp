// report.scorecard: a study's table as a picture, against what is to be reached.
#include "plugins/report/scorecard/scorecard.h"

#include "plugins/report/common/gnuplot.h"

#include "kernel/stage/plugin.h"

namespace {
using namespace pectora;

class ScorecardStage final : public Stage {
 public:
  void describe(Visitor& v) override {
    v.text("path", path_, TextRole::outputPath, "PNG file to write");
    v.text("title", title_, TextRole::plain, "What is seen");
    v.texts("lines", lines_, TextRole::plain, "The table's lines: the header first, cells separated by commas, the first of each the row's name");
    v.reals("goals", goals_, "", {-1e9, 1e9}, "For each column after the first the greatest absolute value that reaches the goal; negative: the least value; 0: none");
  }

  Outputs run(const Inputs&, Host&) override {
    if (path_.empty()) throw Error("a file to write is needed").of("path");
    const Scorecard card = readScorecard(title_, lines_, goals_);
    return {drawPicture(path_, [&](const std::string& png) { return gnuplotCommands(card, png); })};
  }

 private:
  std::string path_, title_;
  std::vector<std::string> lines_;
  std::vector<double> goals_;
};

}  // namespace

PECTORA_STAGE(ScorecardStage, {.id = "report.scorecard", .version = "1.0", .summary = "Draws a study's table against what is to be reached",
                               .outputs = {{"report", {"Report"}}}, .isCacheable = false})
