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

/// As a string of JSON, which has no other control characters than those of a scene's name: none.
std::string json_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

}  // namespace

Results::Results(std::string directory, const Scene& scene)
    : directory_(std::move(directory)), scene_(scene), checkpoints_(path(scene.name + ".checkpoint"), scene) {
  particles_.stem = scene.name;
  grid_.stem = scene.name + "_grid";
}

void Results::claim() {
  if (!lock_) lock_.emplace(directory_);
}

void Results::begin(long long resumed_step, bool keep_checkpoint_aside) {
  claim();
  if (resumed_step < 0) keep_checkpoint_aside ? checkpoints_.keep_aside() : checkpoints_.remove();
  begin(particles_, resumed_step);
  begin(grid_, resumed_step);
  std::error_code error;
  fs::remove(path("summary.json"), error);
}

/// The number in a frame's name is its step, which gives its time.
void Results::begin(Series& series, long long resumed_step) {
  const std::string head = series.stem + "_";
  std::vector<std::pair<long long, fs::path>> frames;
  std::error_code error;
  const fs::directory_iterator entries(directory_, error);
  if (error) throw FileError(fmt::format("{}: {}", directory_, error.message()));
  for (const auto& entry : entries) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() != ".hdf" || stem.rfind(head, 0) != 0) continue;
    const std::string digits = stem.substr(head.size());
    if (digits.size() < 6 || digits.size() > 18 ||
        digits.find_first_not_of("0123456789") != std::string::npos)
      continue;
    frames.emplace_back(std::stoll(digits), entry.path());
  }
  std::sort(frames.begin(), frames.end());
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
    json += fmt::format("    {{ \"name\" : {}, \"time\" : {} }}{}\n", json_text(series.frames[i].first),
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

void Results::write_summary(const std::string& json) {
  write_text_file(path("summary.json"), json);
}

}  // namespace vsb::app
