// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/parameter.h"
#include "host/parameter_values.h"
#include "pixels/pixel_transform.h"

namespace metamer::ofx {

/// Names that effects share, in parameters.
inline constexpr const char* kMixName = "mix";
inline constexpr const char* kHostSpaceName = "hostSpace";

/// One effect of the bundle: what it is called, what can be set, what it does to a pixel. Shared by its instances, safe
/// between threads.
class Effect {
 public:
  struct Names {
    std::string identifier;  ///< reverse domain; part of users' projects
    std::string label;
    std::string description;
  };

  virtual ~Effect() = default;

  const Names& names() const { return m_names; }
  const std::vector<Parameter>& parameters() const { return m_parameters; }

  /// What the parameters of one instance ask for at a time.
  /// @param hostSpace  our name of the source's colour space, where the host has told it and the user follows it
  /// @throws spectral::InputError with the line to show
  virtual std::shared_ptr<const PixelTransform> transform(const ParameterValues& values, double time,
                                                          const std::optional<std::string>& hostSpace) const = 0;

  /// Our name of the colour space that the manual menus ask for.
  virtual std::string wantedSpace(const ParameterValues& values) const = 0;

  /// Greys out what has no say.
  virtual void enableParameters(const ParameterValues& values) const = 0;

 protected:
  Effect(Names names, std::vector<Parameter> parameters)
      : m_names(std::move(names)), m_parameters(std::move(parameters)) {}

 private:
  Names m_names;
  std::vector<Parameter> m_parameters;
};

}  // namespace metamer::ofx
