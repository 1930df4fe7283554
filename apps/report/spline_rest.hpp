// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bodies that begin under a stress that varies, as that of their weight, with quadratic B-splines: whether
/// the particles' sums keep the balance that stress and weight have as fields.
///
/// At a node, sigma grad N + (div sigma) N is summed over the particles by the midpoint rule, whose error on
/// the quadratic pieces of N cancels inside the body. At a free surface and at a support it does not, where
/// the middles of the cells, at which the pieces meet, lie between two particles: an even number of them per
/// cell. The stress then settles by a share of what it varies by over a cell: with 2 particles 1/8 at a free
/// surface and 1/24 at a support, with 4 some 1/25 and 1/100. With 3 it is at rest to round-off.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace vsb::app {

/// A sentence for each body whose stress will settle.
std::vector<std::string> spline_rest_advice(const Scene& scene);

}  // namespace vsb::app
