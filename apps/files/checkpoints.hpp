// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The checkpoints of a run: HDF5 files with a seal, NAME.checkpoint the last one and NAME.checkpoint.before
/// the one before it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/simulation.hpp"

namespace vsb::app {

class Checkpoints {
 public:
  /// `path` is that of the last one.
  Checkpoints(std::string path, const Scene& scene);

  /// `saved`, what the watch over the tractions has seen, and the particles of the simulation. Both old ones
  /// stay until the new one is on the disk.
  void write(const SavedState& saved, const std::string& watched, Simulation& simulation);
  /// The state to resume from: that of the last one, or, where that is missing or damaged, which is said on
  /// standard error, of the one before. None where there is neither. Throws FileError where none can be read,
  /// for a scene that differs in more than its output and its end, or where the directory has checkpoints of
  /// another name alone.
  std::optional<SavedState> read();
  /// What the watch had seen by the state that was read.
  const std::string& watched() const { return watched_; }
  /// The particles of the state that was read.
  std::unique_ptr<ByteSource> read_particles() const;
  /// Renames the last one, so that a run that begins anew neither takes nor replaces it, and removes the one
  /// before; says so on standard error.
  void keep_aside() const;
  /// Whether the last one is known to be good: this run has read or written it.
  bool last_is_whole() const { return last_is_whole_; }
  void remove() const;

 private:
  std::string before() const { return path_ + ".before"; }
  SavedState read(const std::string& file);
  void refuse_another_name() const;

  std::string path_;
  const Scene& scene_;
  std::string read_from_, watched_;
  bool last_is_whole_ = false;
};

}  // namespace vsb::app
