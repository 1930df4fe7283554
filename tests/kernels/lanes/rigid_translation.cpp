// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A body without load or stress that moves as a whole stays without stress, but for round-off, wherever its
/// particles pass the faces of cells: jittered, on a lattice whose particles come to lie on faces to the last
/// bit, and just beside them. Particle kernels and cell lanes, linear functions and B-splines.

#include <common_steps.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

enum class Arrangement { jittered, on_faces, beside_faces };

/// A block of 4 cells in every direction, density and modulus about 1.
template <int Dim, class Real>
ParticleBlock<Dim, Real, Device> make_body(const UniformGrid<Dim, Real>& grid, Arrangement arrangement,
                                           const Vector<3, double>& step, unsigned seed) {
  auto block = fill_cells<Dim, Real>(grid, 2, Real(1), [&](const Vector<Dim, int>& cell) {
    for (int i = 0; i < Dim; ++i)
      if (cell[i] < 10 || cell[i] >= 14) return false;
    return true;
  });
  Random random(seed);
  edit(block, [&](const auto& p) {
    for (int k = 0; k < p.count(); ++k) {
      for (int i = 0; i < Dim; ++i) {
        if (arrangement == Arrangement::jittered)
          p.position(k, i) += grid.spacing[i] * random.draw<Real>(-0.2, 0.2);
        if (arrangement == Arrangement::beside_faces) {  // 0.1 to 1e-17 cells beside, on either side
          const Real face = p.position(k, i) + grid.spacing[i] * Real(0.25) * (random.index(2) ? 1 : -1);
          const double away = std::pow(10., -random(1, 17)) * (random.index(2) ? 1 : -1);
          p.position(k, i) = face + grid.spacing[i] * static_cast<Real>(away);
        }
        p.velocity(k, i) = static_cast<Real>(step[i]) * grid.spacing[i];
      }
      p.mass(k) *= random.draw<Real>(0.9, 1.1);
    }
  });
  return block;
}

template <int Dim, class Real>
double largest_stress(const ParticleBlock<Dim, Real, Device>& block) {
  const auto p = read(block);
  double most = 0;
  for (int k = 0; k < p.count(); ++k)
    for (int c = 0; c < p.stress_size; ++c) {
      const double s = std::abs(static_cast<double>(p.cauchy_stress(k, c)));
      most = s <= most ? most : std::isfinite(s) ? s : 1e300;
    }
  return most;
}

/// A wave crosses a third of the smallest cell in a step of 1 s.
constexpr double modulus = 0.005;

/// The same body on both engines.
template <int Dim, class Real, template <int, class> class BasisOf,
          template <int, class, class> class StateOf>
struct Translation {
  ParticleBlock<Dim, Real, Device> block, copy;  ///< of the particle kernels, of cell lanes
  LinearElastic<Real> material = LinearElastic<Real>::from_young(modulus, 0.25);
  BasisOf<Dim, Real> basis;
  StateOf<Dim, Real, Device> lanes;
  State<Dim, Real, Device> state;
  StepOptions<Dim, Real> options;

  Translation(const ParticleBlock<Dim, Real, Device>& body, const UniformGrid<Dim, Real>& grid,
              RemapMethod remap_method)
      : block(body), copy(allocate_particles<Dim, Real, Device>(body.particles.count())) {
    Kokkos::deep_copy(copy.block, block.block);
    basis.grid = grid;
    set_grid(lanes, grid);
    if constexpr (BasisOf<Dim, Real>::ghost_layers > 0) basis.grid = with_ghost_layer(grid);
    lanes.memory.remap_method = remap_method;
    options.dt = 1;
    state = make_state(block.particles, basis);
    REQUIRE(pack_lanes(Exec(), copy.particles, lanes) == -1);
    prepare_lane_step(Exec(), lanes, NoVirtualStress{});
  }
  void step() {
    const std::vector<Body<Real>> bodies{{0, block.particles.count(), material}};
    REQUIRE(vsb::step(Exec(), state, bodies, basis, NoVirtualStress{}, options) == -1);
    REQUIRE(lane_step(Exec(), lanes, material, DeterminantVolume{}, NoVirtualStress{}, options) == -1);
  }
  void read_back() { unpack_particles(Exec(), lanes.memory, copy.particles); }
};

/// Largest strains in the course of a run.
struct Strains {
  double particles, lanes;
};

template <int Dim, class Real, template <int, class> class BasisOf,
          template <int, class, class> class StateOf>
Strains translate(Arrangement arrangement, const Vector<3, double>& step, RemapMethod remap_method,
                  int steps) {
  const auto grid = make_grid<Dim, Real>({{24, 24, 24}});
  Translation<Dim, Real, BasisOf, StateOf> run(make_body<Dim, Real>(grid, arrangement, step, 1), grid,
                                               remap_method);
  Strains most{0, 0};
  for (int n = 0; n < steps; ++n) {
    run.step();
    if (n % 8 != 7 && n + 1 < steps) continue;
    run.read_back();
    most.particles = std::max(most.particles, largest_stress(run.block) / modulus);
    most.lanes = std::max(most.lanes, largest_stress(run.copy) / modulus);
  }
  return most;
}

template <int Dim, class Real, template <int, class> class BasisOf,
          template <int, class, class> class StateOf>
