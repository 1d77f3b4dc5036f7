#include "kernel/host/settings.h"

#include "tests/kernel/host/helpers.h"

using namespace pectora;

namespace {

struct Sample {
  double lift = 30;
  int rows = 4;
  bool fast = false;
  std::string type = "cup", path;
  std::vector<double> weights{1, 2};
  std::vector<std::string> tags;

  void describe(Visitor& v) {
    v.real("lift", lift, "mm", {0, 80}, {0, 50}, "How far");
    v.integer("rows", rows, "", {1, 100}, {1, 10}, "How many");
    v.flag("fast", fast, "Whether");
    v.choice("type", type, {"cup", "saucer"}, "Which");
    v.text("path", path, TextRole::inputPath, "Where");
    v.reals("weights", weights, "kg", {0, 10}, "Numbers");
    v.texts("tags", tags, TextRole::plain, "Words");
  }
  void set(const Settings& given) {
    applySettings(given, [this](Visitor& v) { describe(v); });
  }
};

}  // namespace

TEST(Settings, KeepTheirDefaultsWhereNothingIsGiven) {
  Sample s;
  s.set({});
  EXPECT_EQ(s.lift, 30);
  EXPECT_EQ(s.type, "cup");
}

TEST(Settings, AreSetByName) {
  Sample s;
  s.set({{"lift", 12.5}, {"rows", 7.0}, {"fast", true}, {"type", std::string("saucer")}, {"weights", std::vector<double>{3}}, {"tags", std::string("one")}});
  EXPECT_EQ(s.lift, 12.5);
  EXPECT_EQ(s.rows, 7);
  EXPECT_TRUE(s.fast);
  EXPECT_EQ(s.type, "saucer");
  EXPECT_EQ(s.weights, std::vector<double>{3});
  EXPECT_EQ(s.tags, std::vector<std::string>{"one"});
}

TEST(Settings, OutOfRangeSayWhatIsAllowed) {
  Sample s;
  const Error error = errorOf([&] { s.set({{"lift", 81.0}}); });
  EXPECT_TRUE(contains(error.what(), "lift")) << error.what();
  EXPECT_TRUE(contains(error.what(), "81")) << error.what();
  EXPECT_TRUE(contains(error.what(), "0 to 80 mm")) << error.what();
  EXPECT_EQ(s.lift, 30);
}

TEST(Settings, RefuseWhatIsNoFiniteNumber) {
  Sample s;
  EXPECT_THROW(s.set({{"lift", std::nan("")}}), Error);
  EXPECT_THROW(s.set({{"lift", INFINITY}}), Error);
  EXPECT_THROW(s.set({{"rows", 2.5}}), Error);
  EXPECT_THROW(s.set({{"weights", std::vector<double>{1, 11}}}), Error);
}

TEST(Settings, RefuseAWrongType) {
  Sample s;
  EXPECT_THROW(s.set({{"lift", std::string("30")}}), Error);
  EXPECT_THROW(s.set({{"fast", 1.0}}), Error);
  EXPECT_THROW(s.set({{"type", true}}), Error);
}

TEST(Settings, SuggestTheNearestNameAndChoice) {
  Sample s;
  EXPECT_TRUE(contains(errorOf([&] { s.set({{"lfit", 1.0}}); }).what(), "\"lift\""));
  EXPECT_TRUE(contains(errorOf([&] { s.set({{"type", std::string("sauce")}}); }).what(), "\"saucer\""));
}

TEST(Settings, AreReadFromWordsOfTheCommandLine) {
  Sample s;
  const auto known = parameters([&](Visitor& v) { s.describe(v); });
  EXPECT_EQ(std::get<double>(parseText(known[0], "12.5")), 12.5);
  EXPECT_EQ(std::get<bool>(parseText(known[2], "true")), true);
  EXPECT_EQ(std::get<std::vector<double>>(parseText(known[5], "1,2.5")), (std::vector<double>{1, 2.5}));
  EXPECT_THROW(parseText(known[0], "12mm"), Error);
  EXPECT_THROW(parseText(known[2], "maybe"), Error);
}

TEST(CanonicalText, TellsNeighbouringNumbersApart) {
  EXPECT_NE(canonicalText(0.1), canonicalText(std::nextafter(0.1, 1)));
  EXPECT_EQ(canonicalText(30.0), "30");
}
