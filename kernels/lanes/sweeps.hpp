// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The sweeps over cell lanes of one MUSL step, a layer each call:
///   A  mass, momentum and force of the nodes: m_I = sum_p m_p N_Ip,  p_I = sum_p m_p v_p N_Ip,
///      f_I = -sum_p V_p sigma_p . grad N_Ip with the virtual stress (kernels/lanes/sums.hpp);
///   B  FLIP, v_p <- (1 - eta) v_p + sum_I N_Ip g_I with the increment g_I = dt a_I + eta v_I, eta being the
///      share of PIC (kernels/particles/grid_to_particles.hpp) and v_I the velocity before the step, and the
///      momentum of the re-map, p*_I = sum_p N_Ip m_p v_p;
///   C  L = sum_I v*_I (x) grad N_Ip,  sigma <- material(sigma, L dt),
///      V <- V det(I + dt L) or V exp(dt tr L),  x_p <- x_p + dt sum_I N_Ip v*_I.
///      Particles that leave their cell go to the layer's list of migrating particles.
/// C of a step and A of the next one are one sweep: a particle is read and written once for both.
///
/// With PositionVelocity::grid particles move by v_I, as in the paper.
/// The nodes store g, dt v* in cells and, for PositionVelocity::grid, dt v in cells, so that the particles
/// only interpolate.
///
/// Against volumetric locking the mean divergence of a cell replaces the divergence of L
/// (physics/mean_divergence.hpp). C sums the particles' volumes first to find it.
///
/// With many particles per cell the mass matrix of the cell replaces sweep B:
///   p*_I = (1 - eta) p_I + sum_J M_IJ g_J,   M_IJ = sum_p m_p N_Ip N_Jp.
/// A sums the consistent mass matrix M cell by cell (physics/cell_mass_matrix.hpp), RemapLanes adds M g to
/// the nodes, and C begins with v_p <- (1 - eta) v_p + sum_I N_Ip g_I.
#pragma once

#include <vsb/kernels/lanes/plasticity.hpp>
#include <vsb/kernels/lanes/virtual_stress.hpp>
#include <vsb/physics/kinematics.hpp>
#include <vsb/physics/mean_divergence.hpp>
#include <vsb/physics/next_cell.hpp>

namespace vsb {

namespace kernel {

/// Calls work(group, number) for the groups of a layer that hold particles, in order.
template <int Dim, class Real, class Device, class Work>
KOKKOS_FORCEINLINE_FUNCTION void for_each_group(const CellLanes<Dim, Real, Device>& lanes, int layer,
                                                const Work& work) {
  for (int g = lanes.layer_first(layer); g < lanes.layer_first(layer + 1); ++g) {
    const auto& group = lanes.groups(g);
    if (group.slots > 0) work(group, g);
  }
}

/// Sweep A.
template <bool EqualSpacing, class Field, int Dim, class Real, class Device>
struct SumLanes {
  LoadedLanes<Dim, Real, Device> on;
  LaneNodes<Dim, Real, Device> nodes;
  Field virtual_stress;
  Kokkos::View<int*, Device> only;  ///< [layer]: 0: the layer is skipped; empty: no layer is

  KOKKOS_FUNCTION void operator()(int layer) const {
    if (only.size() > 0 && only(layer) == 0) return;
    StepSums<Dim, Real, Device> sums(nodes);
    sums.begin_anew(on.lanes, layer);
    for_each_group(on.lanes, layer, [&](const auto& group, int) {
      sums.begin(group);
      sum_group_with<EqualSpacing>(on, group, virtual_stress, sums);
    });
    sums.end();
  }
};

/// v_p <- (1 - eta) v_p + sum_I N_Ip g_I for the particles of a group.
template <int Dim, class Real, class Device>
KOKKOS_FORCEINLINE_FUNCTION void accelerate(const CellLanes<Dim, Real, Device>& lanes,
                                            const LaneNodes<Dim, Real, Device>& nodes,
                                            const LaneGroup<Dim>& group, Real pic) {
  using P = typename Lanes<Real>::Pack;
  const P kept(Real(1) - pic);
  Vector<(1 << Dim), P> dv[Dim];
  static_for<Dim>([&](auto i)
                      VSB_UNROLLED { values_at_corners(nodes, nodes.increment_column + i, group, dv[i]); });
  for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
    const CornerFunctions<Dim, P> N(lanes.load_xi(entry));
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      const P v = lanes.load(lanes.velocity_column + i, entry);
      lanes.store(lanes.velocity_column + i, entry, kept * v + N.interpolate(dv[i]));
    });
  }
}

