// SPDX-License-Identifier: Apache-2.0
// Every public function of stage that has a range, with arguments just outside it and just inside.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "metamer/stage/chart_difference.h"
#include "metamer/stage/chart_grid.h"
#include "metamer/stage/chart_sampler.h"
#include "metamer/stage/chart_table.h"
#include "metamer/stage/emitter_match.h"
#include "metamer/stage/emitter_model.h"
#include "metamer/stage/emitter_selection.h"
#include "metamer/stage/environment_drive.h"
#include "metamer/stage/fixture.h"
#include "metamer/stage/match_outcome.h"
#include "metamer/stage/non_negative_least_squares.h"
#include "metamer/stage/panel_linearity.h"
#include "metamer/stage/rgb_wall.h"
#include "metamer/stage/stage_description.h"
#include "metamer/stage/stage_geometry.h"
#include "metamer/stage/wall_spectra.h"
#include "spectral/refusals.h"

namespace metamer::stage {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using spectral::DomainSamples;
using spectral::testLibrary;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

const std::vector<Eigen::Vector2d>& corners() {
  static const std::vector<Eigen::Vector2d> corners = {{1, 1}, {7, 1}, {7, 5}, {1, 5}};
  return corners;
}

/// Patches of rising light, all different.
Matrix3Xd patches(Eigen::Index count) {
  Matrix3Xd rgb(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    rgb.col(i) = Vector3d(0.1, 0.2, 0.3) * static_cast<double>(i + 1) + Vector3d::Unit(i % 3);
  }
  return rgb;
}

TEST(StageRanges, Differences) {
  const Matrix3d same = Matrix3d::Identity();
  EXPECT_TAKEN(chartDifferences(patches(3), patches(3), same, Vector3d::Ones()));
  EXPECT_REFUSED("patches '3'", chartDifferences(patches(3), patches(2), same, Vector3d::Ones()));
  EXPECT_TAKEN(summaryOf({1, 2}, {0, 1}));
  EXPECT_REFUSED("patch '2'", summaryOf({1, 2}, {2}));
  EXPECT_REFUSED("patch '-1'", summaryOf({1, 2}, {-1}));
  EXPECT_TAKEN(likeness(VectorXd::Ones(3), VectorXd::Ones(3)));
  EXPECT_REFUSED("values '3'", likeness(VectorXd::Ones(3), VectorXd::Ones(4)));
}

TEST(StageRanges, Grids) {
  EXPECT_TAKEN(ChartGrid(corners(), 1, ChartGrid::kMostAlong));
  EXPECT_REFUSED("columns '0'", ChartGrid(corners(), 0, 4));
  EXPECT_REFUSED("columns '1001'", ChartGrid(corners(), 1001, 4));
  EXPECT_REFUSED("rows '0'", ChartGrid(corners(), 6, 0));
  EXPECT_REFUSED("rows '1001'", ChartGrid(corners(), 6, 1001));
  EXPECT_REFUSED("corners", ChartGrid({{1, 1}, {7, 1}, {7, 5}}, 6, 4));
  EXPECT_REFUSED("corners", ChartGrid({{1, 1}, {7, 1}, {4, 1}, {1, 5}}, 6, 4));
}

TEST(StageRanges, Pictures) {
  const std::vector<float> values(8 * 6 * 3, 0.5F);
  const PictureView picture{values, 8, 6, 3, {0, 1, 2}};
  StageLayout layout;
  const auto sampler = [&](int columns, int rows) {
    layout.columns = columns;
    layout.rows = rows;
    return ChartSampler(layout, testLibrary(), {});
  };
  EXPECT_REFUSED("charts.columns '0'", sampler(0, 4));
  EXPECT_REFUSED("charts.columns '1001'", sampler(1001, 4));
  EXPECT_REFUSED("charts.rows '-1'", sampler(6, -1));
  layout.names = {"one"};
  EXPECT_REFUSED("charts.names '1'", sampler(6, 4));
  layout.names = {};
  const ChartSampler six = sampler(6, 4);
  EXPECT_TAKEN(six.sample(picture, corners()));
  EXPECT_TAKEN(meanOfBox(picture, {0, 0, 8, 6}, "p"));
  const auto refused = [&](const char* what, PictureView view) {
    EXPECT_REFUSED(what, six.sample(view, corners()));
    EXPECT_REFUSED(what, meanOfBox(view, {0, 0, 1, 1}, "p"));
  };
  refused("width '0'", {values, 0, 6, 3, {0, 1, 2}});
  refused("height '-6'", {values, 8, -6, 3, {0, 1, 2}});
  refused("channels '0'", {values, 8, 6, 0, {0, 1, 2}});
  refused("values '144'", {values, 8, 7, 3, {0, 1, 2}});
  refused("colours '3'", {values, 8, 6, 3, {0, 1, 3}});
  refused("colours '-1'", {values, 8, 6, 3, {-1, 1, 2}});
  for (const std::array<int, 4>& box :
       {std::array{-1, 0, 8, 6}, {0, -1, 8, 6}, {0, 0, 9, 6}, {0, 0, 8, 7}, {4, 0, 4, 6}}) {
    EXPECT_REFUSED("box", meanOfBox(picture, box, "p"));
  }
}

TEST(StageRanges, Charts) {
  const ChartTable two{"two.csv", {"a", "b"}, patches(2)};
  EXPECT_TAKEN(alignCharts({two}, std::nullopt));
  EXPECT_REFUSED("charts '0'", alignCharts({}, std::nullopt));
  EXPECT_REFUSED("names of a chart '1'", alignCharts({two, {"x.csv", {"a"}, patches(2)}}, std::nullopt));
  EXPECT_REFUSED("patches", parseChart("patch,R,G,B\n", "x.csv"));
  EXPECT_REFUSED("header", parseChart("patch,R,G\na,1,2\n", "x.csv"));
}

TEST(StageRanges, Models) {
  EXPECT_TAKEN(ledModel(360, 1));
  EXPECT_TAKEN(ledModel(830, 300));
  EXPECT_REFUSED("peak", ledModel(359, 10));
  EXPECT_REFUSED("peak", ledModel(831, 10));
  EXPECT_REFUSED("width", ledModel(500, 0.9));
  EXPECT_REFUSED("width", ledModel(500, 301));
  EXPECT_REFUSED("peak", ledModel(kNotANumber, 10));
  EXPECT_TAKEN(phosphorModel(450, 20, 560, 120, 0));
  EXPECT_TAKEN(phosphorModel(450, 20, 560, 120, 100));
  EXPECT_REFUSED("pump share", phosphorModel(450, 20, 560, 120, -0.1));
  EXPECT_REFUSED("pump share", phosphorModel(450, 20, 560, 120, 101));
  EXPECT_REFUSED("pump", phosphorModel(359, 20, 560, 120, 1));
  EXPECT_REFUSED("pump width", phosphorModel(450, 0, 560, 120, 1));
  EXPECT_REFUSED("peak", phosphorModel(450, 20, 900, 120, 1));
  EXPECT_REFUSED("width", phosphorModel(450, 20, 560, 301, 1));
  EXPECT_REFUSED("emitter", emitterFromModel("led:620"));
  EXPECT_REFUSED("emitter", emitterFromModel("led:620:18:1"));
  EXPECT_REFUSED("near names", emittersFrom("D6", testLibrary()));
  EXPECT_REFUSED("near names", readFixture({"D6"}, testLibrary()));
}

TEST(StageRanges, Systems) {
  const EmitterColumns emitters = EmitterColumns::Ones(spectral::kDomainSize, 2);
  const DomainSamples light = DomainSamples::Ones();
  const ObserverCurves curves = ObserverCurves::Ones();
  EXPECT_TAKEN(illuminantSystem(emitters, light, curves));
  EXPECT_REFUSED("target", illuminantSystem(emitters, DomainSamples::Zero(), curves));
  EXPECT_TAKEN(reflectanceSystem(emitters, light, curves, {light}));
  EXPECT_REFUSED("reflectances '0'", reflectanceSystem(emitters, light, curves, {}));
  EXPECT_REFUSED("target", reflectanceSystem(emitters, DomainSamples::Zero(), curves, {light}));
  EXPECT_TAKEN(chartSystem({patches(3)}, patches(3)));
  EXPECT_REFUSED("patches of an emitter's chart '2'", chartSystem({patches(2)}, patches(3)));
  EXPECT_REFUSED("charts", chartSystem({Matrix3Xd(3, 0)}, Matrix3Xd(3, 0)));
  EXPECT_REFUSED("must be sim", matchMethodFromName("mit"));
}

TEST(StageRanges, Matches) {
  const auto solved = [](Eigen::Index rows, Eigen::Index columns, Eigen::Index targets, double value = 1) {
    return solveMatch({MatrixXd::Ones(rows, columns), VectorXd::Constant(targets, value)});
  };
  EXPECT_TAKEN(solved(3, 1, 3));
  EXPECT_TAKEN(solved(64, kMostDrives, 64));
  EXPECT_REFUSED("emitters '0'", solved(3, 0, 3));
  EXPECT_REFUSED("emitters '65'", solved(65, kMostDrives + 1, 65));
  EXPECT_REFUSED("target '2'", solved(3, 1, 2));
  EXPECT_REFUSED("no light", solved(3, 1, 3, 0));
  EXPECT_REFUSED("no light", solveMatch({MatrixXd::Zero(3, 2), VectorXd::Ones(3)}));

  const SeenResponses seen{Matrix3d::Identity(), Vector3d::Ones()};
  const MatchSystem system = chartSystem({patches(2)}, patches(2));
  EXPECT_TAKEN(solvePerceptualMatch(system, seen, {VectorXd::Ones(1)}));
  EXPECT_REFUSED("drives of a start '2'", solvePerceptualMatch(system, seen, {VectorXd::Ones(2)}));
  EXPECT_REFUSED("target '4'", solvePerceptualMatch({MatrixXd::Ones(4, 1), VectorXd::Ones(4)}, seen, {}));
  EXPECT_REFUSED("target", solvePerceptualMatch(system, {Matrix3d::Identity(), Vector3d::Zero()}, {}));
}

TEST(StageRanges, LeastSquares) {
  const MatrixXd matrix = MatrixXd::Identity(3, 2);
  const VectorXd target = VectorXd::Ones(3);
  EXPECT_TAKEN(nonNegativeLeastSquares(matrix, target));
  EXPECT_REFUSED("columns '0'", nonNegativeLeastSquares(MatrixXd(3, 0), target));
  EXPECT_REFUSED("columns '65'", nonNegativeLeastSquares(MatrixXd::Ones(3, kMostDrives + 1), target));
  EXPECT_REFUSED("rows '0'", nonNegativeLeastSquares(MatrixXd(0, 2), VectorXd()));
  EXPECT_REFUSED("target '2'", nonNegativeLeastSquares(matrix, VectorXd::Ones(2)));
  EXPECT_REFUSED("matrix", nonNegativeLeastSquares(MatrixXd::Constant(3, 2, kNotANumber), target));
  EXPECT_REFUSED("target", nonNegativeLeastSquares(matrix, VectorXd::Constant(3, kInfinite)));
  const auto limited = [&](const VectorXd& upper, const VectorXd& power, double budget) {
    return nonNegativeLeastSquares(matrix, target, {upper, power, budget});
  };
  const VectorXd two = VectorXd::Ones(2);
  EXPECT_TAKEN(limited(VectorXd::Constant(2, kInfinite), VectorXd::Zero(2), 1e-9));
  EXPECT_REFUSED("limits", limited(VectorXd::Ones(3), two, 1));
  EXPECT_REFUSED("limits", limited(VectorXd::Zero(2), two, 1));
  EXPECT_REFUSED("power", limited(two, VectorXd::Ones(1), 1));
  EXPECT_REFUSED("power", limited(two, VectorXd::Constant(2, -1e-9), 1));
  EXPECT_REFUSED("power", limited(two, VectorXd::Constant(2, kInfinite), 1));
  EXPECT_REFUSED("power budget", limited(two, two, 0));
}

TEST(StageRanges, Selections) {
  const SelectionCase two{"two", {MatrixXd::Identity(3, 2), VectorXd::Ones(3)}};
  EXPECT_TAKEN(selectEmitters({two}, {0, 1}, 2));
  EXPECT_REFUSED("targets", selectEmitters({}));
  EXPECT_REFUSED("emitters '0'", selectEmitters({{"none", {MatrixXd(3, 0), VectorXd::Ones(3)}}}));
  EXPECT_REFUSED("emitters '17'",
                 selectEmitters({{"many", {MatrixXd::Ones(3, kMostSelectable + 1), VectorXd::Ones(3)}}}));
  EXPECT_REFUSED("emitters of a target '3'",
                 selectEmitters({two, {"three", {MatrixXd::Ones(3, 3), VectorXd::Ones(3)}}}));
  EXPECT_REFUSED("target '2'", selectEmitters({{"short", {MatrixXd::Ones(3, 2), VectorXd::Ones(2)}}}));
  EXPECT_REFUSED("holds no light", selectEmitters({{"dark", {MatrixXd::Ones(3, 2), VectorXd::Zero(3)}}}));
  EXPECT_REFUSED("required emitter '2'", selectEmitters({two}, {2}));
  EXPECT_REFUSED("required emitter '-1'", selectEmitters({two}, {-1}));
  EXPECT_REFUSED("most '-1'", selectEmitters({two}, {}, -1));
}

TEST(StageRanges, Outcomes) {
  const Fixture fixture = readFixture({"led:628:14", "led:460:16"}, testLibrary());
  const auto chart = testLibrary().reflectances("colorchecker").samples;
  const auto matched = [&](const char* method, const char* weights) {
    return matchSpectra({method, weights, {}, "w"}, fixture, testLibrary().illuminant("A"),
                        testLibrary().observer("CIE 1931 2"), chart, Matrix3d::Identity());
  };
  EXPECT_TAKEN(matched("mim", "absolute"));
  EXPECT_REFUSED("method", matched("mit", "absolute"));
  EXPECT_REFUSED("weights 'abs'", matched("mrm", "abs"));
  const ChartTable seen{"c.csv", {"white", "grey"}, patches(2)};
  const auto read = [&](const char* method, const char* weights) {
    return matchCharts({method, weights, {}, "w"}, {seen}, seen, Matrix3d::Identity());
  };
  EXPECT_TAKEN(read("mrm", "relative"));
  EXPECT_REFUSED("method", read("sim", "absolute"));
  EXPECT_REFUSED("weights", read("mrm", "Absolute"));
}

TEST(StageRanges, Environments) {
  const SceneChart scene{patches(2), {0, 0, 1}};
  const auto driver = [&](const std::vector<Matrix3Xd>& emitters, const std::vector<SceneChart>& scenes, int white) {
    return EnvironmentDriver(emitters, scenes, white).emitterCount();
  };
  EXPECT_TAKEN(driver({patches(2)}, {scene}, 1));
  EXPECT_REFUSED("emitters '0'", driver({}, {scene}, 0));
  EXPECT_REFUSED("emitters '17'", driver(std::vector<Matrix3Xd>(17, patches(2)), {scene}, 0));
  EXPECT_REFUSED("scene charts", driver({patches(2)}, {}, 0));
  EXPECT_REFUSED("emitter's chart '3'", driver({patches(2), patches(3)}, {scene}, 0));
  EXPECT_REFUSED("scene chart '3'", driver({patches(2)}, {{patches(3), {0, 0, 1}}}, 0));
  EXPECT_REFUSED("white patch '-1'", driver({patches(2)}, {scene}, -1));
  EXPECT_REFUSED("white patch '2'", driver({patches(2)}, {scene}, 2));
  EXPECT_REFUSED("direction", driver({patches(2)}, {{patches(2), {0, 0, 0}}}, 0));
}

TEST(StageRanges, Panels) {
  const auto judged = [](const std::vector<double>& drives, Eigen::Index colours) {
    return judgeLinearity({drives, patches(colours)});
  };
  EXPECT_TAKEN(judgeLinearity({{1, 2, 3}, Vector3d::Ones() * Eigen::RowVector3d(1, 2, 3)}));
  EXPECT_REFUSED("drives '2'", judged({1, 2, 2}, 3));
  EXPECT_REFUSED("colours of a series '2'", judged({1, 2, 3}, 2));
}

TEST(StageRanges, Geometry) {
  EXPECT_TAKEN(rectangleFormFactor(1e-3, 1e-3, 1e3));
  for (const double length : {0.0, -1.0, kNotANumber, kInfinite}) {
    EXPECT_REFUSED("width", rectangleFormFactor(length, 1, 1));
    EXPECT_REFUSED("height", rectangleFormFactor(1, length, 1));
    EXPECT_REFUSED("distance", rectangleFormFactor(1, 1, length));
    EXPECT_REFUSED("distance", calibrationSquareBeta(1, 1, length));
  }
  const LatLong layout{4, 2};
  DiffuseConvolution light(layout, {0, 0, 2});
  EXPECT_TAKEN((light.addRow(1, Eigen::Matrix3Xf::Ones(3, 4)), 0));
  EXPECT_REFUSED("row '2'", (light.addRow(2, Eigen::Matrix3Xf::Ones(3, 4)), 0));
  EXPECT_REFUSED("row '-1'", (light.addRow(-1, Eigen::Matrix3Xf::Ones(3, 4)), 0));
  EXPECT_REFUSED("pixels of a row '3'", (light.addRow(0, Eigen::Matrix3Xf::Ones(3, 3)), 0));
  EXPECT_REFUSED("direction", DiffuseConvolution(layout, {0, 0, 0}));
  EXPECT_REFUSED("width '0'", DiffuseConvolution({0, 2}, {0, 0, 1}));
  EXPECT_REFUSED("height '0'", DiffuseConvolution({4, 0}, {0, 0, 1}));
}

TEST(StageRanges, Walls) {
  WallCapture wall;
  wall.cameraFromWall << 0.82, 0.31, 0.02, 0.09, 0.90, 0.14, 0.01, 0.12, 0.88;
  wall.charts.fill(patches(4));
  wall.target = patches(4);
  wall.patchNames = {"a", "b", "c", "d"};
  wall.environmentWhite = Vector3d(1.1, 1.0, 0.8);
  const auto with = [&](const std::function<void(WallCapture&, WallOptions&)>& change) {
    WallCapture capture = wall;
    WallOptions options;
    change(capture, options);
    return solveWall(capture, options);
  };
  EXPECT_TAKEN(with([](auto&, auto& options) { options = {3, VectorXd::Zero(4), 1}; }));
  EXPECT_REFUSED("held patch '4'", with([](auto&, auto& options) { options.heldPatch = 4; }));
  EXPECT_REFUSED("held patch '-2'", with([](auto&, auto& options) { options.heldPatch = -2; }));
  EXPECT_REFUSED("patch weights '3'", with([](auto&, auto& options) { options.patchWeights = VectorXd::Ones(3); }));
  EXPECT_REFUSED("patch weight '-1'", with([](auto&, auto& options) { options.patchWeights = -VectorXd::Ones(4); }));
  EXPECT_REFUSED("largest condition", with([](auto&, auto& options) { options.largestCondition = 0.99; }));
  EXPECT_REFUSED("largest condition", with([](auto&, auto& options) { options.largestCondition = kNotANumber; }));
  EXPECT_REFUSED("patches of a chart '3'", with([](auto& capture, auto&) { capture.charts[1] = patches(3); }));
  EXPECT_REFUSED("patch names '3'", with([](auto& capture, auto&) { capture.patchNames.pop_back(); }));
  EXPECT_REFUSED("no patch", with([](auto& capture, auto&) { capture.target = Matrix3Xd(3, 0); }));
  EXPECT_REFUSED("beta '0'", with([](auto& capture, auto&) { capture.beta = 0; }));
  EXPECT_REFUSED("black_level", with([](auto& capture, auto&) { capture.blackLevel = Vector3d::Constant(2); }));

  WallSpectra spectra{{DomainSamples::Ones(), DomainSamples::Ones(), DomainSamples::Ones()},
                      ObserverCurves::Ones(),
                      testLibrary().reflectances("colorchecker").samples,
                      DomainSamples::Ones(),
                      1};
  EXPECT_TAKEN(captureOf(spectra));
  spectra.beta = 0;
  EXPECT_REFUSED("beta '0'", captureOf(spectra));
  spectra.beta = 1;
  spectra.reflectances.clear();
  EXPECT_REFUSED("reflectances", captureOf(spectra));
}

TEST(StageRanges, Descriptions) {
  const auto parsed = [](const std::string& more) {
    return parseStage(
        "metamer_stage: 1\n"
        "spectra: {emitters: {red: 'led:628:14', green: 'led:525:24', blue: 'led:460:16'},"
        " camera: Canon EOS 5D Mark II, target: FL2}\n" +
            more,
        "s.yaml", {});
  };
  EXPECT_TAKEN(parsed("q: {max_condition: 1, skin_weight: 0}"));
  EXPECT_REFUSED("max_condition", parsed("q: {max_condition: 0.99}"));
  EXPECT_REFUSED("skin_weight", parsed("q: {skin_weight: -1}"));
  EXPECT_REFUSED("width_m", parsed("calibration_square: {width_m: 0, height_m: 1, distance_m: 1}"));
  EXPECT_REFUSED("none.yaml", readStage("/nonexistent/none.yaml"));
}

}  // namespace
}  // namespace metamer::stage
