// SPDX-License-Identifier: Apache-2.0
#include "bare_properties.h"

#include <stdexcept>

namespace bare_host {

Properties::Properties(const Properties& other) {
  const std::lock_guard lock(other.m_mutex);
  for (const auto& [name, values] : other.m_current) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] != nullptr) {
        set(name, static_cast<int>(i), *values[i]);
      }
    }
  }
}

void Properties::set(const std::string& name, int index, Value value) {
  const std::lock_guard lock(m_mutex);
  auto& values = m_current[name];
  const auto place = static_cast<std::size_t>(index);
  if (values.size() <= place) {
    values.resize(place + 1, nullptr);
  }
  if (values[place] == nullptr || *values[place] != value) {
    m_values.push_back(std::move(value));
    values[place] = &m_values.back();
  }
}

void Properties::setAll(const std::string& name, const std::vector<int>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    set(name, static_cast<int>(i), values[i]);
  }
}

const Properties::Value* Properties::find(const std::string& name, int index) const {
  const std::lock_guard lock(m_mutex);
  const auto values = m_current.find(name);
  if (values == m_current.end() || index < 0 || static_cast<std::size_t>(index) >= values->second.size()) {
    return nullptr;
  }
  return values->second[static_cast<std::size_t>(index)];
}

int Properties::dimension(const std::string& name) const {
  const std::lock_guard lock(m_mutex);
  const auto values = m_current.find(name);
  return values == m_current.end() ? 0 : static_cast<int>(values->second.size());
}

std::string Properties::text(const std::string& name, int index) const {
  const Value* value = find(name, index);
  return value == nullptr ? std::string() : std::get<std::string>(*value);
}

int Properties::integer(const std::string& name, int index) const {
  const Value* value = find(name, index);
  return value == nullptr ? 0 : std::get<int>(*value);
}

double Properties::number(const std::string& name, int index) const {
  const Value* value = find(name, index);
  return value == nullptr ? 0.0 : std::get<double>(*value);
}

std::vector<std::string> Properties::texts(const std::string& name) const {
  std::vector<std::string> all;
  for (int i = 0; i < dimension(name); ++i) {
    all.push_back(text(name, i));
  }
  return all;
}

namespace {

template <typename Type>
OfxStatus put(OfxPropertySetHandle set, const char* name, int index, Type value) {
  if (set == nullptr || index < 0) {
    return kOfxStatErrBadHandle;
  }
  Properties::of(set).set(name, index, Properties::Value(std::move(value)));
  return kOfxStatOK;
}

template <typename Type>
OfxStatus take(OfxPropertySetHandle set, const char* name, int index, Type* value) {
  if (set == nullptr) {
    return kOfxStatErrBadHandle;
  }
  const Properties::Value* found = Properties::of(set).find(name, index);
  if (found == nullptr) {
    return kOfxStatErrUnknown;
  }
  const Type* held = std::get_if<Type>(found);
  if (held == nullptr) {
    return kOfxStatErrValue;
  }
  *value = *held;
  return kOfxStatOK;
}

OfxStatus takeString(OfxPropertySetHandle set, const char* name, int index, char** value) {
  if (set == nullptr) {
    return kOfxStatErrBadHandle;
  }
  const Properties::Value* found = Properties::of(set).find(name, index);
  const auto* text = found == nullptr ? nullptr : std::get_if<std::string>(found);
  if (text == nullptr) {
    return kOfxStatErrUnknown;
  }
  *value = const_cast<char*>(text->c_str());
  return kOfxStatOK;
}

OfxStatus setPointer(OfxPropertySetHandle set, const char* name, int index, void* value) {
  return put<void*>(set, name, index, value);
}
OfxStatus setString(OfxPropertySetHandle set, const char* name, int index, const char* value) {
  return put<std::string>(set, name, index, value);
}
OfxStatus setDouble(OfxPropertySetHandle set, const char* name, int index, double value) {
  return put<double>(set, name, index, value);
}
OfxStatus setInt(OfxPropertySetHandle set, const char* name, int index, int value) {
  return put<int>(set, name, index, value);
}
OfxStatus setPointerN(OfxPropertySetHandle, const char*, int, void* const*) {
  return kOfxStatErrUnsupported;
}
OfxStatus setStringN(OfxPropertySetHandle, const char*, int, const char* const*) {
  return kOfxStatErrUnsupported;
}
OfxStatus setDoubleN(OfxPropertySetHandle, const char*, int, const double*) {
  return kOfxStatErrUnsupported;
}
OfxStatus setIntN(OfxPropertySetHandle, const char*, int, const int*) {
  return kOfxStatErrUnsupported;
}
OfxStatus getPointer(OfxPropertySetHandle set, const char* name, int index, void** value) {
  return take<void*>(set, name, index, value);
}
OfxStatus getDouble(OfxPropertySetHandle set, const char* name, int index, double* value) {
  return take<double>(set, name, index, value);
}
OfxStatus getInt(OfxPropertySetHandle set, const char* name, int index, int* value) {
  return take<int>(set, name, index, value);
}
OfxStatus getPointerN(OfxPropertySetHandle, const char*, int, void**) {
  return kOfxStatErrUnsupported;
}
OfxStatus getStringN(OfxPropertySetHandle, const char*, int, char**) {
  return kOfxStatErrUnsupported;
}
OfxStatus getDoubleN(OfxPropertySetHandle set, const char* name, int count, double* values) {
  for (int i = 0; i < count; ++i) {
    if (const OfxStatus status = take<double>(set, name, i, values + i); status != kOfxStatOK) {
      return status;
    }
  }
  return kOfxStatOK;
}
OfxStatus getIntN(OfxPropertySetHandle set, const char* name, int count, int* values) {
  for (int i = 0; i < count; ++i) {
    if (const OfxStatus status = take<int>(set, name, i, values + i); status != kOfxStatOK) {
      return status;
    }
  }
  return kOfxStatOK;
}
OfxStatus reset(OfxPropertySetHandle, const char*) {
  return kOfxStatErrUnsupported;
}
OfxStatus getDimension(OfxPropertySetHandle set, const char* name, int* count) {
  *count = Properties::of(set).dimension(name);
  return kOfxStatOK;
}

}  // namespace

const OfxPropertySuiteV1& propertySuite() {
  static const OfxPropertySuiteV1 suite = {setPointer,  setString,  setDouble,  setInt,     setPointerN, setStringN,
                                           setDoubleN,  setIntN,    getPointer, takeString, getDouble,   getInt,
                                           getPointerN, getStringN, getDoubleN, getIntN,    reset,       getDimension};
  return suite;
}

}  // namespace bare_host
