// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Quadratic B-splines and uGIMP in the kernels: conservation, walls, patches, and Algorithm 1 with their
/// wider support.
#include "wide_bases.hpp"

#include <set>
#include <vsb/kernels/readout/balance.hpp>
#include "both_engines.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

const int count = 300;

template <int Dim>
Walls<Dim> random_walls(Random& random) {
  Walls<Dim> walls;
  for (int i = 0; i < Dim; ++i)
    for (auto& fixed : walls.fixed[i]) fixed = static_cast<ComponentMask>(random.index(1 << Dim));
  return walls;
}

template <int Dim>
Walls<Dim> rollers_below() {
  Walls<Dim> walls;
  for (int i = 0; i < Dim; ++i) walls.fixed[i][0] = static_cast<ComponentMask>(1 << i);
  return walls;
}

/// A ghost node's image and the signs of the components, one direction after the other; a node that is no
/// ghost of a wall is its own.
template <int Dim>
struct Image {
  int node;
  bool ghost = false;
  double sign[Dim];
};

template <class Basis>
Image<Basis::dimension> image_of(const Basis& basis, int node) {
  constexpr int Dim = Basis::dimension;
  auto ijk = basis.grid.node_ijk(node);
  Image<Dim> image;
  for (double& s : image.sign) s = 1;
  for (int i = 0; i < Dim; ++i)
    for (int side = 0; side < 2; ++side) {
      const int face = side == 0 ? 1 : basis.grid.cells[i] - 1;
      const bool beyond = side == 0 ? ijk[i] < face : ijk[i] > face;
      if (!beyond || basis.walls.fixed[i][side] == 0) continue;
      image.ghost = true;
      ijk[i] = 2 * face - ijk[i];
      for (int c = 0; c < Dim; ++c)
        if (basis.walls.fixed[i][side] >> c & 1) image.sign[c] = -image.sign[c];
      break;  // in a grid of one cell the image is at the other face
    }
  image.node = basis.grid.node_index(ijk);
  return image;
}

