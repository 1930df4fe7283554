// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a code that embeds vsb may forget: each is answered by an exception that names it, or does no harm.
#include <common_steps.hpp>
#include <functional>
#include <vsb/kernels/lanes/loads.hpp>
#include <vsb/physics/traction_fields.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

using Load = UniformVirtualStress<2, double>;
const double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A block of 3 x 3 cells with four particles each, in the middle of 5 x 5 cells.
struct Block {
  UniformGrid<2, double> grid{{{0.0, 0.0}}, {{1.0, 1.0}}, {{5, 5}}};
  ParticleBlock<2, double, Device> block =
      fill_cells<2, double>(grid, 2, 1.0, [](const Vector<2, int>& cell) {
        return cell[0] >= 1 && cell[0] <= 3 && cell[1] >= 1 && cell[1] <= 3;
      });
  Particles<2, double, Device>& particles = block.particles;
  Load load{};
  StepOptions<2, double> options{};

  Block() {
    load.count = 1;
    load.stress[0] = pressure_stress<2>(1.0);
    options.dt = 1e-3;
  }
};

/// Nothing is missing for a step of the particle kernels, before a test takes something away.
struct ParticleScene : Block {
  LinearBasis<2, double> basis{grid};
  State<2, double, Device> state = make_state(particles, basis);
  std::vector<Body<double>> bodies{{0, 36, LinearElastic<double>::from_young(100, 0.3)}};

  ParticleScene() { declare(1); }
  void declare(TractionMask mask) { Kokkos::deep_copy(state.occupancy.tractions, mask); }
  int step() { return vsb::step(Exec(), state, bodies, basis, load, options); }
};

/// The same on cell lanes.
template <class State>
struct LaneScene : Block {
  State lanes;
  LinearElastic<double> material = LinearElastic<double>::from_young(100, 0.3);

  LaneScene() {
    set_grid(lanes, grid);
    lanes.boundary.everywhere = 1;
  }
  void pack() { REQUIRE(pack_lanes(Exec(), particles, lanes) == -1); }
  void prepare() { prepare_lane_step(Exec(), lanes, load); }
  int step() { return lane_step(Exec(), lanes, material, DeterminantVolume{}, load, options); }
};

double force_on(const State<2, double, Device>& state) {
  double sum = 0;
  const auto sums = read(state.nodes.sums);
  for (size_t I = 0; I < sums.extent(0); ++I) sum += std::abs(sums(I, 3)) + std::abs(sums(I, 4));
  return sum;
}

}  // namespace

TEST_CASE("particles with positions alone have their boundary marked") {
  const Block body;
  Particles<2, double, Device> positions;
  positions.position = body.particles.position;
  CHECK(positions.count() == 36);
  const LinearBasis<2, double> basis{body.grid};
  auto occupancy = allocate_occupancy<Device>(positions.count(), basis);
  Kokkos::deep_copy(occupancy.tractions, 1u);
  CHECK(update_occupancy(Exec(), positions, occupancy, basis) == -1);
  CHECK(occupancy.boundary_node_count == 16);
  CHECK(mark_boundary_nodes(Exec(), positions, occupancy.cells, basis, occupancy.tractions,
                            occupancy.boundary) == 16);
  CHECK_THROWS_WITH(make_state(positions, basis), containing("velocity is 0 x 0, expected 36 x 2"));
}

TEST_CASE("positions outside the grid are refused where nodes are marked") {
  const Block body;
  const LinearBasis<2, double> basis{body.grid};
  const auto bits = allocate_cell_bits<Device>(basis.grid);
  const BoundaryNodes<Device> tractions("vsb::tractions", 36), boundary("vsb::boundary", 36);
  const auto mark = [&] {
    return mark_boundary_nodes(Exec(), body.particles, bits, basis, tractions, boundary);
  };
  CHECK_NOTHROW(mark());
  for (const double bad : {not_a_number, -1e9, 5.5, 1e300}) {
    CAPTURE(bad);
    edit(body.block, [&](const auto& p) { p.position(7, 1) = bad; });
    CHECK_THROWS_WITH(mark(), containing("position of particle 7 is outside the grid"));
  }
  const auto other = allocate_cell_bits<Device>(CellNumbering<2>{{{2, 2}}});
  CHECK_THROWS_WITH(mark_boundary_nodes(Exec(), body.particles, other, basis, tractions, boundary),
                    containing("another grid"));
}

