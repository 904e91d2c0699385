// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <cstddef>
#include <memory>
#include <string>

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// Where spaces that are not built in are looked up. A config is opened when it is first asked for, so that what asks
/// for none does not care whether it is there; copies share what was opened. May be asked from several threads at a
/// time.
class ConfigSource {
 public:
  /// No config.
  ConfigSource();
  ConfigSource(std::nullptr_t);  // NOLINT(google-explicit-constructor): no config
  /// One that is open already. @param name  its file or name, for messages
  ConfigSource(OCIO::ConstConfigRcPtr config,  // NOLINT(google-explicit-constructor)
               std::string name = "config");
  /// The config that $OCIO names now: a file, an archive, or a name of OCIO's own (ocio://default). None where it is
  /// not set.
  static ConfigSource environment();

  /// Null where there is none.
  /// @throws spectral::InputError where $OCIO cannot be read
  OCIO::ConstConfigRcPtr open() const;
  /// The config's file or name, for messages.
  const std::string& name() const;

 private:
  struct State;
  std::shared_ptr<State> m_state;
};

/// Whether a config is one of OCIO's own, which are named and not files.
bool isBuiltInConfig(const std::string& name);

/// A config by its file, archive (.ocioz) or, of OCIO's own, its name (ocio://default).
/// @throws spectral::InputError where it is not there or cannot be read
OCIO::ConstConfigRcPtr configNamed(const std::string& name);

}  // namespace metamer::ocio
