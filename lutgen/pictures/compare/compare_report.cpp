// SPDX-License-Identifier: Apache-2.0
#include "compare/compare_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>

#include "metamer/spectral/formatted.h"

namespace metamer::lutgen {
namespace {

using Json = nlohmann::ordered_json;

/// Four digits behind the point; text where JSON has no number.
Json rounded(double value) {
  return std::isfinite(value) ? Json(std::round(value * 1e4) / 1e4) : Json("infinite");
}

const sip::ComparedColour* worstOf(const CompareReport& report) {
  const sip::Comparison& comparison = report.comparison;
  return comparison.colours.empty() ? nullptr : &comparison.colours[comparison.worst];
}

std::string worstText(const CompareReport& report) {
  const sip::ComparedColour* worst = worstOf(report);
  if (worst == nullptr) {
    return "none";
  }
  return spectral::formatted("%s at %+.4g stops, rgb %.5g %.5g %.5g", worst->name.c_str(), worst->stop, worst->rgb[0],
                             worst->rgb[1], worst->rgb[2]);
}

/// A promise was measured in doubles, and goes through floats here; a release may move a probe.
constexpr double kPromiseSlack = 0.01;
constexpr double kPromiseShare = 0.02;

bool holds(double found, double promised) {
  return found <= promised * (1 + kPromiseShare) + kPromiseSlack;
}

std::string verdict(const CompareReport& report) {
  if (report.isJudgedByCertificate) {
    const ocio::CertificateRecord& promise = *report.certificate;
    return spectral::formatted("mean %.4f, p99 %.4f, max %.4f, promised %.4f, %.4f, %.4f by ", report.comparison.mean,
                               report.comparison.p99, report.comparison.max, promise.mean, promise.p99, promise.max) +
           promise.where;
  }
  return spectral::formatted("%s CIEDE2000 %.4f, tolerance %.4f", report.statistic.c_str(), report.figure(),
                             *report.tolerance);
}

/// At most three: a certificate of another world differs in all.
std::string staleText(const std::vector<std::string>& stale) {
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t k = 0; k < std::min(kShown, stale.size()); ++k) {
    text += (k > 0 ? "; " : "") + stale[k];
  }
  return stale.size() > kShown ? text + "; and " + std::to_string(stale.size() - kShown) + " more" : text;
}

}  // namespace

bool CompareReport::passes() const {
  if (isJudgedByCertificate) {
    return holds(comparison.mean, certificate->mean) && holds(comparison.p99, certificate->p99) &&
           holds(comparison.max, certificate->max);
  }
  return !tolerance || figure() <= *tolerance;
}

double CompareReport::figure() const {
  return statistic == "mean" ? comparison.mean : statistic == "max" ? comparison.max : comparison.p99;
}

std::string textOf(const CompareReport& report) {
  const sip::Comparison& comparison = report.comparison;
  std::string text = "A: " + report.kindA + " " + report.nameA + "\nB: " + report.kindB + " " + report.nameB + "\n";
  text += spectral::formatted("CIEDE2000: mean %.4f, p99 %.4f, max %.4f over %zu colours, linear ", comparison.mean,
                              comparison.p99, comparison.max, comparison.colours.size()) +
          report.space + "\n";
  text += "worst: " + worstText(report) + "\n";
  if (report.tolerance || report.isJudgedByCertificate) {
    text += std::string(report.passes() ? "passed: " : "EXCEEDED: ") + verdict(report) + "\n";
  }
  if (!report.stale.empty()) {
    text += (report.passes() ? "stale: " : "cause: ") + staleText(report.stale) + "\n";
  }
  return text;
}

std::string jsonOf(const CompareReport& report) {
  const sip::Comparison& comparison = report.comparison;
  Json document = {{"metamer_comparison", 1},
                   {"tool", {{"name", "metamer"}, {"version", METAMER_VERSION}}},
                   {"a", {{"kind", report.kindA}, {"name", report.nameA}}},
                   {"b", {{"kind", report.kindB}, {"name", report.nameB}}},
                   {"space", report.space},
                   {"error",
                    {{"metric", "CIEDE2000"},
                     {"mean", rounded(comparison.mean)},
                     {"p99", rounded(comparison.p99)},
                     {"max", rounded(comparison.max)},
                     {"count", comparison.colours.size()}}}};
  if (const sip::ComparedColour* worst = worstOf(report)) {
    document["error"]["worst"] = {{"name", worst->name},
                                  {"stop", rounded(worst->stop)},
                                  {"rgb", {rounded(worst->rgb[0]), rounded(worst->rgb[1]), rounded(worst->rgb[2])}}};
  }
  if (const auto& promise = report.certificate) {
    document["certificate"] = {
        {"file", promise->where},
        {"promised",
         {{"mean", rounded(promise->mean)}, {"p99", rounded(promise->p99)}, {"max", rounded(promise->max)}}},
        {"stale", report.stale}};
  }
  if (report.isJudgedByCertificate) {
    document["tolerance"] = {{"by", "certificate"}, {"passed", report.passes()}};
  } else if (report.tolerance) {
    document["tolerance"] = {
        {"statistic", report.statistic}, {"value", *report.tolerance}, {"passed", report.passes()}};
  }
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string junitOf(const CompareReport& report) {
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  const int failures = report.passes() ? 0 : 1;
  pugi::xml_node suites = document.append_child("testsuites");
  pugi::xml_node suite = suites.append_child("testsuite");
  suite.append_attribute("name") = "lutgen compare";
  suite.append_attribute("tests") = 1;
  suite.append_attribute("failures") = failures;
  suite.append_attribute("errors") = 0;
  pugi::xml_node test = suite.append_child("testcase");
  test.append_attribute("classname") = "metamer.compare";
  test.append_attribute("name") = (report.nameA + " against " + report.nameB).c_str();
  if (!report.passes()) {
    pugi::xml_node failure = test.append_child("failure");
    failure.append_attribute("message") = verdict(report).c_str();
    failure.append_attribute("type") = "tolerance";
    failure.text() = textOf(report).c_str();
  }
  test.append_child("system-out").text() = textOf(report).c_str();
  std::ostringstream text;
  document.save(text, "  ", pugi::format_default, pugi::encoding_utf8);
  return std::move(text).str();
}

}  // namespace metamer::lutgen
