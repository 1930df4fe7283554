// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The scene of all benchmarks: the column of the paper's Table 3, 10 m long, fixed at its lower end, in a
/// grid with void cells beyond every free face; with as many cells across as along it is a block.
///
/// Particles lie on a lattice, each jittered within its cell; velocities and stresses are random with a fixed
/// seed, so that no number is zero or denormal. Loads and gravity are so small that no particle ever leaves
/// its cell: every step does the same work.
#pragma once

#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>
#include <vsb/kernels/lanes/build.hpp>
#include <vsb/kernels/step.hpp>
#include <vsb/physics/linear_basis.hpp>

namespace vsb::bench {

#if defined(VSB_BACKEND_CUDA)
using Exec = Kokkos::Cuda;
#elif defined(VSB_BACKEND_OPENMP)
using Exec = Kokkos::OpenMP;
#else
using Exec = Kokkos::Serial;
#endif
using Device = Exec::device_type;

/// Whether that is the host: on a device there are the particle kernels alone.
constexpr bool runs_on_host = std::is_same_v<Device::memory_space, Kokkos::HostSpace>;

/// Where the virtual stress acts.
enum class Load { off, end_face, free_faces };

/// Where particles lie: on a lattice, or anywhere around its points.
enum class Arrangement { jittered, lattice };

/// How fine the column is.
struct Size {
  const char* name;
  int cells_across;     ///< in each direction across the column
  int cells_along;      ///< over its length
  int per_direction;    ///< particles per cell and direction
  int void_across = 1;  ///< layers of void cells beyond the faces across
  int void_along = 1;   ///< the same beyond the end
};

template <int Dim>
int particle_count(const Size& size) {
  int n = size.cells_along * size.per_direction;
  for (int i = 1; i < Dim; ++i) n *= size.cells_across * size.per_direction;
  return n;
}

/// Particles, and what they are to go through.
template <int Dim, class Real>
struct Column {
  static constexpr double length = 10;     ///< m
  static constexpr double density = 1000;  ///< kg/m^3
  int axis = Dim - 1;                      ///< the direction of the length; the lower end is at node 0
  Size size;
  Load load;
  LinearBasis<Dim, Real> basis;
  ParticleBlock<Dim, Real, Device> block;
  LinearElastic<Real> material;
  StepOptions<Dim, Real> options;
  double pressure;                                 ///< Pa, positive in compression
  UniformVirtualStress<Dim, Real> virtual_stress;  ///< -pressure I

  double spacing() const { return length / size.cells_along; }
  double end_face_area() const {
    double area = 1;
    for (int i = 1; i < Dim; ++i) area *= size.cells_across * spacing();
    return area;
  }
  /// Whether the load's traction is declared at a node: everywhere, or at the end face and the layer of nodes
  /// below it, which is N1 of a load on that face alone.
  bool declared_at(const Vector<Dim, int>& node) const {
    return load == Load::free_faces || (load == Load::end_face && node[axis] >= size.cells_along - 1);
  }
};

/// The column and the state of the particle kernels.
template <int Dim, class Real>
struct Scene : Column<Dim, Real> {
  State<Dim, Real, Device> state;
  std::vector<Body<Real>> bodies;
};

/// Random numbers in [-1, 1), the same with every standard library.
class Noise {
 public:
  double operator()() { return static_cast<double>(engine_()) / 2147483648.0 - 1; }

