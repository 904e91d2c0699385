// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "metamer/ocio/certificate_record.h"
#include "metamer/sip/comparison.h"

namespace metamer::lutgen {

/// What one comparison says.
struct CompareReport {
  std::string kindA;
  std::string nameA;
  std::string kindB;
  std::string nameB;
  std::string space;  ///< linear space of the figures
  sip::Comparison comparison;
  std::optional<double> tolerance;
  std::string statistic = "p99";  ///< "mean", "p99" or "max": what the tolerance is for
  /// Of a file or look against a recipe, that is, the converged engine: what its certificate says, and whether that
  /// judges it.
  std::optional<ocio::CertificateRecord> certificate = {};
  bool isJudgedByCertificate = false;
  std::vector<std::string> stale = {};  ///< what the certificate names and is no longer so

  double figure() const;
  bool passes() const;
};

/// Some lines for people.
std::string textOf(const CompareReport& report);
/// For programs: fields in a fixed order, no times.
std::string jsonOf(const CompareReport& report);
/// JUnit XML: one test case, failed where the tolerance is exceeded.
std::string junitOf(const CompareReport& report);

}  // namespace metamer::lutgen
