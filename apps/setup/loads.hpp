// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The tractions of a scene as the kernels take them: a virtual stress field at a time, which of them act by
/// which method, and the surface points of those that need some.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include <vsb/kernels/boundary/self_balance.hpp>
#include <vsb/kernels/step.hpp>
#include "setup/body_surface.hpp"
#include "setup/local_origin.hpp"
#include "setup/place_particles.hpp"
#include "setup/setup_error.hpp"

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
/// The tractions that move with the material, as a mask.
TractionMask carried_tractions(const Scene& scene);
/// [particle]: those of them in whose surface it is placed. Throws SetupError for one that has no particle.
std::vector<TractionMask> carried_by_particles(const Scene& scene, const PlacedParticles& placed);
/// Massless boundary particles on the surface of the bodies, and loaded material points: every piece of
/// surface loads the nearest particle of its traction's layer.
std::vector<LoadedPoint> loaded_points(const Scene& scene, const PlacedParticles& placed);
/// Conforming loads: the faces between cells with particles and the others, all of whose nodes lie in the
/// traction's surface, share their area between their nodes. `occupied`: cells along x first.
template <int Dim, class Grid>
std::vector<LoadedPoint> conforming_points(const Scene& scene, const Grid& grid,
                                           const std::vector<bool>& occupied);
/// Force, and torque about a point, of each traction at full load on the initial surface.
struct Resultant {
  Point force{}, torque{};
  double load = 0;  ///< integral of |sbar n|, which a closed surface does not cancel: p A of a pressure
};
std::vector<Resultant> exact_resultants(const Scene& scene, const Point& about);
/// sbar of a traction at full load.
Stress6 full_stress(const Scene& scene, const TractionSpec& traction, const Point& x);
/// The field of a traction at full load as the kernels take it; `scene` says of what its bodies are.
template <int Dim, class Real>
StressField<Dim, Real> stress_field(const Scene& scene, const StressFieldSpec& spec);

/// The virtual stress of a scene's tractions at a time.
template <int Dim, class Real>
class Loads {
 public:
  /// Positions are counted from `origin`.
  Loads(const Scene& scene, const Point& origin)
      : on_nodes_(imposed_by(scene, Imposition::virtual_stress) |
                  imposed_by(scene, Imposition::virtual_stress_original)),
        original_(imposed_by(scene, Imposition::virtual_stress_original)),
        gauss_points_(scene.method.cell_gauss_points) {
    uniform_.count = fields_.count = static_cast<int>(scene.tractions.size());
    for (size_t k = 0; k < scene.tractions.size(); ++k) {
      const auto& traction = scene.tractions[k];
      if (!std::holds_alternative<Stress6>(traction.field)) {
        fields_.field[k] = stress_field<Dim, Real>(scene, seen_from(origin, traction.field));
        all_uniform_ = false;
        all_affine_ = all_affine_ && fields_.field[k].is_affine();
      }
      if (traction.all_nodes) at_all_active_nodes_ |= TractionMask(1) << k;
      if (traction.self_balanced) balanced_ |= TractionMask(1) << k;
    }
  }

  /// The tractions that act through nodes, by the virtual stress method.
  TractionMask on_nodes() const { return on_nodes_; }
  /// Of these, the ones that act at all active nodes.
  TractionMask at_all_active_nodes() const { return at_all_active_nodes_; }

  void set_time(const Scene& scene, double t) {
    set_factors(scene, [&](const TractionSpec& traction) { return traction.time(t); });
  }
  /// All of them at full load, whatever their time.
  void set_full(const Scene& scene) {
    set_factors(scene, [](const TractionSpec&) { return 1.0; });
  }
  /// The share of the full load that factor_of(traction) says.
  template <class Factor>
  void set_factors(const Scene& scene, const Factor& factor_of) {
    for (size_t k = 0; k < scene.tractions.size(); ++k) {
      const double factor = factor_of(scene.tractions[k]);
      if (const auto* full = std::get_if<Stress6>(&scene.tractions[k].field)) {
        for (size_t c = 0; c < SymmetricTensor<Dim, Real>::size; ++c)
          uniform_.stress[k][static_cast<int>(c)] = static_cast<Real>(factor * (*full)[c]);
        fields_.field[k] = UniformStress<Dim, Real>{uniform_.stress[k]};
        fields_.factor[k] = 1;  // rounded once: the same bits as in uniform_
      } else {
        fields_.factor[k] = static_cast<Real>(factor);
      }
    }
  }

  /// Takes the resultant out of the self-balanced tractions, for particles where they are now. `near` is any
  /// point near them.
  template <class Exec, class Device>
  void balance(const Exec& exec, const Particles<Dim, Real, Device>& particles,
               const Vector<Dim, Real>& near) {
    if (balanced_ == 0 || all_uniform_) return;  // a uniform stress has no resultant at all nodes
    fields_.balanced = 0;
    fields_.balance = balancing_force(exec, particles, fields_, balanced_, near);
    fields_.balanced = balanced_;
  }

  /// Calls work(field) with the kernels' field for these tractions; WithOriginal: by the original method too.
  template <bool WithOriginal, class Grid, class Device, class Work>
  auto with_field(const Grid& grid, const CellBits<Device>& cells, const Work& work) const {
    using Fields = TractionFields<Dim, Real>;
    if (fields_.count == 0) return work(NoVirtualStress{});
    if (on_nodes_ == 0) return work(OnSurfacePoints<Fields>{fields_});
    if constexpr (WithOriginal) {
      if (original_ != 0)
        return work(
            OriginalVirtualStress<Fields, Grid, Device>{fields_, grid, cells, original_, gauss_points_});
    }
    return all_uniform_ ? work(uniform_) : work(fields_);
  }