/// Sweep B.
template <int Dim, class Real, class Device>
struct AccelerateLanes {
  using P = typename Lanes<Real>::Pack;
  using Momentum = LayerSums<1, Dim, Dim, Real, Device>;
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  Real pic;  ///< eta

  KOKKOS_FUNCTION void operator()(int layer) const {
    Momentum sums(nodes);
    for_each_group(lanes, layer, [&](const auto& group, int) {
      sums.begin(group);
      accelerate_and_sum(group, sums);
    });
    sums.end();
  }
  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void accelerate_and_sum(const LaneGroup<Dim>& group,
                                                                          Momentum& sums) const {
    accelerate(lanes, nodes, group, pic);
    CellPolynomial<Dim, P> p[Dim];
    lane_sums::momentum(lanes, group, p);
    static_for<Dim>([&](auto i) VSB_UNROLLED { sums.add(1 + i, group, p[i]); });
  }
};

/// p*_I = (1 - eta) p_I + sum_J M_IJ g_J, in place of sweep B; the nodes have (1 - eta) p_I.
template <int Dim, class Real, class Device>
struct RemapLanes {
  using P = typename Lanes<Real>::Pack;
  using Momentum = LayerSums<1, Dim, Dim, Real, Device>;
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;

  KOKKOS_FUNCTION void operator()(int layer) const {
    Momentum sums(nodes);
    for_each_group(lanes, layer, [&](const auto& group, int g) {
      sums.begin(group);
      add_gain(g, group, sums);
    });
    sums.end();
  }
  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void add_gain(int g, const LaneGroup<Dim>& group,
                                                                Momentum& sums) const {
    CellMassMatrix<Dim, P> M;
    static_for<M.size>([&](auto k) VSB_UNROLLED { M[k] = P::load(lanes.mass_matrix_at(g, k)); });
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      CellPolynomial<Dim, P> dv;
      values_at_corners(nodes, nodes.increment_column + i, group, dv);
      sums.add(1 + i, group, times<Dim>(M, dv));
    });
  }
};

/// Sweep C for one group.
template <bool EqualSpacing, class Material, class Volume, int Dim, class Real, class Device>
struct MoveGroup {
  using P = typename Lanes<Real>::Pack;
  CellLanes<Dim, Real, Device> lanes;
  LaneNodes<Dim, Real, Device> nodes;
  UniformGrid<Dim, Real> grid;
  Material material;
  Volume volume;
  MigratingParticles<Dim, Real, Device> migrating;
  Real beta = 0;  ///< share of the divergence that a mean replaces (physics/mean_divergence.hpp)
  PositionVelocity position_velocity = PositionVelocity::strain;
  Real pic = 0;  ///< eta

