// SPDX-License-Identifier: Apache-2.0
#include "device/opencl_programs.h"

#include <algorithm>

#include "device/window_text.h"

namespace metamer::ofx {
namespace {

constexpr std::size_t kKeptPrograms = 8;
/// OpenCL C 1.2 as it is, without any of the options that loosen arithmetic.
constexpr const char* kOptions = "-cl-std=CL1.2";
/// Where a device has it: results are then the processor's to the bit.
constexpr const char* kExactDivisions = " -cl-fp32-correctly-rounded-divide-sqrt";

/// A compiler's log can be pages: what it says first of an error.
std::string firstError(const std::string& log) {
  const std::size_t at = log.find("error");
  const std::size_t begin = at == std::string::npos ? 0 : log.rfind('\n', at) + 1;
  return log.substr(begin, std::min<std::size_t>(log.find('\n', begin) - begin, 200));
}

}  // namespace

OpenCl::Owned OpenClPrograms::kernel(OpenCl::Handle context, OpenCl::Handle device, const char* name) {
  const Entry built = entry(context, device);
  if (!built.problem.empty()) {
    throw OpenClError(OpenCl::kSuccess, built.problem);
  }
  OpenCl::Status status = OpenCl::kSuccess;
  OpenCl::Owned made(m_library->createKernel(built.program.get(), name, &status), m_library->releaseKernel);
  if (status == OpenCl::kInvalidKernelName) {
    return {nullptr, m_library->releaseKernel};
  }
  OpenClError::check(status, "a kernel");
  return made;
}

OpenClPrograms::Entry OpenClPrograms::entry(OpenCl::Handle context, OpenCl::Handle device) {
  const std::lock_guard lock(m_mutex);
  const auto found = std::find_if(m_entries.begin(), m_entries.end(),
                                  [&](const Entry& each) { return each.context == context && each.device == device; });
  if (found != m_entries.end()) {
    m_entries.splice(m_entries.begin(), m_entries, found);
  } else {
    m_entries.push_front(build(context, device));
    if (m_entries.size() > kKeptPrograms) {
      m_entries.pop_back();
    }
  }
  return m_entries.front();
}

OpenClPrograms::Entry OpenClPrograms::build(OpenCl::Handle context, OpenCl::Handle device) const {
  const std::string text = openClWindowText();
  const char* source = text.c_str();
  OpenCl::Status status = OpenCl::kSuccess;
  OpenCl::Handle const program = m_library->createProgram(context, 1, &source, nullptr, &status);
  OpenClError::check(status, "a program");
  Entry made{context, device, {program, m_library->releaseProgram}, {}};
  OpenCl::Flags arithmetic = 0;
  m_library->deviceInfo(device, OpenCl::kSingleArithmetic, sizeof arithmetic, &arithmetic, nullptr);
  std::string options = kOptions;
  options += (arithmetic & OpenCl::kRoundsDivisions) != 0 ? kExactDivisions : "";
  status = m_library->buildProgram(program, 1, &device, options.c_str(), nullptr, nullptr);
  if (status != OpenCl::kSuccess) {
    std::size_t bytes = 0;
    m_library->buildInfo(program, device, OpenCl::kBuildLog, 0, nullptr, &bytes);
    std::string log(bytes, '\0');
    m_library->buildInfo(program, device, OpenCl::kBuildLog, log.size(), log.data(), nullptr);
    made.problem = "the driver does not compile the kernel (" + std::to_string(status) + "): " + firstError(log);
  }
  return made;
}

}  // namespace metamer::ofx
