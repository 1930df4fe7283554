// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What must hold before a kernel is timed: conservation, completeness and counts, none of them computed with
/// the kernel's own formula. A check calls `run`, which launches what will be timed, and returns an empty
/// string, or what is wrong.
#pragma once

#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vsb/kernels/readout/health.hpp>

namespace vsb::bench {

/// A sum, and the sum of the magnitudes, to which the round-off of its terms is compared. In long double, so
/// that adding up adds next to none.
struct Sum {
  long double value = 0, magnitude = 0;
  void add(double x) {
    value += x;
    magnitude += std::abs(x);
  }
  friend Sum operator+(const Sum& a, const Sum& b) { return {a.value + b.value, a.magnitude + b.magnitude}; }
  friend Sum operator*(double s, const Sum& a) { return {s * a.value, std::abs(s) * a.magnitude}; }
};

/// Collects what is wrong, for sums of terms in Real.
template <class Real>
class Findings {
 public:
  void require(bool holds, const std::string& what) {
    if (!holds) text_ += (text_.empty() ? "" : "; ") + what;
  }
  /// The sums agree to round-off; never for NaN.
  void require_equal(const Sum& a, const Sum& b, const std::string& what) {
    const long double round_off = 16 * std::numeric_limits<Real>::epsilon();
    require(std::abs(a.value - b.value) <= round_off * (a.magnitude + b.magnitude),
            what + " " + std::to_string(a.value) + " where " + std::to_string(b.value) + " is right");
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// The sum of term(particles, p) over all particles, which lie on the host.
template <int Dim, class Real, class Term>
Sum particle_sum(const Column<Dim, Real>& scene, const Term& term) {
  const auto host = host_copy(scene.block);
  Sum sum;
  for (int p = 0; p < host.particles.count(); ++p) sum.add(static_cast<double>(term(host.particles, p)));
  return sum;
}

template <int Dim, class Real>
Sum particle_momentum(const Column<Dim, Real>& scene, int i) {
  return particle_sum(scene, [i](const auto& p, int n) { return p.mass(n) * p.velocity(n, i); });
}

/// A copy of a View on the host that later launches leave alone.
template <class View>
auto snapshot(const View& view) {
  auto copy = Kokkos::create_mirror(view);
  Kokkos::deep_copy(copy, view);
  return copy;
}

/// The sum over all nodes of column c of Nodes::sums.
template <int Dim, class Real>
Sum node_sum(const Scene<Dim, Real>& scene, int c) {
  const auto sums = snapshot(scene.state.nodes.sums);
  Sum sum;
  for (size_t I = 0; I < sums.extent(0); ++I) sum.add(static_cast<double>(sums(I, c)));
  return sum;
}

/// The sum over all nodes of m_I field(I, i).
template <class Fields, int Dim, class Real>
Sum node_momentum(const Scene<Dim, Real>& scene, const Fields& field, int i) {
  const auto sums = snapshot(scene.state.nodes.sums);
  const auto host = snapshot(field);
  Sum sum;
  for (size_t I = 0; I < sums.extent(0); ++I) sum.add(static_cast<double>(sums(I, 0) * host(I, i)));
  return sum;
}

/// N1 in closed form: all active nodes but those two layers or more below the free faces.
template <int Dim, class Real>
int expected_boundary_nodes(const Column<Dim, Real>& scene) {
  const Size& size = scene.size;
  int layer = 1, inner = 1;
  for (int i = 1; i < Dim; ++i) {
    layer *= size.cells_across + 1;
    inner *= std::max(size.cells_across - 3, 0);
  }
  if (scene.load == Load::off) return 0;
  if (scene.load == Load::end_face) return 2 * layer;
  return layer * (size.cells_along + 1) - inner * (size.cells_along - 1);
}

/// Mass, momentum and force of the particles arrive at the nodes; the virtual stress changes forces on N1
/// only. The resultant of a load on the end face is pressure times area, exactly: its nodes form whole
/// layers.
template <int Dim, class Real, class Run>
std::string check_particles_to_grid(Scene<Dim, Real>& scene, const Run& run) {
  Findings<Real> findings;
  const Load load = scene.load;
  scene.load = Load::off;
  run();
  const Sum mass = particle_sum(scene, [](const auto& p, int n) { return p.mass(n); });
  findings.require_equal(node_sum(scene, 0), mass, "mass");
  for (int i = 0; i < Dim; ++i) {
    findings.require_equal(node_sum(scene, 1 + i), particle_momentum(scene, i), "momentum");
    findings.require_equal(node_sum(scene, 1 + Dim + i), static_cast<double>(scene.options.gravity[i]) * mass,
                           "force");
  }
  scene.load = load;
  if (load == Load::off) return findings.text();

  const auto bare = snapshot(scene.state.nodes.sums);
  const auto boundary = snapshot(scene.state.occupancy.boundary);
  run();
  const auto loaded = snapshot(scene.state.nodes.sums);
  for (int c = 0; c < bare.extent_int(1); ++c) {
    Sum with, without;
    for (size_t I = 0; I < bare.extent(0); ++I) {
      if (boundary(I) != 0 && c > Dim) continue;
      with.add(static_cast<double>(loaded(I, c)));
      without.add(static_cast<double>(bare(I, c)));
    }
    findings.require_equal(with, without, "sum without virtual stress");
  }
  apply_load(scene, Load::end_face);
  run();
  const int along = 1 + Dim + scene.axis;
  Sum bare_force;
  for (size_t I = 0; I < bare.extent(0); ++I) bare_force.add(static_cast<double>(bare(I, along)));
  findings.require_equal(node_sum(scene, along), bare_force + Sum{-scene.pressure * scene.end_face_area(), 0},
                         "loaded force");
  apply_load(scene, load);
  return findings.text();
}

/// Without damping and prescribed components, nodes gain the impulse of their forces.
template <int Dim, class Real, class Run>
std::string check_update_nodes(Scene<Dim, Real>& scene, const Run& run) {
  Findings<Real> findings;
  const Real damping = scene.options.damping;
  scene.options.damping = 0;
  Kokkos::deep_copy(scene.state.nodes.fixed_components, ComponentMask(0));
  run();
  for (int i = 0; i < Dim; ++i)
    findings.require_equal(
        node_momentum(scene, scene.state.nodes.velocity, i),
        node_sum(scene, 1 + i) + static_cast<double>(scene.options.dt) * node_sum(scene, 1 + Dim + i),
        "momentum");
  scene.options.damping = damping;
  fill_nodes(scene);
  return findings.text();
}

/// Particles gain the momentum that the nodes gain.
template <int Dim, class Real, class Run>
std::string check_velocity_gain(Scene<Dim, Real>& scene, const Run& run) {
  Findings<Real> findings;
  Sum before[Dim];
  for (int i = 0; i < Dim; ++i) before[i] = particle_momentum(scene, i);
  run();
  for (int i = 0; i < Dim; ++i)
    findings.require_equal(particle_momentum(scene, i),
                           before[i] + static_cast<double>(scene.options.dt) *
                                           node_momentum(scene, scene.state.nodes.acceleration, i),
                           "momentum");
  return findings.text();
}

/// Without prescribed components, the re-map conserves momentum.
template <int Dim, class Real, class Run>
std::string check_remap_velocity(Scene<Dim, Real>& scene, const Run& run) {
  Findings<Real> findings;
  Kokkos::deep_copy(scene.state.nodes.fixed_components, ComponentMask(0));
  run();
  for (int i = 0; i < Dim; ++i)
    findings.require_equal(node_momentum(scene, scene.state.nodes.remapped_velocity, i),
                           particle_momentum(scene, i), "momentum");
  fill_nodes(scene);
  return findings.text();
}

/// In the velocity field v = g x, every volume grows by (1 + g dt)^Dim and every position by 1 + g dt.
template <int Dim, class Real, class Run>
std::string check_update_stress(Scene<Dim, Real>& scene, const Run& run) {
  Findings<Real> findings;
  const double g = 1e-3 / static_cast<double>(scene.options.dt);
  auto& nodes = scene.state.nodes;
  const auto velocity = snapshot(nodes.velocity);
  for (int I = 0; I < nodes.count(); ++I)
    for (int i = 0; i < Dim; ++i)
      velocity(static_cast<size_t>(I), i) =
          static_cast<Real>(g * static_cast<double>(scene.basis.grid.node_position(I)[i]));
  const auto old_velocity = snapshot(nodes.velocity), old_remapped = snapshot(nodes.remapped_velocity);
  Kokkos::deep_copy(nodes.velocity, velocity);
  Kokkos::deep_copy(nodes.remapped_velocity, velocity);
  const auto volume = [](const auto& p, int n) { return p.volume(n); };
  const auto along = [](const auto& p, int n) { return p.position(n, Dim - 1); };
  const Sum volumes = particle_sum(scene, volume), positions = particle_sum(scene, along);
  run();
  findings.require_equal(particle_sum(scene, volume), std::pow(1.001, Dim) * volumes, "volume");
  findings.require_equal(particle_sum(scene, along), 1.001 * positions, "sum of positions");
  findings.require(find_invalid(Exec(), scene.state.particles).particle < 0, "a particle is spoilt");
  Kokkos::deep_copy(nodes.velocity, old_velocity);
  Kokkos::deep_copy(nodes.remapped_velocity, old_remapped);
  return findings.text();
}

/// As many boundary nodes as the closed form says.
template <int Dim, class Real, class Run>
std::string check_boundary_nodes(Scene<Dim, Real>& scene, const Run& run) {
  Findings<Real> findings;
  const int found = run(), expected = expected_boundary_nodes(scene);
  findings.require(found == expected, std::to_string(found) + " boundary nodes where " +
                                          std::to_string(expected) + " are right");
  return findings.text();
}

/// Particles gain the momentum that the nodes gain, all fields stay finite, and N1 is complete.
template <int Dim, class Real, class Run>
std::string check_step(Scene<Dim, Real>& scene, const Run& run) {
  Findings<Real> findings;
  const auto momentum = check_velocity_gain(scene, run);
  findings.require(momentum.empty(), momentum);
  findings.require(find_invalid(Exec(), scene.state.particles).particle < 0, "a particle is spoilt");
  findings.require(scene.state.occupancy.boundary_node_count == expected_boundary_nodes(scene),
                   "the number of boundary nodes is wrong");
  return findings.text();
}

/// All particles are listed once, by increasing bin and then by increasing number.
template <int Dim, class Real, class Run>
std::string check_bins(Scene<Dim, Real>& scene, const Run& run) {
  run();
  Findings<Real> findings;
  const auto order = snapshot(scene.state.occupancy.bins.order),
             bin = snapshot(scene.state.occupancy.bins.bin);
  bool sorted = true;
  for (size_t k = 1; k < order.extent(0); ++k) {
    const int a = order(k - 1), b = order(k);
    sorted = sorted && (bin(a) < bin(b) || (bin(a) == bin(b) && a < b));
  }
  findings.require(sorted, "the particles are not sorted");
  int cells = scene.size.cells_along;
  for (int i = 1; i < Dim; ++i) cells *= scene.size.cells_across;
  findings.require(scene.state.occupancy.bins.occupied_count() == cells,
                   "the column's cells are not all occupied");
  return findings.text();
}

}  // namespace vsb::bench
