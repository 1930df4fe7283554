// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What three cases of a series say of a figure that nobody knows exactly (Richardson):
///   f(h) = f* + C h^p,   (f1 - f2) / (f2 - f3) = (h1^p - h2^p) / (h2^p - h3^p),
///   f* = f3 + (f3 - f2) / ((h2 / h3)^p - 1).
#pragma once

#include <array>
#include <optional>
#include <string>

namespace vsb::app {

struct Convergence {
  std::optional<double> rate;          ///< p
  std::optional<double> extrapolated;  ///< f*
  std::string note;                    ///< why there is neither
};

/// Of three values at different h > 0, in any order.
Convergence convergence_of(std::array<double, 3> abscissae, std::array<double, 3> values);

}  // namespace vsb::app
