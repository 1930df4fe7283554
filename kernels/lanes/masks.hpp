// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Loops over the different traction masks of the nodes of a group of cell lanes.
#pragma once

#include <vsb/views/cell_lanes.hpp>

namespace vsb {

/// Calls work(mask, bits) for every traction mask that some of the group's nodes have. Node l of row r is
/// node[r] + l. Bit l of loaded[r] is set where it is loaded; bit l of bits[r] where it has the mask.
template <int Dim, int rows, class Tractions, class Work>
KOKKOS_FORCEINLINE_FUNCTION void for_each_mask(const LaneGroup<Dim>& group, const int (&node)[rows],
                                               const std::uint64_t (&loaded)[rows],
                                               const Tractions& tractions, const Work& work) {
  if (group.load != GroupLoad::mixed) {
    work(group.tractions, loaded);
    return;
  }
  std::uint64_t left[rows];
  for (int r = 0; r < rows; ++r) left[r] = loaded[r];
  while (true) {
    TractionMask mask = 0;
    for (int r = 0; r < rows && mask == 0; ++r)
      for (int l = 0; l < 64 && mask == 0 && left[r] >> l != 0; ++l)
        if (left[r] >> l & 1) mask = tractions(node[r] + l);
    if (mask == 0) return;
    std::uint64_t bits[rows] = {};
    for (int r = 0; r < rows; ++r) {
      for (int l = 0; l < 64 && left[r] >> l != 0; ++l)
        if ((left[r] >> l & 1) && tractions(node[r] + l) == mask) bits[r] |= std::uint64_t(1) << l;
      left[r] &= ~bits[r];
    }
    work(mask, bits);
  }
}

}  // namespace vsb