  KOKKOS_FORCEINLINE_FUNCTION void operator()(const LaneGroup<Dim>& group, int layer) const {
    if (beta > Real(0))
      move<true>(group, layer);
    else
      move<false>(group, layer);
  }
  /// averaged: whether the mean replaces the divergence.
  template <bool averaged>
  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void move(const LaneGroup<Dim>& group, int layer) const {
    P mean;
    if constexpr (averaged) mean = mean_divergence(group);
    Vector<(1 << Dim), P> dx[Dim];
    CellPolynomial<Dim, P> u[Dim];
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      values_at_corners(nodes, nodes.remapped_column + i, group, u[i]);
      if (position_velocity == PositionVelocity::grid)
        values_at_corners(nodes, nodes.displacement_column + i, group, dx[i]);
      else
        dx[i] = EqualSpacing ? u[i] : P(grid.inverse_spacing[i] * grid.spacing[0]) * u[i];
      coefficients_from_nodes<Dim>(u[i]);
    });
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      const auto xi = lanes.load_xi(entry);
      Matrix<Dim, P> L;  // dt L
      static_for<Dim>([&](auto i) VSB_UNROLLED {
        static_for<Dim>([&](auto j) VSB_UNROLLED {
          L(i, j) = derivative_at<j, Dim>(u[i], xi);
          if constexpr (!EqualSpacing) L(i, j) *= P(grid.inverse_spacing[j] * grid.spacing[0]);
        });
      });
      if constexpr (averaged) L = with_mean_divergence(L, mean, P(beta));
      advance(entry, L);
      const P V = lanes.load(lanes.volume_column, entry);
      lanes.store(lanes.volume_column, entry, volume(V, L, P(1)));
      const CornerFunctions<Dim, P> N(xi);
      Vector<Dim, P> moved;
      static_for<Dim>([&](auto i) VSB_UNROLLED { moved[i] = xi[i] + N.interpolate(dx[i]); });
      lanes.store_row(lanes.xi_column, entry, moved);
      if (!all_off_the_faces(moved)) copy_migrating(group, layer, entry);
    }
  }
  /// Whether all are in their cell as off_the_faces leaves them.
  KOKKOS_FORCEINLINE_FUNCTION static bool all_off_the_faces(const Vector<Dim, P>& xi) {
    const P lowest(math::epsilon<Real>);
    auto inside = (xi[0] >= lowest) & (xi[0] < P(1));
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      if constexpr (i > 0) inside = inside & (xi[i] >= lowest) & (xi[i] < P(1));
    });
    return !any(!inside);
  }

  /// The mean of dt tr L over every cell, sum_p V_p dt tr L_p / sum_p V_p.
  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION P mean_divergence(const LaneGroup<Dim>& group) const {
    CellPolynomial<Dim, P> theta;
    lane_sums::set_zero<Dim>(theta);
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      CellPolynomial<Dim, P> u;
      coefficients_of(nodes, nodes.remapped_column + i, group, u);
      static_for<(1 << Dim)>([&](auto k) VSB_UNROLLED {
        if constexpr (k >> i & 1) theta[k ^ (1 << i)] += P(grid.inverse_spacing[i] * grid.spacing[0]) * u[k];
      });
    });
    P V_sum(Real(0)), V_theta(Real(0));
    for (size_t entry = lanes.begin(group); entry < lanes.end(group); entry += P::width) {
      const P V = lanes.load(lanes.volume_column, entry);
      V_sum += V;
      V_theta += V * value_at<Dim>(theta, lanes.load_xi(entry));
    }
    return math::select(V_sum > P(Real(0)), V_theta / V_sum, P(Real(0)));
  }

  KOKKOS_FORCEINLINE_FUNCTION void advance(size_t entry, const Matrix<Dim, P>& L) const {
    constexpr int remembered = Material::template state_size<Dim>();
    const auto sigma = lanes.load_stress(entry);
    if constexpr (remembered == 0) {
      lanes.store_row(lanes.stress_column, entry, material.advance(sigma, L, P(1)));
    } else if constexpr (Material::plastic) {
      advance_plastic_lanes(lanes, material, entry, sigma, L);
    } else {
      // Lane by lane: such materials branch.
      const LaneMask with_particle = lanes.with_particle(entry / P::width);
      for (int l = 0; l < P::width; ++l) {
        if (!(with_particle >> l & 1)) continue;  // the strain of a ghost has no bound
        Vector<remembered, Real> state;
        SymmetricTensor<Dim, Real> s;
        Matrix<Dim, Real> L_l;
        for (int c = 0; c < remembered; ++c) state[c] = *lanes.at(lanes.state_column + c, entry + l);
        for (int c = 0; c < s.size; ++c) s[c] = sigma[c][l];
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) L_l(i, j) = L(i, j)[l];
        s = material.advance(s, state, L_l, Real(1));
        for (int c = 0; c < remembered; ++c) *lanes.at(lanes.state_column + c, entry + l) = state[c];
        for (int c = 0; c < s.size; ++c) *lanes.at(lanes.stress_column + c, entry + l) = s[c];
      }
    }
  }

  /// Copies the particles of a slot that left their cell to the layer's list, and moves those on a face off
  /// it. Ghosts move with the velocity field. Outside their cell their coordinates would grow without bound,
  /// so that those of the slot are reset.
  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void copy_migrating(const LaneGroup<Dim>& group, int layer,
                                                                      size_t entry) const {
    const size_t slot = entry / P::width;
    const LaneMask with_particle = lanes.with_particle(slot);
    const int n = migrating.first(layer) + migrating.count(layer);
    auto& head = migrating.head(n);
    auto xi = lanes.load_xi(entry);
    LaneMask below[Dim], above[Dim], migrating_lanes = 0;
    if (next_to_here(group, xi, with_particle, below, above)) {
      for (int i = 0; i < Dim; ++i) migrating_lanes |= below[i] | above[i];
      for (int l = 0; l < P::width; ++l) {
        auto cell = lanes.cell(group, l);
        for (int i = 0; i < Dim; ++i)
          cell[i] += static_cast<int>(above[i] >> l & 1) - static_cast<int>(below[i] >> l & 1);
        head.cell[l] = cell;
      }
      head.far = 0;
      head.to[0] = below[Dim - 1];
      head.to[2] = above[Dim - 1];
      head.to[1] = migrating_lanes & ~head.to[0] & ~head.to[2];
      if (Dim == 1) {
        head.to[1] = migrating_lanes;
        head.to[0] = head.to[2] = 0;
      }
    } else {
      migrating_lanes = find_migrating_lanes(group, xi, with_particle, head);
    }
    const LaneMask staying = with_particle & ~migrating_lanes;
    lanes.with_particle(slot) = staying;
    const auto stays = P::Mask::from_bits(staying);
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      if (migrating_lanes != 0) xi[i].store(&migrating.data(n, (lanes.xi_column + i) * P::width));
      lanes.store(lanes.xi_column + i, entry, math::select(stays, xi[i], P(Real(0.5))));
    });
    for (int c = Dim; c < lanes.columns(); ++c) {
      const P value = lanes.load(c, entry);
      if (migrating_lanes != 0) value.store(&migrating.data(n, c * P::width));
      lanes.store(c, entry, math::select(stays, value, P(Real(0))));
    }
    if (migrating_lanes == 0) return;
    head.x = group.x;
    head.row = group.row;
    for (int t = 0; t < 3; ++t) head.overflow[t] = 0;
    for (int l = 0; l < P::width; ++l) {
      if (!(migrating_lanes >> l & 1)) continue;
      const size_t e = entry + static_cast<size_t>(l);
      head.id[l] = lanes.id(e);
      lanes.id(e) = -1;
      ++migrating.lost(layer);
    }
    ++migrating.count(layer);
  }
  /// The common case: all particles of a slot are in their cell or a neighbour of it, and away from the faces
  /// of the grid. Finds which lanes went below and above along every axis; xi becomes that in the new cell.
  KOKKOS_FORCEINLINE_FUNCTION bool next_to_here(const LaneGroup<Dim>& group, Vector<Dim, P>& xi,
                                                LaneMask with_particle, LaneMask (&below)[Dim],
                                                LaneMask (&above)[Dim]) const {
    const auto first = lanes.cell(group, 0);
    bool inner = first[0] > 0 && first[0] + P::width < grid.cells[0];
    for (int i = 1; i < Dim; ++i) inner = inner && first[i] > 0 && first[i] + 1 < grid.cells[i];
    if (!inner) return false;
    Vector<Dim, P> there;
    LaneMask inside = with_particle;
    static_for<Dim>([&](auto i) VSB_UNROLLED {
      const auto lower = xi[i] < P(Real(0)), upper = xi[i] >= P(Real(1));
      there[i] =
          xi[i] + math::select(lower, P(Real(1)), P(Real(0))) - math::select(upper, P(Real(1)), P(Real(0)));
      const P lowest(math::epsilon<Real>);
      there[i] = math::select(there[i] >= lowest, there[i], lowest);
      below[i] = bits_of(lower) & with_particle;
      above[i] = bits_of(upper) & with_particle;
      inside &= bits_of((xi[i] >= P(Real(-1))) & (there[i] < P(Real(1))));
    });
    if (inside != with_particle) return false;
    xi = there;
    return true;
  }
  /// Any case, lane by lane: finds the new cells of the particles that left theirs. Returns their lanes.
  [[gnu::noinline]] KOKKOS_FUNCTION LaneMask
  find_migrating_lanes(const LaneGroup<Dim>& group, Vector<Dim, P>& xi, LaneMask with_particle,
                       typename MigratingParticles<Dim, Real, Device>::Head& head) const {
    LaneMask migrating_lanes = 0;
    head.far = head.to[0] = head.to[1] = head.to[2] = 0;
    for (int l = 0; l < P::width; ++l) {
      if (!(with_particle >> l & 1)) continue;
      const auto before = lanes.cell(group, l);
      auto cell = before;
      Vector<Dim, Real> here;
      for (int i = 0; i < Dim; ++i) here[i] = xi[i][l];
      const bool leaves = to_next_cell(grid, cell, here, lanes.node_centred ? Real(0.5) : Real(0));
      for (int i = 0; i < Dim; ++i) xi[i].set(l, here[i]);
      if (!leaves) continue;
      const LaneMask lane = LaneMask(1) << l;
      const int layers = Dim == 1 ? 0 : cell[Dim - 1] - before[Dim - 1];
      (layers < -1 || layers > 1 ? head.far : head.to[layers + 1]) |= lane;
      head.cell[l] = cell;
      migrating_lanes |= lane;
    }
    return migrating_lanes;
  }
};

