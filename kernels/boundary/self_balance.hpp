// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The body force that removes the resultant of a virtual stress whose tractions balance each other, such as
/// a pressure in a closed hole. With chi = 1 at all active nodes the force and the torque of a virtual stress
/// are
///   F = sum_p V_p fbar(x_p),   T = sum_p V_p x_p x fbar(x_p)
/// on any grid, since sum_I N_I = 1 and sum_I N_I x_I = x. Both should be zero. The particles' quadrature of
/// the divergence leaves an error, which a body force removes:
///   fbar <- fbar + c + w x (x - x_c),   c = -F / V,   J w = -T_c,
/// with the centroid x_c and the inertia J of the particles' volumes.
///
/// Reads positions and volumes; costs one pass over the particles, with sums in a fixed order.
#pragma once

#include <vsb/kernels/particles/ordered_sum.hpp>
#include <vsb/physics/traction_fields.hpp>
#include <vsb/views/particles.hpp>

namespace vsb {

namespace kernel {

/// One particle: V, V r, V r r^T (xx yy zz xy yz xz), V fbar, V r x fbar, with r = x - near.
template <class Field, int Dim, class Real, class Device>
struct DivergenceMoments {
  static constexpr int size = 1 + 3 + 6 + 3 + 3;
  Particles<Dim, Real, Device> particles;
  Field virtual_stress;
  TractionMask tractions;
  Vector<Dim, Real> near;

  KOKKOS_FUNCTION void operator()(int p, Vector<size, double>& sum) const {
    const auto x = particles.position_of(p);
    const auto divergence = virtual_stress.at(x, tractions).divergence;
    const double V = static_cast<double>(particles.volume(p));
    auto r = Vector<3, double>::zero(), f = r;
    for (int i = 0; i < Dim; ++i) {
      r[i] = static_cast<double>(x[i]) - static_cast<double>(near[i]);
      f[i] = static_cast<double>(divergence[i]);
    }
    sum[0] += V;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      sum[1 + i] += V * r[i];
      sum[4 + i] += V * r[i] * r[i];
      sum[7 + i] += V * r[i] * r[j];  // xy, yz, xz
      sum[10 + i] += V * f[i];
      sum[13 + i] += V * (r[j] * f[k] - r[k] * f[j]);
    }
  }
};

}  // namespace kernel

/// The body force that balances the divergence of the given tractions of `virtual_stress`, which must not
/// contain one already. `near` is any point near the particles: it keeps round-off small. Waits for the
/// device.
template <class Exec, class Field, int Dim, class Real, class Device>
RigidBodyForce<Dim, Real> balancing_force(const Exec& exec, const Particles<Dim, Real, Device>& particles,
                                          const Field& virtual_stress, TractionMask tractions,
                                          const Vector<Dim, Real>& near) {
  using Moments = kernel::DivergenceMoments<Field, Dim, Real, Device>;
  const auto m = ordered_sum<Moments::size, Device>(exec, "vsb::divergence_moments", particles.count(),
                                                    Moments{particles, virtual_stress, tractions, near});
  const double V = m[0];
  auto result = RigidBodyForce<Dim, Real>::zero();
  double c[3], T[3];  // centroid from `near`, torque about it
  for (int i = 0; i < 3; ++i) c[i] = m[1 + i] / V;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    T[i] = m[13 + i] - (c[j] * m[10 + k] - c[k] * m[10 + j]);
  }
  for (int i = 0; i < Dim; ++i) {
    result.about[i] = near[i] + static_cast<Real>(c[i]);
    result.constant[i] = static_cast<Real>(-m[10 + i] / V);
  }
  if constexpr (Dim > 1) {
    Matrix<3, double> second, J;  // sum V (r - c) (r - c)^T, and the inertia
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      second(i, i) = m[4 + i] - V * c[i] * c[i];
      second(i, j) = second(j, i) = m[7 + i] - V * c[i] * c[j];
    }
    const double size = trace(second);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) J(i, j) = (i == j ? size : 0.0) - second(i, j);
    if constexpr (Dim == 2)  // about z alone
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) J(i, j) = i == j ? size : 0.0;
    // Particles on one line have no inertia about it: w stays zero.
    if (determinant(J) > 1e-12 * size * size * size) {
      const Vector<3, double> w = inverse(J) * Vector<3, double>{{-T[0], -T[1], -T[2]}};
      const double skew[3][3] = {{0, -w[2], w[1]}, {w[2], 0, -w[0]}, {-w[1], w[0], 0}};
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) result.spin(i, j) = static_cast<Real>(skew[i][j]);
    }
  }
  return result;
}

}  // namespace vsb
