// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ofxCore.h>
#include <ofxProperty.h>

#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <variant>
#include <vector>

namespace bare_host {

/// A property set with no rules of its own: anything may be set at any index, from any thread.
class Properties {
 public:
  using Value = std::variant<int, double, std::string, void*>;

  Properties() = default;
  Properties(const Properties& other);
  Properties& operator=(const Properties&) = delete;

  OfxPropertySetHandle handle() { return reinterpret_cast<OfxPropertySetHandle>(this); }
  static Properties& of(OfxPropertySetHandle handle) { return *reinterpret_cast<Properties*>(handle); }

  void set(const std::string& name, int index, Value value);
  void set(const std::string& name, Value value) { set(name, 0, std::move(value)); }
  void setAll(const std::string& name, const std::vector<int>& values);
  /// Null where it is not there. The pointer lives as long as the set: hosts' strings do.
  const Value* find(const std::string& name, int index = 0) const;
  int dimension(const std::string& name) const;
  std::string text(const std::string& name, int index = 0) const;
  int integer(const std::string& name, int index = 0) const;
  double number(const std::string& name, int index = 0) const;
  std::vector<std::string> texts(const std::string& name) const;

 private:
  mutable std::mutex m_mutex;
  /// Older values are kept: a plug-in may still hold a pointer to their text.
  std::deque<Value> m_values;
  std::map<std::string, std::vector<const Value*>> m_current;
};

/// The property suite over such sets.
const OfxPropertySuiteV1& propertySuite();

}  // namespace bare_host