/// The number of particles that may leave the cells of a layer before its sums are computed anew.
template <int Dim, class Real, class Device>
KOKKOS_FUNCTION int few_migrating(const CellLanes<Dim, Real, Device>& lanes, int layer) {
  int slots = 0;
  for (int g = lanes.layer_first(layer); g < lanes.layer_first(layer + 1); ++g)
    slots += lanes.groups(g).slots;
  return slots * lanes.width / 16;
}

/// Sweep C of a layer, by move(group), and, if asked for, A of the next step, by sum(group, number). A
/// particle that leaves its cell is added to the sums on its own when it arrives. For many particles a sweep
/// A after their arrival costs less, so that a layer with many of them ends its sweep A here.
template <int Dim, class Real, class Device, class Move, class Sum>
KOKKOS_FORCEINLINE_FUNCTION void move_layer(const CellLanes<Dim, Real, Device>& lanes,
                                            const MigratingParticles<Dim, Real, Device>& migrating, int layer,
                                            bool and_sum, const Move& move, const Sum& sum) {
  auto& lost = migrating.lost(layer);
  migrating.count(layer) = lost = 0;
  const int few = and_sum ? few_migrating(lanes, layer) : -1;
  for_each_group(lanes, layer, [&](const auto& group, int g) {
    const bool and_sum_group = lost <= few;
    move(group);
    if (and_sum_group) sum(group, g);
  });
  migrating.many(layer) = lost > few;
}

