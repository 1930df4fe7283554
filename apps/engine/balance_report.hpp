// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The balance of an engine in the terms of the scene.
#pragma once

#include <vsb/kernels/readout/balance.hpp>
#include "engine/simulation.hpp"
#include "setup/loads.hpp"

namespace vsb::app {

/// b: under the loads of time t, s; `about`: a position of the scene to which the torques are moved from
/// `origin`, about which the kernels count them; exact: of each traction at full load, about that position.
template <int Dim>
BalanceReport report_balance(const Scene& scene, const Balance<Dim>& b, const Point& origin,
                             const Point& about, const std::vector<Resultant>& exact, double t) {
  BalanceReport report;
  report.force_ratio = b.force_ratio();
  report.energy_ratio = b.strain_energy > 0 ? b.kinetic_energy / b.strain_energy : 1.0;
  for (int i = 0; i < Dim; ++i) report.net_force[static_cast<size_t>(i)] = b.net_force[i];
  report.torque_about = about;
  Point arm;
  for (size_t i = 0; i < 3; ++i) arm[i] = about[i] - origin[i];
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3, l = (i + 2) % 3;
    report.net_torque[i] =
        b.net_torque[static_cast<int>(i)] - (arm[j] * report.net_force[l] - arm[l] * report.net_force[j]);
    for (size_t k = 0; k < scene.tractions.size(); ++k) {
      const double factor = scene.tractions[k].time(t);
      report.exact_force[i] += factor * exact[k].force[i];
      report.exact_torque[i] += factor * exact[k].torque[i];
    }
  }
  return report;
}

}  // namespace vsb::app
