// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bit masks that nodes and lanes carry.
#pragma once

#include <cstdint>

namespace vsb {

/// Bit k says that traction k acts at a node: chi_I of the paper, for up to 32 tractions.
using TractionMask = std::uint32_t;

/// Bit i says that velocity component i is prescribed (zero) at a node.
using ComponentMask = std::uint8_t;

/// Bit l says something of lane l of a pack.
using LaneMask = std::uint32_t;

}  // namespace vsb
