# SPDX-License-Identifier: Apache-2.0
# Which OpenImageIO is linked: the release that script/releases/openimageio.txt pins, which the install tree carries, or the
# system's. The release stands alone; Debian's draws some 250 libraries in, which take a quarter of a second to load.
include(MetamerReleases)
set(METAMER_OIIO release CACHE STRING "OpenImageIO to link: release (script/releases/openimageio.txt), or system (2.4 or newer)")
set_property(CACHE METAMER_OIIO PROPERTY STRINGS release system)

set(METAMER_OIIO_VERSION 2.4)
metamer_release(OpenImageIO "${METAMER_OIIO}" METAMER_OIIO)
find_package(OpenImageIO ${METAMER_OIIO_VERSION} REQUIRED)
set(METAMER_OIIO_FOLDER "${CMAKE_INSTALL_LIBDIR}/metamer/openimageio")
if(METAMER_OIIO_ROOT)
  metamer_install_release(OpenImageIO "${METAMER_OIIO_ROOT}" ${OpenImageIO_LIBRARIES})
endif()
