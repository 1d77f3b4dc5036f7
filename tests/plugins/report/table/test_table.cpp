// CSV lines as JSON.
#include "plugins/report/table/table.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

using namespace pectora;

TEST(Table, SplitsCellsAtCommasOutsideQuotes) {
  EXPECT_EQ(csvCells("a,\"b, \"\"c\"\"\",,1"), (std::vector<std::string>{"a", "b, \"c\"", "", "1"}));
}

TEST(Table, BecomesAnArrayOfObjectsWithNumbersWhereCellsAreNumbers) {
  EXPECT_EQ(tableJson({"name,mm", "\"skin, outer\",-1.5e-3", "pleura,nan"}),
            "[\n {\n  \"name\": \"skin, outer\",\n  \"mm\": -0.0015\n },\n {\n  \"name\": \"pleura\",\n  \"mm\": \"nan\"\n }\n]\n");
  EXPECT_EQ(tableJson({}), "[]\n");
}

TEST(Table, NamesTheLineThatDoesNotFitItsHeader) {
  try {
    tableJson({"a,b", "1,2", "3"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("line 3"), std::string::npos) << error.what();
  }
}
