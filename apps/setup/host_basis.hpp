// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The multilinear basis of a scene's grid for work on the host, such as on a snapshot, whose positions are
/// those of the scene.
#pragma once

#include "scene/scene.hpp"
#include "setup/basis_of.hpp"

namespace vsb::app {

/// Calls work(basis) with the basis of the scene's dimension and grid, in double precision.
template <class Work>
void with_host_basis(const Scene& scene, const Work& work) {
  using Host = Kokkos::HostSpace::device_type;
  const auto in_dimension = [&](auto dimension) {
    constexpr int Dim = decltype(dimension)::value;
    if (scene.grid.mapped())
      work(OwnedBasis<MappedLinearBasis<Dim, double>, Host>(scene, Point{}).basis);
    else
      work(OwnedBasis<LinearBasis<Dim, double>, Host>(scene, Point{}).basis);
  };
  switch (scene.dimension) {
    case 1:
      return in_dimension(std::integral_constant<int, 1>());
    case 2:
      return in_dimension(std::integral_constant<int, 2>());
    default:
      return in_dimension(std::integral_constant<int, 3>());
  }
}

/// Where particle p of an array of positions (3 per particle) is.
template <int Dim>
Vector<Dim, double> position_of(const std::vector<double>& position, size_t p) {
  Vector<Dim, double> x;
  for (int i = 0; i < Dim; ++i) x[i] = position[3 * p + static_cast<size_t>(i)];
  return x;
}

}  // namespace vsb::app
