// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a run leaves behind: frames that ParaView opens, a checkpoint, and a summary.
///   NAME_000123.hdf, NAME.hdf.series   particles, VTKHDF 1.0 (vertex cells); the index gives the times
///   NAME_grid_000123.hdf, ...          nodal fields on the mesh of the grid's cells, on request
///   NAME.checkpoint                    the last complete state of a run that is not at its end
///   summary.json
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "run/simulation.hpp"

namespace vsb::app {

class Results {
 public:
  /// Names the directory; nothing is touched yet.
  Results(std::string directory, const Scene& scene);

  /// Creates the directory and removes what an earlier run of this scene left there. A resumed run keeps the
  /// frames up to the step it resumes from; any other starts with `resumed_step` -1. Throws FileError.
  void begin(long long resumed_step);

  void write_frame(const ParticleReader& particles);
  void write_grid_frame(const GridSnapshot& grid, long long step, double time);
  /// `saved` and the particles of the simulation.
  void write_checkpoint(const SavedState& saved, Simulation& simulation);
  /// The state to resume from; none where there is no checkpoint. Throws FileError for one that is damaged or
  /// was written by another scene.
  std::optional<SavedState> read_checkpoint() const;
  /// The particles of that state.
  std::unique_ptr<ByteSource> read_checkpoint_particles() const;
  /// The step of the checkpoint; none where there is none that can be read.
  std::optional<long long> checkpoint_step() const;
  void remove_checkpoint();
  void write_summary(const std::string& json);

  const std::string& directory() const { return directory_; }

 private:
  struct Series {
    std::string stem;
    std::vector<std::pair<std::string, double>> frames;  ///< file name, time
  };
  std::string path(const std::string& name) const { return directory_ + "/" + name; }
  std::string checkpoint_path() const { return path(scene_.name + ".checkpoint"); }
  void begin(Series& series, long long resumed_step);
  void add_to_index(Series& series, const std::string& file, double time);
  void write_index(const Series& series) const;

  std::string directory_;
  const Scene& scene_;
  Series particles_, grid_;
};

}  // namespace vsb::app