TEST_CASE("tractions declared between steps act in the next one") {
  ParticleScene s;
  s.declare(2);
  s.load.count = 2;
  s.load.stress[1] = SymmetricTensor<2, double>::zero();
  REQUIRE(s.step() == -1);
  CHECK(force_on(s.state) == 0);
  s.declare(1);
  REQUIRE(s.step() == -1);
  CHECK(s.state.occupancy.boundary_node_count == 16);
  CHECK(force_on(s.state) > 1);
  edit(s.state.occupancy.tractions, [](const auto& host) { host(7) = 0; });  // a corner of the block
  REQUIRE(s.step() == -1);
  CHECK(s.state.occupancy.boundary_node_count == 15);
  s.state.occupancy.at_all_active_nodes = 1;
  REQUIRE(s.step() == -1);
  CHECK(s.state.occupancy.boundary_node_count == 15);  // the body has no other nodes
  CHECK(s.state.occupancy.marked_at_all_active_nodes == 1);
}

TEST_CASE("a step of the particle kernels names what is missing") {
  struct Missing {
    std::function<void(ParticleScene&)> take_away;
    std::string answer;
  };
  using S = ParticleScene;
  const std::vector<Missing> list{
      {[](S& s) { s.options.dt = 0; }, "StepOptions::dt is 0"},
      {[](S& s) { s.options = {}; }, "StepOptions::dt is 0"},
      {[](S& s) { s.options.dt = not_a_number; }, "StepOptions::dt is nan"},
      {[](S& s) { s.options.dt = -1; }, "StepOptions::dt is -1"},
      {[](S& s) { s.options.damping = not_a_number; }, "StepOptions::damping is nan"},
      {[](S& s) { s.options.gravity[1] = not_a_number; }, "StepOptions::gravity is nan"},
      {[](S& s) { s.load.count = 0; }, "the load has no traction: set its `count`"},
      {[](S& s) { s.load = {}; }, "the load has no traction: set its `count`"},
      {[](S& s) { s.load.count = 9; }, "allowed are 0 to 8 tractions"},
      {[](S& s) { s.state.occupancy.minimum_fill = 0.5; }, "call set_fill_criterion"},
      {[](S& s) { s.declare(0); }, "no traction is declared at any node"},
      {[](S& s) { s.declare(5); }, "traction 2 is declared at nodes, but the load has no stress for it"},
      {[](S& s) { s.bodies.clear(); }, "particle 0 of 36 is in no body"},
      {[](S& s) { s.bodies[0].last = 35; }, "particle 35 of 36 is in no body"},
      {[](S& s) { s.bodies[0].first = 1; }, "particle 0 of 36 is in no body"},
      {[](S& s) { s.bodies[0].last = 37; }, "last = 37, but there are 36"},
      {[](S& s) {
         s.bodies.push_back({20, 25, s.bodies[0].material});
       },
       "particle 20 is in two bodies"},
      {[](S& s) {
         s.bodies[0].material = LinearElastic<double>{not_a_number, not_a_number};
       },
       "constrained modulus"},
      {[](S& s) { s.bodies[0].material = Hencky<double>::from_young(100, 0.3); }, "material_state is 0 x 0"},
      {[](S& s) { s.state.particles = random_particles(s.grid, 40, 3).particles; }, "is in no body"},
      {[](S& s) {
         s.state.particles = random_particles(s.grid, 40, 3).particles;
         s.bodies[0].last = 40;
       },
       "ParticleBins has 36 rows where there are 40"},
      {[](S& s) { s.state.particles.mass = {}; }, "mass is 0 x 1, expected 36 x 1"},
      {[](S& s) { s.state.particles.volume = {}; }, "volume is 0 x 1, expected 36 x 1"},
      {[](S& s) { Kokkos::deep_copy(s.particles.mass, 0.0); }, "particle 0 has a mass or a volume"},
      {[](S& s) { edit(s.block, [](const auto& p) { p.volume(9) = not_a_number; }); },
       "particle 9 has a mass or a volume"},
      {[](S& s) {
         s.basis.grid.cells = {{6, 5}};
       },
       "State::nodes has 36 rows where there are 42"},
      {[](S& s) { s.state.surface = allocate_surface_points<2, double, Device>(1, 35, s.basis.bin_count()); },
       "SurfacePoints::node_force has 35 rows"},
  };
  for (const auto& missing : list) {
    CAPTURE(missing.answer);
    ParticleScene s;
    missing.take_away(s);
    const auto before = read(s.block);
    CHECK_THROWS_WITH(s.step(), containing(missing.answer));
    const auto after = read(s.block);
    CHECK(before.position(0, 0) == after.position(0, 0));
  }
  ParticleScene s;
  CHECK(s.step() == -1);
  CHECK(step(Exec(), s.state, s.bodies, s.basis, NoVirtualStress{}, s.options) == -1);
  // Bodies in any order.
  const auto rock = s.bodies[0].material;
  s.bodies = {{20, 36, rock}, {0, 5, rock}, {5, 5, rock}, {5, 20, rock}};
  CHECK(s.step() == -1);
  s.bodies[3].last = 19;
  CHECK_THROWS_WITH(s.step(), containing("particle 19 of 36 is in no body"));
}

