// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Ghost nodes of node-centred cell lanes as mirror images of nodes inside (see physics/walls.hpp and
/// kernels/particles/mirror_nodes.hpp). The sums of a ghost g are added to those of its image, with the sign
/// s of a component; the ghost moves as its image does. Edges and corners are reflected in all their walls at
/// once.
///
/// update_nodes adds gravity to the force of an image by its mass, m g. The part of the mass that came from a
/// ghost has the reflected gravity s g. So an image gets
///   m <- m + m_g,   p <- p + s p_g,   f <- f + s (f_g + m_g g) - m_g g.
#pragma once

#include <algorithm>
#include <vector>
#include <vsb/kernels/lanes/mark_nodes.hpp>
#include <vsb/physics/walls.hpp>

namespace vsb {

/// Ghost nodes by their images; nodes are those of cell lanes.
template <class Device>
struct LaneGhosts {
  Kokkos::View<int*, Device> image;             ///< [image]: number of its node
  Kokkos::View<int*, Device> first;             ///< [images + 1]: its ghosts
  Kokkos::View<int*, Device> ghost;             ///< [ghost]: number of its node
  Kokkos::View<ComponentMask*, Device> turned;  ///< [ghost]: bit i: component i changes its sign
};

/// Lists the ghosts of lanes that were packed anew. `last` is the last node of the scene's grid.
template <int Dim, class Real, class Device>
LaneGhosts<Device> list_ghosts(const CellLanes<Dim, Real, Device>& lanes, const Vector<Dim, int>& last,
                               const Walls<Dim>& walls) {
  bool any = false;
  for (int i = 0; i < Dim; ++i) any = any || walls.mirrored(i, 0) || walls.mirrored(i, 1);
  if (!any) return {};
  constexpr int width = Lanes<Real>::width;
  const auto node_groups = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), lanes.node_group_at);
  const int per_row = lanes.groups_per_row() + 1;
  const auto lowest = lanes.lowest_node();
  Vector<3, int> rows{{1, 1, 1}};
  for (int i = 1; i < Dim; ++i) rows[i] = lanes.box.cells[i] + 1;
  const auto node_of = [&](const Vector<3, int>& ijk) {
    const int x = ijk[0] - lowest[0];
    int row = 0;
    for (int i = Dim - 1; i > 0; --i) {
      const int at = ijk[i] - lowest[i];
      if (at < 0 || at >= rows[i]) return -1;
      row = row * rows[i] + at;
    }
    if (x < 0 || x >= per_row * width) return -1;
    const int node_group = node_groups(static_cast<size_t>(row * per_row + x / width));
    return node_group < 0 ? -1 : node_group * width + x % width;
  };
  struct Pair {
    int image, ghost;
    ComponentMask turned;
  };
  std::vector<Pair> pairs;
  for (int box_index = 0; box_index < static_cast<int>(node_groups.extent(0)); ++box_index) {
    if (node_groups(static_cast<size_t>(box_index)) < 0) continue;
    for (int l = 0; l < width; ++l) {
      Vector<3, int> ijk{{lowest[0] + box_index % per_row * width + l, 0, 0}};
      for (int i = 1, row = box_index / per_row; i < Dim; ++i) {
        ijk[i] = lowest[i] + row % rows[i];
        row /= rows[i];
      }
      auto image = ijk;
      ComponentMask turned = 0;
      for (int i = 0; i < Dim; ++i)
        for (const int side : {0, 1}) {
          const int wall = side == 0 ? 0 : last[i];
          if (!walls.mirrored(i, side) || ijk[i] != wall + (side == 0 ? -1 : 1)) continue;
          image[i] = wall + (side == 0 ? 1 : -1);
          turned = static_cast<ComponentMask>(turned ^ walls.fixed[i][side]);
        }
      bool ghost = false;
      for (int i = 0; i < Dim; ++i) ghost = ghost || image[i] != ijk[i];
      const int to = ghost ? node_of(image) : -1;
      // A ghost without an image is not a node of any particle.
      if (to >= 0) pairs.push_back({to, node_of(ijk), turned});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.image < b.image; });
  size_t images = 0;
  for (size_t n = 0; n < pairs.size(); ++n) images += n == 0 || pairs[n].image != pairs[n - 1].image;
  LaneGhosts<Device> g;
  g.image = decltype(g.image)("vsb::ghost_images", images);
  g.first = decltype(g.first)("vsb::first_ghosts", images + 1);
  g.ghost = decltype(g.ghost)("vsb::lane_ghosts", pairs.size());
  g.turned = decltype(g.turned)("vsb::ghosts_turned", pairs.size());
  const auto image = Kokkos::create_mirror_view(g.image), first = Kokkos::create_mirror_view(g.first),
             ghost = Kokkos::create_mirror_view(g.ghost);
  const auto turned = Kokkos::create_mirror_view(g.turned);
  size_t k = 0;
  for (size_t n = 0; n < pairs.size(); ++n) {
    if (n == 0 || pairs[n].image != pairs[n - 1].image) {
      image(k) = pairs[n].image;
      first(k++) = static_cast<int>(n);
    }
    ghost(n) = pairs[n].ghost;
    turned(n) = pairs[n].turned;
  }
  first(k) = static_cast<int>(pairs.size());
  Kokkos::deep_copy(g.image, image);
  Kokkos::deep_copy(g.first, first);
  Kokkos::deep_copy(g.ghost, ghost);
  Kokkos::deep_copy(g.turned, turned);
  return g;
}

