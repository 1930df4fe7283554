// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The step on cell lanes beside the step of the particle kernels, from the same particles, loads and
/// supports.
#pragma once

#include <algorithm>
#include <common_steps.hpp>
#include <map>
#include <vsb/kernels/lane_step.hpp>
#include <vsb/kernels/lanes/loads.hpp>

#include "support.hpp"

namespace vsb::test {

/// Where cell lanes keep every node: its number in the grid, and in the lanes. Fails where a grid node has
/// two.
template <int Dim, class Real>
std::map<int, int> lane_nodes_of_grid(const CellLanes<Dim, Real, Device>& lanes,
                                      const CellNumbering<Dim>& grid) {
  const auto groups = read(lanes.groups);
  std::map<int, int> lane_nodes;
  int twice = 0;
  for (int g = 0; g < lanes.group_count; ++g)
    for (int l = 0; l < lanes.width; ++l) {
      const auto& group = groups(g);
      const auto cell = lanes.cell(group, l);
      for (int a = 0; a < 1 << Dim; ++a) {
        auto ijk = cell;
        bool inside = true;
        for (int i = 0; i < Dim; ++i) {
          ijk[i] += a >> i & 1;
          inside = inside && ijk[i] >= 0 && ijk[i] <= grid.cells[i];
        }
        if (!inside) continue;
        const int lane_node = group.node[a >> 1] + l + (a & 1);
        twice += lane_nodes.emplace(grid.node_index(ijk), lane_node).first->second != lane_node;
      }
    }
  CHECK(twice == 0);
  return lane_nodes;
}

/// The same of node-centred cell lanes; `grid` is the one with its ghost layer.
template <int Dim, class Real>
std::map<int, int> lane_nodes_of_grid(const SplineLaneState<Dim, Real, Device>& s,
                                      const CellNumbering<Dim>& grid) {
  const auto& lanes = s.memory.lanes;
  const auto groups = read(lanes.groups);
  const auto stencils = read(lanes.stencils);
  std::map<int, int> lane_nodes;
  int twice = 0;
  for (int g = 0; g < lanes.group_count; ++g)
    for (int l = 0; l < lanes.width; ++l)
      for (int a = 0; a < (Dim == 1 ? 3 : Dim == 2 ? 9 : 27); ++a) {
        auto ijk = lanes.cell(groups(g), l);  // the middle node, by its number in the scene's grid
        bool inside = true;
        for (int i = 0, digits = a; i < Dim; ++i, digits /= 3) {
          ijk[i] += digits % 3;  // less one, and one more for the ghost layer
          inside = inside && ijk[i] >= 0 && ijk[i] <= grid.cells[i];
        }
        if (!inside) continue;
        const int lane_node = stencils(g).node[a / 3] + l + a % 3;
        twice += lane_nodes.emplace(grid.node_index(ijk), lane_node).first->second != lane_node;
      }
  CHECK(twice == 0);
  return lane_nodes;
}

/// The tractions that act at the nodes of a grid according to cell lanes.
template <int Dim, class Real>
std::vector<TractionMask> tractions_of_nodes(const LaneState<Dim, Real, Device>& s) {
  const auto tractions = read(s.boundary.tractions);
  std::vector<TractionMask> masks(static_cast<size_t>(s.memory.grid.node_count()), 0);
  for (const auto& [node, lane_node] : lane_nodes_of_grid<Dim, Real>(s.memory.lanes, s.memory.grid))
    masks[static_cast<size_t>(node)] = tractions(lane_node);
  return masks;
}

/// The same of node-centred cell lanes, for the grid with its ghost layer. Nodes that no particle reaches are
/// not kept by the lanes, and may be active all the same; what they have is taken from `otherwise`.
template <int Dim, class Real>
std::vector<TractionMask> tractions_of_nodes(const SplineLaneState<Dim, Real, Device>& s,
                                             std::vector<TractionMask> otherwise) {
  const auto tractions = read(s.boundary.tractions);
  for (const auto& [node, lane_node] : lane_nodes_of_grid<Dim, Real>(s, with_ghost_layer(s.grid)))
    otherwise[static_cast<size_t>(node)] = tractions(lane_node);
  return otherwise;
}

/// Largest differences between particles, each relative to the largest number of its kind: positions to the
/// cell size.
struct Difference {
  double position = 0, velocity = 0, stress = 0, volume = 0, state = 0;
  bool same_mass = true;
  double largest() const { return std::max({position, velocity, stress, volume, state}); }
};

template <class A, class B, int Dim, class Real>
Difference difference(const A& a, const B& b, const UniformGrid<Dim, Real>& grid) {
  Difference d;
  const auto compare = [&](const auto& of_a, const auto& of_b, int columns) {
    double most = 0, scale = 0;
    for (int p = 0; p < static_cast<int>(of_a.extent(0)); ++p)
      for (int c = 0; c < columns; ++c) {
        const double x = of_a(p, c), y = of_b(p, c);
        // NaN must not hide: it is a difference as large as there is.
        most = std::abs(x - y) <= most ? most : std::isfinite(x - y) ? std::abs(x - y) : 1e300;
        scale = std::max(scale, std::abs(x));
      }
    return most / (scale > 0 ? scale : 1);
  };
  for (int p = 0; p < a.count(); ++p) {
    for (int i = 0; i < Dim; ++i) {
      const double x = std::abs(static_cast<double>(a.position(p, i) - b.position(p, i)) / grid.spacing[i]);
      d.position = x <= d.position ? d.position : std::isfinite(x) ? x : 1e300;
    }
    const double V = std::abs(static_cast<double>(b.volume(p)) / static_cast<double>(a.volume(p)) - 1);
    d.volume = V <= d.volume ? d.volume : std::isfinite(V) ? V : 1e300;
    d.same_mass = d.same_mass && a.mass(p) == b.mass(p);
  }
  d.velocity = compare(a.velocity, b.velocity, Dim);
  d.stress = compare(a.cauchy_stress, b.cauchy_stress, a.stress_size);
  d.state = compare(a.material_state, b.material_state, static_cast<int>(a.material_state.extent(1)));
  return d;
}

/// 1e-12 in double, 1e-5 in float.
template <class Real>
constexpr double engine_tolerance = sizeof(Real) == 8 ? 1e-12 : 1e-5;
/// What the bodies below are like.
struct BodyShape {
  bool equal_spacing = false;
  double drift = 0;            ///< m/s, of the whole body in all directions
  bool on_lower_face = false;  ///< of x
  bool slivers = false;        ///< particles 2^-4 to 2^-40 cells beside a face
};

/// A block with a cavity and rough faces, particles anywhere in cells of 2^Dim, density about 1 kg/m^Dim,
/// for a material of about 100 Pa: in 100 steps of 2 ms a wave runs through four cells or more.
///
/// In float all loads, stresses and velocities are to be `amplitude` times as large, so that particles move
/// little: the particle kernels round positions in the grid, and cell lanes positions in a cell. A particle
/// that passes a face a step sooner or later for that has another velocity gradient in this step. Which of
/// two float engines is nearer to double is tested in rigid_translation.cpp.
template <int Dim, class Real, template <int, class> class BasisOf = LinearBasis>
struct BothEngines {
  static constexpr Real amplitude = sizeof(Real) == 4 ? Real(1e-5) : Real(1);
  static constexpr bool splines = BasisOf<Dim, Real>::ghost_layers > 0;
  UniformGrid<Dim, Real> grid;                   ///< without a ghost layer
  BasisOf<Dim, Real> basis;                      ///< complete once the engines run
  ParticleBlock<Dim, Real, Device> block, copy;  ///< for the particle kernels, for cell lanes
  State<Dim, Real, Device> state;
  std::conditional_t<splines, SplineLaneState<Dim, Real, Device>, LaneState<Dim, Real, Device>> lanes;
  StepOptions<Dim, Real> options;
  long long moved = 0;              ///< from cell to cell, or packed anew
  bool load_seen[4] = {};           ///< by GroupLoad
  std::vector<TractionMask> masks;  ///< declared at the grid's nodes
  TractionMask at_all_active_nodes = 0;
  SurfacePoints<Dim, Real, Device> surface;  ///< none, unless a test has some
  CarriedTractions<Device> carried;          ///< by particles; none, unless a test has some