  /// The tractions of the original method, and the Gauss points per direction of its cells.
  TractionMask original() const { return original_; }
  int gauss_points() const { return gauss_points_; }

  /// Calls work(field) with the field as the sweeps over cell lanes take it: of the (modified) virtual stress
  /// method alone, and as an affine one where it is, if asked for.
  template <bool AsAffine = true, class Work>
  void with_lane_field(const Work& work) const {
    if (modified() == 0) return work(NoVirtualStress{});
    if (all_uniform_) {
      auto uniform = uniform_;
      for_each_other([&](int k) { uniform.stress[k] = SymmetricTensor<Dim, Real>::zero(); });
      return work(uniform);
    }
    auto fields = fields_;
    for_each_other([&](int k) { fields.field[k] = StressField<Dim, Real>(); });
    if constexpr (AsAffine) {
      if (all_affine_) {
        AffineVirtualStress<Dim, Real> affine;
        affine.count = fields.count;
        for (int k = 0; k < affine.count; ++k) {
          affine.field[k] = fields.field[k].as_affine();
          affine.factor[k] = fields.factor[k];
        }
        affine.find_axis();
        return work(affine);
      }
    }
    work(fields);
  }

  /// Calls work(field) with the field of all tractions, for what loads cell lanes beside the sweeps.
  template <class Work>
  auto with_field_beside_lanes(const Work& work) const {
    return all_uniform_ ? work(uniform_) : work(fields_);
  }

 private:
  TractionMask modified() const { return on_nodes_ & ~original_; }
  /// Calls work(k) for the tractions that are not of the modified method.
  template <class Work>
  void for_each_other(const Work& work) const {
    for (int k = 0; k < fields_.count; ++k)
      if ((modified() >> k & 1u) == 0) work(k);
  }

  TractionMask on_nodes_, original_, at_all_active_nodes_ = 0, balanced_ = 0;
  int gauss_points_;
  bool all_uniform_ = true, all_affine_ = true;
  UniformVirtualStress<Dim, Real> uniform_{};
  TractionFields<Dim, Real> fields_{};
};

template <int Dim, class Real>
SymmetricTensor<Dim, Real> to_tensor(const Stress6& s) {
  SymmetricTensor<Dim, Real> t;
  for (size_t c = 0; c < SymmetricTensor<Dim, Real>::size; ++c)
    t[static_cast<int>(c)] = static_cast<Real>(s[c]);
  return t;
}

template <int Dim, class Real>
StressField<Dim, Real> stress_field(const Scene& scene, const StressFieldSpec& spec) {
  const auto number = [](double x) { return static_cast<Real>(x); };
  const auto vector = [&](const Point& p) {
    Vector<Dim, Real> v;
    for (size_t i = 0; i < Dim; ++i) v[static_cast<int>(i)] = number(p[i]);
    return v;
  };
  const auto tensor = [](const Stress6& s) { return to_tensor<Dim, Real>(s); };
  using Field = StressField<Dim, Real>;
  return std::visit(
      Overloaded{[&](const Stress6& s) -> Field { return UniformStress<Dim, Real>{tensor(s)}; },
                 [&](const Affine<Stress6>& affine) -> Field {
                   AffineStress<Dim, Real> field{tensor(affine.value), {}};
                   for (size_t k = 0; k < Dim; ++k) field.gradient[k] = tensor(affine.gradient[k]);
                   return field;
                 },
                 [&](const HydrostaticSpec& h) -> Field {
                   return HydrostaticStress<Dim, Real>{number(h.unit_weight), number(h.level),
                                                       number(h.width), vector(h.up)};
                 },
                 [&](const RadialBlendSpec& b) -> Field {
                   Point across{1, 1, 1};
                   if (b.axis >= 0) across[static_cast<size_t>(b.axis)] = 0;
                   return RadialBlend<Dim, Real>{vector(b.center),       vector(across),
                                                 number(b.inner_radius), number(b.outer_radius),
                                                 tensor(b.inner),        tensor(b.outer)};
                 },
                 [&](const PlanarBlendSpec& b) -> Field {
                   return PlanarBlend<Dim, Real>{vector(b.start), vector(b.end) - vector(b.start),
                                                 tensor(b.at_start), tensor(b.at_end)};
                 },
                 [&](const EllipseSpec& e) -> Field {
                   if constexpr (Dim == 2)
                     return ExactEllipse<Real>{
                         number(e.semi_major), number(e.semi_minor),
                         number(e.pressure),   number(e.far_stress),
                         number(e.far_ratio),  number(scene.bodies.front().material.poisson_ratio)};
                   else
                     throw std::logic_error("exact_ellipse is a field of plane strain");
                 }},
      spec);
}

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
  const Point origin = local_origin(scene);
  const auto point_of = [&](const Vector<Dim, int>& ijk) {
    return to_scene(grid.node_position(grid.node_index(ijk)), origin);
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
          x[c] = point_of(ijk);
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
      points.push_back({point_of(grid.node_ijk(node)), sum, tractions, carried_by_none});
  return points;
}

}  // namespace vsb::app
