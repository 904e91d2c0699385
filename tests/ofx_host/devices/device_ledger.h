// SPDX-License-Identifier: Apache-2.0
#pragma once

// What a library of a device that the plug-in loads in a test writes down: every call counted, and those refused that a
// test names.
struct DeviceLedger {
  int programs;  ///< built
  int buffers;   ///< made and not released
  int uploads;   ///< buffers made
  int kernels;   ///< enqueued
  int reads;
  int writes;
  int waits;     ///< calls that return when the queue is empty
  int released;  ///< programs
  int calls;     ///< that may fail
  int failing;   ///< the number of the one call, from 1 on, that fails; 0: none
  /// The functions whose name begins like this, and what they answer; null: all work.
  const char* refused;
  int status;
};

/// The library exports this under the name "metamerLedger".
using DeviceLedgerFunction = DeviceLedger*();
