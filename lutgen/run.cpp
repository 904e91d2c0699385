// SPDX-License-Identifier: Apache-2.0
#include "run.h"

#include <OpenColorIO/OpenColorIO.h>

#include <chrono>
#include <cmath>
#include <iostream>

#include "metamer/spectral/formatted.h"
#include "metamer/spectral/interruption.h"
#include "metamer/spectral/message_line.h"

namespace metamer::lutgen {
namespace {

constexpr int kUsageError = 2;
constexpr const char* kProgram = "lutgen: ";
constexpr const char* kNote = "lutgen: note: ";

/// Takes what a quiet command says.
class Silence : public std::streambuf {
 protected:
  int_type overflow(int_type c) override { return traits_type::not_eof(c); }
  std::streamsize xsputn(const char* /*text*/, std::streamsize count) override { return count; }
};

/// How the one command of this program talks.
struct Talk {
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  bool isQuiet = false;
  bool hasSummary = false;
  bool isResultOnOutput = false;
  Silence silence;
  std::ostream output{std::cout.rdbuf()};
  std::ostream nothing{&silence};
};

Talk& talk() {
  static Talk& talk = *new Talk;  // outlives the last flush of std::cout
  return talk;
}

std::string lineOf(const char* prefix, const std::string& message) {
  return prefix + spectral::messageLine(message, spectral::kLongestMessage - std::string(prefix).size());
}

/// CLI11's ranges let through what compares with nothing.
void refuseWhatIsNotFinite(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_type_name().find("FLOAT") == std::string::npos) {
      continue;
    }
    for (const std::string& text : option->results()) {
      double value = 0;
      if (CLI::detail::lexical_cast(text, value) && !std::isfinite(value)) {
        throw CLI::ValidationError(option->get_name(), "'" + text + "' is no finite number; give one");
      }
    }
  }
}

/// What all commands have in common.
void addToAll(CLI::App& application) {
  for (CLI::App* command : application.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_subcommands([](const CLI::App*) { return true; }).empty() && command->get_name() != "list") {
      if (command->get_option_no_throw("--quiet") == nullptr) {
        command->add_flag("--quiet", talk().isQuiet, "Say nothing but failures");
      }
    } else {
      addToAll(*command);
    }
    command->parse_complete_callback([command] {
      refuseWhatIsNotFinite(*command);
      if (talk().isQuiet) {
        std::cout.rdbuf(&talk().silence);
      }
    });
  }
}

bool isList(const CLI::App& application) {
  const auto commands = application.get_subcommands();
  return !commands.empty() && commands.front()->get_name() == "list";
}

}  // namespace

int fail(const std::string& message, int code) {
  std::cerr << lineOf(kProgram, message) << std::endl;
  return code;
}

void note(const std::vector<std::string>& notes) {
  for (const std::string& text : notes) {
    if (!talk().isQuiet) {
      std::cerr << lineOf(kNote, text) << std::endl;
    }
  }
}

void summarise(const std::string& text) {
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - talk().start;
  talk().hasSummary = true;
  words() << text << spectral::formatted("%s%.1f s\n", text.empty() ? "" : ", ", time.count());
}

std::ostream& standardOutput() {
  talk().isResultOnOutput = true;
  return talk().output;
}

std::ostream& words() {
  return talk().isQuiet ? talk().nothing : talk().isResultOnOutput ? std::cerr : std::cout;
}

bool isQuiet() {
  return talk().isQuiet;
}

int run(int argumentCount, char** arguments, const std::function<void(CLI::App&)>& addCommands) {
  spectral::endCleanlyBySignals("lutgen");
  // What OpenColorIO would say comes as an exception as well.
  OCIO_NAMESPACE::SetLoggingLevel(OCIO_NAMESPACE::LOGGING_LEVEL_NONE);
  CLI::App application("Colour transforms from spectra: LUT files and pictures under another light.", "lutgen");
  application.set_version_flag(
      "--version", std::string("lutgen ") + METAMER_VERSION + " (OpenColorIO " + OCIO_NAMESPACE::GetVersion() + ")");
  application.require_subcommand(1);
  talk();  // the clock
  addCommands(application);
  addToAll(application);
  try {
    application.parse(argumentCount, arguments);
    if (!talk().hasSummary && !talk().isResultOnOutput && !isList(application)) {
      summarise("done");
    }
    std::cout.flush();
    talk().output.flush();
    return std::cout && talk().output ? 0 : fail("standard output cannot be written", kFailure);
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
