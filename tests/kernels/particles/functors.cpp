// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Kernel functors, each called for one index on the host, against numbers worked out by hand.
#include <algorithm>
#include <iterator>
#include <utility>
#include <vsb/kernels/readout/balance.hpp>
#include <vsb/kernels/readout/health.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

// One cell [1, 3] with its particle a quarter of the way: N = 3/4, 1/4 and dN = -1/2, 1/2.
const LinearBasis<1, double> cell_1d{UniformGrid<1, double>({{1}}, {{2}}, {{1}})};

Particles<1, double, Host> particle_1d() {
  const auto particles = allocate_particles<1, double, Host>(1).particles;
  particles.position(0, 0) = 1.5;
  particles.velocity(0, 0) = 3;
  particles.mass(0) = 4;
  particles.volume(0) = 2;
  particles.cauchy_stress(0, 0) = 10;
  particles.cauchy_stress(0, 1) = particles.cauchy_stress(0, 2) = 1000;  // do no work in one dimension
  return particles;
}

/// Sums by node and column.
class Sums {
 public:
  KOKKOS_FUNCTION double& at(int node, int column) {
    used_[node][column] = true;
    return sums_[node][column];
  }
  double operator[](const std::pair<int, int>& at) const { return sums_[at.first][at.second]; }
  /// How many were added to.
  int size() const {
    int n = 0;
    for (const auto& node : used_) n += static_cast<int>(std::count(std::begin(node), std::end(node), true));
    return n;
  }
  void clear() { *this = Sums(); }

 private:
  double sums_[4][5] = {};
  bool used_[4][5] = {};
};

/// What a contribution adds.
struct Collector {
  Sums& sums;
  KOKKOS_FUNCTION double& operator()(int, int node, int column) const { return sums.at(node, column); }
};

/// sbar = -7 and fbar = 3 for traction 1, the only one declared.
struct OneDimensionalField : ActsOnParticles {
  KOKKOS_FUNCTION VirtualStressValue<1, double> at(const Vector<1, double>&, TractionMask mask) const {
    if (mask == 0) return VirtualStressValue<1, double>::zero();
    return {{{-7, 0, 0}}, {{3}}};
  }
};

/// Adds a particle's number + 1 to its first node, and ten times that to its second.
struct NumberedContribution {
  static constexpr int columns = 1;
  KOKKOS_FUNCTION void operator()(int p, const kernel::BinSink<double, 2, 1>& sink) const {
    sink(0, -1, 0) += p + 1;
    sink(1, -1, 0) += 10 * (p + 1);
  }
};

}  // namespace

TEST_CASE("ParticlesToGrid in one dimension") {
  Sums sums;
  const BoundaryNodes<Host> boundary("vsb::boundary", 2);
  const Vector<1, double> gravity{{-5}};
  SECTION("without a virtual stress") {
    kernel::ParticlesToGrid<LinearBasis<1, double>, NoVirtualStress, 1, double, Host> functor{
        particle_1d(), cell_1d, {}, boundary, gravity};
    boundary(0) = boundary(1) = 1;  // not looked at
    functor(0, Collector{sums});
    CHECK(sums.size() == 6);
    CHECK(sums[{0, 0}] == 3);         // 3/4 of 4 kg
    CHECK(sums[{0, 1}] == 9);         // times 3 m/s
    CHECK(sums[{0, 2}] == -15 + 10);  // 3 kg of weight, and -V sigma dN = -2 10 (-1/2)
    CHECK(sums[{1, 0}] == 1);
    CHECK(sums[{1, 1}] == 3);
    CHECK(sums[{1, 2}] == -5 - 10);
  }
  SECTION("a virtual stress and its divergence act at marked nodes only") {
    kernel::ParticlesToGrid<LinearBasis<1, double>, OneDimensionalField, 1, double, Host> functor{
        particle_1d(), cell_1d, {}, boundary, gravity};
    boundary(1) = 2;
    functor(0, Collector{sums});
    CHECK(sums[{0, 2}] == -5);
    CHECK(sums[{1, 2}] == -5 - 17 + 1.5);  // -2 (10 + 7) / 2, and 1/4 of 2 m times 3 N/m
    boundary(0) = 2, boundary(1) = 0;      // marked before unmarked
    sums.clear();
    functor(0, Collector{sums});
    CHECK(sums[{0, 2}] == -15 + 17 + 4.5);
    CHECK(sums[{1, 2}] == -15);
  }
}

