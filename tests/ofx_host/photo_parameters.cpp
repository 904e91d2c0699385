// SPDX-License-Identifier: Apache-2.0
#include "photo_parameters.h"

#include <iomanip>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace photo_host {
namespace {

namespace Param = OFX::Host::Param;

template <typename Value>
Value parsed(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  Value value{};
  if (!(stream >> value)) {
    throw std::runtime_error("must be a number, not '" + text + "'");
  }
  return value;
}

template <typename Value>
std::string printed(Value value) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream << std::setprecision(17) << value;
  return stream.str();
}

/// All of HostSupport's one-valued parameters have the same four functions.
template <typename Base, typename Value>
class Single : public Base, public TextValue {
 public:
  Single(Param::SetInstance* set, Param::Descriptor& descriptor, Value value) : Base(descriptor, set), m_value(value) {}

  OfxStatus get(Value& value) override {
    value = m_value;
    return kOfxStatOK;
  }
  OfxStatus get(OfxTime, Value& value) override { return get(value); }
  OfxStatus set(Value value) override {
    m_value = value;
    return kOfxStatOK;
  }
  OfxStatus set(OfxTime, Value value) override { return set(value); }

  void setText(const std::string& text) override { m_value = parsed<Value>(text); }
  std::string text() const override { return printed(m_value); }

 protected:
  Value m_value;
};

class Number final : public Single<Param::DoubleInstance, double> {
 public:
  using Single::Single;
  OfxStatus derive(OfxTime, double&) override { return kOfxStatErrUnsupported; }
  OfxStatus integrate(OfxTime, OfxTime, double&) override { return kOfxStatErrUnsupported; }
};

using Flag = Single<Param::BooleanInstance, bool>;

/// Menus are written by label, where the label is there.
class Menu final : public Single<Param::ChoiceInstance, int> {
 public:
  using Single::Single;
  void setText(const std::string& text) override {
    const auto& properties = getProperties();
    for (int i = 0; i < properties.getDimension(kOfxParamPropChoiceOption); ++i) {
      if (properties.getStringProperty(kOfxParamPropChoiceOption, i) == text) {
        m_value = i;
        return;
      }
    }
    if (text.find_first_not_of("0123456789") != std::string::npos || text.empty()) {
      throw std::runtime_error("has no entry '" + text + "'");
    }
    m_value = parsed<int>(text);
  }
};

class Text final : public Param::StringInstance, public TextValue {
 public:
  Text(Param::SetInstance* set, Param::Descriptor& descriptor, std::string value)
      : StringInstance(descriptor, set), m_value(std::move(value)) {}

  OfxStatus get(std::string& value) override {
    value = m_value;
    return kOfxStatOK;
  }
  OfxStatus get(OfxTime, std::string& value) override { return get(value); }
  OfxStatus set(const char* value) override {
    m_value = value;
    return kOfxStatOK;
  }
  OfxStatus set(OfxTime, const char* value) override { return set(value); }

  void setText(const std::string& text) override { m_value = text; }
  std::string text() const override { return m_value; }

 private:
  std::string m_value;
};

}  // namespace

Param::Instance* newParameter(Param::SetInstance* set, Param::Descriptor& descriptor) {
  const std::string& type = descriptor.getType();
  const auto& properties = descriptor.getProperties();
  if (type == kOfxParamTypeDouble) {
    return new Number(set, descriptor, properties.getDoubleProperty(kOfxParamPropDefault));
  }
  if (type == kOfxParamTypeBoolean) {
    return new Flag(set, descriptor, properties.getIntProperty(kOfxParamPropDefault) != 0);
  }
  if (type == kOfxParamTypeChoice) {
    return new Menu(set, descriptor, properties.getIntProperty(kOfxParamPropDefault));
  }
  if (type == kOfxParamTypeString) {
    return new Text(set, descriptor, properties.getStringProperty(kOfxParamPropDefault));
  }
  if (type == kOfxParamTypeGroup) {
    return new Param::GroupInstance(descriptor, set);
  }
  return nullptr;
}

}  // namespace photo_host
