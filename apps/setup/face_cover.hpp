// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What particles cover of the faces of the grid that they stand on, for resultants
/// (kernels/readout/resultant.hpp), and how far those of a polar grid fill its cells.
#pragma once

#include "setup/place_particles.hpp"

namespace vsb::app {

/// A particle, and the box or sector of the lattice of which it is (a share of) the material.
struct LatticeParticle {
  Point position;
  double volume;
  Point middle, edges;  ///< of the box, m
};

/// Adds what particle `number` covers of faces on which its box stands, or the row of boxes below, where that
/// is not what its volume and distance say by themselves. With the section of the particle across its box, of
/// height H, taken as linear,
///   V = int A dy,  V d = int A y dy over 0 <= y <= H:   A(0) = V (4 H - 6 d) / H^2.
void add_covers(const Scene& scene, const BodySpec& body, const LatticeParticle& p, int number,
                std::vector<PlacedCover>& covers);

/// The volume of particles that fill the cells of the grid, over that of their sectors: the edges of a polar
/// grid's cells are chords of its arcs, sin(dtheta) / dtheta; else 1. Forces are sums over particles'
/// volumes: with those of the sectors the tractions on a polar grid would act on an area larger by dtheta /
/// sin(dtheta). Masses are those of the sectors.
double cell_filling(const Scene& scene, const BodySpec& body);

}  // namespace vsb::app
