# SPDX-License-Identifier: BSD-3-Clause
# Installs this build into scratch prefixes, then configures, builds and runs consumers against them: a program through
# find_package(vsb), and with the source tree as a subdirectory (with the installed Kokkos, so that none is built twice);
# and a shared library against a prefix that was moved after installation. None may see a warning or a note.
set(scratch "${CMAKE_CURRENT_BINARY_DIR}/consumer")
set(prefix "${scratch}/prefix")
set(moved "${scratch}/moved")

add_test(NAME consumer.install COMMAND "${CMAKE_COMMAND}" --install "${PROJECT_BINARY_DIR}" --prefix "${prefix}")
add_test(NAME consumer.install_and_move
         COMMAND "${CMAKE_COMMAND}" -DBUILD=${PROJECT_BINARY_DIR} -DFROM=${scratch}/before_the_move -DTO=${moved}
                 -P "${CMAKE_CURRENT_SOURCE_DIR}/consumer/install_and_move.cmake")

# commands: what is run once all of `targets` (all: every one) is built.
function(vsb_add_consumer_test name prefix targets commands)
  add_test(NAME consumer.${name}
           COMMAND "${CMAKE_CTEST_COMMAND}" --build-and-test "${CMAKE_CURRENT_SOURCE_DIR}/consumer" "${scratch}/${name}"
                   --build-generator "${CMAKE_GENERATOR}" --build-target ${targets} --build-options ${ARGN}
                   -DVSB_SOURCE_DIR=${PROJECT_SOURCE_DIR} "-DCMAKE_PREFIX_PATH=${prefix}" -DCMAKE_BUILD_TYPE=Release
                   -DVSB_BACKEND=${VSB_BACKEND} -DVSB_DOWNLOAD_SECONDS=0
                   --test-command sh -c "${commands}")
  set_tests_properties(consumer.${name} PROPERTIES LABELS consumer TIMEOUT 600 FAIL_REGULAR_EXPRESSION "warning:;note:"
                                                   ENVIRONMENT "OMP_PROC_BIND=false;OMP_NUM_THREADS=2")
endfunction()
foreach(from package subdirectory)
  vsb_add_consumer_test(${from} "${prefix}" all "./particle_step && ./lane_step && ./own_field && ./lane_step_without_flags"
                        -DVSB_FROM=${from} -DVSB_EXAMPLES_SHARED=OFF)
endforeach()
set_tests_properties(consumer.install PROPERTIES FIXTURES_SETUP vsb_installed LABELS consumer)
set_tests_properties(consumer.package consumer.subdirectory PROPERTIES FIXTURES_REQUIRED vsb_installed)
if(vsb_builds_kokkos)  # another Kokkos may not be position independent, and lies elsewhere
  vsb_add_consumer_test(shared_library "${moved}" boundary_nodes_main ./boundary_nodes_main -DVSB_FROM=package
                        "-DVSB_KOKKOS_IN=${moved}")
  set_tests_properties(consumer.shared_library PROPERTIES FIXTURES_REQUIRED vsb_moved)
endif()
set_tests_properties(consumer.install_and_move PROPERTIES FIXTURES_SETUP vsb_moved LABELS consumer)
