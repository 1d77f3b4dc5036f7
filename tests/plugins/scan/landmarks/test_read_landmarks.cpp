#include "plugins/scan/landmarks/read_landmarks.h"

#include "kernel/stage/error.h"

#include <gtest/gtest.h>

using namespace pectora;

TEST(ReadLandmarks, TakesOneSetOrTheChosenOfTwo) {
  EXPECT_EQ(readLandmarks("# mine\nneck, 1.5, -90, 20\r\n\nnavel,0,-100,-300\n", "").points[0].position, (Vec3{1.5, -90, 20}));
  const std::string both = "name,ct_x,ct_y,ct_z,scan_x,scan_y,scan_z\nneck,1,2,3,4,5,6\n";
  EXPECT_EQ(readLandmarks(both, "ct").points[0].position, (Vec3{1, 2, 3}));
  EXPECT_EQ(readLandmarks(both, "scan").points[0].position, (Vec3{4, 5, 6}));
}

TEST(ReadLandmarks, RefusesWithTheLine) {
  for (const char* text : {"", "neck,1,2\n", "neck,1,2,x\n", "neck,1,2,nan\n", "neck,1,2,3\nneck,1,2,3\n", ",1,2,3\n"}) EXPECT_THROW(readLandmarks(text, ""), Error) << text;
  EXPECT_THROW(readLandmarks("name,x,y,z\nneck,1,2,3\n", "ct"), Error);
  try {
    readLandmarks("neck,1,2,3\nnavel,1,2,oops\n", "");
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("line 2"), std::string::npos);
  }
}
