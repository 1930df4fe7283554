// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a run leaves behind: frames that ParaView opens, a checkpoint, and a summary.
///   NAME_000123.hdf, NAME.hdf.series   particles, VTKHDF 1.0 (vertex cells); the index gives the times
///   NAME_grid_000123.hdf, ...          nodal fields on the mesh of the grid's cells, on request
///   NAME.checkpoint, ...               the last complete states, see files/checkpoints.hpp
///   summary.json
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/simulation.hpp"
#include "files/checkpoints.hpp"
#include "files/directory_lock.hpp"

namespace vsb::app {

class Results {
 public:
  /// Names the directory; nothing is touched yet.
  Results(std::string directory, const Scene& scene);

  /// Creates the directory and keeps other processes out of it. Throws FileError where one is in it.
  void claim();
  /// Claims the directory, where that has not been done, and removes what an earlier run of this scene left
  /// there. A resumed run keeps the frames up to the step it resumes from; any other starts with
  /// `resumed_step` -1 and keeps a checkpoint aside, or else removes it. Throws FileError.
  void begin(long long resumed_step, bool keep_checkpoint_aside = true);

  void write_frame(const ParticleReader& particles);
  void write_grid_frame(const GridSnapshot& grid, long long step, double time);
  Checkpoints& checkpoints() { return checkpoints_; }
  void write_summary(const std::string& json);

  const std::string& directory() const { return directory_; }

 private:
  struct Series {
    std::string stem;
    std::vector<std::pair<std::string, double>> frames;  ///< file name, time
  };
  std::string path(const std::string& name) const { return directory_ + "/" + name; }
  void begin(Series& series, long long resumed_step);
  void add_to_index(Series& series, const std::string& file, double time);
  void write_index(const Series& series) const;

  std::string directory_;
  const Scene& scene_;
  Series particles_, grid_;
  Checkpoints checkpoints_;
  std::optional<DirectoryLock> lock_;
};

}  // namespace vsb::app
