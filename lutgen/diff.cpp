// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "metamer/ocio/certificate_record.h"
#include "metamer/spectral/path_text.h"
#include "run.h"

namespace metamer::lutgen {
namespace {

using Json = nlohmann::ordered_json;

struct DiffArguments {
  std::string a;
  std::string b;
  bool isJson = false;
  bool decidesExit = false;
};

Json jsonOf(const DiffArguments& arguments, const std::vector<ocio::CertificateChange>& changes) {
  Json list = Json::array();
  for (const ocio::CertificateChange& change : changes) {
    const auto value = [](const std::string& text) { return text.empty() ? Json(nullptr) : Json::parse(text); };
    list.push_back({{"part", change.part},
                    {"field", change.field},
                    {"before", value(change.before)},
                    {"after", value(change.after)},
                    {"words", change.words()}});
  }
  return {{"metamer_difference", 1}, {"a", arguments.a}, {"b", arguments.b}, {"changes", list}};
}

void diff(const DiffArguments& arguments) {
  const std::vector<ocio::CertificateChange> changes = changesBetween(
      ocio::readCertificate(spectral::pathOf(arguments.a)), ocio::readCertificate(spectral::pathOf(arguments.b)));
  if (arguments.isJson) {
    standardOutput() << jsonOf(arguments, changes).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  } else {
    for (const ocio::CertificateChange& change : changes) {
      words() << change.words() << '\n';
    }
    summarise(arguments.a + " and " + arguments.b +
              (changes.empty()
                   ? " say the same"
                   : ": " + std::to_string(changes.size()) + (changes.size() == 1 ? " difference" : " differences")));
  }
  if (arguments.decidesExit && !changes.empty()) {
    throw CLI::RuntimeError(kExceeded);
  }
}

}  // namespace

void addDiff(CLI::App& application) {
  CLI::App* command = application.add_subcommand("diff", "Tell what changed between two certificates");
  const auto arguments = std::make_shared<DiffArguments>();
  command->add_option("A", arguments->a, "Certificate (FILE.json) of before")->required();
  command->add_option("B", arguments->b, "Certificate of now")->required();
  command->add_flag("--json", arguments->isJson, "JSON on stdout");
  command->add_flag("--exit-code", arguments->decidesExit, "Exit 3 where they differ");
  command->callback([arguments] { diff(*arguments); });
}

}  // namespace metamer::lutgen
