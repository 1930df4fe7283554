// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bodies so thin that quadratic B-splines let them bend without strain.
///
/// Across a body that lies within one cell and reaches over its middle act the functions of four rows of
/// nodes. Where it has one or two rows of particles there, the nodes can move so that every row of particles
/// turns and bends without stretch, and slides past the other without shear: the stiffness has null vectors.
/// Three rows of particles leave none, nor does a second cell.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace vsb::app {

/// A sentence for each such body.
std::vector<std::string> thin_body_advice(const Scene& scene);

}  // namespace vsb::app
