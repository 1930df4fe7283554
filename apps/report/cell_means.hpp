// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Means of the stress over the cells of the grid. The stress of a multilinear cell is first order accurate
/// wherever it is sampled, except near the cell's middle, where it is second order: a norm at cell means
/// tells the error of the method from that of the sampling.
#pragma once

#include <vector>

#include "engine/particle_reader.hpp"

namespace vsb::app {

/// Of every cell and body that has particles there, in the order of cells, the bodies of one cell in theirs.
struct CellMeans {
  std::vector<double> volume;    ///< of the particles, m^3: the weight in a norm
  std::vector<double> position;  ///< [3 per mean] mean position by volume: where the mean stress belongs, m
  std::vector<double> cauchy_stress;  ///< [6 per mean] mean by volume, Pa
};

CellMeans cell_means(const Scene& scene, const ParticleReader& particles);

}  // namespace vsb::app
