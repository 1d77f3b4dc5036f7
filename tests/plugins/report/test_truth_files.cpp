#include "plugins/report/truth/truth_files.h"
#include "plugins/scan/file/read_surface.h"

#include <gtest/gtest.h>

using namespace pectora;

TEST(NrrdFile, HasTheGeometryInItsHeaderAndTheLabelsBehindABlankLine) {
  Labels labels;
  labels.grid.size = {2, 3, 4};
  labels.grid.spacing = {0.5, 0.5, 2.5};
  labels.grid.origin = {-10, 20, -30};
  labels.label.assign(24, 7);
  labels.names = {"", "air"};
  const std::string bytes = nrrdBytes(labels, "key");
  EXPECT_NE(bytes.find("sizes: 2 3 4\n"), std::string::npos);
  EXPECT_NE(bytes.find("space: left-posterior-superior\n"), std::string::npos);
  EXPECT_NE(bytes.find("space directions: (0.5,0,0) (0,0.5,0) (0,0,2.5)\n"), std::string::npos);
  EXPECT_NE(bytes.find("label_1:=air\n"), std::string::npos);
  EXPECT_EQ(bytes.size() - (bytes.find("\n\n") + 2), 24u);
}

TEST(FastScanText, IsReadBackWithItsSweeps) {
  Points points;
  points.points = {{-106.93, 99.8, 68.81}, {1, 2, 3}, {4, 5, 6}};
  points.sweeps = {0, 0, 1};
  const RawSurface s = readFastScanText(fastScanText(points));
  ASSERT_EQ(s.points.size(), 3u);
  EXPECT_EQ(s.points[0], points.points[0]);
  EXPECT_EQ(s.sweeps, points.sweeps);
}

TEST(LandmarksCsv, HoldsWhatBothSidesHave) {
  Landmarks ct, scan;
  ct.points = {{"neck", {1, 2, 3}}, {"navel", {4, 5, 6}}};
  scan.points = {{"navel", {7, 8, 9}}};
  EXPECT_EQ(landmarksCsv(ct, scan), "name,ct_x,ct_y,ct_z,scan_x,scan_y,scan_z\nnavel,4.0000,5.0000,6.0000,7.0000,8.0000,9.0000\n");
}