/// Sweep C, and A of the next step.
template <bool EqualSpacing, class Field, class Material, class Volume, int Dim, class Real, class Device>
struct MoveLanes {
  LoadedLanes<Dim, Real, Device> on;
  MoveGroup<EqualSpacing, Material, Volume, Dim, Real, Device> move;
  Field virtual_stress;
  bool and_sum;  ///< whether A follows at once

  KOKKOS_FUNCTION void operator()(int layer) const {
    StepSums<Dim, Real, Device> sums(move.nodes);
    move_layer(
        on.lanes, move.migrating, layer, and_sum,
        [&](const auto& group) { accelerate_and_move(group, layer); },
        [&](const auto& group, int) {
          sums.begin(group);
          sum_group_with<EqualSpacing>(on, group, virtual_stress, sums);
        });
    sums.end();
  }
  KOKKOS_FORCEINLINE_FUNCTION void accelerate_and_move(const LaneGroup<Dim>& group, int layer) const {
    if (on.lanes.remaps_by_mass_matrix()) accelerate_apart(group);
    move(group, layer);
  }
  [[gnu::noinline, gnu::flatten]] KOKKOS_FUNCTION void accelerate_apart(const LaneGroup<Dim>& group) const {
    accelerate(on.lanes, move.nodes, group, move.pic);
  }
};

}  // namespace kernel

}  // namespace vsb
