// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Numbers and packs under one name, lane by lane, for tests that run with both.
#pragma once

#include <vsb/views/pack.hpp>

#include "support.hpp"

namespace vsb::test {

/// One lane of a number or of a pack.
inline double lane(double x, int) {
  return x;
}
template <class T, int W>
double lane(Pack<T, W> x, int l) {
  return static_cast<double>(x[l]);
}
template <class T>
struct Traits {
  using real = T;
  static constexpr int width = 1;
  static T draw(Random& random, double low, double high) { return random.draw<T>(low, high); }
};
template <class T, int W>
struct Traits<Pack<T, W>> {
  using real = T;
  static constexpr int width = W;
  static Pack<T, W> draw(Random& random, double low, double high) {
    Pack<T, W> p;
    for (int l = 0; l < W; ++l) p.set(l, random.draw<T>(low, high));
    return p;
  }
};

template <int Dim, class T>
Vector<Dim, T> draw_vector(Random& random, double low, double high) {
  Vector<Dim, T> v;
  for (int i = 0; i < Dim; ++i) v[i] = Traits<T>::draw(random, low, high);
  return v;
}

}  // namespace vsb::test