TEST_CASE("a grid without cells, or without a cell size, is refused") {
  const Block body;
  const auto refused = [&](const UniformGrid<2, double>& grid, const std::string& why) {
    CHECK_THROWS_WITH(make_state(body.particles, LinearBasis<2, double>{grid}), containing(why));
    CHECK_THROWS_WITH(allocate_occupancy<Device>(36, LinearBasis<2, double>{grid}), containing(why));
    LaneState<2, double, Device> lanes;
    lanes.memory.grid = grid;
    CHECK_THROWS_WITH(pack_lanes(Exec(), body.particles, lanes), containing(why));
    SplineLaneState<2, double, Device> splines;
    splines.grid = grid;
    CHECK_THROWS_WITH(pack_lanes(Exec(), body.particles, splines), containing(why));
  };
  refused({}, "cells of 0 m in direction 0");
  refused({{{0, 0}}, {{1, 0}}, {{5, 5}}}, "cells of 0 m in direction 1");
  refused({{{0, not_a_number}}, {{1, 1}}, {{5, 5}}}, "begins at nan m");
  refused({{{0, 0}}, {{1, 1}}, {{5, 0}}}, "0 cells in direction 1");
  refused({{{0, 0}}, {{1, 1}}, {{100000, 100000}}}, "more than an int counts");
}

TEST_CASE("arrays that cannot be what is meant are not wrapped") {
  double x[12] = {};
  using P = Particles<2, double, Device>;
  CHECK_NOTHROW(P::wrap(x, 4, 3, 3));
  CHECK_NOTHROW(P::wrap(x, 4, 3, 1, 4));
  CHECK_NOTHROW(P::wrap(x, 1, 3, 1));
  CHECK_NOTHROW(P::wrap(nullptr, 0, 2, 2));
  CHECK_THROWS_WITH(P::wrap(x, 4, 3, 1), containing("rows overlap"));
  CHECK_THROWS_WITH(P::wrap(x, 4, 3, 1, 2), containing("rows overlap"));
  CHECK_THROWS_WITH(P::wrap(x, 4, 3, 0), containing("must be positive"));
  CHECK_THROWS_WITH(P::wrap(x, 4, 0), containing("must be positive"));
  CHECK_THROWS_WITH(P::wrap(nullptr, 4, 2, 2), containing("null pointer"));
}

TEST_CASE("sums over particles that were not sorted are refused") {
  ParticleScene s;
  ScatterWorkspace<double, Device> workspace;
  const auto sum = [&](const State<2, double, Device>& state) {
    particles_to_grid(Exec(), s.particles, state.occupancy.bins, state.nodes, state.occupancy.boundary,
                      workspace, s.basis, NoVirtualStress{}, s.options.gravity, Scatter::gathered);
  };
  CHECK_THROWS_WITH(sum(s.state), containing("not sorted by bin"));
  REQUIRE(update_occupancy(Exec(), s.particles, s.state.occupancy, s.basis) == -1);
  CHECK_NOTHROW(sum(s.state));
  CHECK_THROWS_WITH(
      update_occupancy(Exec(), random_particles(s.grid, 35, 3).particles, s.state.occupancy, s.basis),
      containing("ParticleBins has 36 rows where there are 35"));
}

#if !defined(VSB_BACKEND_CUDA)  // cell lanes run on hosts alone