TEST_CASE("ParticlesToGrid in two dimensions") {
  // Cell 1 m x 2 m, particle at a quarter in both directions; only node 3 (upper right): N = 1/16, dN = (1/4,
  // 1/8).
  const LinearBasis<2, double> basis{UniformGrid<2, double>({{0, 0}}, {{1, 2}}, {{1, 1}})};
  const auto particles = allocate_particles<2, double, Host>(1).particles;
  const double state[] = {0.25, 0.5, 16, -32, 2, 2, 8, 4, 100, 2};  // x, v, m, V, sigma
  for (int i = 0; i < 2; ++i) {
    particles.position(0, i) = state[i];
    particles.velocity(0, i) = state[2 + i];
  }
  particles.mass(0) = state[4];
  particles.volume(0) = state[5];
  for (int c = 0; c < 4; ++c) particles.cauchy_stress(0, c) = state[6 + c];
  UniformVirtualStress<2, double> pressure;
  pressure.count = 1;
  pressure.stress[0] = pressure_stress<2>(4.);
  const BoundaryNodes<Host> boundary("vsb::boundary", 4);
  kernel::ParticlesToGrid<LinearBasis<2, double>, UniformVirtualStress<2, double>, 2, double, Host> functor{
      particles, basis, pressure, boundary, {{0, -8}}};
  Sums sums;
  functor(0, Collector{sums});
  CHECK(sums[{3, 0}] == 0.125);
  CHECK(sums[{3, 1}] == 2);
  CHECK(sums[{3, 2}] == -4);
  CHECK(sums[{3, 3}] == -2 * (8 * 0.25 + 2 * 0.125));
  CHECK(sums[{3, 4}] == -1 - 2 * (2 * 0.25 + 4 * 0.125));
  boundary(3) = 1;  // sigma - sbar = sigma + 4 I
  sums.clear();
  functor(0, Collector{sums});
  CHECK(sums[{3, 3}] == -2 * (12 * 0.25 + 2 * 0.125));
  CHECK(sums[{3, 4}] == -1 - 2 * (2 * 0.25 + 8 * 0.125));
}

TEST_CASE("UpdateNode") {
  const auto nodes = allocate_nodes<2, double, Host>(3);
  const kernel::UpdateNode<2, double, Host> functor{nodes, 0.1, 0.5};
  nodes.mass(0) = 2;
  nodes.momentum(0, 0) = 6, nodes.force(0, 0) = 10;   // damped: with the motion, 9
  nodes.momentum(0, 1) = -6, nodes.force(0, 1) = 10;  // against it, 11
  functor(0);
  CHECK(nodes.acceleration(0, 0) == 4.5);
  CHECK(nodes.velocity(0, 0) == 3 + 2.25);
  CHECK(nodes.acceleration(0, 1) == 5.5);
  CHECK(nodes.velocity(0, 1) == -3 + 2.75);

  nodes.mass(1) = 2;
  nodes.fixed_components(1) = 2;  // y
  nodes.momentum(1, 0) = nodes.momentum(1, 1) = 6;
  nodes.force(1, 0) = nodes.force(1, 1) = -10;
  functor(1);
  CHECK(nodes.acceleration(1, 0) == -5.5);
  CHECK(nodes.velocity(1, 0) == 3 - 2.75);
  CHECK(nodes.acceleration(1, 1) == 0);
  CHECK(nodes.velocity(1, 1) == 0);

  nodes.velocity(2, 0) = nodes.acceleration(2, 1) = 99;  // left over from when the node was active
  functor(2);
  for (int i = 0; i < 2; ++i) {
    CHECK(nodes.acceleration(2, i) == 0);
    CHECK(nodes.velocity(2, i) == 0);
  }
}