void check_no_stress(std::initializer_list<RemapMethod> variants) {
  // In cells per step: on faces all lie again and again, in the others none does but by chance. And a first
  // step from a face as small as loads that set in gently make it.
  const Vector<3, double> dyadic{{1. / 64, -1. / 32, 1. / 64}}, decimal{{0.0123, -0.0317, 0.0211}},
      tiny{{1e-20, -3e-21, 1e-22}};
  constexpr int steps = 128;
  for (const Arrangement arrangement :
       {Arrangement::jittered, Arrangement::on_faces, Arrangement::beside_faces})
    for (const auto& step : {dyadic, decimal, tiny})
      for (const RemapMethod remap_method : variants) {
        const auto most = translate<Dim, Real, BasisOf, StateOf>(arrangement, step, remap_method, steps);
        CAPTURE(static_cast<int>(arrangement), step[0], remap_method == RemapMethod::mass_matrix);
        // Every step rounds the velocities at 2^Dim nodes or more, some times, to epsilon.
        const double round_off = steps * 0.03 * epsilon<Real>;
        CHECK(most.particles < round_off);
        CHECK(most.lanes < round_off);
      }
}

/// The root mean square of the differences in stress.
template <int Dim, class A, class B>
double distance(const ParticleBlock<Dim, A, Device>& a, const ParticleBlock<Dim, B, Device>& b) {
  const auto p = read(a);
  const auto q = read(b);
  double sum = 0;
  for (int k = 0; k < p.count(); ++k)
    for (int c = 0; c < p.stress_size; ++c)
      sum += std::pow(static_cast<double>(p.cauchy_stress(k, c)) - static_cast<double>(q.cauchy_stress(k, c)),
                      2);
  return std::sqrt(sum / (p.count() * p.stress_size));
}

/// A body that shakes as it flies, in single precision, beside the same one in double.
template <int Dim, template <int, class> class BasisOf, template <int, class, class> class StateOf>
void check_single_precision() {
  const Vector<3, double> step{{0.0123, -0.0317, 0.0211}};
  const auto grid = make_grid<Dim, float>({{24, 24, 24}});
  const auto body = make_body<Dim, float>(grid, Arrangement::jittered, step, 3);
  Random random(4);
  edit(body, [&](const auto& p) {
    for (int k = 0; k < p.count(); ++k)
      for (int i = 0; i < Dim; ++i) p.velocity(k, i) += grid.spacing[i] * random.draw<float>(-1e-3, 1e-3);
  });
  const auto same = allocate_particles<Dim, double, Device>(body.particles.count());
  const auto from = read(body);
  edit(same, [&](const auto& p) {
    for (int k = 0; k < p.count(); ++k) {
      for (int i = 0; i < Dim; ++i) {
        p.position(k, i) = static_cast<double>(from.position(k, i));
        p.velocity(k, i) = static_cast<double>(from.velocity(k, i));
      }
      p.mass(k) = static_cast<double>(from.mass(k));
      p.volume(k) = static_cast<double>(from.volume(k));
    }
  });
  Translation<Dim, float, BasisOf, StateOf> single(body, grid, RemapMethod::second_sweep);
  Translation<Dim, double, BasisOf, StateOf> exact(same, make_grid<Dim, double>({{24, 24, 24}}),
                                                   RemapMethod::second_sweep);
  double particles = 0, lanes = 0, engines = 0, scale = 0;
  for (int n = 0; n < 96; ++n) {
    single.step();
    exact.step();
    if (n % 8 != 7) continue;
    single.read_back();
    exact.read_back();
    particles = std::max(particles, distance<Dim>(exact.block, single.block));
    lanes = std::max(lanes, distance<Dim>(exact.block, single.copy));
    engines = std::max(engines, distance<Dim>(exact.block, exact.copy));
    scale = std::max(scale, largest_stress(exact.block));
  }
  CAPTURE(particles / scale, lanes / scale, engines / scale);
  CHECK(scale > 1e-3 * modulus);  // it does shake
  CHECK(engines < 1e-11 * scale);
  CHECK(particles > 1e-7 * scale);
  CHECK(lanes < 1.6 * particles);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("a rigid translation leaves no stress", "", ((int Dim, typename Real), Dim, Real),
                       (1, double), (2, double), (3, double), (2, float), (3, float)) {
  check_no_stress<Dim, Real, LinearBasis, LaneState>({RemapMethod::second_sweep, RemapMethod::mass_matrix});
}

TEMPLATE_TEST_CASE_SIG("a rigid translation leaves no stress with splines", "",
                       ((int Dim, typename Real), Dim, Real), (2, double), (2, float)) {
  check_no_stress<Dim, Real, QuadraticBSplineBasis, SplineLaneState>({RemapMethod::second_sweep});
}

TEMPLATE_TEST_CASE_SIG("single precision is as near to double on cell lanes as with the particle kernels", "",
                       ((int Dim), Dim), 1, 2, 3) {
  check_single_precision<Dim, LinearBasis, LaneState>();
}

TEST_CASE("single precision is as near to double on cell lanes as with the particle kernels, with splines") {
  check_single_precision<2, QuadraticBSplineBasis, SplineLaneState>();
}
