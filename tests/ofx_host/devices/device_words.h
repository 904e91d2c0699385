// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstring>

#include "device_ledger.h"

// What the libraries of devices that are the tests' own have in common.

/// Of a library: one, which the plug-in's and the test's view share.
inline DeviceLedger& ledgerOfLibrary() {
  static DeviceLedger kept = {};
  return kept;
}

inline void count(int& counter, int by = 1) {
  std::atomic_ref(counter) += by;
}

/// Whether a call of this name is to fail; asked once by each that may.
inline bool isRefused(const char* name) {
  DeviceLedger& ledger = ledgerOfLibrary();
  const bool isTheOne = ++std::atomic_ref(ledger.calls) == ledger.failing;
  return isTheOne ||
         (ledger.refused != nullptr && std::strncmp(ledger.refused, name, std::strlen(ledger.refused)) == 0);
}
