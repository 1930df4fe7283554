// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The simulations that the program can make, one for each precision and basis, in all dimensions; the
/// particle kernels of each are compiled on their own, from basis_instance.cpp.in.
#pragma once

#include "engine/simulation.hpp"

namespace vsb::app {

enum class InstanceOf { linear, linear_float, mapped, ugimp, quadratic_bspline };

template <InstanceOf instance>
std::unique_ptr<Simulation> make_instance(const Scene& scene, PlacedParticles* placed);

}  // namespace vsb::app
