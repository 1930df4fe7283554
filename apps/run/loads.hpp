// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The tractions of a scene as the kernels take them: a virtual stress field at a time, which of them act by
/// which method, and the surface points of those that need some.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include <vsb/kernels/step.hpp>
#include <vsb/physics/exact_ellipse.hpp>
#include "run/body_surface.hpp"
#include "run/place_particles.hpp"
#include "run/simulation.hpp"

namespace vsb::app {

/// A surface point on the host.
struct LoadedPoint {
  Point position{}, area{};
  TractionMask tractions = 0;
  int carrier = carried_by_grid;
};

/// The tractions that are imposed in a given way, as a mask.
TractionMask imposed_by(const Scene& scene, Imposition imposition);
/// Of the tractions in `among`, those whose surface contains a point.
TractionMask tractions_at(const Scene& scene, TractionMask among, const Point& x);
/// Massless boundary particles on the surface of the bodies, and loaded material points: every piece of
/// surface loads the nearest particle of its traction's layer.
std::vector<LoadedPoint> loaded_points(const Scene& scene, const PlacedParticles& placed);
/// Conforming loads: the faces between cells with particles and the others, all of whose nodes lie in the
/// traction's surface, share their area between their nodes. `occupied`: cells along x first.
template <int Dim, class Grid>
std::vector<LoadedPoint> conforming_points(const Scene& scene, const Grid& grid,
                                           const std::vector<bool>& occupied);
/// Force and torque about the origin of each traction at full load on the initial surface.
struct Resultant {
  Point force{}, torque{};
};
std::vector<Resultant> exact_resultants(const Scene& scene);
/// sbar of a traction at full load, also where it is an exact field.
Stress6 full_stress(const Scene& scene, const TractionSpec& traction, const Point& x);
/// The exact field of an ellipse in the material of the first body.
template <class Real>
ExactEllipse<Real> ellipse_field(const Scene& scene, const EllipseSpec& e) {
  return {static_cast<Real>(e.semi_major), static_cast<Real>(e.semi_minor),
          static_cast<Real>(e.pressure),   static_cast<Real>(e.far_stress),
          static_cast<Real>(e.far_ratio),  static_cast<Real>(scene.bodies.front().material.poisson_ratio)};
}

/// The virtual stress of a scene's tractions at a time.
template <int Dim, class Real>
class Loads {
 public:
  explicit Loads(const Scene& scene)
      : on_nodes_(imposed_by(scene, Imposition::virtual_stress) |
                  imposed_by(scene, Imposition::virtual_stress_original)),
        original_(imposed_by(scene, Imposition::virtual_stress_original)),
        gauss_points_(scene.method.cell_gauss_points) {
    field_.uniform.count = static_cast<int>(scene.tractions.size());
    for (size_t k = 0; k < scene.tractions.size(); ++k)
      if (scene.tractions[k].exact) {
        field_.is_exact = TractionMask(1) << k;
        if constexpr (Dim == 2) field_.exact = ellipse_field<Real>(scene, *scene.tractions[k].exact);
      }
  }

  /// The tractions that act through boundary nodes, by the virtual stress method.
  TractionMask on_nodes() const { return on_nodes_; }

  void set_time(const Scene& scene, double t) {
    for (size_t k = 0; k < scene.tractions.size(); ++k) {
      const auto& traction = scene.tractions[k];
      const double factor = traction.time(t);
      for (size_t c = 0; c < SymmetricTensor<Dim, Real>::size; ++c)
        field_.uniform.stress[k][static_cast<int>(c)] =
            static_cast<Real>(traction.exact ? 0.0 : factor * traction.virtual_stress[c]);
      if (traction.exact) field_.factor = static_cast<Real>(factor);
    }
  }

  /// Calls work(field) with the kernels' field for these tractions; WithOriginal: by the original method too.
  template <bool WithOriginal, class Grid, class Device, class Work>
  auto with_field(const Grid& grid, const CellBits<Device>& cells, const Work& work) const {
    if constexpr (Dim == 2 && std::is_same<Real, double>::value) {
      if (field_.is_exact) return by_method<WithOriginal>(field_, grid, cells, work);
    }
    if (field_.uniform.count == 0) return work(NoVirtualStress{});
    return by_method<WithOriginal>(field_.uniform, grid, cells, work);
  }

