// SPDX-License-Identifier: BSD-3-Clause
#include "files/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "files/frames.hpp"
#include "files/hdf5_file.hpp"

namespace vsb::app {

namespace fs = std::filesystem;

namespace {

std::string frame_name(const std::string& stem, long long step) {
  return fmt::format("{}_{:06d}.hdf", stem, step);
}

constexpr std::int64_t checkpoint_version = 1;

/// Bytes into an array of a file.
struct IntoRows final : ByteSink {
  explicit IntoRows(Hdf5Rows<unsigned char>& into) : rows(into) {}
  void take(const void* from, size_t bytes) override {
    rows.append(static_cast<const unsigned char*>(from), bytes);
  }
  Hdf5Rows<unsigned char>& rows;
};

}  // namespace

Results::Results(std::string directory, const Scene& scene)
    : directory_(std::move(directory)), scene_(scene) {
  particles_.stem = scene.name;
  grid_.stem = scene.name + "_grid";
}

void Results::begin(long long resumed_step) {
  std::error_code error;
  fs::create_directories(directory_, error);
  if (error)
    throw FileError(fmt::format("{}: cannot create the directory ({})", directory_, error.message()));
  begin(particles_, resumed_step);
  begin(grid_, resumed_step);
  if (resumed_step < 0) remove_checkpoint();
  fs::remove(path("summary.json"), error);
}

/// The number in a frame's name is its step, which gives its time.
void Results::begin(Series& series, long long resumed_step) {
  const std::string head = series.stem + "_";
  std::vector<std::pair<long long, fs::path>> frames;
  for (const auto& entry : fs::directory_iterator(directory_)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() != ".hdf" || stem.rfind(head, 0) != 0) continue;
    const std::string digits = stem.substr(head.size());
    if (digits.size() < 6 || digits.size() > 18 ||
        digits.find_first_not_of("0123456789") != std::string::npos)
      continue;
    frames.emplace_back(std::stoll(digits), entry.path());
  }
  std::sort(frames.begin(), frames.end());
  std::error_code error;
  for (const auto& [step, file] : frames) {
    if (step <= resumed_step)
      series.frames.emplace_back(file.filename().string(), static_cast<double>(step) * scene_.time.dt);
    else
      fs::remove(file, error);
  }
  fs::remove(path(series.stem + ".hdf.series"), error);
  if (!series.frames.empty()) write_index(series);
}

void Results::add_to_index(Series& series, const std::string& file, double time) {
  const auto same = [&](const auto& frame) { return frame.first == file; };
  if (std::none_of(series.frames.begin(), series.frames.end(), same)) series.frames.emplace_back(file, time);
  write_index(series);
}

void Results::write_index(const Series& series) const {
  std::string json = "{\n  \"file-series-version\" : \"1.0\",\n  \"files\" : [\n";
  for (size_t i = 0; i < series.frames.size(); ++i)
    json += fmt::format("    {{ \"name\" : \"{}\", \"time\" : {} }}{}\n", series.frames[i].first,
                        series.frames[i].second, i + 1 < series.frames.size() ? "," : "");
  write_text_file(path(series.stem + ".hdf.series"), json + "  ]\n}\n");
}

void Results::write_frame(const ParticleReader& particles) {
  const std::string name = frame_name(particles_.stem, particles.step);
  write_particle_frame(path(name), scene_, particles);
  add_to_index(particles_, name, particles.time);
}

void Results::write_grid_frame(const GridSnapshot& grid, long long step, double time) {
  const std::string name = frame_name(grid_.stem, step);
  vsb::app::write_grid_frame(path(name), scene_, grid, time);
  add_to_index(grid_, name, time);
}

void Results::write_checkpoint(const SavedState& saved, Simulation& simulation) {
  Hdf5Writer file(checkpoint_path());
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
  if (scene_.removal) {
    const auto& staged = saved.staged;
    file.group("staged");
    file.attribute("staged", "loads_begin", std::vector<std::int64_t>{staged.loads_begin});
    file.dataset("staged/present", staged.present, {staged.present.size()});
    const std::vector<unsigned char> stages(staged.stages.begin(), staged.stages.end());
    file.dataset("staged/stages", stages, {stages.size()});
  }
  write_provenance(file, scene_);
  file.commit();
}

std::optional<SavedState> Results::read_checkpoint() const {
  const std::string name = checkpoint_path();
  std::error_code error;
  if (!fs::exists(name, error)) return {};
  const Hdf5Reader file(name);
  const auto number = [&](const char* attribute) {
    const auto values = file.integers("checkpoint", attribute);
    if (values.size() != 1 || values[0] < 0)
      throw FileError(fmt::format("{}: {} is damaged", name, attribute));
    return values[0];
  };
  if (number("version") != checkpoint_version)
    throw FileError(fmt::format("{}: checkpoint version {}, this program reads {}", name, number("version"),
                                checkpoint_version));
  if (file.text("provenance", "scene") != scene_.resolved)
    throw FileError(fmt::format(
        "{}: written for another scene (or other --set values); remove it, or run without --resume", name));
  SavedState saved{number("step"), static_cast<size_t>(number("bytes_per_number")), {}};
  if (scene_.removal) {
    const auto stages = file.bytes("staged/stages");
    saved.staged.present = file.bytes("staged/present");
    saved.staged.stages.assign(stages.begin(), stages.end());
    saved.staged.loads_begin = file.integers("staged", "loads_begin").at(0);
  }
  return saved;
}

std::unique_ptr<ByteSource> Results::read_checkpoint_particles() const {
  return std::make_unique<Hdf5Bytes>(checkpoint_path(), "checkpoint/particles");
}

std::optional<long long> Results::checkpoint_step() const {
  std::error_code error;
  if (!fs::exists(checkpoint_path(), error)) return {};
  try {
    const auto steps = Hdf5Reader(checkpoint_path()).integers("checkpoint", "step");
    if (steps.size() == 1) return steps[0];
  } catch (const FileError&) {
  }
  return {};
}

void Results::remove_checkpoint() {
  std::error_code error;
  fs::remove(checkpoint_path(), error);
}

void Results::write_summary(const std::string& json) {
  write_text_file(path("summary.json"), json);
}

}  // namespace vsb::app
