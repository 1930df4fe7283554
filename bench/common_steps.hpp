// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The steps that benchmarks and tests have in common, of linear elastic bodies under each kind of field:
/// declared here, and compiled once, in the library vsb_common_steps, in place of once in every source.
#pragma once

#include <vsb/kernels/lane_step.hpp>
#include <vsb/kernels/step.hpp>
#include <vsb/physics/linear_basis.hpp>
#include <vsb/physics/quadratic_bspline_basis.hpp>
#include <vsb/physics/traction_fields.hpp>

// `prefix` is `extern template` or `template`; Basis and Lanes belong together.
#define VSB_COMMON_STEPS(prefix, Dim, Real, Basis, Lanes, ...)                                               \
  prefix void prepare_lane_step(const HostExec&, Lanes<Dim, Real, HostExec::device_type>&,                   \
                                const __VA_ARGS__&);                                                         \
  prefix int lane_step(const HostExec&, Lanes<Dim, Real, HostExec::device_type>&,                            \
                       const LinearElastic<Real>&, const DeterminantVolume&, const __VA_ARGS__&,             \
                       const StepOptions<Dim, Real>&);                                                       \
  prefix int step(const HostExec&, State<Dim, Real, HostExec::device_type>&, const std::vector<Body<Real>>&, \
                  const Basis<Dim, Real>&, const __VA_ARGS__&, const StepOptions<Dim, Real>&);

#define VSB_COMMON_ENGINES(prefix, Dim, Real, Basis, Lanes)                                        \
  VSB_COMMON_STEPS(prefix, Dim, Real, Basis, Lanes, NoVirtualStress)                               \
  VSB_COMMON_STEPS(prefix, Dim, Real, Basis, Lanes, UniformVirtualStress<Dim, Real>)               \
  VSB_COMMON_STEPS(prefix, Dim, Real, Basis, Lanes, TractionFields<Dim, Real>)                     \
  prefix int pack_lanes(const HostExec&, const Particles<Dim, Real, HostExec::device_type>&,       \
                        Lanes<Dim, Real, HostExec::device_type>&);                                 \
  prefix int update_occupancy(const HostExec&, const Particles<Dim, Real, HostExec::device_type>&, \
                              Occupancy<HostExec::device_type>&, const Basis<Dim, Real>&);

namespace vsb {

using HostExec = Kokkos::DefaultHostExecutionSpace;

VSB_COMMON_ENGINES(extern template, 1, double, LinearBasis, LaneState)
VSB_COMMON_ENGINES(extern template, 2, double, LinearBasis, LaneState)
VSB_COMMON_ENGINES(extern template, 3, double, LinearBasis, LaneState)
VSB_COMMON_ENGINES(extern template, 1, float, LinearBasis, LaneState)
VSB_COMMON_ENGINES(extern template, 2, float, LinearBasis, LaneState)
VSB_COMMON_ENGINES(extern template, 3, float, LinearBasis, LaneState)
VSB_COMMON_ENGINES(extern template, 1, double, QuadraticBSplineBasis, SplineLaneState)
VSB_COMMON_ENGINES(extern template, 2, double, QuadraticBSplineBasis, SplineLaneState)
VSB_COMMON_ENGINES(extern template, 3, double, QuadraticBSplineBasis, SplineLaneState)
VSB_COMMON_ENGINES(extern template, 2, float, QuadraticBSplineBasis, SplineLaneState)
VSB_COMMON_ENGINES(extern template, 3, float, QuadraticBSplineBasis, SplineLaneState)

}  // namespace vsb