TEST_CASE("GridToParticles and the re-map") {
  const double pic = GENERATE(0, 0.25);
  const auto particles = particle_1d();
  const auto nodes = allocate_nodes<1, double, Host>(2);
  nodes.acceleration(0, 0) = 8;
  nodes.acceleration(1, 0) = -4;
  nodes.velocity(0, 0) = 2;
  nodes.velocity(1, 0) = 16;
  kernel::GridToParticles<LinearBasis<1, double>, 1, double, Host>{particles, nodes, cell_1d, pic, 0.5}(0);
  CHECK(particles.velocity(0, 0) == (1 - pic) * (3 + 0.5 * (6 - 1)) + pic * (1.5 + 4));
  CHECK(particles.position(0, 0) == 1.5);

  particles.velocity(0, 0) = 3;
  Sums sums;
  kernel::RemapMomentum<LinearBasis<1, double>, 1, double, Host>{particles, cell_1d}(0, Collector{sums});
  CHECK(sums[{0, 0}] == 9);
  CHECK(sums[{1, 0}] == 3);

  const kernel::RemapNode<1, double, Host> remap{nodes};
  nodes.mass(0) = 6;
  nodes.remapped_velocity(0, 0) = 9;
  remap(0);
  CHECK(nodes.remapped_velocity(0, 0) == 1.5);
  nodes.fixed_components(0) = 1;
  remap(0);
  CHECK(nodes.remapped_velocity(0, 0) == 0);
  nodes.remapped_velocity(1, 0) = 9;  // without mass
  remap(1);
  CHECK(nodes.remapped_velocity(1, 0) == 0);
}

TEST_CASE("UpdateStress") {
  const auto position_velocity = GENERATE(PositionVelocity::strain, PositionVelocity::grid);
  const auto particles = particle_1d();
  const auto nodes = allocate_nodes<1, double, Host>(2);
  nodes.velocity(0, 0) = 4;  // 3/4 of 4 + 1/4 of 8
  nodes.velocity(1, 0) = 8;
  nodes.remapped_velocity(0, 0) = 1;  // 3/4 of 1 + 1/4 of 1.5; L = (1.5 - 1) / 2
  nodes.remapped_velocity(1, 0) = 1.5;
  const LinearElastic<double> material{200, 100};
  kernel::UpdateStress<LinearBasis<1, double>, LinearElastic<double>, DeterminantVolume, 1, double, Host>{
      particles, nodes, cell_1d, material, {}, position_velocity, 0.5}(0);
  CHECK(particles.position(0, 0) == 1.5 + 0.5 * (position_velocity == PositionVelocity::grid ? 5 : 1.125));
  CHECK(particles.volume(0) == 2 * 1.125);
  CHECK(particles.cauchy_stress(0, 0) == 10 + 400 * 0.125);
  CHECK(particles.cauchy_stress(0, 1) == 1000 + 200 * 0.125);
  CHECK(particles.cauchy_stress(0, 2) == 1000 + 200 * 0.125);
  CHECK(particles.velocity(0, 0) == 3);
}

TEST_CASE("LocateParticle") {
  const LinearBasis<1, double> basis{UniformGrid<1, double>({{0}}, {{1}}, {{10}})};
  const auto particles = allocate_particles<1, double, Host>(4).particles;
  const double positions[] = {3.5, 9.99, -0.5, 3.5};
  for (int p = 0; p < 4; ++p) particles.position(p, 0) = positions[p];
  const ParticleBins<Host>::Ints bin("vsb::bin", 4);
  Kokkos::deep_copy(bin, 3);
  const kernel::LocateParticle<LinearBasis<1, double>, Particles<1, double, Host>, Host> functor{particles,
                                                                                                 basis, bin};
  const auto found = [&](int p) {
    int minimum = 1;
    functor(p, minimum);
    return minimum;
  };
  CHECK(found(0) == 1);
  CHECK(found(1) == 0);
  CHECK(bin(1) == 9);
  CHECK(found(1) == 1);
  CHECK(found(2) == 2 - 4);
  CHECK(bin(2) == 3);
  int minimum = -4;  // particle 0 lost, found by another thread
  functor(2, minimum);
  CHECK(minimum == -4);
}

TEST_CASE("the functors of the sort") {
  auto bins = allocate_bins<Host>(6, 4);
  const int bin[] = {3, 1, 3, 1, 3, 3};
  for (int p = 0; p < 6; ++p) bins.bin(p) = bin[p];
  for (int p = 0; p < 6; ++p) kernel::CountInBin<Host>{bins}(p);
  int sum = 0;
  for (int b = 0; b < 4; ++b) kernel::ScanOffsets<Host>{bins}(b, sum, true);
  const int offset[] = {0, 0, 2, 2, 6};
  for (int b = 0; b < 5; ++b) CHECK(bins.offset(b) == offset[b]);
  for (const int p : {5, 3, 2, 0, 1, 4}) kernel::OrderByBin<Host>{bins}(p);  // as threads may come
  const int placed[] = {3, 1, 5, 2, 0, 4};
  for (int i = 0; i < 6; ++i) CHECK(bins.order(i) == placed[i]);
  sum = 0;
  for (int b = 0; b < 4; ++b) kernel::ScanOccupied<Host>{bins}(b, sum, true);
  CHECK(sum == 2);
  CHECK(bins.occupied(0) == 1);
  CHECK(bins.occupied(1) == 3);
  const int slot[] = {-1, 0, -1, 1}, sorted[] = {1, 3, 0, 2, 4, 5};
  for (int b = 0; b < 4; ++b) CHECK(bins.slot(b) == slot[b]);
  for (int s = 0; s < 2; ++s) kernel::SortBin<Host>{bins}(s);
  for (int i = 0; i < 6; ++i) CHECK(bins.order(i) == sorted[i]);
}