template <class Fields>
void fill_randomly(const Fields& fields, Random& random) {
  edit(fields, [&](const auto& host) {
    for (size_t I = 0; I < host.extent(0); ++I)
      for (size_t c = 0; c < host.extent(1); ++c) host(I, c) = random(-1, 1);
  });
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("wide bases: mass, momentum and force pass without loss", "", WideBases) {
  constexpr int Dim = TestType::dimension;
  const auto inner = make_grid<Dim, double>();
  const auto basis = WideBasis<TestType>::on(inner);
  const auto block = random_particles(inner, count, 94);
  auto state = make_state(block.particles, basis);
  REQUIRE(update_occupancy(Exec(), state.particles, state.occupancy, basis) == -1);
  auto gravity = Vector<Dim, double>::zero();
  gravity[Dim - 1] = -3;
  double mass = 0, momentum[Dim] = {};
  const auto particles = read(block);
  for (int p = 0; p < count; ++p) {
    mass += particles.mass(p);
    for (int i = 0; i < Dim; ++i) momentum[i] += particles.mass(p) * particles.velocity(p, i);
  }
  const double round_off = 1e-12 * count;  // terms near 1; V |sigma| |dN| up to some 100 each
  for (const Scatter strategy : {Scatter::gathered, Scatter::atomic}) {
    assemble_forces(Exec(), state.particles, state.occupancy, state.surface, state.nodes,
                    state.sums_workspace, basis, NoVirtualStress{}, gravity, strategy);
    const auto& sums = state.nodes.sums;
    CHECK_THAT(column_sum(sums, 0), WithinAbs(mass, round_off));
    for (int i = 0; i < Dim; ++i) {
      CHECK_THAT(column_sum(sums, 1 + i), WithinAbs(momentum[i], round_off));
      CHECK_THAT(column_sum(sums, 1 + Dim + i), WithinAbs(mass * gravity[i], 100 * round_off));
    }
  }
  const double dt = 0.01;
  update_nodes(Exec(), state.nodes, basis, 0., dt);
  grid_to_particles(Exec(), state.particles, state.nodes, basis, 0., dt);
  remap_velocity(Exec(), state.particles, state.occupancy.bins, state.nodes, state.remap_workspace, basis,
                 Scatter::gathered);
  const auto sums = read(state.nodes.sums), v = read(state.nodes.remapped_velocity);
  for (int i = 0; i < Dim; ++i) {
    double remapped = 0;
    for (int I = 0; I < state.nodes.count(); ++I) remapped += sums(I, 0) * v(I, i);
    CHECK_THAT(remapped, WithinAbs(momentum[i] + dt * mass * gravity[i], 2 * round_off));
  }
}

TEMPLATE_TEST_CASE("ghost nodes mirror their images; folding is the transpose", "",
                   (QuadraticBSplineBasis<1, double>), (QuadraticBSplineBasis<2, double>),
                   (QuadraticBSplineBasis<3, double>)) {
  constexpr int Dim = TestType::dimension;
  Random random(95);
  for (const Vector<3, int> cells : {Vector<3, int>{{1, 1, 1}}, {{2, 1, 2}}, {{5, 4, 3}}, {{1, 7, 2}}})
    for (int trial = 0; trial < 10; ++trial) {
      auto basis = WideBasis<TestType>::on(make_grid<Dim, double>(cells));
      basis.walls = random_walls<Dim>(random);
      const auto n = static_cast<size_t>(basis.node_count());
      using Fields = typename Nodes<Dim, double, Device>::Fields;
      const Fields v("v", n, Dim), sums("sums", n, 1 + 2 * Dim);
      fill_randomly(v, random);
      fill_randomly(sums, random);
      const auto before = read(v);
      const auto scattered = read(sums);
      std::vector<double> given(scattered.data(), scattered.data() + scattered.size());
      std::vector<double> free(before.data(), before.data() + before.size());

      mirror_vectors(Exec(), basis, v);
      const auto mirrored = read(v);
      int wrong = 0;
      for (int I = 0; I < basis.node_count(); ++I) {
        const auto image = image_of(basis, I);
        REQUIRE_FALSE(image_of(basis, image.node).ghost);
        for (int i = 0; i < Dim; ++i)
          wrong += mirrored(I, i) != image.sign[i] * free[static_cast<size_t>(image.node * Dim + i)];
      }
      CHECK(wrong == 0);

      // Power: sum_I f_I v_I over all nodes is that of the folded forces over the nodes without ghosts.
      double power = 0, folded_power = 0, mass = 0;
      for (int I = 0; I < basis.node_count(); ++I)
        for (int i = 0; i < Dim; ++i)
          power += given[static_cast<size_t>(I * (1 + 2 * Dim) + 1 + Dim + i)] * mirrored(I, i);
      for (int I = 0; I < basis.node_count(); ++I) mass += given[static_cast<size_t>(I * (1 + 2 * Dim))];
      fold_ghost_nodes(Exec(), basis, sums, 1);
      const auto folded = read(sums);
      for (int I = 0; I < basis.node_count(); ++I) {
        const bool ghost = image_of(basis, I).ghost;
        for (int c = 0; ghost && c < 1 + 2 * Dim; ++c) wrong += folded(I, c) != 0;
        for (int i = 0; i < Dim; ++i) folded_power += folded(I, 1 + Dim + i) * mirrored(I, i);
      }
      CHECK(wrong == 0);
      CHECK_THAT(folded_power, WithinAbs(power, 1e-12));
      CHECK_THAT(column_sum(sums, 0), WithinAbs(mass, 1e-12));
    }
}

TEMPLATE_LIST_TEST_CASE("at a wall, fixed components vanish and the others have no slope", "", WideBases) {
  constexpr int Dim = TestType::dimension;
  Random random(96);
  for (int trial = 0; trial < 20; ++trial) {
    const auto inner = make_grid<Dim, double>();
    auto basis = WideBasis<TestType>::on(inner);
    basis.walls = random_walls<Dim>(random);
    typename Nodes<Dim, double, Device>::Fields v("v", static_cast<size_t>(basis.node_count()), Dim);
    fill_randomly(v, random);
    edit(v, [&](const auto& host) {  // as update_nodes does
      for (int I = 0; I < basis.node_count(); ++I)
        for (int i = 0; i < Dim; ++i) {
          const int at = basis.grid.node_ijk(I)[i];
          for (int side = 0; side < 2; ++side)
            for (int c = 0; c < Dim; ++c)
              if (at == (side == 0 ? 1 : basis.grid.cells[i] - 1) && (basis.walls.fixed[i][side] >> c & 1))
                host(I, c) = 0;
        }
    });
    mirror_vectors(Exec(), basis, v);
    const auto host = read(v);
    const auto field = [&](int node, int i) { return host(node, i); };
    for (int i = 0; i < Dim; ++i)
      for (int side = 0; side < 2; ++side) {
        if (!basis.mirrored(i, side)) continue;
        auto x = random_point(inner, random);
        x[i] = inner.lower[i] + (side == 0 ? 0 : inner.cells[i] * inner.spacing[i]);
        const auto shape = basis.shape(x);
        const auto value = shape.interpolate(field);
        const auto gradient = shape.gradient(field);
        for (int c = 0; c < Dim; ++c) {
          CAPTURE(i, side, c);
          if (basis.walls.fixed[i][side] >> c & 1)
            CHECK_THAT(value[c], WithinAbs(0, 1e-14));
          else
            CHECK_THAT(gradient(c, i), WithinAbs(0, 1e-12));
        }
      }
  }
}

namespace {

/// One corner of a body between planes of symmetry at x_i = 0, or, without walls, the whole body: a ball of
/// cells with a hole under pressure and an initial velocity that stretches it.
template <class Basis>
struct Symmetric {
  static constexpr int Dim = Basis::dimension;
  static constexpr int half = 6;  // cells
  UniformGrid<Dim, double> inner;
  ParticleBlock<Dim, double, Device> block;
  Basis basis;
  State<Dim, double, Device> state;

  explicit Symmetric(bool whole) {
    Vector<Dim, double> lower, spacing;
    Vector<Dim, int> cells;
    for (int i = 0; i < Dim; ++i) {
      lower[i] = whole ? -0.25 * half : 0;
      spacing[i] = 0.25;
      cells[i] = whole ? 2 * half : half;
    }
    inner = {lower, spacing, cells};
    block = fill_cells<Dim, double>(inner, 2, 1., [&](const Vector<Dim, int>& cell) {
      double r2 = 0;
      for (int i = 0; i < Dim; ++i) {
        const double x = lower[i] + 0.25 * (cell[i] + 0.5);
        r2 += x * x;
      }
      return r2 < 1 && (Dim == 1 || r2 > 0.1);
    });
    edit(block, [&](const auto& particles) {
      for (int p = 0; p < particles.count(); ++p)
        for (int i = 0; i < Dim; ++i) particles.velocity(p, i) = (0.1 + 0.05 * i) * particles.position(p, i);
    });
    basis = WideBasis<Basis>::on(inner);
    if (!whole) basis.walls = rollers_below<Dim>();
    state = make_state(block.particles, basis);
    Kokkos::deep_copy(state.occupancy.tractions, 1u);
    if (!whole)
      edit(state.nodes.fixed_components, [&](const auto& fixed) {
        for (int I = 0; I < basis.node_count(); ++I)
          for (int i = 0; i < Dim; ++i)
            if (basis.grid.node_ijk(I)[i] == 1) fixed(I) = static_cast<ComponentMask>(fixed(I) | 1 << i);
      });
  }
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("a corner between planes of symmetry moves as it does in the whole body", "",
                        WideBases) {
  constexpr int Dim = TestType::dimension;
  Symmetric<TestType> whole(true), corner(false);
  UniformVirtualStress<Dim, double> pressure;
  pressure.count = 1;
  pressure.stress[0] = pressure_stress<Dim>(3.);
  StepOptions<Dim, double> options;
  options.dt = 0.01;  // waves at 11.6 m/s: half a cell per step
  options.damping = 0.1;
  for (auto* one : {&whole, &corner}) {
    const std::vector<Body<double>> bodies{
        {0, one->block.particles.count(), LinearElastic<double>::from_young(100, 0.3)}};
    for (int n = 0; n < 50; ++n)
      REQUIRE(step(Exec(), one->state, bodies, one->basis, pressure, options) == -1);
  }
  const auto all = read(whole.block), part = read(corner.block);
  REQUIRE(all.count() == (part.count() << Dim));
  // Both lattices are in the order of their cells, so the corner's particles come in the same order.
  double worst_position = 0, worst_stress = 0, moved = 0, largest = 0;
  int next = 0;
  const auto start = read(Symmetric<TestType>(true).block);
  for (int p = 0; p < all.count(); ++p) {
    bool in_corner = true;
    for (int i = 0; i < Dim; ++i) in_corner = in_corner && start.position(p, i) > 0;
    if (!in_corner) continue;
    for (int i = 0; i < Dim; ++i) {
      worst_position = std::max(worst_position, std::abs(all.position(p, i) - part.position(next, i)));
      moved = std::max(moved, std::abs(all.position(p, i) - start.position(p, i)));
    }
    for (int c = 0; c < all.stress_size; ++c) {
      worst_stress = std::max(worst_stress, std::abs(all.cauchy_stress(p, c) - part.cauchy_stress(next, c)));
      largest = std::max(largest, std::abs(all.cauchy_stress(p, c)));
    }
    ++next;
  }
  REQUIRE(next == part.count());
  CHECK(moved > 0.01);
  CHECK(largest > 1);
  CHECK(worst_position < 1e-13);
  CHECK(worst_stress < 1e-11);

  // The balance counts the corner once: its kinetic energy is a share of the whole body's.
  const std::vector<Body<double>> none;
  const auto of_whole = balance(Exec(), whole.state, none, whole.basis, pressure, options);
  const auto of_corner = balance(Exec(), corner.state, none, corner.basis, pressure, options);
  CHECK(of_whole.kinetic_energy > 0);
  CHECK(whole.state.occupancy.boundary_node_count > corner.state.occupancy.boundary_node_count);
  // A node on a plane of symmetry has the mass of both halves in the whole body, of one in the corner, where
  // its mirrored neighbours' share is folded onto it: the energy is the whole's over 2^Dim.
  CHECK_THAT(of_corner.kinetic_energy * (1 << Dim), WithinRel(of_whole.kinetic_energy, 1e-10));
}

TEMPLATE_LIST_TEST_CASE("a patch under uniform stress is in balance at any offset of the mesh", "",
                        WideBases) {
  // A bar between rollers at all faces but the last: it ends at any position within a cell, and there the
  // virtual stress is the one it has. Nothing else acts, so no node may feel a force in a free component.
  constexpr int Dim = TestType::dimension;
  Random random(97);
  for (int trial = 0; trial < 20; ++trial) {
    const auto inner = make_grid<Dim, double>({{8, 3, 3}});
    auto basis = WideBasis<TestType>::on(inner);
    for (int i = 0; i < Dim; ++i)
      for (int side = 0; side < 2; ++side)
        if (i > 0 || side == 0) basis.walls.fixed[i][side] = static_cast<ComponentMask>(1 << i);
    // The lattices that uGIMP's particles fill without a gap: 4, 2 and 4 in place of 4/3 per cell.
    const int per_cell[3] = {4, 2, 4};
    if constexpr (std::is_same<TestType, UniformGimpBasis<Dim, double>>::value)
      for (int i = 0; i < Dim; ++i) basis.half_width[i] = 0.5 / per_cell[i];
    const int columns = 9 + random.index(16);
    std::vector<Vector<Dim, double>> positions;
    for (int p = 0; p < columns; ++p)
      for (int q = 0; q < (Dim > 1 ? 3 * per_cell[1] : 1); ++q)
        for (int r = 0; r < (Dim > 2 ? 3 * per_cell[2] : 1); ++r) {
          const int k[3] = {p, q, r};
          Vector<Dim, double> x;
          for (int i = 0; i < Dim; ++i) x[i] = inner.lower[i] + inner.spacing[i] * (k[i] + 0.5) / per_cell[i];
          positions.push_back(x);
        }
    const auto block = allocate_particles<Dim, double, Device>(static_cast<int>(positions.size()));
    SymmetricTensor<Dim, double> stress;
    for (int c = 0; c < SymmetricTensor<Dim, double>::size; ++c) stress[c] = c < 3 ? random(-1, 1) : 0;
    // Sheared and free at both ends, the walls gone, any offset of the mesh will do.
    const bool free = trial % 2;
    if (free) {
      for (int i = 0; i < Dim; ++i) basis.walls.fixed[i][0] = basis.walls.fixed[i][1] = 0;
      for (int c = 3; c < SymmetricTensor<Dim, double>::size; ++c) stress[c] = random(-1, 1);
      Vector<Dim, double> shift;
      for (int i = 0; i < Dim; ++i) shift[i] = random(0, 1) * inner.spacing[i];
      for (int i = 0; i < Dim; ++i) basis.grid.lower[i] -= shift[i], basis.grid.cells[i] += 1;
    }
    edit(block, [&](const auto& particles) {
      for (int p = 0; p < particles.count(); ++p) {
        for (int i = 0; i < Dim; ++i) particles.position(p, i) = positions[static_cast<size_t>(p)][i];
        particles.mass(p) = particles.volume(p) = 0.01;
        for (int c = 0; c < particles.stress_size; ++c) particles.cauchy_stress(p, c) = stress[c];
      }
    });
    auto state = make_state(block.particles, basis);
    Kokkos::deep_copy(state.occupancy.tractions, 1u);
    UniformVirtualStress<Dim, double> field;
    field.count = 1;
    field.stress[0] = stress;
    REQUIRE(update_occupancy(Exec(), state.particles, state.occupancy, basis) == -1);
    assemble_forces(Exec(), state.particles, state.occupancy, state.surface, state.nodes,
                    state.sums_workspace, basis, field, Vector<Dim, double>::zero(), Scatter::gathered);
    const auto sums = read(state.nodes.sums);
    double worst = 0;
    for (int I = 0; I < basis.node_count(); ++I)
      for (int i = 0; i < Dim; ++i) {
        const int at = basis.grid.node_ijk(I)[i];
        const bool fixed =
            (at == 1 && basis.mirrored(i, 0)) || (at == basis.grid.cells[i] - 1 && basis.mirrored(i, 1));
        if (!fixed) worst = std::max(worst, std::abs(sums(I, 1 + Dim + i)));
      }
    CAPTURE(trial, columns);
    CHECK(state.occupancy.boundary_node_count > 0);
    CHECK(worst < 1e-13);
  }
}

namespace {

/// Algorithm 1 for functions that reach `support` cells from their node, by lists: which cells touch, and
/// which a support overlaps, is decided by coordinates. Ghost cells beyond walls are not there.
template <class Basis>
std::vector<bool> boundary_by_lists(const Basis& basis, const std::vector<bool>& void_cell, double support) {
  constexpr int Dim = Basis::dimension;
  const auto& grid = basis.grid;
  const auto exists = [&](const Vector<Dim, int>& cell) {
    for (int i = 0; i < Dim; ++i)
      if ((cell[i] == 0 && basis.walls.fixed[i][0]) ||
          (cell[i] == grid.cells[i] - 1 && basis.walls.fixed[i][1]))
        return false;
    return true;
  };
  const auto touch = [](const Vector<Dim, int>& a, const Vector<Dim, int>& b) {
    for (int i = 0; i < Dim; ++i)
      if (std::abs(a[i] - b[i]) > 1) return false;
    return true;
  };
  const auto overlaps = [&](const Vector<Dim, int>& node, const Vector<Dim, int>& cell) {
    for (int i = 0; i < Dim; ++i)
      if (cell[i] + 1 <= node[i] - support || cell[i] >= node[i] + support) return false;
    return true;
  };
  std::vector<Vector<Dim, int>> filled, empty, e1, marked;
  size_t number = 0;
  for_each_cell(grid, [&](const Vector<Dim, int>& cell) {
    const bool is_void = void_cell[number++];
    if (exists(cell)) (is_void ? empty : filled).push_back(cell);
  });
  for (const auto& cell : empty)
    for (const auto& other : filled)
      if (touch(cell, other)) {
        e1.push_back(cell);
        break;
      }
  marked = e1;
  for (const auto& cell : filled)
    for (const auto& other : e1)
      if (touch(cell, other)) {
        marked.push_back(cell);
        break;
      }
  std::vector<bool> in_n1(static_cast<size_t>(grid.node_count()));
  for (int I = 0; I < grid.node_count(); ++I) {
    const auto node = grid.node_ijk(image_of(basis, I).node);
    const auto meets = [&](const auto& cells) {
      for (const auto& cell : cells)
        if (overlaps(node, cell)) return true;
      return false;
    };
    in_n1[static_cast<size_t>(I)] = meets(filled) && meets(marked);
  }
  return in_n1;
}

}  // namespace

TEMPLATE_TEST_CASE("N1 of wide bases against lists, random bodies and walls", "",
                   (QuadraticBSplineBasis<1, double>), (QuadraticBSplineBasis<2, double>),
                   (QuadraticBSplineBasis<3, double>)) {
  constexpr int Dim = TestType::dimension;
  Random random(98);
  for (const int nx : {1, 2, 3, 61, 62, 63, 64, 66, 130})
    for (const double fill : {0.02, 0.3, 0.9, 0.98}) {
      const auto inner = make_grid<Dim, double>({{nx, 4, 2}});
      auto basis = WideBasis<TestType>::on(inner);
      basis.walls = random_walls<Dim>(random);
      const auto& grid = basis.grid;
      std::vector<bool> void_cell;
      std::vector<Vector<Dim, double>> positions;
      for_each_cell(grid, [&](const Vector<Dim, int>& cell) {
        bool inside = true;
        for (int i = 0; i < Dim; ++i) inside = inside && cell[i] > 0 && cell[i] < grid.cells[i] - 1;
        void_cell.push_back(!inside || random(0, 1) > fill);
        if (void_cell.back()) return;
        Vector<Dim, double> x;
        for (int i = 0; i < Dim; ++i) x[i] = grid.lower[i] + grid.spacing[i] * (cell[i] + random(0.01, 0.99));
        positions.push_back(x);
      });
      const auto block = allocate_particles<Dim, double, Device>(static_cast<int>(positions.size()));
      edit(block, [&](const auto& particles) {
        for (int p = 0; p < particles.count(); ++p) {
          for (int i = 0; i < Dim; ++i) particles.position(p, i) = positions[static_cast<size_t>(p)][i];
          particles.mass(p) = particles.volume(p) = 1;
        }
      });
      const auto n = static_cast<size_t>(basis.node_count());
      const BoundaryNodes<Device> tractions("tractions", n), boundary("boundary", n);
      edit(tractions, [&](const auto& host) {
        for (size_t I = 0; I < n; ++I) host(I) = static_cast<TractionMask>(random.index(4));
      });
      const auto declared = read(tractions);
      const auto bits = allocate_cell_bits<Device>(grid);
      const int counted = mark_boundary_nodes(Exec(), block.particles, bits, basis, tractions, boundary);
      const auto got = read(boundary);
      const auto in_n1 = boundary_by_lists(basis, void_cell, 1.5);
      int wrong = 0, expected_count = 0;
      for (int I = 0; I < basis.node_count(); ++I) {
        const auto image = image_of(basis, I);  // the traction is declared at the mirror position
        const TractionMask expected =
            in_n1[static_cast<size_t>(I)] ? declared(static_cast<size_t>(image.node)) : 0;
        wrong += got(static_cast<size_t>(I)) != expected;
        expected_count += expected != 0 && !image.ghost;
      }
      CAPTURE(nx, fill);
      CHECK(wrong == 0);
      CHECK(counted == expected_count);
      if (block.particles.count() == 0) continue;

      // The same on cell lanes, which keep the nodes that particles reach.
      SplineLaneState<Dim, double, Device> lanes;
      lanes.grid = inner;
      lanes.memory.walls = basis.walls;
      lanes.boundary.declared = tractions;
      REQUIRE(pack_lanes(Exec(), block.particles, lanes) == -1);
      std::vector<TractionMask> theirs(got.data(), got.data() + got.extent(0));
      CHECK((tractions_of_nodes(lanes, theirs) == theirs));
      CHECK(count_loaded_nodes(Exec(), lanes) == expected_count);
    }
}

TEMPLATE_TEST_CASE("underfilled cells of wide bases are those of the linear basis", "",
                   (QuadraticBSplineBasis<1, double>), (QuadraticBSplineBasis<2, double>),
                   (UniformGimpBasis<3, double>)) {
  constexpr int Dim = TestType::dimension;
  const auto inner = make_grid<Dim, double>();
  const auto basis = WideBasis<TestType>::on(inner);
  const LinearBasis<Dim, double> linear{basis.grid};
  const auto block = random_particles(inner, 200, 99);
  const double mean = 200 / (inner.cell_count() * inner.cell_volume());
  auto wide_state = make_state(block.particles, basis);
  auto linear_state = make_state(block.particles, linear);
  for (const double tau : {0.2, 0.5, 0.8}) {
    // The fill is of the volume; masses and volumes are near 1, so the criterion is scaled to cells of that
    // size.
    set_fill_criterion(wide_state.occupancy, tau);
    set_fill_criterion(linear_state.occupancy, tau);
    wide_state.occupancy.minimum_fill *= mean;
    linear_state.occupancy.minimum_fill *= mean;
    REQUIRE(update_occupancy(Exec(), wide_state.particles, wide_state.occupancy, basis) == -1);
    REQUIRE(update_occupancy(Exec(), linear_state.particles, linear_state.occupancy, linear) == -1);
    const auto a = read(wide_state.occupancy.cells.underfilled),
               b = read(linear_state.occupancy.cells.underfilled);
    int differ = 0, some = 0;
    for (size_t i = 0; i < a.size(); ++i) {
      differ += a.data()[i] != b.data()[i];
      some += a.data()[i] != 0;
    }
    CHECK(differ == 0);
    CHECK(some > 0);
  }
}
