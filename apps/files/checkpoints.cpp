// SPDX-License-Identifier: BSD-3-Clause
#include "files/checkpoints.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "files/frames.hpp"
#include "files/hdf5_file.hpp"
#include "files/sealed_file.hpp"
#include "scene/resumable.hpp"

namespace vsb::app {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t checkpoint_version = 4;

/// Bytes into an array of a file.
struct IntoRows final : ByteSink {
  explicit IntoRows(Hdf5Rows<unsigned char>& into) : rows(into) {}
  void take(const void* from, size_t bytes) override {
    rows.append(static_cast<const unsigned char*>(from), bytes);
  }
  Hdf5Rows<unsigned char>& rows;
};

bool exists(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// A number that is written as an attribute.
std::int64_t number(const Hdf5Reader& file, const std::string& path, const char* group, const char* name) {
  const auto values = file.integers(group, name);
  if (values.size() != 1 || values[0] < 0)
    throw FileError(fmt::format("{}: {} of {} is damaged", path, name, group));
  return values[0];
}

/// Whether a file has this seal; not where it is damaged.
bool has_seal(const std::string& path, const std::string& seal) {
  try {
    return checked_seal(path) == seal;
  } catch (const FileError&) {
    return false;
  }
}

/// A free name for a checkpoint, by its step. One of the same content, which a run of the same scene has left
/// before, is replaced.
std::string name_aside(const std::string& path, const std::string& file) {
  const std::string seal = checked_seal(file);
  const std::string first =
      fmt::format("{}.step-{}", path, number(Hdf5Reader(file), file, "checkpoint", "step"));
  std::string name = first;
  for (int n = 2; exists(name) && !has_seal(name, seal); ++n) name = fmt::format("{}-{}", first, n);
  return name;
}

}  // namespace

Checkpoints::Checkpoints(std::string path, const Scene& scene) : path_(std::move(path)), scene_(scene) {}

void Checkpoints::write(const SavedState& saved, const std::string& watched, Simulation& simulation) {
  Hdf5Writer file(path_);
  file.group("checkpoint");
  file.attribute("checkpoint", "version", std::vector<std::int64_t>{checkpoint_version});
  file.attribute("checkpoint", "step", std::vector<std::int64_t>{saved.step});
  file.attribute("checkpoint", "bytes_per_number",
                 std::vector<std::int64_t>{static_cast<std::int64_t>(saved.bytes_per_number)});
  ByteCount count;
  simulation.save_particles(count);
  auto particles = file.rows<unsigned char>("checkpoint/particles", {count.count});
  IntoRows into(particles);
  simulation.save_particles(into);
  particles.finish();
  file.text("checkpoint/watched", watched);
  if (may_lose_particles(scene_)) {
    const auto& staged = saved.staged;
    file.group("staged");
    file.attribute("staged", "outflow", staged.outflow);
    file.attribute("staged", "loads_begin", std::vector<std::int64_t>{staged.loads_begin});
    file.dataset("staged/present", staged.present, {staged.present.size()});
    const std::vector<unsigned char> stages(staged.stages.begin(), staged.stages.end());
    if (!stages.empty()) file.dataset("staged/stages", stages, {stages.size()});
  }
  write_provenance(file, scene_);
  const std::string temporary = file.finish();
  std::error_code error;
  try {
    seal_file(temporary);
  } catch (const FileError&) {
    fs::remove(temporary, error);
    throw;
  }
  if (last_is_whole_) fs::rename(path_, before(), error);
  put_in_place(temporary, path_);
  last_is_whole_ = true;
}

std::optional<SavedState> Checkpoints::read() {
  if (!exists(path_) && !exists(before())) {
    refuse_another_name();
    return {};
  }
  std::string trouble;
  for (const auto& file : {path_, before()}) {
    try {
      checked_seal(file);
    } catch (const FileError& error) {
      if (trouble.empty()) trouble = error.what();
      continue;
    }
    const auto saved = read(file);
    if (!trouble.empty())
      fmt::print(stderr, "vsb: {}; going on from the checkpoint before it, of step {}\n", trouble,
                 saved.step);
    read_from_ = file;
    last_is_whole_ = file == path_;
    return saved;
  }
  throw FileError(trouble);
}

void Checkpoints::refuse_another_name() const {
  const fs::path path(path_);
  std::error_code error;
  std::set<std::string> found;
  for (const auto& entry : fs::directory_iterator(path.parent_path(), error)) {
    auto file = entry.path().filename();
    if (file.extension() == ".before") file = file.stem();
    if (file.extension() == ".checkpoint") found.insert(file.string());
  }
  if (found.empty()) return;
  throw FileError(fmt::format(
      "{}: there is no {} to resume from, but {}: give the scene its 'name', or another --out; run without "
      "--resume to start anew",
      path.parent_path().string(), path.filename().string(), fmt::join(found, ", ")));
}

SavedState Checkpoints::read(const std::string& path) {
  const Hdf5Reader file(path);
  const auto version = number(file, path, "checkpoint", "version");
  if (version != checkpoint_version)
    throw FileError(
        fmt::format("{}: checkpoint version {}, this program reads {}", path, version, checkpoint_version));
  const auto obstacle = obstacle_to_resume(file.text("provenance/scene"), scene_.resolved);
  if (!obstacle.empty())
    throw FileError(fmt::format(
        "{}: written for another scene: {} (a resumed run may change {}); run without --resume to start anew",
        path, obstacle, resumable_keys()));
  SavedState saved{number(file, path, "checkpoint", "step"),
                   static_cast<size_t>(number(file, path, "checkpoint", "bytes_per_number")),
                   {}};
  watched_ = file.text("checkpoint/watched");
  if (may_lose_particles(scene_)) {
    const auto stages = scene_.removal ? file.bytes("staged/stages") : std::vector<unsigned char>();
    saved.staged.outflow = file.integers("staged", "outflow");
    saved.staged.present = file.bytes("staged/present");
    saved.staged.stages.assign(stages.begin(), stages.end());
    saved.staged.loads_begin = number(file, path, "staged", "loads_begin");
  }
  return saved;
}

std::unique_ptr<ByteSource> Checkpoints::read_particles() const {
  return std::make_unique<Hdf5Bytes>(read_from_, "checkpoint/particles");
}

void Checkpoints::keep_aside() const {
  for (const auto& file : {path_, before()}) {
    if (!exists(file)) continue;
    std::string aside;
    try {
      aside = name_aside(path_, file);
    } catch (const FileError& error) {
      fmt::print(stderr, "vsb: removing a checkpoint: {}\n", error.what());
      continue;
    }
    std::error_code error;
    fs::rename(file, aside, error);
    if (error) throw FileError(fmt::format("{}: cannot be renamed ({})", file, error.message()));
    fmt::print(
        stderr,
        "vsb: keeping the checkpoint that was there as {} (with --resume the run would have gone on from "
        "it; it will, once it is named {} again)\n",
        aside, fs::path(path_).filename().string());
    break;
  }
  remove();
}

void Checkpoints::remove() const {
  std::error_code error;
  fs::remove(path_, error);
  fs::remove(before(), error);
}

}  // namespace vsb::app