TEST_CASE("SumBin and SumNode") {
  // Three nodes in a line, particles 0 and 2 between the first two, 1 between the last two.
  const LinearBasis<1, double> basis{UniformGrid<1, double>({{0}}, {{1}}, {{2}})};
  auto bins = allocate_bins<Host>(3, 3);
  const int order[] = {0, 2, 1}, offset[] = {0, 2, 3, 3}, slot[] = {0, 1, -1};
  std::copy(order, order + 3, bins.order.data());
  std::copy(offset, offset + 4, bins.offset.data());
  std::copy(slot, slot + 3, bins.slot.data());
  bins.occupied(0) = 0, bins.occupied(1) = 1;
  const ScatterWorkspace<double, Host>::Target sums("vsb::sums", 2, 2), target("vsb::target", 3, 1);
  Kokkos::deep_copy(target, 99);
  for (int s = 0; s < 2; ++s) kernel::SumBin<NumberedContribution, 2, double, Host>{{}, bins, sums}(s);
  CHECK(sums(0, 0) == 1 + 3);
  CHECK(sums(0, 1) == 10 + 30);
  CHECK(sums(1, 0) == 2);
  CHECK(sums(1, 1) == 20);
  for (int node = 0; node < 3; ++node)
    kernel::SumNode<LinearBasis<1, double>, 1, double, Host>{basis, bins, sums, target}(node);
  CHECK(target(0, 0) == 4);
  CHECK(target(1, 0) == 40 + 2);
  CHECK(target(2, 0) == 20);
}

TEST_CASE("bits of rows of cells and nodes") {
  CHECK(kernel::valid_bits(0, 3) == 7);
  CHECK(kernel::valid_bits(0, 64) == ~std::uint64_t(0));
  CHECK(kernel::valid_bits(1, 64) == 0);
  CHECK(kernel::valid_bits(1, 65) == 1);

  const std::uint64_t top = std::uint64_t(1) << 63;
  const BitRows<1> tiling(UniformGrid<1, double>({{0}}, {{1}}, {{130}}));
  CHECK(tiling.words == 3);
  const CellBits<Host>::Rows bits("vsb::bits", 1, 3);
  bits(0, 0) = top, bits(0, 1) = 4, bits(0, 2) = 1;
  const auto dilated = [&](int w, bool both) {
    return kernel::dilated_word(bits, tiling, w, {{0, 0}}, {{0, 0}}, both ? 1 : 0, 1);
  };
  CHECK(dilated(0, false) == top);
  CHECK(dilated(0, true) == (top | top >> 1));
  CHECK(dilated(1, false) == (1 | 4 | 8));           // 1 carried from the first word
  CHECK(dilated(1, true) == (1 | 2 | 4 | 8 | top));  // top carried from the last
  CHECK(dilated(2, true) == 3);
}

