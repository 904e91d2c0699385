// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ofxCore.h>
#include <ofxImageEffect.h>
#include <ofxMessage.h>
#include <ofxMultiThread.h>
#include <ofxParam.h>

#include <stdexcept>

namespace metamer::ofx {

/// A call that the host answered with a failure. Never leaves the plug-in: the entry point returns its status.
class HostError : public std::runtime_error {
 public:
  HostError(OfxStatus status, const char* what) : std::runtime_error(what), m_status(status) {}
  OfxStatus status() const { return m_status; }

 private:
  OfxStatus m_status;
};

/// Throws where `status` is a failure. `what` names the call.
inline void check(OfxStatus status, const char* what) {
  if (status != kOfxStatOK) {
    throw HostError(status, what);
  }
}

/// The suites a host offers. Plain pointers that live as long as the host.
struct HostSuites {
  const OfxPropertySuiteV1* property = nullptr;
  const OfxImageEffectSuiteV1* effect = nullptr;
  const OfxParameterSuiteV1* parameter = nullptr;
  const OfxMultiThreadSuiteV1* multiThread = nullptr;    ///< may be missing
  const OfxMessageSuiteV1* message = nullptr;            ///< may be missing
  const OfxMessageSuiteV2* persistentMessage = nullptr;  ///< may be missing
  OfxPropertySetHandle hostProperties = nullptr;         ///< may be missing

  /// @throws HostError kOfxStatErrMissingHostFeature without property, image effect or parameter suite
  static HostSuites fetch(const OfxHost* host);
};

}  // namespace metamer::ofx
