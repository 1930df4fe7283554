// SPDX-License-Identifier: BSD-3-Clause
#include "files/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <numeric>

#include <vsb/physics/plastic_strain.hpp>
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

/// Points and cells of one kind.
struct Mesh {
  std::vector<double> points;              ///< [3 per point], m
  std::vector<std::int64_t> connectivity;  ///< [points_per_cell per cell]
  size_t points_per_cell = 1;
  unsigned char cell_type = 1;  ///< VTK's number; 1 is a vertex
};

/// The VTKHDF 1.0 group of an unstructured grid; the data of the points follow in VTKHDF/PointData.
void write_mesh(Hdf5Writer& file, const Mesh& mesh, double time) {
  file.group("VTKHDF");
  file.attribute("VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
  file.attribute("VTKHDF", "Type", "UnstructuredGrid");
  for (const char* group : {"PointData", "CellData", "FieldData"}) file.group(std::string("VTKHDF/") + group);
  file.dataset("VTKHDF/FieldData/TimeValue", std::vector<double>{time}, {1});
  const size_t points = mesh.points.size() / 3, cells = mesh.connectivity.size() / mesh.points_per_cell;
  const auto number = [&](const char* name, size_t value) {
    file.dataset(std::string("VTKHDF/") + name, std::vector<std::int64_t>{static_cast<std::int64_t>(value)},
                 {1});
  };
  number("NumberOfPoints", points);
  number("NumberOfCells", cells);
  number("NumberOfConnectivityIds", mesh.connectivity.size());
  file.dataset("VTKHDF/Points", mesh.points, {points, 3});
  file.dataset("VTKHDF/Connectivity", mesh.connectivity, {mesh.connectivity.size()});
  std::vector<std::int64_t> offsets(cells + 1);
  for (size_t i = 0; i <= cells; ++i) offsets[i] = static_cast<std::int64_t>(i * mesh.points_per_cell);
  file.dataset("VTKHDF/Offsets", offsets, {cells + 1});
  file.dataset("VTKHDF/Types", std::vector<unsigned char>(cells, mesh.cell_type), {cells});
}

double equivalent_plastic_strain(const Snapshot& s, size_t particle) {
  SymmetricTensor<3, double> strain;
  for (size_t c = 0; c < 6; ++c) strain[static_cast<int>(c)] = s.plastic_strain[6 * particle + c];
  return equivalent_plastic_deviatoric_strain(strain);
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
  const std::string name = frame_name(particles_.stem, s.step);
  Hdf5Writer file(path(name));
  Mesh mesh;
  mesh.points = s.position;
  mesh.connectivity.resize(n);
  std::iota(mesh.connectivity.begin(), mesh.connectivity.end(), std::int64_t(0));
  write_mesh(file, mesh, s.time);
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
  if (!s.recovered_stress.empty() && wanted("recovered_stress"))
    field("recovered_stress", s.recovered_stress, 6);
  if (!s.plastic_strain.empty() && wanted("plastic_strain")) field("plastic_strain", s.plastic_strain, 6);
  if (!s.plastic_strain.empty() && wanted("equivalent_plastic_strain")) {
    std::vector<double> measure(n);
    for (size_t i = 0; i < n; ++i) measure[i] = equivalent_plastic_strain(s, i);
    field("equivalent_plastic_strain", measure, 1);
  }
  if (wanted("volume")) field("volume", s.volume, 1);
  if (wanted("mass")) field("mass", s.mass, 1);
  if (wanted("in_boundary")) field("in_boundary", s.in_boundary, 1);
  if (!exact.displacement.empty()) field("exact_displacement", exact.displacement, 3);
  if (!exact.cauchy_stress.empty()) field("exact_cauchy_stress", exact.cauchy_stress, 6);
  write_provenance(file, scene_);
  file.commit();
  add_to_index(particles_, name, s.time);
}

/// The grid goes out as a mesh of lines, quadrilaterals or hexahedra: VTK 9.1 crashes on plane image data.
void Results::write_grid_frame(const GridSnapshot& grid, long long step, double time) {
  const std::string name = frame_name(grid_.stem, step);
  Hdf5Writer file(path(name));
  const auto d = static_cast<size_t>(scene_.dimension);
  std::array<size_t, 3> nodes{1, 1, 1}, cells{1, 1, 1};
  for (size_t i = 0; i < d; ++i) {
    cells[i] = static_cast<size_t>(scene_.grid.cells[i]);
    nodes[i] = cells[i] + 1;
  }
  Mesh mesh;
  for (size_t k = 0; k < nodes[2]; ++k)
    for (size_t j = 0; j < nodes[1]; ++j)
      for (size_t i = 0; i < nodes[0]; ++i) {
        const Point x = node_position(scene_.grid, scene_.dimension,
                                      {static_cast<int>(i), static_cast<int>(j), static_cast<int>(k)});
        mesh.points.insert(mesh.points.end(), x.begin(), x.end());
      }
  constexpr std::array<std::array<size_t, 3>, 8> corners{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  for (size_t k = 0; k < cells[2]; ++k)
    for (size_t j = 0; j < cells[1]; ++j)
      for (size_t i = 0; i < cells[0]; ++i)
        for (size_t a = 0; a < (size_t(1) << d); ++a)
          mesh.connectivity.push_back(static_cast<std::int64_t>(
              i + corners[a][0] + nodes[0] * (j + corners[a][1] + nodes[1] * (k + corners[a][2]))));
  mesh.points_per_cell = size_t(1) << d;
  mesh.cell_type = d == 1 ? 3 : d == 2 ? 9 : 12;  // VTK_LINE, VTK_QUAD, VTK_HEXAHEDRON
  write_mesh(file, mesh, time);
  const size_t n = grid.mass.size();
  file.dataset("VTKHDF/PointData/mass", grid.mass, {n});
  file.dataset("VTKHDF/PointData/velocity", grid.velocity, {n, 3});
  file.dataset("VTKHDF/PointData/force", grid.force, {n, 3});
  file.dataset("VTKHDF/PointData/boundary", grid.boundary, {n});
  write_provenance(file, scene_);
  file.commit();
  add_to_index(grid_, name, time);
}

void Results::write_checkpoint(const SavedState& saved) {
  Hdf5Writer file(checkpoint_path());
  file.group("checkpoint");
  file.attribute("checkpoint", "version", std::vector<std::int64_t>{checkpoint_version});
  file.attribute("checkpoint", "step", std::vector<std::int64_t>{saved.step});
  file.attribute("checkpoint", "bytes_per_number",
                 std::vector<std::int64_t>{static_cast<std::int64_t>(saved.bytes_per_number)});
  file.dataset("checkpoint/particles", saved.particles, {saved.particles.size()});
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
  SavedState saved{number("step"),
                   static_cast<size_t>(number("bytes_per_number")),
                   file.bytes("checkpoint/particles"),
                   {}};
  if (scene_.removal) {
    const auto stages = file.bytes("staged/stages");
    saved.staged.present = file.bytes("staged/present");
    saved.staged.stages.assign(stages.begin(), stages.end());
    saved.staged.loads_begin = file.integers("staged", "loads_begin").at(0);
  }
  return saved;
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
