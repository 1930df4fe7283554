// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Uses the shared library of boundary_nodes.cpp.
///   boundary_nodes_main  exits 0 when the nodes are those that one counts by hand
/// 5 x 5 cells with one particle each in the middle of 7 x 7 have 20 nodes on their edge and 12 beside them,
/// on the edge of the inner 3 x 3.
#include <cstdio>

extern "C" int count_boundary_nodes(double* x, int n, int cells);

int main() {
  double x[25][2];
  for (int p = 0; p < 25; ++p) {
    x[p][0] = 1.5 + p % 5;
    x[p][1] = 1.5 + p / 5;
  }
  const int found = count_boundary_nodes(x[0], 25, 7);
  std::printf("%d boundary nodes\n", found);
  return found == 32 ? 0 : 1;
}