TEMPLATE_TEST_CASE("a step on cell lanes names what is missing", "", (LaneState<2, double, Device>),
                   (SplineLaneState<2, double, Device>)) {
  using S = LaneScene<TestType>;
  {
    S s;
    CHECK_THROWS_WITH(s.prepare(), containing("call pack_lanes before prepare_lane_step"));
    s.pack();
    CHECK_THROWS_WITH(s.step(), containing("call prepare_lane_step after pack_lanes"));
    s.prepare();
    CHECK(s.step() == -1);
    s.pack();
    CHECK_THROWS_WITH(s.step(), containing("call prepare_lane_step after pack_lanes"));
  }
  struct Missing {
    std::function<void(S&)> take_away;
    std::string answer;
  };
  const std::vector<Missing> steps{
      {[](S& s) { s.options = {}; }, "StepOptions::dt is 0"},
      {[](S& s) { s.load.count = 0; }, "the load has no traction: set its `count`"},
      {[](S& s) { s.material.lambda = not_a_number; }, "constrained modulus"},
      {[](S& s) { s.lanes.memory.walls.fixed[1][0] = 2; }, "call unpack_particles before"},
      {[](S& s) { s.lanes.memory.grid.lower[0] = 0.1; }, "call unpack_particles before"},
      {[](S& s) { s.lanes.boundary.everywhere = 3; }, "call prepare_lane_step again"},
      {[](S& s) { s.lanes.boundary.at_all_active_nodes = 1; }, "call prepare_lane_step again"},
      {[](S& s) { s.lanes.boundary.declared = BoundaryNodes<Device>("vsb::declared", 36); },
       "call prepare_lane_step again"},
  };
  for (const auto& missing : steps) {
    CAPTURE(missing.answer);
    S s;
    s.pack();
    s.prepare();
    missing.take_away(s);
    CHECK_THROWS_WITH(s.step(), containing(missing.answer));
  }
  const std::vector<Missing> packs{
      {[](S& s) { s.lanes.boundary.everywhere = 0; }, "no traction is declared at any node"},
      {[](S& s) { s.lanes.boundary.everywhere = 4; }, "traction 2 is declared at nodes"},
      {[](S& s) { s.load.count = 0; }, "the load has no traction: set its `count`"},
      {[](S& s) { s.lanes.boundary.declared = BoundaryNodes<Device>("vsb::declared", 7); },
       "LaneBoundary::declared has 7 rows"},
      {[](S& s) { s.particles.mass = {}; }, "mass is 0 x 1"},
      {[](S& s) { Kokkos::deep_copy(s.particles.volume, 0.0); }, "particle 0 has a mass or a volume"},
      {[](S& s) { s.lanes.memory.lanes.state_size = 4; }, "material_state is 0 x 0"},
  };
  for (const auto& missing : packs) {
    CAPTURE(missing.answer);
    S s;
    missing.take_away(s);
    const auto begin = [&] {
      pack_lanes(Exec(), s.particles, s.lanes);
      s.prepare();
    };
    CHECK_THROWS_WITH(begin(), containing(missing.answer));
  }
  S s;
  s.pack();
  s.prepare();
  const auto hencky = Hencky<double>::from_young(100, 0.3);
  CHECK_THROWS_WITH(lane_step(Exec(), s.lanes, hencky, DeterminantVolume{}, s.load, s.options),
                    containing("set LaneState::memory.lanes.state_size"));
  CHECK_THROWS_WITH(unpack_particles(Exec(), s.lanes.memory, random_particles(s.grid, 40, 3).particles),
                    containing("has 40 rows where there are 36"));
}

TEMPLATE_TEST_CASE("a load that finds no node at the start is refused", "", (LaneState<2, double, Device>),
                   (SplineLaneState<2, double, Device>)) {
  const int nodes = (TestType::splines ? with_ghost_layer(Block().grid) : Block().grid).node_count();
  LaneScene<TestType> beside;  // declared in a corner of the grid
  beside.lanes.boundary.everywhere = 0;
  const BoundaryNodes<Device> corner("vsb::declared", static_cast<size_t>(nodes));
  edit(corner, [](const auto& declared) { declared(0) = 1; });
  beside.lanes.boundary.declared = corner;
  beside.pack();
  CHECK_THROWS_WITH(beside.prepare(), containing("let the grid reach a cell beyond a loaded face"));
  prepare_lane_step(Exec(), beside.lanes, NoVirtualStress{});
  // The void begins where the grid ends: a face of the body there is no boundary.
  ParticleScene s;
  s.basis.grid = {{{1.0, 1.0}}, {{1.0, 1.0}}, {{3, 3}}};
  s.state = make_state(s.particles, s.basis);
  s.declare(1);
  CHECK_THROWS_WITH(s.step(), containing("let the grid reach a cell beyond a loaded face"));
}