  explicit BothEngines(const BodyShape& shape, unsigned seed = 81) {
    grid = make_grid<Dim, Real>({{42, 22, 22}});
    if (shape.equal_spacing) {
      Vector<Dim, Real> h;
      for (int i = 0; i < Dim; ++i) h[i] = Real(0.5);
      grid = UniformGrid<Dim, Real>(grid.lower, h, grid.cells);
    }
    basis.grid = grid;
    if constexpr (splines) {
      basis.grid = with_ghost_layer(grid);
      lanes.grid = grid;
    }
    Random random(seed);
    std::vector<Vector<Dim, Real>> positions;
    for_each_cell(grid, [&](const Vector<Dim, int>& cell) {
      double r2 = 0;
      for (int i = 0; i < Dim; ++i) {
        const int lowest = i == 0 && shape.on_lower_face ? 0 : 3;
        if (cell[i] < lowest || cell[i] >= (i == 0 ? 24 : 9)) return;
        r2 += (cell[i] - 6.2) * (cell[i] - 6.2);
      }
      if (r2 < 1.5) return;
      for (int part = 0; part < 1 << Dim; ++part) {
        if (random.index(16) == 0) continue;
        Vector<Dim, Real> x;
        for (int i = 0; i < Dim; ++i) {
          auto xi = random.draw<Real>(0.02, 0.48) + static_cast<Real>(0.5 * (part >> i & 1));
          if (shape.slivers && random.index(2) == 0) {
            const int bits = 4 + random.index(sizeof(Real) == 4 ? 13 : 37);
            xi = part >> i & 1 ? Real(1) - std::ldexp(Real(1), -bits) : std::ldexp(Real(1), -bits);
          }
          x[i] = grid.lower[i] + grid.spacing[i] * (static_cast<Real>(cell[i]) + xi);
        }
        positions.push_back(x);
      }
    });
    random.shuffle(positions);
    const int n = static_cast<int>(positions.size());
    block = allocate_particles<Dim, Real, Device>(n);
    edit(block, [&](const auto& p) {
      for (int k = 0; k < n; ++k) {
        for (int i = 0; i < Dim; ++i) {
          p.position(k, i) = positions[static_cast<size_t>(k)][i];
          p.velocity(k, i) = amplitude * static_cast<Real>(shape.drift + random(-0.1, 0.1));
        }
        p.volume(k) = grid.cell_volume() / Real(1 << Dim) * random.draw<Real>(0.9, 1.1);
        p.mass(k) = p.volume(k) * random.draw<Real>(0.9, 1.1);
        for (int c = 0; c < p.stress_size; ++c) p.cauchy_stress(k, c) = amplitude * random.draw<Real>(-1, 1);
      }
    });
    copy = allocate_particles<Dim, Real, Device>(n);
    if constexpr (!splines) lanes.memory.grid = grid;
    options.dt = static_cast<Real>(0.002);
    masks.assign(static_cast<size_t>(basis.node_count()), 0);
  }

