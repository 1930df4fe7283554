// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The equivalent plastic deviatoric strain of particles, Eq. (34). The state of a plastic material begins
/// with the plastic strain tensor.
#pragma once

#include <vsb/physics/plastic_strain.hpp>
#include <vsb/views/particles.hpp>

namespace vsb {

namespace kernel {

template <int Dim, class Real, class Device>
struct EquivalentPlasticStrain {
  Particles<Dim, Real, Device> particles;
  int state_offset;  ///< of Body
  Kokkos::View<Real*, Device> strain;

  KOKKOS_FUNCTION void operator()(int p) const {
    SymmetricTensor<Dim, Real> plastic;
    for (int c = 0; c < plastic.size; ++c) plastic[c] = particles.material_state(p + state_offset, c);
    strain(p) = equivalent_plastic_deviatoric_strain(plastic);
  }
};

}  // namespace kernel

/// Writes strain(p) of particles first, ..., last - 1, of a plastic material.
template <class Exec, int Dim, class Real, class Device>
void equivalent_plastic_strain(const Exec& exec, const Particles<Dim, Real, Device>& particles, int first,
                               int last, int state_offset, const Kokkos::View<Real*, Device>& strain) {
  Kokkos::parallel_for("vsb::equivalent_plastic_strain", Kokkos::RangePolicy<Exec>(exec, first, last),
                       kernel::EquivalentPlasticStrain<Dim, Real, Device>{particles, state_offset, strain});
}

}  // namespace vsb
