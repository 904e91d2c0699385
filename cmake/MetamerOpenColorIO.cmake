# SPDX-License-Identifier: Apache-2.0
# Which OpenColorIO is linked: the release that script/releases/opencolorio.txt pins, which the install tree carries, or the
# system's.
include(MetamerReleases)
set(METAMER_OCIO release CACHE STRING "OpenColorIO to link: release (script/releases/opencolorio.txt), or system (2.1 or newer)")
set_property(CACHE METAMER_OCIO PROPERTY STRINGS release system)

set(METAMER_OCIO_VERSION 2.1)
metamer_release(OpenColorIO "${METAMER_OCIO}" METAMER_OCIO)
find_package(OpenColorIO ${METAMER_OCIO_VERSION} REQUIRED)
set(METAMER_OCIO_FOLDER "${CMAKE_INSTALL_LIBDIR}/metamer/opencolorio")
if(METAMER_OCIO_ROOT)
  metamer_install_release(OpenColorIO "${METAMER_OCIO_ROOT}" "${OpenColorIO_LIBRARY}")
endif()
