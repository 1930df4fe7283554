// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What the tests share: the backend under test, access to its data, and bodies of particles to work on.
#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <vector>
#include <vsb/kernels/mesh/make_mapped_mesh.hpp>
#include <vsb/physics/linear_basis.hpp>
#include <vsb/physics/mapped_basis.hpp>
#include <vsb/views/particles.hpp>

#include "catch.hpp"

namespace vsb::test {

#if defined(VSB_BACKEND_SERIAL)
using Exec = Kokkos::Serial;
#elif defined(VSB_BACKEND_OPENMP)
using Exec = Kokkos::OpenMP;
#elif defined(VSB_BACKEND_CUDA)
using Exec = Kokkos::Cuda;
#endif
using Device = Exec::device_type;
/// Where a test calls a functor for one index.
using Host = Kokkos::HostSpace::device_type;

template <class Real>
constexpr double epsilon = std::numeric_limits<Real>::epsilon();

/// A view's values in host memory, once the kernels that write them are done.
template <class View>
auto read(const View& view) {
  Kokkos::fence();
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
}

/// Lets `change` write to a view's values in host memory, then brings them to the device.
template <class View, class Change>
void edit(const View& view, const Change& change) {
  const auto host = read(view);
  change(host);
  Kokkos::deep_copy(view, host);
}

template <int Dim, class Real, class Change>
void edit(const ParticleBlock<Dim, Real, Device>& block, const Change& change) {
  Kokkos::fence();
  const auto host = host_copy(block);
  change(host.particles);
  copy_to_device(host, block);
}

template <int Dim, class Real>
Particles<Dim, Real, Kokkos::HostSpace> read(const ParticleBlock<Dim, Real, Device>& block) {
  Kokkos::fence();
  return host_copy(block).particles;
}

/// Random numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  /// Uniform between low and high.
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  template <class Real>
  Real draw(double low, double high) {
    return static_cast<Real>((*this)(low, high));
  }
  /// One of 0, ..., count - 1.
  int index(int count) { return static_cast<int>((*this)(0, count)); }
  template <class List>
  void shuffle(List& list) {
    for (int i = static_cast<int>(list.size()) - 1; i > 0; --i)
      std::swap(list[static_cast<size_t>(i)], list[static_cast<size_t>(index(i + 1))]);
  }

 private:
  std::mt19937 engine_;
};

/// A grid that tells its directions apart: other cells, cell sizes and corner in each. The numbers are
/// dyadic, so that positions of nodes carry no round-off.
template <int Dim, class Real>
UniformGrid<Dim, Real> make_grid(const Vector<3, int>& cells = {{5, 4, 3}}) {
  constexpr double corner[3] = {-1.5, 2.25, 0.75}, size[3] = {0.5, 0.25, 0.375};
  Vector<Dim, Real> lower, spacing;
  Vector<Dim, int> count;
  for (int i = 0; i < Dim; ++i) {
    lower[i] = static_cast<Real>(corner[i]);
    spacing[i] = static_cast<Real>(size[i]);
    count[i] = cells[i];
  }
  return {lower, spacing, count};
}

/// The same nodes, each moved by up to `share` of the cell size in every direction. A share below 1 / (2 Dim)
/// leaves det J positive at every corner, by diagonal dominance.
template <int Dim, class Real, class To = Device>
MappedMesh<Dim, Real, To> make_distorted_mesh(double share, const Vector<3, int>& cells = {{5, 4, 3}},
                                              unsigned seed = 5) {
  const auto grid = make_grid<Dim, Real>(cells);
  Random random(seed);
  return make_mapped_mesh<Real, To>(grid.cells, [&](const Vector<Dim, int>& ijk) {
    auto x = grid.node_position(grid.node_index(ijk));
    for (int i = 0; i < Dim; ++i) x[i] += random.draw<Real>(-share, share) * grid.spacing[i];
    return x;
  });
}

/// Each cell of a grid, by its coordinates.
template <int Dim, class Visit>
void for_each_cell(const CellNumbering<Dim>& grid, const Visit& visit) {
  Vector<Dim, int> cell = Vector<Dim, int>::zero();
  for (int n = 0; n < grid.cell_count(); ++n) {
    visit(cell);
    for (int i = 0; i < Dim && ++cell[i] == grid.cells[i]; ++i) cell[i] = 0;
  }
}

template <int Dim, class Real>
Vector<Dim, Real> random_point(const UniformGrid<Dim, Real>& grid, Random& random) {
  Vector<Dim, Real> x;
  for (int i = 0; i < Dim; ++i)
    x[i] = grid.lower[i] + grid.spacing[i] * random.draw<Real>(0.001, grid.cells[i] - 0.001);
  return x;
}

/// n particles anywhere in a grid, with masses and volumes near 1 and any velocity and stress.
template <int Dim, class Real>
ParticleBlock<Dim, Real, Device> random_particles(const UniformGrid<Dim, Real>& grid, int n, unsigned seed) {
  const auto block = allocate_particles<Dim, Real, Device>(n);
  Random random(seed);
  edit(block, [&](const auto& particles) {
    for (int p = 0; p < n; ++p) {
      const auto x = random_point(grid, random);
      for (int i = 0; i < Dim; ++i) {
        particles.position(p, i) = x[i];
        particles.velocity(p, i) = random.draw<Real>(-1, 1);
      }
      particles.mass(p) = random.draw<Real>(0.5, 1.5);
      particles.volume(p) = random.draw<Real>(0.5, 1.5);
      for (int c = 0; c < particles.stress_size; ++c)
        particles.cauchy_stress(p, c) = random.draw<Real>(-10, 10);
    }
  });
  return block;
}

/// Particles on the lattice that divides cells into `per_direction`^Dim equal parts, in the cells for which
/// filled(cell) holds; at rest and free of stress.
template <int Dim, class Real, class Filled>
ParticleBlock<Dim, Real, Device> fill_cells(const UniformGrid<Dim, Real>& grid, int per_direction,
                                            Real density, const Filled& filled) {
  int parts = 1;
  for (int i = 0; i < Dim; ++i) parts *= per_direction;
  std::vector<Vector<Dim, Real>> positions;
  for_each_cell(grid, [&](const Vector<Dim, int>& cell) {
    if (!filled(cell)) return;
    for (int part = 0; part < parts; ++part) {
      Vector<Dim, Real> x;
      for (int i = 0, rest = part; i < Dim; ++i, rest /= per_direction)
        x[i] = grid.lower[i] + grid.spacing[i] * (static_cast<Real>(cell[i]) +
                                                  (static_cast<Real>(rest % per_direction) + Real(0.5)) /
                                                      static_cast<Real>(per_direction));
      positions.push_back(x);
    }
  });
  const auto block = allocate_particles<Dim, Real, Device>(static_cast<int>(positions.size()));
  edit(block, [&](const auto& particles) {
    for (int p = 0; p < particles.count(); ++p) {
      for (int i = 0; i < Dim; ++i) particles.position(p, i) = positions[static_cast<size_t>(p)][i];
      particles.volume(p) = grid.cell_volume() / static_cast<Real>(parts);
      particles.mass(p) = density * particles.volume(p);
    }
  });
  return block;
}

/// The sum of one column of nodal values, in double.
template <class View>
double column_sum(const View& view, int column) {
  const auto host = read(view);
  double sum = 0;
  for (size_t I = 0; I < host.extent(0); ++I) sum += static_cast<double>(host(I, column));
  return sum;
}

}  // namespace vsb::test
