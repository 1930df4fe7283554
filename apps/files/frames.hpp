// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Frames as VTKHDF 1.0 files: particles as vertices, the grid as a mesh of its cells.
#pragma once

#include <string>

#include "engine/simulation.hpp"
#include "files/hdf5_file.hpp"

namespace vsb::app {

/// Which program and which scene made a file; a group of its own, which VTK ignores.
void write_provenance(Hdf5Writer& file, const Scene& scene);

/// The fields that the scene asks for, one after the other, and those of its exact solution, where it names
/// one, as exact_displacement and exact_cauchy_stress.
void write_particle_frame(const std::string& path, const Scene& scene, const ParticleReader& particles);

void write_grid_frame(const std::string& path, const Scene& scene, const GridSnapshot& grid, double time);

}  // namespace vsb::app