TEST_CASE("MarkOccupied, FindExterior, FindBoundary and MarkNodes in a row of five cells") {
  const UniformGrid<1, double> grid({{0}}, {{1}}, {{5}});
  const auto particles = allocate_particles<1, double, Host>(2).particles;
  particles.position(0, 0) = 2.5;
  particles.position(1, 0) = 3.5;
  const auto bits = allocate_cell_bits<Host>(grid);
  const BitRows<1> tiling(grid);
  using Mark = kernel::MarkOccupied<UniformGrid<1, double>, 1, double, Host>;
  for (int p = 0; p < 2; ++p) Mark{particles, grid, bits.occupied}(p);
  CHECK(bits.occupied(0, 0) == 0b01100);
  kernel::FindExterior<1, Host>{bits, tiling}(0);
  CHECK(bits.exterior(0, 0) == 0b10010);
  kernel::FindBoundary<1, Host>{bits, tiling}(0);
  CHECK(bits.boundary(0, 0) == 0b11110);
  const BoundaryNodes<Host> tractions("vsb::tractions", 6), boundary("vsb::boundary", 6);
  Kokkos::deep_copy(tractions, 5u);
  tractions(3) = 0;
  int count = 10;
  kernel::MarkNodes<1, Host>{bits, tiling, 0, tractions, boundary, 0u}(0, count);
  CHECK(count == 12);
  const TractionMask expected[] = {0, 0, 5, 0, 5, 0};  // active nodes 2, 3, 4; none declared at 3
  for (int node = 0; node < 6; ++node) CHECK(boundary(node) == expected[node]);

  // Without boundary cells traction 2 acts at the active nodes all the same, where it is declared.
  Kokkos::deep_copy(bits.boundary, std::uint64_t(0));
  count = 0;
  kernel::MarkNodes<1, Host>{bits, tiling, 0, tractions, boundary, 4u}(0, count);
  CHECK(count == 2);
  for (int node = 0; node < 6; ++node) CHECK(boundary(node) == (expected[node] & 4u));
}

TEST_CASE("NodeBalance, StrainEnergy and SumChunk") {
  const auto nodes = allocate_nodes<1, double, Host>(2);
  const Nodes<1, double, Host>::Fields bare("vsb::bare", 2, 3);
  nodes.force(1, 0) = 5;
  bare(1, 2) = 3;
  nodes.mass(1) = 2;
  nodes.momentum(1, 0) = 6;
  const kernel::NodeBalance<1, double, Host> balance{nodes, bare};
  auto sum = Vector<3, double>::zero();
  balance(1, sum);
  CHECK(sum[0] == 25);
  CHECK(sum[1] == 9);
  CHECK(sum[2] == 9);
  nodes.fixed_components(1) = 1;
  balance(1, sum);
  CHECK(sum[0] == 25);
  CHECK(sum[1] == 18);
  CHECK(sum[2] == 9);
  balance(0, sum);  // a node without mass adds nothing
  CHECK(sum[2] == 9);

  const auto plane = allocate_nodes<2, double, Host>(4);
  const Nodes<2, double, Host>::Fields plane_bare("vsb::bare", 4, 5);
  plane.force(3, 0) = 2;
  plane.force(3, 1) = 5;
  const kernel::NodeBalance<2, double, Host> in_plane{plane, plane_bare};
  auto free = Vector<3, double>::zero();
  in_plane(3, free);
  CHECK(free[0] == 0);  // without mass the force acts on nothing
  plane.mass(3) = 1;
  in_plane(3, free);
  CHECK(free[0] == 29);

  const auto particles = allocate_particles<2, double, Host>(3).particles;
  particles.volume(2) = 8;
  for (int c = 0; c < 4; ++c) particles.cauchy_stress(2, c) = c + 1;
  auto energy = Vector<1, double>::zero();
  kernel::StrainEnergy<2, double, Host>{particles, 1, 100}(1, energy);
  CHECK_THAT(energy[0],
             WithinRel(4 * 46. / 100, 1e-15));  // |sigma|^2 = 1 + 4 + 9 + 2 16 over 2 M, times 8 m^2

  struct Term {
    KOKKOS_FUNCTION void operator()(int i, Vector<1, double>& s) const { s[0] += i; }
  };
  const Kokkos::View<double**, Kokkos::LayoutRight, Host> partial("vsb::partial", 2, 1);
  kernel::SumChunk<1, Term, Host>{{}, 1030, partial}(1);
  CHECK(partial(1, 0) == 1024 + 1025 + 1026 + 1027 + 1028 + 1029);
}

TEST_CASE("CheckParticle names the first spoilt field") {
  const auto particles = allocate_particles<2, double, Host>(1).particles;
  particles.volume(0) = 1;
  const kernel::CheckParticle<2, double, Host> check{particles};
  CHECK(check.field(0) == ParticleField::none);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0., -1., infinity, std::numeric_limits<double>::quiet_NaN()}) {
    particles.volume(0) = bad;
    CHECK(check.field(0) == ParticleField::volume);
  }
  particles.cauchy_stress(0, 3) = -infinity;
  CHECK(check.field(0) == ParticleField::cauchy_stress);
  particles.velocity(0, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK(check.field(0) == ParticleField::velocity);
  particles.position(0, 1) = infinity;
  CHECK(check.field(0) == ParticleField::position);
  int lowest = 7;
  check(0, lowest);
  CHECK(lowest == 0);
}
