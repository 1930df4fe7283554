// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The state of cell lanes bit by bit. It is described once (describe), and the description is walked by
/// SaveLanes, which writes, and by RestoreLanes, which reads.
///   numbers, and the shapes of the groups: from these follow the sizes of the arrays;
///   the number of the particle in each entry; the particles' columns, of the slots in use;
///   the sums of the nodes; mass matrices; surface points.
#pragma once

#include <utility>
#include <vector>

#include <vsb/kernels/lane_step.hpp>
#include "engine/byte_stream.hpp"
#include "setup/execution_space.hpp"

namespace vsb::app {

namespace detail {

/// Parts of a column: first row, rows.
struct Runs {
  std::vector<std::pair<size_t, size_t>> of;
  size_t length() const {
    size_t sum = 0;
    for (const auto& run : of) sum += run.second;
    return sum;
  }
};

/// Entries that may hold particles: a group uses the first of the slots that it has room for.
inline Runs entries_in_use(const std::vector<GroupShape>& groups, size_t width) {
  Runs used;
  size_t first = 0;
  for (const auto& group : groups) {
    if (group.slots > 0) used.of.emplace_back(first * width, static_cast<size_t>(group.slots) * width);
    first += static_cast<size_t>(group.capacity);
  }
  return used;
}

/// The columns of the nodes' sums.
template <int Dim, class Real, class Device>
std::vector<int> columns_of_sums(const LaneMemory<Dim, Real, Device>& m) {
  std::vector<int> columns;
  for (int plane = 0; plane < (m.lanes.node_centred ? 3 : 2); ++plane)
    for (int c = 0; c < m.nodes.sum_columns; ++c)
      columns.push_back((plane == 0   ? m.nodes.lower_sums
                         : plane == 1 ? m.nodes.upper_sums
                                      : m.nodes.middle_sums) +
                        c);
  return columns;
}

/// The numbers of lanes, from which with the shapes of the groups the sizes of their arrays follow.
template <int Dim>
struct LaneNumbers {
  int width = 0;
  CellBox<Dim> box;
  int groups = 0, slots = 0, nodes = 0, slack = 0;
  GroupMargin<Dim> group_margin;
  int steps_since_repacked = 0, steps_with_migration = 0;
  bool prepared = false, remaps_by_mass_matrix = false;
};

template <class View>
auto on_host(const View& view) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
}

/// Writes what is described.
class SaveLanes {
 public:
  explicit SaveLanes(ByteSink& to) : to_(to) {}

  template <class T>
  bool number(T& x) {
    to_.number(x);
    return true;
  }
  template <class T>
  bool list(const std::vector<T>& values, int) {
    to_.array(values.data(), values.size());
    return true;
  }
  template <class View>
  bool whole(const View& view) {
    to_.array(on_host(view).data(), view.span());
    return true;
  }
  template <class View>
  bool runs(const View& column, const Runs& runs) {
    const auto host = on_host(column);
    to_.number(runs.length());
    for (const auto& [first, count] : runs.of) to_.values(&host(first), count);
    return true;
  }

 private:
  ByteWriter to_;
};

/// Reads it. False where there is something else than described.
class RestoreLanes {
 public:
  explicit RestoreLanes(ByteSource& from) : size_(from.size()), from_(from) {}

  template <class T>
  bool number(T& x) {
    return from_.number(x);
  }
  /// `count` values, which cannot be more than there are bytes.
  template <class T>
  bool list(std::vector<T>& values, int count) {
    if (count < 0 || static_cast<size_t>(count) > size_) return false;
    values.resize(static_cast<size_t>(count));
    return from_.array(values.data(), values.size());
  }
  template <class View>
  bool whole(const View& view) {
    const auto host = Kokkos::create_mirror_view(view);
    if (!from_.array(host.data(), host.span())) return false;
    Kokkos::deep_copy(view, host);
    return true;
  }
  template <class View>
  bool runs(const View& column, const Runs& runs) {
    const auto host = Kokkos::create_mirror_view(column);
    if (!from_.length(runs.length())) return false;
    for (const auto& [first, count] : runs.of)
      if (!from_.values(&host(first), count)) return false;
    Kokkos::deep_copy(column, host);
    return true;
  }
  bool at_end() const { return from_.at_end(); }

