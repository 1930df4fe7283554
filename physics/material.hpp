// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The materials and volume updates a body can choose from; the choice is made once per launch of a kernel,
/// by visiting.
#pragma once

#include <variant>
#include <vsb/physics/linear_elastic.hpp>

namespace vsb {

template <class Real>
using Material = std::variant<LinearElastic<Real>>;

using VolumeUpdate = std::variant<DeterminantVolume, ExponentialVolume>;

}  // namespace vsb
