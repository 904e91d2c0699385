// SPDX-License-Identifier: Apache-2.0
#include "host/property_set.h"

#include <array>

namespace metamer::ofx {

std::string PropertySet::getString(const char* name, int index) const {
  char* value = nullptr;
  check(suite().propGetString(m_handle, name, index, &value), name);
  return value == nullptr ? std::string() : std::string(value);
}

double PropertySet::getDouble(const char* name, int index) const {
  double value = 0;
  check(suite().propGetDouble(m_handle, name, index, &value), name);
  return value;
}

int PropertySet::getInt(const char* name, int index) const {
  int value = 0;
  check(suite().propGetInt(m_handle, name, index, &value), name);
  return value;
}

void* PropertySet::getPointer(const char* name) const {
  void* value = nullptr;
  check(suite().propGetPointer(m_handle, name, 0, &value), name);
  return value;
}

OfxRectI PropertySet::getRectI(const char* name) const {
  std::array<int, 4> value{};
  check(suite().propGetIntN(m_handle, name, 4, value.data()), name);
  return {value[0], value[1], value[2], value[3]};
}

std::optional<std::string> PropertySet::findString(const char* name, int index) const {
  char* value = nullptr;
  if (suite().propGetString(m_handle, name, index, &value) != kOfxStatOK || value == nullptr) {
    return std::nullopt;
  }
  return value;
}

std::optional<int> PropertySet::findInt(const char* name, int index) const {
  int value = 0;
  if (suite().propGetInt(m_handle, name, index, &value) != kOfxStatOK) {
    return std::nullopt;
  }
  return value;
}

std::optional<void*> PropertySet::findPointer(const char* name) const {
  void* value = nullptr;
  if (suite().propGetPointer(m_handle, name, 0, &value) != kOfxStatOK) {
    return std::nullopt;
  }
  return value;
}

void PropertySet::set(const char* name, const std::string& value, int index) const {
  check(suite().propSetString(m_handle, name, index, value.c_str()), name);
}

void PropertySet::set(const char* name, double value, int index) const {
  check(suite().propSetDouble(m_handle, name, index, value), name);
}

void PropertySet::set(const char* name, int value, int index) const {
  check(suite().propSetInt(m_handle, name, index, value), name);
}

void PropertySet::setPointer(const char* name, void* value) const {
  check(suite().propSetPointer(m_handle, name, 0, value), name);
}

void PropertySet::setAll(const char* name, const std::vector<std::string>& values) const {
  for (std::size_t i = 0; i < values.size(); ++i) {
    set(name, values[i], static_cast<int>(i));
  }
}

bool PropertySet::trySet(const char* name, const std::string& value, int index) const {
  return suite().propSetString(m_handle, name, index, value.c_str()) == kOfxStatOK;
}

bool PropertySet::trySet(const char* name, int value, int index) const {
  return suite().propSetInt(m_handle, name, index, value) == kOfxStatOK;
}

}  // namespace metamer::ofx
