// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "host_support.h"

namespace photo_host {

/// A parameter that holds one value for all times, readable and writable as text.
class TextValue {
 public:
  virtual ~TextValue() = default;
  virtual void setText(const std::string& text) = 0;
  virtual std::string text() const = 0;
};

/// The instance of one declared parameter, at its default.
OFX::Host::Param::Instance* newParameter(OFX::Host::Param::SetInstance* set, OFX::Host::Param::Descriptor& descriptor);

}  // namespace photo_host
