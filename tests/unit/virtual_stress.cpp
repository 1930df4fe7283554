// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Virtual stress fields.
#include <vsb/physics/virtual_stress.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

TEMPLATE_TEST_CASE_SIG("a pressure is minus the identity, all three normal components", "", ((int Dim), Dim),
                       1, 2, 3) {
  const auto s = pressure_stress<Dim>(2.5);
  for (int c = 0; c < symmetric_components(Dim); ++c) CHECK(s[c] == (c < 3 ? -2.5 : 0));
}

TEMPLATE_TEST_CASE_SIG("the tractions of a mask add up", "", ((int Dim, typename Real), Dim, Real),
                       (1, double), (2, float), (3, double)) {
  UniformVirtualStress<Dim, Real> field;
  field.count = 8;
  for (int k = 0; k < 8; ++k)
    for (int c = 0; c < symmetric_components(Dim); ++c)
      field.stress[k][c] = static_cast<Real>((1 << k) * (c + 1));  // each sum of them is unique
  const auto x = Vector<Dim, Real>::zero();
  for (TractionMask mask = 0; mask < 256; ++mask) {
    const auto value = field.at(x, mask);
    for (int c = 0; c < symmetric_components(Dim); ++c)
      CHECK(value.stress[c] == static_cast<Real>(mask) * static_cast<Real>(c + 1));
    for (int i = 0; i < Dim; ++i) CHECK(value.divergence[i] == 0);
  }
  field.count = 2;
  CHECK(field.at(x, 0xFFFFFFFFu).stress[0] == 3);
  field.count = 0;
  CHECK(field.at(x, 1).stress[0] == 0);
}

TEST_CASE("no virtual stress is zero, and says so at compile time") {
  static_assert(!NoVirtualStress::loaded && UniformVirtualStress<1, double>::loaded);
  const auto value = NoVirtualStress{}.at(Vector<2, double>{{1, 2}}, 0xFFFFFFFFu);
  for (int c = 0; c < 4; ++c) CHECK(value.stress[c] == 0);
  for (int i = 0; i < 2; ++i) CHECK(value.divergence[i] == 0);
}
