// SPDX-License-Identifier: Apache-2.0
// Builds where metamer::ocio_plugin brings OpenColorIO along.
#include <OpenColorIO/OpenColorIO.h>

#include <cstdio>

int main() {
  std::puts(OCIO_NAMESPACE::GetVersion());
  return 0;
}
