// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include "metamer/ocio/certificate_record.h"
#include "refusal.h"

/// Whatever two certificates say (the bytes before and after the first NUL), their differences are lines, and none is
/// there between a certificate and itself; or they are refused by one short line.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace metamer;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(text.find('\0'), text.size());
  try {
    const auto before = ocio::certificateFrom(text.substr(0, end), "before");
    require(changesBetween(before, before).empty());
    const auto after = ocio::certificateFrom(text.substr(std::min(end + 1, text.size())), "after");
    for (const ocio::CertificateChange& change : changesBetween(before, after)) {
      require(change.words().find('\n') == std::string::npos && change.words().size() < 2000);
    }
  } catch (const spectral::InputError& error) {
    checkRefusal(error);
  }
  return 0;
}
