// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/chart_expectation.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "least_squares/lawson_hanson.h"
#include "metamer/spectral/text.h"

namespace metamer::stage {
namespace {

/// Hats every 25 nm over what cameras see: LED lights leave 0.2 % of a chart unexplained, 9 bands leave 0.8 %.
constexpr int kBands = 13;
constexpr double kFirstBandNm = 400;
constexpr double kLastBandNm = 700;
/// A patch is grey where its reflectance varies by less than this share over the range below.
constexpr double kGreyBelow = 0.06;
constexpr int kGreyFromNm = 430;
constexpr int kGreyToNm = 680;
/// Share of a channel's largest value below which noise is not counted as relative.
constexpr double kNoiseFloor = 0.05;
/// Of a normal distribution: standard deviation over the median of absolute deviations.
constexpr double kSigmaFromMedian = 1.4826;

/// 401 x bands, columns of sum 1; the first and the last band hold on beyond their centres.
Eigen::MatrixXd hats(const Eigen::VectorXd& centres) {
  const double step = centres[1] - centres[0];
  Eigen::MatrixXd result(spectral::kDomainSize, centres.size());
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    const double nm = std::clamp<double>(spectral::kDomainStartNm + static_cast<double>(i), kFirstBandNm, kLastBandNm);
    for (Eigen::Index b = 0; b < centres.size(); ++b) {
      result(i, b) = std::max(0.0, 1 - std::abs(nm - centres[b]) / step);
    }
  }
  return result * result.colwise().sum().cwiseInverse().asDiagonal();
}

}  // namespace

std::optional<ChartExpectation> expectationOf(const std::vector<std::string>& names,
                                              const spectral::ReflectanceSet& set, int columns, int rows) {
  std::unordered_map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < set.samples.size(); ++i) {
    places.emplace(spectral::lowerCase(set.samples[i].name()), i);
  }
  ChartExpectation expectation;
  expectation.set = set.name;
  expectation.columns = columns;
  expectation.rows = rows;
  std::vector<std::size_t> samples;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto place = places.find(spectral::lowerCase(names[i]));
    if (place != places.end()) {
      expectation.known.push_back(static_cast<Eigen::Index>(i));
      samples.push_back(place->second);
    }
  }
  if (samples.size() < kFewestKnownPatches) {
    return std::nullopt;
  }
  expectation.bandCentresNm = Eigen::VectorXd::LinSpaced(kBands, kFirstBandNm, kLastBandNm);
  const Eigen::MatrixXd bands = hats(expectation.bandCentresNm);
  expectation.bands.resize(static_cast<Eigen::Index>(samples.size()), kBands);
  expectation.level.resize(expectation.bands.rows());
  const bool fillsGrid = set.samples.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const spectral::DomainSamples reflectance = set.samples[samples[i]].onDomain();
    expectation.bands.row(row) = reflectance.transpose() * bands;
    const Eigen::VectorXd seen =
        reflectance.segment(kGreyFromNm - spectral::kDomainStartNm, kGreyToNm - kGreyFromNm + 1);
    expectation.level[row] = seen.mean();
    const double spread = std::sqrt((seen.array() - seen.mean()).square().mean());
    if (spread < kGreyBelow * seen.mean()) {
      expectation.greys.push_back(row);
    }
    if (fillsGrid) {
      const auto index = static_cast<int>(samples[i]);
      expectation.cell.emplace_back(index % columns, index / columns);
    }
  }
  return expectation;
}

ChannelFit fitChannel(const Eigen::MatrixXd& bands, const Eigen::VectorXd& values, double floor, bool withVeil) {
  const Eigen::VectorXd weights = (values.cwiseAbs().array() + floor).inverse();
  Eigen::MatrixXd columns(bands.rows(), bands.cols() + (withVeil ? 2 : 0));
  columns.leftCols(bands.cols()) = bands;
  if (withVeil) {
    columns.rightCols<2>().col(0).setOnes();
    columns.rightCols<2>().col(1).setConstant(-1);
  }
  Eigen::MatrixXd scaled = weights.asDiagonal() * columns;
  const Eigen::VectorXd lengths = scaled.colwise().norm().cwiseMax(1e-300);
  scaled *= lengths.cwiseInverse().asDiagonal();
  const Eigen::VectorXd wanted = weights.cwiseProduct(values);
  const double size = std::max(wanted.norm(), 1e-300);
  const Eigen::VectorXd solved = solveNonNegative(scaled, wanted / size).cwiseQuotient(lengths) * size;
  ChannelFit fit;
  fit.weights = solved.head(bands.cols());
  fit.fitted = columns * solved;
  if (withVeil) {
    fit.veil = solved[bands.cols()] - solved[bands.cols() + 1];
  }
  return fit;
}

double estimatedNoise(const ChartExpectation& expectation, const std::vector<Eigen::Matrix3Xd>& charts) {
  std::vector<double> residuals;
  double variance = 0;
  for (const Eigen::Matrix3Xd& chart : charts) {
    const Eigen::Matrix3Xd rgb = chart(Eigen::all, expectation.known);
    Eigen::Index strongest = 0;
    rgb.rowwise().sum().maxCoeff(&strongest);
    const Eigen::VectorXd values = rgb.row(strongest).transpose();
    const double floor = kNoiseFloor * std::max(values.maxCoeff(), 1e-300);
    const ChannelFit fit = fitChannel(expectation.bands, values, floor);
    residuals.clear();
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      residuals.push_back(std::abs(values[i] - fit.fitted[i]) / (std::abs(fit.fitted[i]) + floor));
    }
    std::nth_element(residuals.begin(), residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2),
                     residuals.end());
    const auto used = static_cast<double>((fit.weights.array() > 0).count());
    const double freedom =
        static_cast<double>(values.size()) / std::max(1.0, static_cast<double>(values.size()) - used);
    const double sigma = kSigmaFromMedian * residuals[residuals.size() / 2];
    variance += sigma * sigma * freedom / static_cast<double>(charts.size());
  }
  return std::sqrt(variance);
}

}  // namespace metamer::stage
