// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// 100 steps on cell lanes with the mean divergence are 100 steps of the particle kernels: linear functions
/// and B-splines, free and beside walls, every kind of material; and nothing like those without it.
#include "both_engines.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// A nearly incompressible body under a pressure that slides along a wall, or flies. Returns how far the
/// stress is from that of particles that strain by their own divergence.
template <class Engines, int Dim, class Real, class Material>
void check_averaged(const Material& material, bool at_a_wall) {
  const auto run = [&](Volumetric volumetric) {
    Engines engines({false, at_a_wall || sizeof(Real) == 4 ? 0. : 1., at_a_wall});
    if (at_a_wall) {
      engines.lanes.memory.walls.fixed[0][0] = 1;
      engines.options.gravity[0] = -5 * engines.amplitude;
    }
    constexpr int remembered = Material::template state_size<Dim>();
    if (remembered > 0) engines.remember(remembered);
    engines.declare_everywhere(1);
    engines.options.damping = Real(0.1);
    engines.options.dt /= 2;  // stiff in compression
    engines.options.volumetric = volumetric;
    UniformVirtualStress<Dim, Real> f;
    f.count = 1;
    f.stress[0] = pressure_stress<Dim>(2 * engines.amplitude);
    engines.run(material, DeterminantVolume{}, [&](int) { return f; });
    CAPTURE(at_a_wall, engines.moved);
    check_same(engines);
    return engines;
  };
  const auto averaged = run(Volumetric::averaged), full = run(Volumetric::full);
  CHECK(difference(read(averaged.copy), read(full.copy), averaged.grid).stress > 0.05);
}

template <int Dim, class Real>
void check_bases(bool at_a_wall) {
  const auto material = LinearElastic<Real>::from_young(100, 0.45);
  check_averaged<BothEngines<Dim, Real>, Dim, Real>(material, at_a_wall);
  check_averaged<BothEngines<Dim, Real, QuadraticBSplineBasis>, Dim, Real>(material, at_a_wall);
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("the mean divergence on cell lanes", "", ((int Dim, typename Real), Dim, Real),
                       (2, double), (3, double), (2, float)) {
  for (const bool at_a_wall : {false, true}) check_bases<Dim, Real>(at_a_wall);
}

TEST_CASE("the mean divergence on cell lanes, of materials that remember") {
  using Linear = BothEngines<2, double>;
  using Splines = BothEngines<2, double, QuadraticBSplineBasis>;
  const auto hencky = Hencky<double>::from_young(100, 0.45);
  const auto plastic = DruckerPrager<double>::von_mises(100, 0.3, 1, 0);
  check_averaged<Linear, 2, double>(hencky, true);
  check_averaged<Splines, 2, double>(hencky, true);
  check_averaged<Linear, 2, double>(plastic, true);
  check_averaged<Splines, 2, double>(plastic, true);
}
