// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Finds the first particle with an invalid field, as a diverging run makes it: a field that is not finite,
/// or a volume that is not positive (J <= 0).
#pragma once

#include <vsb/views/particles.hpp>

namespace vsb {

/// The fields that are checked, in this order.
enum class ParticleField { position, velocity, cauchy_stress, volume, none };

/// A particle and its invalid field; particle -1 where all fields are valid.
struct Invalid {
  int particle;         ///< the lowest number of an invalid one
  ParticleField field;  ///< its first invalid field
};

namespace kernel {

/// The first invalid field of a particle with this position, velocity, stress and volume.
template <int Dim, class Real>
KOKKOS_FUNCTION ParticleField spoilt_field(const Vector<Dim, Real>& x, const Vector<Dim, Real>& v,
                                           const SymmetricTensor<Dim, Real>& sigma, Real volume) {
  const auto finite = [](const auto& row) {
    for (int c = 0; c < row.size; ++c)
      if (!math::isfinite(row[c])) return false;
    return true;
  };
  if (!finite(x)) return ParticleField::position;
  if (!finite(v)) return ParticleField::velocity;
  if (!finite(sigma)) return ParticleField::cauchy_stress;
  if (!(volume > 0) || !math::isfinite(volume)) return ParticleField::volume;
  return ParticleField::none;
}

template <int Dim, class Real, class Device>
struct CheckParticle {
  Particles<Dim, Real, Device> particles;

  KOKKOS_FUNCTION ParticleField field(int p) const {
    return spoilt_field(particles.position_of(p), particles.velocity_of(p), particles.stress_of(p),
                        static_cast<Real>(particles.volume(p)));
  }
  KOKKOS_FUNCTION void operator()(int p, int& lowest) const {
    if (field(p) != ParticleField::none) lowest = math::min(lowest, p);
  }
};

/// Runs CheckParticle::field for one particle on the device that has the data.
template <int Dim, class Real, class Device>
struct NameField {
  CheckParticle<Dim, Real, Device> check;
  int particle;
  KOKKOS_FUNCTION void operator()(int, int& code) const { code = static_cast<int>(check.field(particle)); }
};

}  // namespace kernel

/// The invalid particle of lowest number. Waits for the device.
template <class Exec, int Dim, class Real, class Device>
Invalid find_invalid(const Exec& exec, const Particles<Dim, Real, Device>& particles) {
  const int n = particles.count();
  const kernel::CheckParticle<Dim, Real, Device> check{particles};
  int lowest = n;
  Kokkos::parallel_reduce("vsb::find_invalid", Kokkos::RangePolicy<Exec>(exec, 0, n), check,
                          Kokkos::Min<int>(lowest));
  exec.fence();
  if (lowest >= n) return {-1, ParticleField::none};
  int code = 0;
  Kokkos::parallel_reduce("vsb::name_invalid_field", Kokkos::RangePolicy<Exec>(exec, 0, 1),
                          kernel::NameField<Dim, Real, Device>{check, lowest}, code);
  exec.fence();
  return {lowest, static_cast<ParticleField>(code)};
}

}  // namespace vsb
