// SPDX-License-Identifier: BSD-3-Clause
#include "files/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "files/build_info.hpp"
#include "files/hdf5_file.hpp"

namespace vsb::app {

namespace fs = std::filesystem;

namespace {

/// Which program and which scene made a file; a group of its own, which VTK ignores.
void write_provenance(Hdf5Writer& file, const Scene& scene) {
  file.group("provenance");
  for (const auto& [name, value] : build_info()) file.attribute("provenance", name, value);
  file.attribute("provenance", "scene", scene.resolved);
}

void begin_vtkhdf(Hdf5Writer& file, const std::string& type, double time) {
  file.group("VTKHDF");
  file.attribute("VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
  file.attribute("VTKHDF", "Type", type);
  for (const char* group : {"PointData", "CellData", "FieldData"}) file.group(std::string("VTKHDF/") + group);
  file.dataset("VTKHDF/FieldData/TimeValue", std::vector<double>{time}, {1});
}

std::string frame_name(const std::string& stem, long long step) {
  return fmt::format("{}_{:06d}.hdf", stem, step);
}

constexpr std::int64_t checkpoint_version = 1;

}  // namespace

Results::Results(std::string directory, const Scene& scene)
    : directory_(std::move(directory)), scene_(scene) {
  particles_.stem = scene.name;
  grid_.stem = scene.name + "_grid";
}

void Results::begin(long long resumed_step) {
  std::error_code error;
  fs::create_directories(directory_, error);
  if (error) throw FileError(fmt::format("{}: {}", directory_, error.message()));
  begin(particles_, resumed_step);
  begin(grid_, resumed_step);
  if (resumed_step < 0) fs::remove(path(scene_.name + ".checkpoint"), error);
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
}

void Results::add_to_index(Series& series, const std::string& file, double time) {
  const auto same = [&](const auto& frame) { return frame.first == file; };
  if (std::none_of(series.frames.begin(), series.frames.end(), same)) series.frames.emplace_back(file, time);
  std::string json = "{\n  \"file-series-version\" : \"1.0\",\n  \"files\" : [\n";
  for (size_t i = 0; i < series.frames.size(); ++i)
    json += fmt::format("    {{ \"name\" : \"{}\", \"time\" : {} }}{}\n", series.frames[i].first,
                        series.frames[i].second, i + 1 < series.frames.size() ? "," : "");
  write_text_file(path(series.stem + ".hdf.series"), json + "  ]\n}\n");
}

void Results::write_frame(const Snapshot& s, const ExactFields& exact) {
  const size_t n = s.count();
  const auto count = static_cast<std::int64_t>(n);
  const std::string name = frame_name(particles_.stem, s.step);
  Hdf5Writer file(path(name));
  begin_vtkhdf(file, "UnstructuredGrid", s.time);
  for (const char* number : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    file.dataset(std::string("VTKHDF/") + number, std::vector<std::int64_t>{count}, {1});
  file.dataset("VTKHDF/Points", s.position, {n, 3});
  std::vector<std::int64_t> numbers(n + 1);
  for (size_t i = 0; i <= n; ++i) numbers[i] = static_cast<std::int64_t>(i);
  file.dataset("VTKHDF/Offsets", numbers, {n + 1});
  numbers.pop_back();
  file.dataset("VTKHDF/Connectivity", numbers, {n});
  file.dataset("VTKHDF/Types", std::vector<unsigned char>(n, 1), {n});  // VTK_VERTEX

  const auto& fields = scene_.output.fields;
  const auto wanted = [&](const char* field) {
    return std::find(fields.begin(), fields.end(), field) != fields.end();
  };
  const auto field = [&](const char* what, const auto& values, size_t columns) {
    const std::vector<size_t> shape = columns == 1 ? std::vector<size_t>{n} : std::vector<size_t>{n, columns};
    file.dataset(std::string("VTKHDF/PointData/") + what, values, shape);
  };
  if (wanted("id")) field("id", s.id, 1);
  if (wanted("displacement")) {
    std::vector<double> u(s.position);
    for (size_t i = 0; i < u.size(); ++i) u[i] -= s.initial_position[i];
    field("displacement", u, 3);
  }
  if (wanted("velocity")) field("velocity", s.velocity, 3);
  if (wanted("cauchy_stress")) field("cauchy_stress", s.cauchy_stress, 6);
  if (wanted("volume")) field("volume", s.volume, 1);
  if (wanted("mass")) field("mass", s.mass, 1);
  if (wanted("in_boundary")) field("in_boundary", s.in_boundary, 1);
  if (!exact.displacement.empty()) field("exact_displacement", exact.displacement, 3);
  if (!exact.cauchy_stress.empty()) field("exact_cauchy_stress", exact.cauchy_stress, 6);
  write_provenance(file, scene_);
  file.commit();
  add_to_index(particles_, name, s.time);
}

void Results::write_grid_frame(const GridSnapshot& grid, long long step, double time) {
  const std::string name = frame_name(grid_.stem, step);
  Hdf5Writer file(path(name));
  begin_vtkhdf(file, "ImageData", time);
  std::vector<std::int64_t> extent;
  std::vector<size_t> zyx(3, 1);
  std::vector<double> origin(3, 0.0), spacing(3, 1.0);
  for (size_t i = 0; i < 3; ++i) {
    const bool used = i < static_cast<size_t>(scene_.dimension);
    const int cells = used ? scene_.grid.cells[i] : 0;
    extent.insert(extent.end(), {0, cells});
    zyx[2 - i] = static_cast<size_t>(cells) + 1;
    if (used) {
      origin[i] = scene_.grid.lower[i];
      spacing[i] = scene_.grid.spacing[i];
    }
  }
  file.attribute("VTKHDF", "WholeExtent", extent);
  file.attribute("VTKHDF", "Origin", origin);
  file.attribute("VTKHDF", "Spacing", spacing);
  file.attribute("VTKHDF", "Direction", std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1});
  auto zyxc = zyx;
  zyxc.push_back(3);
  file.dataset("VTKHDF/PointData/mass", grid.mass, zyx);
  file.dataset("VTKHDF/PointData/velocity", grid.velocity, zyxc);
  file.dataset("VTKHDF/PointData/force", grid.force, zyxc);
  file.dataset("VTKHDF/PointData/boundary", grid.boundary, zyx);
  write_provenance(file, scene_);
  file.commit();
  add_to_index(grid_, name, time);
}

void Results::write_checkpoint(const SavedState& saved) {
  Hdf5Writer file(path(scene_.name + ".checkpoint"));
  file.group("checkpoint");
  file.attribute("checkpoint", "version", std::vector<std::int64_t>{checkpoint_version});
  file.attribute("checkpoint", "step", std::vector<std::int64_t>{saved.step});
  file.attribute("checkpoint", "bytes_per_number",
                 std::vector<std::int64_t>{static_cast<std::int64_t>(saved.bytes_per_number)});
  file.dataset("checkpoint/particles", saved.particles, {saved.particles.size()});
  write_provenance(file, scene_);
  file.commit();
}

std::optional<SavedState> Results::read_checkpoint() const {
  const std::string name = path(scene_.name + ".checkpoint");
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
  return SavedState{number("step"), static_cast<size_t>(number("bytes_per_number")),
                    file.bytes("checkpoint/particles")};
}

void Results::write_summary(const std::string& json) {
  write_text_file(path("summary.json"), json);
}

}  // namespace vsb::app
