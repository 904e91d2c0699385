// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "metamer/spectral/formatted.h"
#include "report/charts.h"
#include "report/drawing.h"

namespace metamer::lutgen {
namespace {

constexpr int kWidth = 400;
constexpr int kHeight = 230;
constexpr double kLeft = 28;
constexpr double kRight = 392;
constexpr double kTop = 34;
constexpr double kBottom = 196;

struct Curve {
  std::string name;
  std::string look;
  std::function<double(double nm)> value;
};

double xOf(double nm) {
  return kLeft +
         (nm - spectral::kDomainStartNm) / (spectral::kDomainEndNm - spectral::kDomainStartNm) * (kRight - kLeft);
}

/// A band under the axis: what each wavelength looks like, as far as a screen shows it.
void drawWavelengths(Drawing& drawing, const sip::TransformSpec& spec, const Screen& screen) {
  constexpr int kStepNm = 8;
  const Eigen::Matrix3d rgbFromXyz = spec.space.rgbFromXyz();
  for (int nm = spectral::kDomainStartNm; nm < spectral::kDomainEndNm; nm += kStepNm) {
    Eigen::Vector3d xyz;
    for (Eigen::Index k = 0; k < 3; ++k) {
      xyz[k] = spec.standardObserver.curves[static_cast<std::size_t>(k)].at(nm + 0.5 * kStepNm);
    }
    const Eigen::Vector3d light = (rgbFromXyz * xyz).cwiseMax(0.0);
    drawing.rectangle(xOf(nm), kBottom, xOf(nm + kStepNm) - xOf(nm) + 0.3, 6, screen.hex(light));
  }
}

/// @param isShare  values are shares of 1; else each curve is drawn to its own height
Chart chartOf(const std::string& words, const std::string& caption, const std::vector<Curve>& curves,
              const sip::TransformSpec& spec, const Screen& screen, bool isShare) {
  Drawing drawing(kWidth, kHeight, words);
  for (int nm = 400; nm < spectral::kDomainEndNm; nm += 50) {
    drawing.line({xOf(nm), kTop}, {xOf(nm), kBottom}, "axis");
    drawing.text(xOf(nm), kBottom + 19, nm == 400 ? "400 nm" : std::to_string(nm), "middle");
  }
  drawing.line({kLeft, kBottom}, {kRight, kBottom}, "axis");
  drawing.text(kLeft - 4, kTop + 8, isShare ? "100 %" : "1", isShare ? "start" : "end");
  drawing.text(kLeft - 4, kBottom, "0", "end");
  drawWavelengths(drawing, spec, screen);
  double legend = kLeft;
  for (const Curve& curve : curves) {
    double largest = isShare ? 1.0 : 0.0;
    for (int nm = spectral::kDomainStartNm; nm <= spectral::kDomainEndNm && !isShare; ++nm) {
      largest = std::max(largest, curve.value(nm));
    }
    std::vector<Eigen::Vector2d> points;
    for (int nm = spectral::kDomainStartNm; nm <= spectral::kDomainEndNm; ++nm) {
      const double share = largest > 0 ? curve.value(nm) / largest : 0.0;
      points.emplace_back(xOf(nm), kBottom - std::clamp(share, 0.0, 1.05) * (kBottom - kTop));
    }
    drawing.path(points, "curve " + curve.look);
    if (!curve.name.empty()) {
      drawing.line({legend, 14}, {legend + 18, 14}, "curve " + curve.look);
      drawing.text(legend + 22, 18, curve.name);
      legend += 40 + 6.2 * static_cast<double>(curve.name.size());
    }
  }
  return {drawing.svg(), caption};
}

/// Long names would leave the drawing.
std::string brief(const std::string& name) {
  constexpr std::size_t kMost = 24;
  return name.size() <= kMost ? name : name.substr(0, kMost - 2) + "...";
}

double through(const sip::Pipeline& side, double nm) {
  double power = side.illuminant.at(nm);
  for (const sip::FilterLayer& filter : side.filters) {
    power *= std::pow(std::max(filter.transmittance.at(nm), 0.0), filter.density);
  }
  return power;
}

Chart observerChart(const sip::Pipeline& side, const std::string& what, const sip::TransformSpec& spec,
                    const Screen& screen) {
  constexpr std::array<const char*, 3> kLooks = {"one", "three", "two"};
  constexpr std::array<const char*, 3> kXyz = {"X", "Y", "Z"};
  constexpr std::array<const char*, 3> kLms = {"L", "M", "S"};
  constexpr std::array<const char*, 3> kRgb = {"red", "green", "blue"};
  const auto& names = side.observer.response == spectral::Observer::Response::Xyz   ? kXyz
                      : side.observer.response == spectral::Observer::Response::Lms ? kLms
                                                                                    : kRgb;
  std::vector<Curve> curves;
  for (std::size_t k = 0; k < 3; ++k) {
    curves.push_back({names[k], kLooks[k], [&side, k](double nm) { return side.observer.curves[k].at(nm); }});
  }
  const std::string text = "What sees it " + what + ": " + side.observer.name;
  return chartOf(text + ", three curves of sensitivity over wavelength", text + "; each curve to its own height",
                 curves, spec, screen, false);
}

}  // namespace

std::vector<Chart> spectraCharts(const sip::TransformSpec& spec, const Screen& screen) {
  const bool hasFilters = !spec.input.filters.empty() || !spec.output.filters.empty();
  const std::string in = spec.input.illuminant.name();
  const std::string out = spec.output.illuminant.name();
  std::vector<Chart> charts = {chartOf(
      "Power over wavelength of the light that it was shot in, " + in + ", and of the new light, " + out,
      std::string("The light it was shot in and the new light") + (hasFilters ? ", behind their filters" : "") +
          "; each to its own height",
      {{brief(in) + (in == out ? " (before)" : ""), "one", [&](double nm) { return through(spec.input, nm); }},
       {brief(out) + (in == out ? " (after)" : ""), "two dashed", [&](double nm) { return through(spec.output, nm); }}},
      spec, screen, false)};
  if (hasFilters) {
    std::vector<Curve> curves;
    for (const sip::Pipeline* side : {&spec.input, &spec.output}) {
      for (const sip::FilterLayer& filter : side->filters) {
        curves.push_back(
            {brief(filter.transmittance.name()), side == &spec.input ? "one" : "two dashed",
             [&filter](double nm) { return std::pow(std::max(filter.transmittance.at(nm), 0.0), filter.density); }});
      }
    }
    charts.push_back(chartOf("Transmittance of the filters over wavelength",
                             "What the filters let through: solid lines before, dashed ones after", curves, spec,
                             screen, true));
  }
  if (spec.input.observer.name == spec.output.observer.name) {
    charts.push_back(observerChart(spec.input, "before and after", spec, screen));
  } else {
    charts.push_back(observerChart(spec.input, "before", spec, screen));
    charts.push_back(observerChart(spec.output, "after", spec, screen));
  }
  return charts;
}

}  // namespace metamer::lutgen
