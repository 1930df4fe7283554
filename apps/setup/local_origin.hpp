// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The local origin: from where the kernels count positions. A scene may lie far from the origin of its
/// coordinates, as on a map, where numbers are large and what tells positions apart is small: single
/// precision tells 4,200,000.25 m from no position nearer than half a metre. The kernels then count from the
/// lower corner of the grid. Scenes, frames and messages know nothing of it: their positions are those of the
/// scene.
#pragma once

#include <type_traits>

#include "scene/scene.hpp"

namespace vsb::app {

/// Along each axis the lower end of the grid where the grid lies farther from 0 than it is long, so that the
/// difference of two coordinates is exact; else 0, as counting from the corner would gain nothing there. 0
/// everywhere where a traction's field knows its position by the scene's origin (EllipseSpec).
Point local_origin(const Scene& scene);

/// A field with its positions counted from `origin`.
StressFieldSpec seen_from(const Point& origin, const StressFieldSpec& field);

/// A position of the scene as a vector of the kernels, and back.
template <class Vector>
Vector to_local(const Point& x, const Point& origin) {
  Vector local;
  for (int i = 0; i < Vector::size; ++i) {
    const auto axis = static_cast<size_t>(i);
    local[i] = static_cast<std::decay_t<decltype(local[i])>>(x[axis] - origin[axis]);
  }
  return local;
}
template <class Vector>
Point to_scene(const Vector& local, const Point& origin) {
  Point x{};
  for (int i = 0; i < Vector::size; ++i)
    x[static_cast<size_t>(i)] = origin[static_cast<size_t>(i)] + static_cast<double>(local[i]);
  return x;
}

/// "(1, 2.5) m", with so many digits, and with enough of them to tell hundredths of a cell apart.
std::string position_text(const Scene& scene, const Point& x, int digits = 6);

/// Refuses a grid of which single precision cannot tell the positions apart: so many cells along an axis that
/// round-off is a share of a cell, or of what a particle moves in a step. Cell lanes count from the
/// particle's own cell. Throws SetupError.
void refuse_unresolved_positions(const Scene& scene, bool on_cell_lanes);

}  // namespace vsb::app