  /// All three must be called, if at all, before `run`.
  void remember(int columns) {
    const int n = block.particles.count();
    allocate_material_state(block, n, columns);
    allocate_material_state(copy, n, columns);
    lanes.memory.lanes.state_size = columns;
  }
  void declare_everywhere(TractionMask mask) {
    lanes.boundary.everywhere = mask;
    for (auto& m : masks) m |= mask;
  }
  /// where(ijk) gives the tractions of a node of the grid, or of one of the ghost layer.
  template <class Where>
  void declare(const Where& where) {
    const BoundaryNodes<Device> declared("vsb::declared", masks.size());
    lanes.boundary.declared = declared;
    edit(declared, [&](const auto& host) {
      for (size_t I = 0; I < masks.size(); ++I) {
        host(I) = where(ijk_of(static_cast<int>(I)));
        masks[I] |= host(I);
      }
    });
  }

  /// field_at(n) is the field at the end of step n. False where a particle is lost.
  template <class Material, class Volume, class FieldAt>
  void run(const Material& material, const Volume& volume, const FieldAt& field_at, int steps = 100) {
    run_with_loads(
        material, volume, field_at, field_at, [](int) { return -1; }, steps);
  }

  /// The same where the sweeps over cell lanes have another field than the particle kernels, and add(n) adds
  /// what else loads the lanes in step n; it returns -1.
  template <class Material, class Volume, class FieldAt, class LaneFieldAt, class Add>
  void run_with_loads(const Material& material, const Volume& volume, const FieldAt& field_at,
                      const LaneFieldAt& lane_field_at, const Add& add, int steps = 100) {
    if constexpr (splines) basis.walls = lanes.memory.walls;
    Kokkos::deep_copy(copy.block, block.block);
    if (block.state_block.size() > 0) Kokkos::deep_copy(copy.state_block, block.state_block);
    state = make_state(block.particles, basis);
    state.surface = surface;
    if constexpr (!splines) lanes.surface = pack_surface_points(Exec(), surface, grid);
    edit(state.occupancy.tractions,
         [&](const auto& host) { std::copy(masks.begin(), masks.end(), host.data()); });
    state.occupancy.at_all_active_nodes = lanes.boundary.at_all_active_nodes = at_all_active_nodes;
    if (carried.any()) set_carried_tractions(state.occupancy, basis, carried.particle, carried.tractions);
    lanes.boundary.bits.carried = carried;
    edit(state.nodes.fixed_components, [&](const auto& host) {
      for (int I = 0; I < basis.node_count(); ++I) {
        const auto ijk = ijk_of(I);
        for (int i = 0; i < Dim; ++i)
          for (const int side : {0, 1})
            if (ijk[i] == side * grid.cells[i])
              host(I) = static_cast<ComponentMask>(host(I) | lanes.memory.walls.fixed[i][side]);
      }
    });
    options.volume_update = volume;
    const std::vector<Body<Real>> bodies{{0, block.particles.count(), material}};
    REQUIRE(pack_lanes(Exec(), copy.particles, lanes) == -1);
    prepare_lane_step(Exec(), lanes, lane_field_at(0));
    REQUIRE(add(0) == -1);
    note_loads();
    for (int n = 0; n < steps; ++n) {
      REQUIRE(lane_step(Exec(), lanes, material, volume, lane_field_at(n + 1), options) == -1);
      REQUIRE(add(n + 1) == -1);
      moved += count_migrating(Exec(), lanes.memory);  // none after packing anew
      REQUIRE(step(Exec(), state, bodies, basis, field_at(n), options) == -1);
      if (n % 5 == 0) note_loads();
    }
    moved += lanes.repacked;
    unpack_particles(Exec(), lanes.memory, copy.particles);
  }
  Difference compare() const { return difference(read(block), read(copy), grid); }

