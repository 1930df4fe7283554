# SPDX-License-Identifier: BSD-3-Clause
# Install and export, so that find_package(vsb) gives vsb::vsb and vsb::native. Where this build made its own Kokkos, that Kokkos is
# installed beside vsb by its own rules.
include(CMakePackageConfigHelpers)
set(vsb_cmake_dir "${CMAKE_INSTALL_LIBDIR}/cmake/vsb")
install(TARGETS vsb vsb_native EXPORT vsbTargets)
install(EXPORT vsbTargets NAMESPACE vsb:: DESTINATION ${vsb_cmake_dir})
write_basic_package_version_file("${PROJECT_BINARY_DIR}/vsbConfigVersion.cmake" COMPATIBILITY SameMinorVersion
                                 ARCH_INDEPENDENT)
set(vsb_kokkos_place "")
if(vsb_builds_kokkos)
  set(vsb_kokkos_place "HINTS \"\${PACKAGE_PREFIX_DIR}\"")
elseif(Kokkos_DIR)
  set(vsb_kokkos_place "PATHS \"${Kokkos_DIR}\"")
endif()
configure_package_config_file(third_party/vsbConfig.cmake.in "${PROJECT_BINARY_DIR}/vsbConfig.cmake"
                              INSTALL_DESTINATION ${vsb_cmake_dir})
install(FILES "${PROJECT_BINARY_DIR}/vsbConfig.cmake" "${PROJECT_BINARY_DIR}/vsbConfigVersion.cmake"
        DESTINATION ${vsb_cmake_dir})
