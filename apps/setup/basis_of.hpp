// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The basis functions of a scene, with the memory they need, on the backend of this build. Bases with ghost
/// layers get a grid with a layer of ghost cells around that of the scene. Positions are counted from an
/// origin in the scene's coordinates (setup/local_origin.hpp).
#pragma once

#include <vsb/kernels/mesh/make_mapped_mesh.hpp>
#include <vsb/physics/linear_basis.hpp>
#include <vsb/physics/mapped_basis.hpp>
#include <vsb/physics/quadratic_bspline_basis.hpp>
#include <vsb/physics/uniform_gimp_basis.hpp>
#include "scene/scene.hpp"
#include "setup/execution_space.hpp"
#include "setup/local_origin.hpp"

namespace vsb::app {

/// A basis together with what it points to, in the memory of the backend or of another device.
template <class Basis, class Device = ExecutionSpace::device_type>
struct OwnedBasis;

template <int Dim, class Real>
UniformGrid<Dim, Real> uniform_grid(const GridSpec& spec, const Point& origin) {
  Vector<Dim, Real> lower, spacing;
  Vector<Dim, int> cells;
  for (int i = 0; i < Dim; ++i) {
    const auto axis = static_cast<size_t>(i);
    lower[i] = static_cast<Real>(spec.lower[axis] - origin[axis]);
    spacing[i] = static_cast<Real>(spec.spacing[axis]);
    cells[i] = spec.cells[axis];
  }
  return {lower, spacing, cells};
}

template <int Dim>
Walls<Dim> walls(const FaceSpec& faces) {
  Walls<Dim> w;
  for (int i = 0; i < Dim; ++i)
    for (int side = 0; side < 2; ++side)
      w.fixed[i][side] = faces.fixed[static_cast<size_t>(i)][static_cast<size_t>(side)];
  return w;
}

template <int Dim, class Real, class Device>
struct OwnedBasis<LinearBasis<Dim, Real>, Device> {
  LinearBasis<Dim, Real> basis;

  OwnedBasis(const Scene& scene, const Point& origin) : basis{uniform_grid<Dim, Real>(scene.grid, origin)} {}
  size_t bytes() const { return 0; }
};

template <int Dim, class Real, class Device>
struct OwnedBasis<QuadraticBSplineBasis<Dim, Real>, Device> {
  QuadraticBSplineBasis<Dim, Real> basis;

  OwnedBasis(const Scene& scene, const Point& origin) {
    basis.grid = with_ghost_layer(uniform_grid<Dim, Real>(scene.grid, origin));
    basis.walls = walls<Dim>(scene.faces);
  }
  size_t bytes() const { return 0; }
};

template <int Dim, class Real, class Device>
struct OwnedBasis<UniformGimpBasis<Dim, Real>, Device> {
  UniformGimpBasis<Dim, Real> basis;

  OwnedBasis(const Scene& scene, const Point& origin) {
    basis.grid = with_ghost_layer(uniform_grid<Dim, Real>(scene.grid, origin));
    basis.walls = walls<Dim>(scene.faces);
    for (int i = 0; i < Dim; ++i)
      basis.half_width[i] = static_cast<Real>(scene.method.gimp_half_width[static_cast<size_t>(i)]);
  }
  size_t bytes() const { return 0; }
};

template <int Dim, class Real, class Device>
struct OwnedBasis<MappedLinearBasis<Dim, Real>, Device> {
  MappedMesh<Dim, Real, Device> mesh;
  MappedLinearBasis<Dim, Real> basis;

  OwnedBasis(const Scene& scene, const Point& origin)
      : mesh(make_mesh(scene.grid, origin)), basis{mesh.grid} {}
  size_t bytes() const {
    return mesh.nodes.position.span() * sizeof(Real) + mesh.nodes.start_cell.span() * sizeof(int);
  }

 private:
  static auto make_mesh(const GridSpec& spec, const Point& origin) {
    Vector<Dim, int> cells;
    for (int i = 0; i < Dim; ++i) cells[i] = spec.cells[static_cast<size_t>(i)];
    return make_mapped_mesh<Real, Device>(cells, [&](const Vector<Dim, int>& ijk) {
      std::array<int, 3> logical{};
      for (int i = 0; i < Dim; ++i) logical[static_cast<size_t>(i)] = ijk[i];
      const Point position = node_position(spec, Dim, logical);
      Vector<Dim, double> x;
      for (int i = 0; i < Dim; ++i) x[i] = position[static_cast<size_t>(i)] - origin[static_cast<size_t>(i)];
      return x;
    });
  }
};

/// The basis for work on the host: the backend's own where that is the host.
template <class Basis>
auto basis_on_host([[maybe_unused]] const Scene& scene, [[maybe_unused]] const Point& origin,
                   [[maybe_unused]] const OwnedBasis<Basis>& of_backend) {
  if constexpr (runs_on_host)
    return of_backend;
  else
    return OwnedBasis<Basis, Kokkos::HostSpace::device_type>(scene, origin);
}

}  // namespace vsb::app
