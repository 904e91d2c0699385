// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/host.h"

namespace metamer::ofx {

/// A property set of the host with types. Holds no ownership.
class PropertySet {
 public:
  PropertySet(const HostSuites& host, OfxPropertySetHandle handle) : m_host(&host), m_handle(handle) {}

  OfxPropertySetHandle handle() const { return m_handle; }

  /// Values that must be there. @throws HostError
  std::string getString(const char* name, int index = 0) const;
  double getDouble(const char* name, int index = 0) const;
  int getInt(const char* name, int index = 0) const;
  void* getPointer(const char* name) const;
  OfxRectI getRectI(const char* name) const;

  /// The same where a host may leave it out: nothing then.
  std::optional<std::string> findString(const char* name, int index = 0) const;
  std::optional<int> findInt(const char* name, int index = 0) const;
  std::optional<void*> findPointer(const char* name) const;

  /// @throws HostError
  void set(const char* name, const std::string& value, int index = 0) const;
  void set(const char* name, double value, int index = 0) const;
  void set(const char* name, int value, int index = 0) const;
  void setPointer(const char* name, void* value) const;
  void setAll(const char* name, const std::vector<std::string>& values) const;

  /// For properties that not every host knows, or holds fixed: false where it refuses.
  bool trySet(const char* name, const std::string& value, int index = 0) const;
  bool trySet(const char* name, int value, int index = 0) const;

 private:
  const OfxPropertySuiteV1& suite() const { return *m_host->property; }

  const HostSuites* m_host;
  OfxPropertySetHandle m_handle;
};

}  // namespace metamer::ofx
