// SPDX-License-Identifier: Apache-2.0
#pragma once

// An OpenCL library for the plug-in to load: the system's own behind it, every call counted, and those refused that a
// test names.
struct OpenClLedger {
  int programs;  ///< built
  int buffers;   ///< made and not released
  int uploads;   ///< buffers made
  int kernels;   ///< enqueued
  int reads;
  int writes;
  int waits;     ///< calls that return when the queue is empty
  int released;  ///< programs
  /// The functions whose OpenCL name begins like this, and what they answer; null: all work.
  const char* refused;
  int status;
};

/// The library exports this under the name "metamerLedger".
using OpenClLedgerFunction = OpenClLedger*();
