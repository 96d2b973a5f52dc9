# SPDX-License-Identifier: MPL-2.0
# The sources are the tree that contains this port. The port of a release has vcpkg_from_github() here instead.
cmake_path(SET SOURCE_PATH NORMALIZE "${CURRENT_PORT_DIR}/../../..")
set(VCPKG_BUILD_TYPE release) # headers only

vcpkg_check_features(OUT_FEATURE_OPTIONS options FEATURES analytic REVCHAIN_ANALYTIC)
vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS ${options} -DREVCHAIN_BUILD_TESTS=OFF -DREVCHAIN_BUILD_EXAMPLES=OFF
)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH share/cmake/revchain)
vcpkg_fixup_pkgconfig()

set(licences "${SOURCE_PATH}/LICENSES/MPL-2.0.txt")
if("analytic" IN_LIST FEATURES)
  list(APPEND licences "${SOURCE_PATH}/LICENSES/GPL-3.0-or-later.txt")
endif()
vcpkg_install_copyright(FILE_LIST ${licences})
file(INSTALL "${CURRENT_PORT_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