 private:
  /// Stands in for the exact field where there is none.
  struct NoExactField {
    KOKKOS_FUNCTION SymmetricTensor<Dim, Real> stress(const Vector<Dim, Real>&) const {
      return SymmetricTensor<Dim, Real>::zero();
    }
  };
  using Exact = std::conditional_t<Dim == 2, ExactEllipse<Real>, NoExactField>;

  template <bool WithOriginal, class Field, class Grid, class Device, class Work>
  auto by_method(const Field& field, const Grid& grid, const CellBits<Device>& cells,
                 const Work& work) const {
    if (on_nodes_ == 0) return work(OnSurfacePoints<Field>{field});
    if constexpr (WithOriginal) {
      if (original_ != 0)
        return work(OriginalVirtualStress<Field, Grid, Device>{field, grid, cells, original_, gauss_points_});
    }
    return work(field);
  }

  TractionMask on_nodes_, original_;
  int gauss_points_;
  UniformOrExactVirtualStress<Exact, Dim, Real> field_{};
};

template <int Dim, class Grid>
std::vector<LoadedPoint> conforming_points(const Scene& scene, const Grid& grid,
                                           const std::vector<bool>& occupied) {
  const TractionMask among = imposed_by(scene, Imposition::nodal);
  std::map<int, std::map<TractionMask, Point>> area;  // of node and tractions
  if (among == 0) return {};
  const auto cell_at = [&](Vector<Dim, int> c) {
    int index = 0;
    for (int i = Dim - 1; i >= 0; --i) {
      if (c[i] < 0 || c[i] >= grid.cells[i]) return false;
      index = index * grid.cells[i] + c[i];
    }
    return static_cast<bool>(occupied[static_cast<size_t>(index)]);
  };
  const auto place = [&](const Vector<Dim, int>& ijk) {
    const auto x = grid.node_position(grid.node_index(ijk));
    Point p{};
    for (int i = 0; i < Dim; ++i) p[static_cast<size_t>(i)] = x[i];
    return p;
  };
  constexpr int corners = 1 << (Dim - 1);
  for (size_t index = 0; index < occupied.size(); ++index) {
    if (!occupied[index]) continue;
    Vector<Dim, int> cell;
    for (int i = 0, rest = static_cast<int>(index); i < Dim; ++i) {
      cell[i] = rest % grid.cells[i];
      rest /= grid.cells[i];
    }
    for (int axis = 0; axis < Dim; ++axis)
      for (int side = 0; side < 2; ++side) {
        auto neighbour = cell;
        neighbour[axis] += side == 0 ? -1 : 1;
        if (cell_at(neighbour)) continue;
        int node[corners];
        Point x[corners];
        TractionMask common = among;
        for (int c = 0; c < corners; ++c) {
          auto ijk = cell;
          ijk[axis] += side;
          for (int k = 1; k < Dim; ++k) ijk[(axis + k) % Dim] += c >> (k - 1) & 1;
          node[c] = grid.node_index(ijk);
          x[c] = place(ijk);
          common &= tractions_at(scene, common, x[c]);
        }
        if (common == 0) continue;
        // Area vector in the direction of the positive axis; 3D: half the cross product of the diagonals.
        Point a{};
        if constexpr (Dim == 1) a = {1, 0, 0};
        if constexpr (Dim == 2) {
          const double sign = axis == 0 ? 1 : -1;  // the other axis runs along the face
          a = {sign * (x[1][1] - x[0][1]), -sign * (x[1][0] - x[0][0]), 0};
        }
        if constexpr (Dim == 3)
          for (size_t i = 0; i < 3; ++i) {
            const size_t j = (i + 1) % 3, k = (i + 2) % 3;
            a[i] =
                0.5 * ((x[3][j] - x[0][j]) * (x[2][k] - x[1][k]) - (x[3][k] - x[0][k]) * (x[2][j] - x[1][j]));
          }
        for (int c = 0; c < corners; ++c) {
          Point& sum = area[node[c]][common];
          for (size_t i = 0; i < 3; ++i) sum[i] += (side == 0 ? -1.0 : 1.0) * a[i] / corners;
        }
      }
  }
  std::vector<LoadedPoint> points;
  for (const auto& [node, by_tractions] : area)
    for (const auto& [tractions, sum] : by_tractions)
      points.push_back({place(grid.node_ijk(node)), sum, tractions, carried_by_none});
  return points;
}

}  // namespace vsb::app
