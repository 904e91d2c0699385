// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bare_host.h"

namespace bare_host {

/// What the host's C functions reach: one host's features and its property set.
struct HostState {
  Features features;
  Properties properties;
  OfxHost host{};
};

/// Fetches a suite, or nothing where the features leave it out.
const void* fetchSuite(OfxPropertySetHandle host, const char* name, int version);

/// Threads that the host's multi-thread suite runs. The suite's functions are given no host to ask.
void setSuiteThreads(int threads);

}  // namespace bare_host