namespace kernel {

/// One image: adds the sums of its ghosts.
template <int Dim, class Real, class Device>
struct FoldLaneGhosts {
  LaneNodes<Dim, Real, Device> nodes;
  LaneGhosts<Device> ghosts;
  Vector<Dim, Real> gravity;  ///< m/s^2
  bool momentum_alone;

  KOKKOS_FUNCTION Real sum(int column, int node) const {
    Real all = 0;
    for (int plane = 0; plane < (Dim > 1 ? 3 : 1); ++plane)
      all += *nodes.at(nodes.sums_of_plane(plane) + column, node);
    return all;
  }
  KOKKOS_FUNCTION void operator()(int k) const {
    const int image = ghosts.image(k);
    const auto to = [&](int column) -> Real& { return *nodes.at(nodes.lower_sums + column, image); };
    for (int n = ghosts.first(k); n < ghosts.first(k + 1); ++n) {
      const int ghost = ghosts.ghost(n);
      const Real m = sum(0, ghost);
      if (!momentum_alone) to(0) += m;
      for (int i = 0; i < Dim; ++i) {
        const Real s = ghosts.turned(n) >> i & 1 ? Real(-1) : Real(1);
        to(1 + i) += s * sum(1 + i, ghost);
        if (momentum_alone) continue;
        const Real weight = m * gravity[i];
        to(1 + Dim + i) += s * (sum(1 + Dim + i, ghost) + weight) - weight;
      }
    }
  }
};

/// One image: its ghosts get its vectors, columns first, ..., first + Dim - 1 and so on.
template <int Dim, class Real, class Device>
struct MirrorLaneGhosts {
  LaneNodes<Dim, Real, Device> nodes;
  LaneGhosts<Device> ghosts;
  int first, vectors;

  KOKKOS_FUNCTION void operator()(int k) const {
    for (int n = ghosts.first(k); n < ghosts.first(k + 1); ++n)
      for (int c = 0; c < vectors * Dim; ++c) {
        const Real s = ghosts.turned(n) >> (c % Dim) & 1 ? Real(-1) : Real(1);
        *nodes.at(first + c, ghosts.ghost(n)) = s * *nodes.at(first + c, ghosts.image(k));
      }
  }
};

/// One image: its ghosts get its tractions.
template <class Device>
struct MirrorLaneTractions {
  LaneGhosts<Device> ghosts;
  BoundaryNodes<Device> tractions;

  KOKKOS_FUNCTION void operator()(int k) const {
    for (int n = ghosts.first(k); n < ghosts.first(k + 1); ++n)
      tractions(ghosts.ghost(n)) = tractions(ghosts.image(k));
  }
};

/// Launches over the images, where there are any.
template <class Exec, class Device, class Functor>
void for_each_image(const char* label, const Exec& exec, const LaneGhosts<Device>& ghosts,
                    const Functor& functor) {
  const auto images = static_cast<int>(ghosts.image.extent(0));
  if (images > 0) Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec>(exec, 0, images), functor);
}

}  // namespace kernel

}  // namespace vsb
