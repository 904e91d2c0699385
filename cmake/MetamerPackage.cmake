# SPDX-License-Identifier: Apache-2.0
# find_package(metamer) from an install: targets, what they need in turn, version.
include(CMakePackageConfigHelpers)

set(METAMER_PACKAGE_FOLDER "${CMAKE_INSTALL_LIBDIR}/cmake/metamer")
set(METAMER_DATA_FOLDER "${CMAKE_INSTALL_DATADIR}/metamer/data")

configure_package_config_file(
  "${CMAKE_CURRENT_LIST_DIR}/metamerConfig.cmake.in" "${PROJECT_BINARY_DIR}/metamerConfig.cmake"
  INSTALL_DESTINATION "${METAMER_PACKAGE_FOLDER}"
  PATH_VARS METAMER_DATA_FOLDER METAMER_OCIO_FOLDER METAMER_OIIO_FOLDER)
# Before 1.0 a minor release may break its users.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/metamerConfigVersion.cmake" COMPATIBILITY SameMinorVersion)

install(EXPORT metamerTargets NAMESPACE metamer:: DESTINATION "${METAMER_PACKAGE_FOLDER}")
install(FILES "${PROJECT_BINARY_DIR}/metamerConfig.cmake" "${PROJECT_BINARY_DIR}/metamerConfigVersion.cmake"
  "${CMAKE_CURRENT_LIST_DIR}/FindOpenColorIO.cmake" "${CMAKE_CURRENT_LIST_DIR}/FindOpenImageIO.cmake"
  DESTINATION "${METAMER_PACKAGE_FOLDER}")
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DATADIR}/metamer")
