// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Tractions that particles carry: where they act, in both engines, as a body moves on through the grid.
#include <set>

#include "both_engines.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// Runs a body that drifts by more than a cell. Traction 0 is declared everywhere, so that it marks N1;
/// traction 2 is carried by the particles that begin beyond cell 16 of x.
template <int Dim, class Real, template <int, class> class BasisOf = LinearBasis>
void check_carried() {
  BothEngines<Dim, Real, BasisOf> body({false, 0, false});
  const int n = body.block.particles.count();
  const auto cell_of = [&](const auto& p, int k) {
    Vector<Dim, Real> x;
    for (int i = 0; i < Dim; ++i) x[i] = p.position(k, i);
    return body.grid.cell_containing(x);
  };
  body.carried.particle = Kokkos::View<TractionMask*, Device>("vsb::carried", static_cast<size_t>(n));
  body.carried.tractions = 4;
  std::vector<bool> carries(static_cast<size_t>(n));
  const Real drift = Real(1.7) * body.grid.spacing[0] / (60 * body.options.dt);
  edit(body.block, [&](const auto& p) {
    for (int k = 0; k < n; ++k) {
      carries[static_cast<size_t>(k)] = cell_of(p, k)[0] > 16;
      p.velocity(k, 0) += drift;
    }
  });
  edit(body.carried.particle, [&](const auto& host) {
    for (size_t k = 0; k < carries.size(); ++k) host(k) = carries[k] ? 4 : 0;
  });
  body.declare([](const Vector<Dim, int>&) { return 1u; });
  UniformVirtualStress<Dim, Real> field;
  field.count = 3;
  for (auto& stress : field.stress) stress = SymmetricTensor<Dim, Real>::zero();
  field.stress[2] = pressure_stress<Dim>(body.amplitude * Real(0.1));
  body.run(
      elastic<Dim, Real>(), DeterminantVolume{}, [&](int) { return field; }, 60);
  CHECK(body.moved > 0);
  body.check_boundary();

  // Written out: bit 2 is at the nodes of N1 around which, within the support of the basis, a carrier is.
  std::set<int> near;
  const auto p = read(body.block);
  const int ghost_layers = BasisOf<Dim, Real>::ghost_layers;
  const auto& nodes = body.basis.grid;
  for (int k = 0; k < n; ++k) {
    if (!carries[static_cast<size_t>(k)]) continue;
    const auto cell = cell_of(p, k);
    const int width = 2 + 2 * ghost_layers, around = Dim == 1   ? width
                                                     : Dim == 2 ? width * width
                                                                : width * width * width;
    for (int a = 0; a < around; ++a) {
      auto ijk = cell;
      for (int i = 0, digits = a; i < Dim; ++i, digits /= width)
        ijk[i] += digits % width;  // less ghost_layers, and
                                   // the ghost layer
      near.insert(nodes.node_index(ijk));
    }
  }
  const auto boundary = read(body.state.occupancy.boundary);
  int wrong = 0, carried = 0, others = 0;
  for (int I = 0; I < nodes.node_count(); ++I) {
    const TractionMask mask = boundary(static_cast<size_t>(I));
    const bool in_n1 = mask & 1, expected = in_n1 && near.count(I) > 0;
    wrong += expected != ((mask & 4) != 0);
    carried += expected;
    others += in_n1 && !expected;
  }
  CHECK(wrong == 0);
  CHECK(carried > 0);
  CHECK(others > 0);
}

}  // namespace

TEST_CASE("carried tractions act where their particles are, in both engines") {
  check_carried<1, double>();
  check_carried<2, double>();
  check_carried<2, float>();
  check_carried<3, double>();
  check_carried<1, double, QuadraticBSplineBasis>();
  check_carried<2, double, QuadraticBSplineBasis>();
  check_carried<3, double, QuadraticBSplineBasis>();
}
