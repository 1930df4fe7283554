// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How far a state is from equilibrium, and the resultant of its tractions.
///   unbalanced U = |f| over free components;   internal I = |f| without virtual stress, over all components;
///   force ratio U / I;   net force = sum_I (f_I with - f_I without virtual stress);
///   kinetic energy sum_p m |v|^2 / 2;   strain energy scale sum_p V |sigma|^2 / (2 M).
#pragma once

#include <vsb/kernels/ordered_sum.hpp>
#include <vsb/kernels/step.hpp>

namespace vsb {

template <int Dim>
struct Balance {
  double unbalanced_force;        ///< N
  double internal_force;          ///< N
  Vector<Dim, double> net_force;  ///< resultant of the virtual stress on all nodes, N
  double kinetic_energy;          ///< J
  double strain_energy;           ///< J, the scale above

  /// 1 for a state without any force.
  double force_ratio() const { return internal_force > 0 ? unbalanced_force / internal_force : 1.0; }
};

namespace kernel {

template <int Dim, class Real, class Device>
struct NodeBalance {
  Nodes<Dim, Real, Device> nodes;                  ///< forces with virtual stress
  typename Nodes<Dim, Real, Device>::Fields bare;  ///< sums without

  KOKKOS_FUNCTION void operator()(int I, Vector<2 + Dim, double>& sum) const {
    for (int i = 0; i < Dim; ++i) {
      const double f = nodes.force(I, i), g = bare(I, 1 + Dim + i);
      if (!(nodes.fixed_components(I) >> i & 1)) sum[0] += f * f;
      sum[1] += g * g;
      sum[2 + i] += f - g;
    }
  }
};

template <int Dim, class Real, class Device>
struct ParticleEnergy {
  Particles<Dim, Real, Device> particles;
  int first;
  double modulus;

  KOKKOS_FUNCTION void operator()(int i, Vector<2, double>& sum) const {
    const int p = first + i;
    const auto v = particles.velocity_of(p);
    const auto s = particles.stress_of(p);
    double ss = 0;
    for (int c = 0; c < SymmetricTensor<Dim, Real>::size; ++c)
      ss += (c < 3 ? 1.0 : 2.0) * static_cast<double>(s[c]) * static_cast<double>(s[c]);
    sum[0] += 0.5 * static_cast<double>(particles.mass(p)) * static_cast<double>(dot(v, v));
    sum[1] += 0.5 * static_cast<double>(particles.volume(p)) * ss / modulus;
  }
};

}  // namespace kernel

/// The balance of a state whose particles all lie in the grid. Overwrites nodes.sums with the sums for the
/// particles' present positions, and brings the occupancy up to date. Waits for the device.
template <class Exec, class Basis, class Field, int Dim, class Real, class Device>
Balance<Dim> balance(const Exec& exec, State<Dim, Real, Device>& s, const std::vector<Body<Real>>& bodies,
                     const Basis& basis, const Field& virtual_stress, const StepOptions<Dim, Real>& options) {
  auto bare = s.nodes;
  bare.sums = typename Nodes<Dim, Real, Device>::Fields("vsb::bare_sums", s.nodes.sums.extent(0),
                                                        Nodes<Dim, Real, Device>::sum_columns);
  particles_to_grid(exec, s.particles, s.occupancy.bins, bare, s.occupancy.boundary, s.sums_workspace, basis,
                    NoVirtualStress{}, options.gravity, options.scatter);
  particles_to_grid(exec, s.particles, s.occupancy.bins, s.nodes, s.occupancy.boundary, s.sums_workspace,
                    basis, virtual_stress, options.gravity, options.scatter);
  const auto forces = ordered_sum<2 + Dim, Device>(
      exec, "vsb::node_balance", s.nodes.count(), kernel::NodeBalance<Dim, Real, Device>{s.nodes, bare.sums});
  Balance<Dim> result{math::sqrt(forces[0]), math::sqrt(forces[1]), {}, 0, 0};
  for (int i = 0; i < Dim; ++i) result.net_force[i] = forces[2 + i];
  for (const auto& body : bodies) {
    const double modulus =
        std::visit([](const auto& m) { return double(m.constrained_modulus()); }, body.material);
    const auto energy =
        ordered_sum<2, Device>(exec, "vsb::particle_energy", body.last - body.first,
                               kernel::ParticleEnergy<Dim, Real, Device>{s.particles, body.first, modulus});
    result.kinetic_energy += energy[0];
    result.strain_energy += energy[1];
  }
  return result;
}

}  // namespace vsb
