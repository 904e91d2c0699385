// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <string>

#include "commands.h"

namespace {

constexpr int kFailure = 1;
constexpr int kUsageError = 2;

/// One line on stderr, whatever the text holds.
void report(std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::cerr << "spectral_ref: " << message << std::endl;
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
  CLI::App application("Reference spectral path tracer: scenes to pictures with error bars.", "spectral_ref");
  application.set_version_flag("--version", std::string("spectral_ref ") + METAMER_VERSION);
  application.require_subcommand(1);
  metamer::spectral_ref::addRender(application);
  metamer::spectral_ref::addMerge(application);
  metamer::spectral_ref::addMeasure(application);
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
