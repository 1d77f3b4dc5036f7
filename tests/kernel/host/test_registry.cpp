#include "tests/kernel/host/helpers.h"

using namespace pectora;

TEST(Registry, MapsAPluginIntoTheProcessOnlyWhenItIsNamed) {
  Registry registry({PECTORA_TEST_PLUGINS});
  EXPECT_TRUE(registry.has("segmenter.slow"));
  EXPECT_FALSE(isMapped("segmenter.slow.so"));
  registry.open("segmenter.slow");
  EXPECT_TRUE(isMapped("segmenter.slow.so"));
  EXPECT_FALSE(isMapped("loader.misnamed.so"));
}

TEST(Registry, SuggestsTheNearestPlugin) {
  Registry registry({PECTORA_TEST_PLUGINS});
  EXPECT_TRUE(contains(errorOf([&] { registry.open("segmenter.ehco"); }).what(), "segmenter.echo"));
}

TEST(Registry, RefusesAPluginOfAnotherBuildBeforeCallingIt) {
  Registry registry({PECTORA_TEST_PLUGINS});
  const std::string text = errorOf([&] { registry.open("loader.oldstamp"); }).what();
  EXPECT_TRUE(contains(text, "interface 0; long ago")) << text;
  EXPECT_TRUE(contains(text, PECTORA_BUILD_STAMP)) << text;
}

TEST(Registry, RefusesWhatIsNoPlugin) {
  Registry registry({PECTORA_TEST_PLUGINS});
  EXPECT_THROW(registry.open("loader.nosymbols"), Error);
  EXPECT_THROW(registry.open("loader.garbage"), Error);
  EXPECT_TRUE(contains(errorOf([&] { registry.open("loader.misnamed"); }).what(), "loader.other"));
}

TEST(Registry, LetsTheFirstFolderWin) {
  Registry registry({"/nowhere", PECTORA_TEST_PLUGINS, PECTORA_PLUGINS});
  EXPECT_TRUE(contains(registry.open("loader.counter").file, "test_plugins"));
  EXPECT_TRUE(registry.has("solver.verlet"));
}
