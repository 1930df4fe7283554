// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How far a state is from equilibrium, and the resultant of its tractions:
///   unbalanced force     U = |f| over the free components of nodes with mass,
///   internal force       I = |f| without virtual stress, over all components,
///   force ratio          U / I,
///   kinetic energy       sum_I |p_I|^2 / (2 m_I),
///   strain energy scale  sum_p V_p |sigma_p|^2 / (2 M),
///   net force and torque of the tractions (kernels/readout/resultant.hpp).
/// The resultant includes forces on prescribed components, which the support takes up, and forces of surface
/// points on nodes without mass, which move nothing. The unbalanced force includes neither.
///
/// The kinetic energy is that of the grid. Particle velocities that cancel at every node are not in it: they
/// move nothing, and the damping, which acts at nodes, does not reduce them.
#pragma once

#include <vsb/kernels/readout/resultant.hpp>
#include <vsb/physics/explicit_dynamics.hpp>

namespace vsb {

/// Forces and energies of a state; the equations are at the top of this file.
template <int Dim>
struct Balance {
  double unbalanced_force;        ///< N
  double internal_force;          ///< N
  Vector<Dim, double> net_force;  ///< resultant of the tractions, N
  Vector<3, double> net_torque;   ///< about the origin, N m; in 1D zero, in 2D along z
  double kinetic_energy;          ///< J
  double strain_energy;           ///< J, the scale above

  /// 1 for a state without any force.
  double force_ratio() const { return internal_force > 0 ? unbalanced_force / internal_force : 1.0; }
};

namespace kernel {

/// What a node adds to the sums: squares of the unbalanced and of the internal force, kinetic energy.
using BalanceSums = Vector<3, double>;

/// Adds a node with mass m, momentum p, force f, and force g without tractions.
template <int Dim>
KOKKOS_FUNCTION void add_node_balance(ComponentMask fixed_components, double m,
                                      const Vector<Dim, double>& momentum, const Vector<Dim, double>& force,
                                      const Vector<Dim, double>& bare, BalanceSums& sum) {
  for (int i = 0; i < Dim; ++i) {
    const double f = force[i], g = bare[i], p = momentum[i];
    const bool fixed = fixed_components >> i & 1;
    if (!fixed && has_mass(m)) sum[0] += f * f;
    sum[1] += g * g;
    if (!fixed && has_mass(m)) sum[2] += 0.5 * p * p / m;
  }
}

template <int Dim, class Real, class Device>
struct NodeBalance {
  Nodes<Dim, Real, Device> nodes;                  ///< sums with virtual stress
  typename Nodes<Dim, Real, Device>::Fields bare;  ///< sums without

  KOKKOS_FUNCTION void operator()(int I, BalanceSums& sum) const {
    Vector<Dim, double> p, f, g;
    for (int i = 0; i < Dim; ++i) {
      p[i] = nodes.momentum(I, i);
      f[i] = nodes.force(I, i);
      g[i] = bare(I, 1 + Dim + i);
    }
    add_node_balance(nodes.fixed_components(I), nodes.mass(I), p, f, g, sum);
  }
};

/// V |sigma|^2 / (2 M) of a particle.
template <int Dim, class Real>
KOKKOS_FUNCTION double strain_energy_scale(const SymmetricTensor<Dim, Real>& s, Real volume, double modulus) {
  double ss = 0;
  for (int c = 0; c < s.size; ++c)
    ss += (c < 3 ? 1.0 : 2.0) * static_cast<double>(s[c]) * static_cast<double>(s[c]);
  return 0.5 * static_cast<double>(volume) * ss / modulus;
}

template <int Dim, class Real, class Device>
struct StrainEnergy {
  Particles<Dim, Real, Device> particles;
  int first;
  double modulus;

  KOKKOS_FUNCTION void operator()(int i, Vector<1, double>& sum) const {
    sum[0] +=
        strain_energy_scale<Dim, Real>(particles.stress_of(first + i), particles.volume(first + i), modulus);
  }
};

}  // namespace kernel

namespace detail {

/// All but the strain energy.
template <int Dim>
Balance<Dim> balance_of(const kernel::BalanceSums& sums, const TractionResultant<Dim>& tractions) {
  return {math::sqrt(sums[0]), math::sqrt(sums[1]), tractions.force, tractions.torque, sums[2], 0};
}

}  // namespace detail

/// The balance of a state whose particles all lie in the grid. Overwrites nodes.sums with the sums for the
/// particles' present positions, and brings the occupancy up to date. Waits for the device.
template <class Exec, class Basis, class Field, int Dim, class Real, class Device>
Balance<Dim> balance(const Exec& exec, State<Dim, Real, Device>& s, const std::vector<Body<Real>>& bodies,
                     const Basis& basis, const Field& virtual_stress, const StepOptions<Dim, Real>& options,
                     const FaceCover<Device>& cover = {}) {
  auto bare = s.nodes;
  bare.sums = typename Nodes<Dim, Real, Device>::Fields("vsb::bare_sums", s.nodes.sums.extent(0),
                                                        Nodes<Dim, Real, Device>::sum_columns);
  particles_to_grid(exec, s.particles, s.occupancy.bins, bare, s.occupancy.boundary,
                    s.sums_workspace.particles, basis, NoVirtualStress{}, options.gravity, options.scatter);
  fold_ghost_nodes(exec, basis, bare.sums, 1);
  assemble_forces(exec, s.particles, s.occupancy, s.surface, s.nodes, s.sums_workspace, basis, virtual_stress,
                  options.gravity, options.scatter);
  const auto sums = ordered_sum<kernel::BalanceSums::size, Device>(
      exec, "vsb::node_balance", s.nodes.count(), kernel::NodeBalance<Dim, Real, Device>{s.nodes, bare.sums});
  auto result = detail::balance_of(sums, resultant(exec, s, basis, virtual_stress, ~TractionMask(0), cover));
  for (const auto& body : bodies) {
    const double modulus =
        std::visit([](const auto& m) { return double(m.constrained_modulus()); }, body.material);
    result.strain_energy +=
        ordered_sum<1, Device>(exec, "vsb::strain_energy", body.last - body.first,
                               kernel::StrainEnergy<Dim, Real, Device>{s.particles, body.first, modulus})[0];
  }
  return result;
}

}  // namespace vsb
