// The work-precision picture: what it draws stands where its figures say.
#include "tests/app/view/desk.h"

#include "app/view/panels/widgets.h"

#include <numbers>

using namespace pectora;
using namespace pectora::view;

namespace {

// Two solves at opposite corners of a grid of whole decades, by solvers of two colours, and the run that is shown.
Study studyWith(double milliseconds, double rms, SolveStatus status = SolveStatus::converged) {
  return {"a reference", {{"solver.one", 1e-2, 1, 1, status}, {"solver.two", 1e-2, 1000, 1e-4, status}, {"solver.one", 1e-3, milliseconds, rms, status, true}}, {}};
}

struct AccuracyDesk : Desktop {
  AccuracyDesk() : Desktop("view_accuracy_home") {
    rest();
    context().choices.source = Source::phantom;   // as if one were open: the picture needs nothing of it
    context().tab = Tab::accuracy;
  }
  void show(Study study) {
    context().study = std::move(study);
    ImGui::GetIO().MousePos = {-1, -1};
    hand.frames(3);
    pixels = target->pixels();
    em = ImGui::GetFont()->FontSize;
  }
  std::array<int, 3> at(float x, float y) const {
    const std::size_t i = (std::size_t(std::lround(y)) * 1280 + std::size_t(std::lround(x))) * 4;
    return {pixels[i], pixels[i + 1], pixels[i + 2]};
  }
  bool isWhite(float x, float y) const {
    const auto c = at(x, y);
    return std::min({c[0], c[1], c[2]}) > 150;
  }
  // Middle of what has a colour, below the legend. The colours are teal and orange.
  ImVec2 middleOf(bool isTeal) {
    const ImVec2 low = hand.place("accuracy.picture", 0, 0), high = hand.place("accuracy.picture", 1, 1);
    double x = 0, y = 0, count = 0;
    for (int row = int(low.y + 4 * em); row < int(high.y); ++row)
      for (int column = int(low.x); column < int(high.x); ++column) {
        const auto c = at(float(column), float(row));
        if (isTeal ? c[2] - c[0] > 60 : c[0] - c[2] > 100) x += column, y += row, ++count;
      }
    EXPECT_GT(count, 20) << "a dot of a third of a letter's height";
    return {float(x / count), float(y / count)};
  }
  // How much of the ring that marks this run is to be seen about a place.
  double ringAt(ImVec2 place) const {
    constexpr int kRays = 36;
    int seen = 0;
    for (int i = 0; i < kRays; ++i) {
      const double angle = 2 * std::numbers::pi * i / kRays;
      bool isSeen = false;
      // The circle is as thick as two pixels, and its radius known to one.
      for (double r = 2.1 * 0.33 * em - 1.5; r <= 2.1 * 0.33 * em + 1.5; r += 0.5)
        isSeen = isSeen || isWhite(place.x + float(r * std::cos(angle)), place.y + float(r * std::sin(angle)));
      seen += isSeen;
    }
    return double(seen) / kRays;
  }
  std::vector<unsigned char> pixels;
  float em = 0;
};

}  // namespace

TEST(AccuracyPicture, MarksThisRunWhereItsTimeAndErrorSay) {
  AccuracyDesk desk;
  desk.show(studyWith(1000, 1));   // in the corner that no other is in
  const ImVec2 coarse = desk.middleOf(true), fine = desk.middleOf(false);
  EXPECT_LT(coarse.x, fine.x) << "time grows to the right";
  EXPECT_LT(coarse.y, fine.y) << "errors grow upwards";
  EXPECT_GT(desk.ringAt({fine.x, coarse.y}), 0.9);

  // Both axes are logarithmic: two of three decades of time, three of four of error.
  desk.show(studyWith(100, 1e-3));
  const ImVec2 between{coarse.x + (fine.x - coarse.x) * 2 / 3, coarse.y + (fine.y - coarse.y) * 3 / 4};
  EXPECT_GT(desk.ringAt(between), 0.9);
  EXPECT_LT(desk.ringAt({fine.x, coarse.y}), 0.2) << "no longer there";

  // What is nearer than the least that is told lies on the lower edge.
  desk.show(studyWith(10, 1e-9));
  EXPECT_GT(desk.ringAt({coarse.x + (fine.x - coarse.x) / 3, fine.y}), 0.9);
}

TEST(AccuracyPicture, FillsOnlyWhatHasConverged) {
  AccuracyDesk desk;
  desk.show(studyWith(1000, 1));
  const ImVec2 dot = desk.middleOf(true);
  const auto full = desk.at(dot.x, dot.y);
  EXPECT_GT(full[2] - full[0], 60);
  desk.show(studyWith(1000, 1, SolveStatus::stalled));
  const auto hollow = desk.at(dot.x, dot.y);
  EXPECT_LT(hollow[2] - hollow[0], 30);
  EXPECT_EQ(openGlErrors(), 0);
}
