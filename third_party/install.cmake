# SPDX-License-Identifier: BSD-3-Clause
# Install and export, so that find_package(vsb) gives vsb::vsb. Where this build made its own Kokkos, that Kokkos is
# installed beside vsb by its own rules.
include(CMakePackageConfigHelpers)
set(vsb_cmake_dir "${CMAKE_INSTALL_LIBDIR}/cmake/vsb")
install(TARGETS vsb EXPORT vsbTargets)
install(EXPORT vsbTargets NAMESPACE vsb:: DESTINATION ${vsb_cmake_dir})
write_basic_package_version_file("${PROJECT_BINARY_DIR}/vsbConfigVersion.cmake" COMPATIBILITY SameMinorVersion
                                 ARCH_INDEPENDENT)
configure_package_config_file(third_party/vsbConfig.cmake.in "${PROJECT_BINARY_DIR}/vsbConfig.cmake"
                              INSTALL_DESTINATION ${vsb_cmake_dir})
install(FILES "${PROJECT_BINARY_DIR}/vsbConfig.cmake" "${PROJECT_BINARY_DIR}/vsbConfigVersion.cmake"
        DESTINATION ${vsb_cmake_dir})
