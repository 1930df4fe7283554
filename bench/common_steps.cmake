# SPDX-License-Identifier: BSD-3-Clause
# vsb_common_steps: the steps that benchmarks and tests have in common, compiled once (common_steps.hpp).
if(VSB_BACKEND STREQUAL "Cuda") # they are steps of hosts
  add_library(vsb_common_steps INTERFACE)
  target_include_directories(vsb_common_steps INTERFACE "${CMAKE_CURRENT_LIST_DIR}")
  return()
endif()
add_library(vsb_common_steps STATIC)
foreach(instance "1 double LinearBasis LaneState" "2 double LinearBasis LaneState" "3 double LinearBasis LaneState"
                 "1 float LinearBasis LaneState" "2 float LinearBasis LaneState" "3 float LinearBasis LaneState"
                 "1 double QuadraticBSplineBasis SplineLaneState" "2 double QuadraticBSplineBasis SplineLaneState"
                 "3 double QuadraticBSplineBasis SplineLaneState" "2 float QuadraticBSplineBasis SplineLaneState"
                 "3 float QuadraticBSplineBasis SplineLaneState")
  string(REPLACE " " ";" instance "${instance}")
  list(GET instance 0 dimension)
  list(GET instance 1 real)
  list(GET instance 2 basis)
  list(GET instance 3 lanes)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/generated/common_step_${basis}_${real}_${dimension}.cpp")
  configure_file("${CMAKE_CURRENT_LIST_DIR}/common_step.cpp.in" "${source}" @ONLY)
  target_sources(vsb_common_steps PRIVATE "${source}")
endforeach()
target_include_directories(vsb_common_steps PUBLIC "${CMAKE_CURRENT_LIST_DIR}")
target_link_libraries(vsb_common_steps PRIVATE vsb_kernel_options)