  /// Whether both have the same tractions at the same nodes, some of them at all.
  void check_boundary() {
    REQUIRE(update_occupancy(Exec(), block.particles, state.occupancy, basis) == -1);
    const auto boundary = read(state.occupancy.boundary);
    std::vector<TractionMask> theirs(boundary.data(), boundary.data() + boundary.extent(0)), mine;
    if constexpr (splines)
      mine = tractions_of_nodes(lanes, theirs);
    else
      mine = tractions_of_nodes(lanes);
    CHECK((mine == theirs));
    CHECK(state.occupancy.boundary_node_count > 0);
    int mine_loaded = 0;
    if constexpr (splines)
      mine_loaded = count_loaded_nodes(Exec(), lanes);
    else
      mine_loaded = count_loaded_nodes(Exec(), lanes.memory.lanes, lanes.boundary);
    CHECK(mine_loaded == state.occupancy.boundary_node_count);
  }

 private:
  /// A node's numbers along the axes in the grid without a ghost layer.
  Vector<Dim, int> ijk_of(int node) const {
    auto ijk = basis.grid.node_ijk(node);
    for (int i = 0; i < Dim; ++i) ijk[i] -= basis.ghost_layers;
    return ijk;
  }
  void note_loads() {
    const auto groups = read(lanes.memory.lanes.groups);
    for (int g = 0; g < lanes.memory.lanes.group_count; ++g)
      load_seen[static_cast<int>(groups(g).load)] = true;
  }
};

template <int Dim, class Real>
LinearElastic<Real> elastic() {
  return LinearElastic<Real>::from_young(100, 0.3);
}

template <int Dim, class Real, template <int, class> class BasisOf>
void check_same(const BothEngines<Dim, Real, BasisOf>& engines, double tolerance = engine_tolerance<Real>) {
  const auto d = engines.compare();
  CHECK(d.same_mass);
  CHECK(d.position < tolerance);
  CHECK(d.velocity < tolerance);
  CHECK(d.stress < tolerance);
  CHECK(d.volume < tolerance);
  CHECK(d.state < tolerance);
}

}  // namespace vsb::test
