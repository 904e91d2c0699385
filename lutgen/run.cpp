// SPDX-License-Identifier: Apache-2.0
#include "run.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <iostream>

namespace metamer::lutgen {
namespace {

constexpr int kUsageError = 2;

}  // namespace

int fail(std::string message, int code) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::cerr << "lutgen: " << message << std::endl;
  return code;
}

void note(const std::vector<std::string>& notes) {
  for (std::string text : notes) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    std::cerr << "lutgen: note: " << text << std::endl;
  }
}

int run(int argumentCount, char** arguments, const std::function<void(CLI::App&)>& addCommands) {
  // What OpenColorIO would say comes as an exception as well.
  OCIO_NAMESPACE::SetLoggingLevel(OCIO_NAMESPACE::LOGGING_LEVEL_NONE);
  CLI::App application("Colour transforms from spectra: LUT files and pictures under another light.", "lutgen");
  application.set_version_flag(
      "--version", std::string("lutgen ") + METAMER_VERSION + " (OpenColorIO " + OCIO_NAMESPACE::GetVersion() + ")");
  application.require_subcommand(1);
  addCommands(application);
  try {
    application.parse(argumentCount, arguments);
    std::cout.flush();
    return std::cout ? 0 : fail("standard output cannot be written", kFailure);
  } catch (const CLI::RuntimeError& verdict) {
    std::cout.flush();
    return verdict.get_exit_code();  // what a command found, not a failure
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      return application.exit(error);  // help or version, on stdout
    }
    return fail(std::string(error.what()) + "; see lutgen --help", kUsageError);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory", kFailure);
  } catch (const std::exception& error) {
    return fail(error.what(), kFailure);
  }
}

}  // namespace metamer::lutgen