TEST_CASE("tractions declared between steps on cell lanes act after prepare_lane_step") {
  LaneScene<LaneState<2, double, Device>> s;
  const BoundaryNodes<Device> declared("vsb::declared", 36);
  Kokkos::deep_copy(declared, 2u);
  s.lanes.boundary.everywhere = 0;
  s.lanes.boundary.declared = declared;
  s.load.count = 2;
  s.load.stress[1] = SymmetricTensor<2, double>::zero();
  s.pack();
  s.prepare();
  REQUIRE(s.step() == -1);
  edit(declared, [](const auto& host) {
    for (size_t I = 0; I < 36; ++I) host(I) = 1;
    host(7) = 0;
  });
  s.prepare();
  CHECK(s.lanes.boundary.all_declared == 3);
  CHECK(count_loaded_nodes(Exec(), s.lanes) == 15);
  CHECK(s.step() == -1);
}

TEST_CASE("loads beside the sweeps cannot be left out, added twice, or counted twice") {
  using S = LaneScene<LaneState<2, double, Device>>;
  const auto add = [](S& s) { return add_lane_loads(Exec(), s.lanes, s.load); };
  S s;
  s.lanes.original = 1;
  s.pack();
  s.prepare();
  CHECK_THROWS_WITH(s.step(), containing("call add_lane_loads after prepare_lane_step"));
  CHECK(add(s) == -1);
  CHECK_THROWS_WITH(add(s), containing("call it once"));
  S many;
  many.lanes.original = 1;
  many.lanes.gauss_points = 0;
  many.pack();
  many.prepare();
  CHECK_THROWS_WITH(add(many), containing("0 Gauss points per direction"));
  CHECK(s.step() == -1);
  CHECK_THROWS_WITH(s.step(), containing("call add_lane_loads"));

  // The sweeps leave the tractions of the original method out of the load by themselves.
  S same, zero;
  for (S* t : {&same, &zero}) {
    t->lanes.original = 1;
    t->pack();
  }
  zero.load.stress[0] = SymmetricTensor<2, double>::zero();
  same.prepare();
  zero.prepare();
  const auto a = read(same.lanes.memory.nodes.data), b = read(zero.lanes.memory.nodes.data);
  double most = 0;
  for (size_t c = 0; c < 10; ++c)
    for (int I = 0; I < same.lanes.memory.lanes.node_count; ++I)
      most = std::max(most, std::abs(a(static_cast<size_t>(I), c) - b(static_cast<size_t>(I), c)));
  CHECK(most == 0);

  SplineLaneState<2, double, Device> splines;
  LaneScene<SplineLaneState<2, double, Device>> t;
  t.pack();
  t.prepare();
  t.lanes.original = 1;
  CHECK_THROWS_WITH(t.step(), containing("use the particle kernels"));
}

TEST_CASE("fields of any kind leave tractions out") {
  const auto all = virtual_stress_of([](const auto& x) {
    return VirtualStressValue<2, double>{pressure_stress<2>(x[0]), {{-1.0, 0.0}}};
  });
  CHECK(all.at(Vector<2, double>{{2, 0}}, 1).stress[0] == -2);
  CHECK(all.without(1).at(Vector<2, double>{{2, 0}}, 1).stress[0] == 0);
  CHECK(all.without(1).at(Vector<2, double>{{2, 0}}, 2).stress[0] == -2);
  TractionFields<2, double> fields{};
  fields.count = 2;
  for (int k = 0; k < 2; ++k) {
    fields.field[k] = UniformStress<2, double>{pressure_stress<2>(1.0 + k)};
    fields.factor[k] = 1;
  }
  CHECK(fields.without(2).at(Vector<2, double>{{2, 0}}, 3).stress[0] == -1);
  AffineVirtualStress<2, double> affine{};
  affine.count = 2;
  for (int k = 0; k < 2; ++k) {
    affine.field[k] = fields.field[k].as_affine();
    affine.factor[k] = 1;
  }
  CHECK(affine.without(1).at(Vector<2, double>{{2, 0}}, 3).stress[0] == -2);
  CHECK(first_tractions(0, 8) == 0);
  CHECK(first_tractions(3, 8) == 7);
  CHECK(first_tractions(32, 32) == ~TractionMask(0));
}

#endif
