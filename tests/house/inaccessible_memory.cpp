// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Does not compile, and says why: no execution space of this build can access memory `Elsewhere`.
#include <vsb/kernels/boundary/mark_boundary_nodes.hpp>
#include <vsb/physics/linear_basis.hpp>

struct Elsewhere {
  using memory_space = Elsewhere;
  using execution_space = Kokkos::DefaultHostExecutionSpace;
  using device_type = Kokkos::Device<execution_space, memory_space>;
  using size_type = size_t;
  static constexpr const char* name() { return "Elsewhere"; }
};

int locate(const vsb::Particles<2, double, Elsewhere::device_type>& particles,
           const vsb::ParticleBins<Elsewhere::device_type>& bins, const vsb::LinearBasis<2, double>& basis) {
  return vsb::locate_particles(Kokkos::DefaultHostExecutionSpace(), particles, bins, basis).lost;
}
