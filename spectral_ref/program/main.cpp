// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <string>
#include <string_view>

#include "checked_words.h"
#include "commands.h"
#include "metamer/spectral/interruption.h"
#include "metamer/spectral/message_line.h"

namespace {

constexpr int kFailure = 1;
constexpr int kUsageError = 2;

constexpr std::string_view kPrefix = "spectral_ref: ";

/// One line on stderr, whatever the text holds.
void report(const std::string& message) {
  std::cerr << kPrefix << metamer::spectral::messageLine(message, metamer::spectral::kLongestMessage - kPrefix.size())
            << std::endl;
}

/// CLI11's ranges let through what compares with nothing.
void refuseWhatIsNotFinite(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& text : option->results()) {
      double value = 0;
      if (option->get_type_name().find("FLOAT") != std::string::npos && CLI::detail::lexical_cast(text, value) &&
          !std::isfinite(value)) {
        throw CLI::ValidationError(option->get_name(), "'" + text + "' is no finite number; give one");
      }
    }
  }
}

int fail(const std::string& message, int code) {
  report(message);
  return code;
}

}  // namespace

namespace metamer::spectral_ref {

void warn(const std::string& message) {
  report(message);
}

}  // namespace metamer::spectral_ref

int main(int argumentCount, char** arguments) {
  metamer::spectral::endCleanlyBySignals("spectral_ref");
  std::vector<std::string> taskWords = metamer::farm::takeTaskWords(argumentCount, arguments);
  CLI::App application("Reference spectral path tracer: scenes to pictures with error bars.", "spectral_ref");
  application.set_version_flag("--version", std::string("spectral_ref ") + METAMER_VERSION);
  application.require_subcommand(1);
  metamer::spectral_ref::addRender(application);
  metamer::spectral_ref::addMerge(application);
  metamer::spectral_ref::addMeasure(application);
  metamer::spectral_ref::addJob(application, std::move(taskWords));
  for (CLI::App* command : application.get_subcommands([](const CLI::App*) { return true; })) {
    command->parse_complete_callback([command] { refuseWhatIsNotFinite(*command); });
  }
  try {
    application.parse(argumentCount, arguments);
    std::cout.flush();
    return std::cout ? 0 : fail("standard output cannot be written", kFailure);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      return application.exit(error);  // help or version, on stdout
    }
    return fail(std::string(error.what()) + "; see spectral_ref --help", kUsageError);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory", kFailure);
  } catch (const std::exception& error) {
    return fail(error.what(), kFailure);
  }
}
