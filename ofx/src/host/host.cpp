// SPDX-License-Identifier: Apache-2.0
#include "host/host.h"

namespace metamer::ofx {
namespace {

template <typename Suite>
void fetchSuite(const OfxHost& host, const char* name, int version, const Suite*& suite) {
  suite = static_cast<const Suite*>(host.fetchSuite(host.host, name, version));
}

}  // namespace

HostSuites HostSuites::fetch(const OfxHost* host) {
  HostSuites suites;
  if (host == nullptr || host->fetchSuite == nullptr) {
    throw HostError(kOfxStatErrMissingHostFeature, "no host");
  }
  fetchSuite(*host, kOfxPropertySuite, 1, suites.property);
  fetchSuite(*host, kOfxImageEffectSuite, 1, suites.effect);
  fetchSuite(*host, kOfxParameterSuite, 1, suites.parameter);
  fetchSuite(*host, kOfxMultiThreadSuite, 1, suites.multiThread);
  fetchSuite(*host, kOfxMessageSuite, 1, suites.message);
  fetchSuite(*host, kOfxMessageSuite, 2, suites.persistentMessage);
  suites.hostProperties = host->host;
  if (suites.property == nullptr || suites.effect == nullptr || suites.parameter == nullptr) {
    throw HostError(kOfxStatErrMissingHostFeature, "the host lacks a suite that every effect needs");
  }
  return suites;
}

}  // namespace metamer::ofx