 private:
  std::mt19937 engine_{20261122};
};

template <int Dim, class Real>
LinearBasis<Dim, Real> make_basis(const Size& size, int axis) {
  const Real h = static_cast<Real>(Column<Dim, Real>::length / size.cells_along);
  Vector<Dim, Real> lower, spacing;
  Vector<Dim, int> cells;
  for (int i = 0; i < Dim; ++i) {
    const bool along = i == axis;
    lower[i] = along ? Real(0) : -static_cast<Real>(size.void_across) * h;
    spacing[i] = h;
    cells[i] = along ? size.cells_along + size.void_along : size.cells_across + 2 * size.void_across;
  }
  return {UniformGrid<Dim, Real>(lower, spacing, cells)};
}

/// Fills the particles; `strain` is the size of the random state, the strain of its stress.
template <int Dim, class Real>
void fill_particles(const Column<Dim, Real>& scene, Arrangement arrangement, double strain,
                    double youngs_modulus, double wave_speed) {
  const auto host = host_copy(scene.block);
  const auto& p = host.particles;
  const int across = scene.size.cells_across * scene.size.per_direction,
            along = scene.size.cells_along * scene.size.per_direction;
  const double distance = scene.spacing() / scene.size.per_direction,
               jitter = arrangement == Arrangement::jittered ? 0.3 * distance : 0;
  double volume = 1;
  for (int i = 0; i < Dim; ++i) volume *= distance;
  Noise noise;
  for (int n = 0; n < p.count(); ++n) {
    int k = n;
    for (int i = 0; i < Dim; ++i) {
      const int extent = i == scene.axis ? along : across, number = k % extent;
      k /= extent;
      p.position(n, i) = static_cast<Real>((number + 0.5) * distance + jitter * noise());
      p.velocity(n, i) = static_cast<Real>(strain * wave_speed * noise());
    }
    p.volume(n) = static_cast<Real>(volume);
    p.mass(n) = static_cast<Real>(scene.density * volume);
    for (int c = 0; c < p.stress_size; ++c)
      p.cauchy_stress(n, c) = static_cast<Real>(strain * youngs_modulus * noise());
  }
  Kokkos::deep_copy(scene.block.block, host.block);
}

/// Fixes the nodes of the lower end, and declares the traction where the load acts.
template <int Dim, class Real>
void fill_nodes(const Scene<Dim, Real>& scene) {
  const auto fixed = Kokkos::create_mirror_view(scene.state.nodes.fixed_components);
  const auto tractions = Kokkos::create_mirror_view(scene.state.occupancy.tractions);
  for (int node = 0; node < scene.basis.node_count(); ++node) {
    const auto I = static_cast<size_t>(node);
    const auto at = scene.basis.grid.node_ijk(node);
    fixed(I) = at[scene.axis] == 0 ? ComponentMask((1 << Dim) - 1) : ComponentMask(0);
    tractions(I) = scene.declared_at(at);
  }
  Kokkos::deep_copy(scene.state.nodes.fixed_components, fixed);
  Kokkos::deep_copy(scene.state.occupancy.tractions, tractions);
}

/// Lets a load act on the column.
template <int Dim, class Real>
void apply_load(Scene<Dim, Real>& scene, Load load) {
  scene.load = load;
  fill_nodes(scene);
  auto& o = scene.state.occupancy;
  o.boundary_node_count =
      mark_boundary_nodes(Exec(), scene.state.particles, o.cells, scene.basis, o.tractions, o.boundary);
}

/// The column at rest but for noise.
template <int Dim, class Real>
Column<Dim, Real> make_column(const Size& size, Load load, int axis = Dim - 1,
                              Arrangement arrangement = Arrangement::jittered) {
  const double E = 1e6, nu = 0.3;
  Column<Dim, Real> s;
  s.axis = axis;
  s.size = size;
  s.load = load;
  s.material = LinearElastic<Real>::from_young(E, nu);
  const double M = static_cast<double>(s.material.constrained_modulus());
  s.basis = make_basis<Dim, Real>(size, axis);
  s.block = allocate_particles_to_pack<Dim, Real, Device>(particle_count<Dim>(size));
  const double strain = 1e-3 * s.spacing() / s.length;  // moves the free end by 0.001 cells
  s.pressure = strain * E;
  s.options.dt = static_cast<Real>(time_step(0.2, s.spacing(), M, s.density));
  s.options.damping = Real(0.05);
  s.options.gravity[s.axis] = static_cast<Real>(-strain * E / (s.density * s.length));
  s.virtual_stress.stress[0] = pressure_stress<Dim>(static_cast<Real>(s.pressure));
  s.virtual_stress.count = 1;
  fill_particles(s, arrangement, strain, E, math::sqrt(M / s.density));
  return s;
}

/// The column with its occupancy up to date.
template <int Dim, class Real>
Scene<Dim, Real> make_scene(const Size& size, Load load, Scatter strategy, int axis = Dim - 1) {
  Scene<Dim, Real> s{make_column<Dim, Real>(size, load, axis), {}, {}};
  s.options.scatter = strategy;
  s.state = make_state(s.block.particles, s.basis);
  s.bodies = {{0, particle_count<Dim>(size), s.material}};
  update_occupancy(Exec(), s.state.particles, s.state.occupancy, s.basis);
  apply_load(s, load);
  return s;
}

/// Calls work(field) with the virtual stress field of the scene's load.
template <int Dim, class Real, class Work>
auto with_field(const Column<Dim, Real>& scene, const Work& work) {
  return scene.load == Load::off ? work(NoVirtualStress{}) : work(scene.virtual_stress);
}

}  // namespace vsb::bench
