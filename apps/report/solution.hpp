// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What is done with a scene.
#pragma once

namespace vsb::app {

enum class Solution {
  steps,         ///< time steps
  static_state,  ///< the static state under the final loads, run/run_static.hpp
  balance        ///< the balance of the initial state under the final loads, run/run_balance.hpp
};

}  // namespace vsb::app
