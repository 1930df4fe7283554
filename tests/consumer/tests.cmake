# SPDX-License-Identifier: BSD-3-Clause
# Installs this build into a scratch prefix, then configures, builds and runs the consumer against it: once through
# find_package(vsb), once with the source tree as a subdirectory (with the installed Kokkos, so that none is built twice).
set(scratch "${CMAKE_CURRENT_BINARY_DIR}/consumer")
set(prefix "${scratch}/prefix")

add_test(NAME consumer.install COMMAND "${CMAKE_COMMAND}" --install "${PROJECT_BINARY_DIR}" --prefix "${prefix}")
set_tests_properties(consumer.install PROPERTIES FIXTURES_SETUP vsb_installed LABELS consumer)

foreach(from package subdirectory)
  add_test(NAME consumer.${from}
           COMMAND "${CMAKE_CTEST_COMMAND}" --build-and-test "${CMAKE_CURRENT_SOURCE_DIR}/consumer" "${scratch}/${from}"
                   --build-generator "${CMAKE_GENERATOR}" --build-options -DVSB_FROM=${from}
                   -DVSB_SOURCE_DIR=${PROJECT_SOURCE_DIR} "-DCMAKE_PREFIX_PATH=${prefix}" -DCMAKE_BUILD_TYPE=Release
                   -DVSB_BACKEND=${VSB_BACKEND} -DVSB_DOWNLOAD_SECONDS=0
                   --test-command consumer)
  set_tests_properties(consumer.${from} PROPERTIES FIXTURES_REQUIRED vsb_installed LABELS consumer TIMEOUT 600
                                                   ENVIRONMENT "OMP_PROC_BIND=false;OMP_NUM_THREADS=2")
endforeach()
