// SPDX-License-Identifier: Apache-2.0
#include "drivers/opencl_programs.h"

#include <algorithm>

#include "device/window_text.h"

namespace metamer::ofx {
namespace {

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
  const Entry built = m_entries.get([&](const Entry& entry) { return entry.isAt(context, device); },
                                    [&] { return build(context, device); });
  if (!built.problem.empty()) {
    throw DeviceError(built.problem);
  }
  OpenCl::Status status = OpenCl::kSuccess;
  OpenCl::Owned made(m_library->createKernel(built.program.get(), name, &status), m_library->releaseKernel);
  if (status == OpenCl::kInvalidKernelName) {
    return {nullptr, m_library->releaseKernel};
  }
  checkOpenCl(status, "a kernel");
  return made;
}

OpenClPrograms::Entry OpenClPrograms::build(OpenCl::Handle context, OpenCl::Handle device) const {
  const char* source = windowText("window.cl").data();
  OpenCl::Status status = OpenCl::kSuccess;
  OpenCl::Handle const program = m_library->createProgram(context, 1, &source, nullptr, &status);
  checkOpenCl(status, "a program");
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
