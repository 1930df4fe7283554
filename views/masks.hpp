// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bit masks that nodes and lanes carry.
#pragma once

#include <cstdint>

namespace vsb {

/// Bit k: traction k acts at a node; chi_I of the paper, for up to 32 tractions.
using TractionMask = std::uint32_t;

/// Bit i: velocity component i is prescribed (zero) at a node.
using ComponentMask = std::uint8_t;

/// Bit l: a property of lane l of a pack.
using LaneMask = std::uint32_t;

}  // namespace vsb
