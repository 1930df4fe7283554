// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Checks that the bins of a basis, their points and the nodes that those reach belong together.
#pragma once

#include <set>

#include "support.hpp"

namespace vsb::test {

/// The nodes of the bin are those of a point in it, in the same order, and each knows the bin.
template <class Basis, class Point>
void check_nodes_of_bin(const Basis& basis, int bin, const Point& x) {
  const auto shape = basis.shape(x);
  for (int a = 0; a < basis.support; ++a) {
    CHECK(basis.node_of_bin(bin, a) == shape.node[a]);
    CHECK(basis.bin_of_node(shape.node[a], a) == bin);
  }
}

/// The nodes ask the bins that points may lie in, all of them, and no others: none beyond a face.
template <class Basis>
void check_bins_of_nodes(const Basis& basis, const std::set<int>& bins) {
  int pairs = 0;
  for (int node = 0; node < basis.node_count(); ++node)
    for (int a = 0; a < basis.support; ++a) {
      const int bin = basis.bin_of_node(node, a);
      if (bin < 0) continue;
      ++pairs;
      CHECK(bins.count(bin) == 1);
      CHECK(basis.node_of_bin(bin, a) == node);
    }
  CHECK(pairs == static_cast<int>(bins.size()) * basis.support);
}

}  // namespace vsb::test