 private:
  size_t size_;
  ByteReader from_;
};

/// Numbers, then groups, whose count is among the numbers.
template <class Archive, int Dim>
bool describe(Archive& a, LaneNumbers<Dim>& n, std::vector<GroupShape>& groups) {
  return a.number(n.width) && a.number(n.box) && a.number(n.groups) && a.number(n.slots) &&
         a.number(n.nodes) && a.number(n.slack) && a.number(n.group_margin) &&
         a.number(n.steps_since_repacked) && a.number(n.steps_with_migration) && a.number(n.prepared) &&
         a.number(n.remaps_by_mass_matrix) && a.list(groups, n.groups);
}

/// The arrays of lanes with these groups.
template <class Archive, class State>
bool describe(Archive& a, State& state, const std::vector<GroupShape>& groups) {
  auto& m = state.memory;
  auto& l = m.lanes;
  const Runs entries{{{0, static_cast<size_t>(l.slot_count) * l.width}}};
  const Runs nodes{{{0, static_cast<size_t>(l.node_count)}}};
  const Runs in_use = entries_in_use(groups, l.width);
  const auto column = [](const auto& data, int c) {
    return Kokkos::subview(data, Kokkos::ALL(), static_cast<size_t>(c));
  };
  bool good = a.runs(l.id, entries);
  for (int c = 0; good && c < l.columns(); ++c) good = a.runs(column(l.data, c), in_use);
  for (const int c : columns_of_sums(m)) good = good && a.runs(column(m.nodes.data, c), nodes);
  good = good && a.whole(l.mass_matrices);
  auto& p = state.surface;
  return good && (p.count() == 0 || (a.whole(p.cell) && a.whole(p.xi) && a.whole(p.area)));
}

/// Marks the entries that hold a particle. False where a particle is missing, or there twice.
template <int Dim, class Real, class Device>
bool mark_held(const CellLanes<Dim, Real, Device>& l) {
  const auto id = on_host(l.id);
  const auto with_particle = Kokkos::create_mirror_view(l.with_particle);
  std::vector<bool> seen(static_cast<size_t>(l.particle_count));
  int count = 0;
  for (size_t slot = 0; slot < static_cast<size_t>(l.slot_count); ++slot) {
    with_particle(slot) = 0;
    for (int lane = 0; lane < l.width; ++lane) {
      const int p = id(slot * l.width + static_cast<size_t>(lane));
      if (p < 0) continue;
      if (p >= l.particle_count || seen[static_cast<size_t>(p)]) return false;
      seen[static_cast<size_t>(p)] = true;
      with_particle(slot) |= LaneMask(1) << lane;
      ++count;
    }
  }
  Kokkos::deep_copy(l.with_particle, with_particle);
  return count == l.particle_count;
}

}  // namespace detail

template <int Dim, class State>
void save_lanes(const State& state, ByteSink& to) {
  const auto& m = state.memory;
  const auto& l = m.lanes;
  detail::LaneNumbers<Dim> n{l.width,
                             l.box,
                             l.group_count,
                             l.slot_count,
                             l.node_count,
                             m.slack,
                             m.group_margin,
                             state.steps_since_repacked,
                             state.steps_with_migration,
                             state.prepared,
                             l.remaps_by_mass_matrix()};
  const auto host = detail::on_host(l.groups);
  std::vector<GroupShape> groups;
  for (size_t g = 0; g < static_cast<size_t>(l.group_count); ++g)
    groups.push_back({host(g).x, host(g).row, host(g).slots, host(g).capacity});
  detail::SaveLanes archive(to);
  detail::describe(archive, n, groups);
  detail::describe(archive, state, groups);
}

/// False where the bytes are not of lanes like these, which are then good for nothing.
template <int Dim, class State>
bool restore_lanes(const ExecutionSpace& exec, State& state, ByteSource& saved) {
  auto& m = state.memory;
  auto& l = m.lanes;
  detail::RestoreLanes archive(saved);
  detail::LaneNumbers<Dim> n;
  std::vector<GroupShape> groups;
  if (!detail::describe(archive, n, groups) || n.width != l.width || n.slots < 0 || n.nodes < 0 ||
      !lay_out_lanes(exec, m, n.box, groups) || l.slot_count != n.slots || l.node_count != n.nodes)
    return false;
  set_remap_method(l, n.remaps_by_mass_matrix);
  m.slack = n.slack;
  m.group_margin = n.group_margin;
  state.steps_since_repacked = n.steps_since_repacked;
  state.steps_with_migration = n.steps_with_migration;
  if (!detail::describe(archive, state, groups) || !archive.at_end() || !detail::mark_held(l)) return false;
  state.surface.sorted = false;
  mark_packed_lanes(exec, state);
  state.prepared = n.prepared;
  return true;
}

}  // namespace vsb::app
