// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/stage_description.h"

#include <gtest/gtest.h>

#include "metamer/stage/chart_grid.h"
#include "metamer/stage/chart_table.h"
#include "spectral/fixture.h"

namespace metamer::stage {
namespace {

using spectral::errorOf;

constexpr const char* kStage =
    "metamer_stage: 1\n"
    "primaries: {red: [0.82, 0.09, 0.01], green: [0.31, 0.90, 0.12], blue: [0.02, 0.14, 0.88]}\n"
    "charts: {red: r.csv, green: g.csv, blue: b.csv, target: t.csv}\n"
    "calibration_square: {width_m: 1, height_m: 2, distance_m: 3}\n"
    "environment: {white: [1.1, 1.0, 0.8]}\n"
    "black_level: [0, 0.01, 0]\n"
    "q: {preserve_white: true, white_patch: white}\n";

TEST(StageFile, ReadsTheShortForm) {
  const StageDescription stage = parseStage(kStage, "s.yaml", "folder");
  EXPECT_EQ(*stage.primaries[1].value, Eigen::Vector3d(0.31, 0.90, 0.12));
  EXPECT_EQ(stage.charts[2].file, std::filesystem::path("folder") / "b.csv");
  EXPECT_EQ(stage.target.file, std::filesystem::path("folder") / "t.csv");
  EXPECT_EQ(stage.heightM, 2);
  EXPECT_EQ(stage.distanceM, 3);
  EXPECT_EQ(*stage.environmentWhite, Eigen::Vector3d(1.1, 1.0, 0.8));
  EXPECT_EQ(stage.blackLevel, Eigen::Vector3d(0, 0.01, 0));
  EXPECT_TRUE(stage.preserveWhite);
  EXPECT_EQ(stage.whitePatch, "white");
  EXPECT_FALSE(stage.spectra);
}

TEST(StageFile, RefusesWithALineAndARemedy) {
  const auto errorIn = [](const std::string& text) { return errorOf([&] { parseStage(text, "s.yaml", ""); }); };
  const std::string stage = kStage;
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = stage;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(errorIn(""), "s.yaml: stage: is empty; a stage starts with 'metamer_stage: 1'");
  EXPECT_NE(errorIn(replaced("stage: 1", "stage: 2")).find("s.yaml:1: metamer_stage '2'"), std::string::npos);
  EXPECT_NE(errorIn(replaced("[0.82, 0.09, 0.01]", "[0.82, 0.09]")).find("s.yaml:2: primaries.red"), std::string::npos);
  EXPECT_NE(errorIn(replaced("green: g.csv, ", "")).find("charts.green"), std::string::npos);
  EXPECT_NE(errorIn(replaced("distance_m: 3", "distance_m: 0")).find("calibration_square.distance_m '0'"),
            std::string::npos);
  EXPECT_NE(errorIn(stage + "spectra: {}\n").find("spectra"), std::string::npos);
  EXPECT_NE(errorIn(stage + "blak_level: [0, 0, 0]\n").find("did you mean 'black_level'"), std::string::npos);
}

TEST(ChartTable, ReadsAnyOrderOfColumns) {
  const ChartTable chart =
      parseChart("# a comment\nG;B;patch;R;Lux\n2;3;\"dark; skin\";1;9\n5;nan;grey;4;9\n", "c.csv");
  EXPECT_EQ(chart.names, (std::vector<std::string>{"dark; skin", "grey"}));
  EXPECT_EQ(chart.rgb.col(0), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(chart.rgb(0, 1), 4);
  EXPECT_TRUE(std::isnan(chart.rgb(2, 1)));
}

TEST(ChartTable, RefusesWithTheLine) {
  const auto errorIn = [](const std::string& text) { return errorOf([&] { parseChart(text, "c.csv"); }); };
  EXPECT_NE(errorIn("a,1,2,3\n").find("c.csv:1: header"), std::string::npos);
  EXPECT_NE(errorIn("patch,R,G,B\na,1,2,3\na,1,2,3\n").find("c.csv:3: patch 'a': is given twice, in line 2"),
            std::string::npos);
  EXPECT_NE(errorIn("patch,R,G,B\na,1,2,three\n").find("c.csv:2: B 'three'"), std::string::npos);
  EXPECT_NE(errorIn("patch,R,G,B\n").find("are missing"), std::string::npos);
  EXPECT_NE(errorIn("").find("are missing"), std::string::npos);
}

TEST(ChartTable, AlignsAndNamesWhatItLeavesOut) {
  const auto table = [](const std::string& where, const std::string& rows) {
    return parseChart("patch,R,G,B\n" + rows, where);
  };
  const std::vector<ChartTable> charts = {table("one", "a,1,1,1\nb,2,2,2\nc,3,3,3\nd,4,,4\ne,5,5,5\n"),
                                          table("two", "c,1,1,9\nb,2,2,2\na,3,3,9\nd,1,1,1\nf,1,1,1\n")};
  const AlignedCharts aligned = alignCharts(charts, std::nullopt);
  // 9 is shared by two different patches of the second chart: it is where the camera clipped.
  EXPECT_EQ(aligned.names, (std::vector<std::string>{"b"}));
  ASSERT_EQ(aligned.excluded.size(), 5U);
  EXPECT_EQ(aligned.excluded[0].name, "c");
  EXPECT_EQ(aligned.excluded[0].reason, "saturated in two");
  EXPECT_EQ(aligned.excluded[2].reason, "a value is missing in one");
  EXPECT_EQ(aligned.excluded[3].reason, "missing in one");
  EXPECT_EQ(aligned.excluded[4].reason, "missing in two");
  EXPECT_EQ(alignCharts(charts, 100.0, {"a"}).names, (std::vector<std::string>{"c", "b"}));
}

TEST(ChartTable, TheSamePatchTwiceIsNotClipped) {
  const ChartTable chart = parseChart("patch,R,G,B\na,1,2,3\nagain,1,2,3\nc,0,0,1\n", "c.csv");
  EXPECT_EQ(alignCharts({chart}, std::nullopt).names.size(), 3U);
}

TEST(ChartGrid, PerspectiveAndBack) {
  const std::vector<Eigen::Vector2d> corners = {{60, 40}, {610, 75}, {585, 440}, {85, 405}};
  const ChartGrid grid(corners, 6, 4);
  EXPECT_TRUE(grid.pixelAt({0, 0}).isApprox(corners[0], 1e-9));
  EXPECT_TRUE(grid.pixelAt({6, 4}).isApprox(corners[2], 1e-9));
  EXPECT_TRUE(grid.cellsAt(grid.pixelAt({2.5, 1.25})).isApprox(Eigen::Vector2d(2.5, 1.25), 1e-9));
  EXPECT_TRUE(grid.isInSampledSquare(grid.pixelAt({2.7, 1.3}), 2, 1));
  EXPECT_FALSE(grid.isInSampledSquare(grid.pixelAt({2.8, 1.3}), 2, 1));
  EXPECT_NE(errorOf([] { ChartGrid({{0, 0}, {1, 1}, {2, 2}, {0, 1}}, 6, 4); }), "no InputError");
  EXPECT_NE(errorOf([] { ChartGrid({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 6, 4); }), "no InputError");
}

}  // namespace
}  // namespace metamer::stage
