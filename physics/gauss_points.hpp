// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Gauss-Legendre points and weights on [0, 1].
#pragma once

#include <vsb/views/tensor.hpp>

namespace vsb {

/// The rule of `count` points on [0, 1], exact for polynomials up to degree 2 count - 1.
template <class T>
struct GaussPoints {
  int count;    ///< 1 to 4
  T point[4];   ///< in [0, 1]
  T weight[4];  ///< their sum is 1

  /// n = 1 to 4 points, exact for polynomials of degree 2 n - 1.
  KOKKOS_FUNCTION explicit GaussPoints(int n) : count(n) {
    if (n == 1) {
      set(0, T(0), T(2));
    } else if (n == 2) {
      set_pair(0, T(0.57735026918962576451), T(1));
    } else if (n == 3) {
      set_pair(0, T(0.77459666924148337704), T(5) / T(9));
      set(2, T(0), T(8) / T(9));
    } else {
      set_pair(0, T(0.33998104358485626480), T(0.65214515486254614263));
      set_pair(2, T(0.86113631159405257522), T(0.34785484513745385737));
    }
  }

 private:
  /// Point and weight on [-1, 1].
  KOKKOS_FUNCTION void set(int i, T x, T w) {
    point[i] = (T(1) + x) / 2;
    weight[i] = w / 2;
  }
  KOKKOS_FUNCTION void set_pair(int i, T x, T w) {
    set(i, -x, w);
    set(i + 1, x, w);
  }
};

}  // namespace vsb
