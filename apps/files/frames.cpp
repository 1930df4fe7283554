// SPDX-License-Identifier: BSD-3-Clause
#include "files/frames.hpp"

#include <algorithm>
#include <array>

#include <vsb/physics/plastic_strain.hpp>
#include "engine/build_info.hpp"
#include "report/comparison.hpp"

namespace vsb::app {

namespace {

/// A mesh of cells of one kind.
struct Mesh {
  size_t points, cells, points_per_cell;
  unsigned char cell_type;  ///< VTK's number
};

template <class T, class Value>
void write_each(Hdf5Writer& file, const std::string& name, size_t count, const Value& value) {
  auto rows = file.rows<T>(name, {count});
  for (size_t n = 0; n < count; ++n) {
    const T v = value(n);
    rows.append(&v, 1);
  }
  rows.finish();
}

/// The VTKHDF 1.0 group of an unstructured grid; the data of the points follow in VTKHDF/PointData.
/// points(rows) fills the positions of the points, corner(n) is entry n of the connectivity.
template <class Points, class Corner>
void write_mesh(Hdf5Writer& file, const Mesh& mesh, double time, const Points& points, const Corner& corner) {
  file.group("VTKHDF");
  file.attribute("VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
  file.attribute("VTKHDF", "Type", "UnstructuredGrid");
  for (const char* group : {"PointData", "CellData", "FieldData"}) file.group(std::string("VTKHDF/") + group);
  file.dataset("VTKHDF/FieldData/TimeValue", std::vector<double>{time}, {1});
  const auto number = [&](const char* name, size_t value) {
    file.dataset(std::string("VTKHDF/") + name, std::vector<std::int64_t>{static_cast<std::int64_t>(value)},
                 {1});
  };
  const size_t corners = mesh.cells * mesh.points_per_cell;
  number("NumberOfPoints", mesh.points);
  number("NumberOfCells", mesh.cells);
  number("NumberOfConnectivityIds", corners);
  auto rows = file.rows<double>("VTKHDF/Points", {mesh.points, 3});
  points(rows);
  rows.finish();
  write_each<std::int64_t>(file, "VTKHDF/Connectivity", corners, corner);
  write_each<std::int64_t>(file, "VTKHDF/Offsets", mesh.cells + 1,
                           [&](size_t n) { return static_cast<std::int64_t>(n * mesh.points_per_cell); });
  write_each<unsigned char>(file, "VTKHDF/Types", mesh.cells, [&](size_t) { return mesh.cell_type; });
}

std::vector<double> equivalent_plastic_strain(const Snapshot& s) {
  std::vector<double> measure(s.count());
  for (size_t p = 0; p < s.count(); ++p) {
    SymmetricTensor<3, double> strain;
    for (size_t c = 0; c < 6; ++c) strain[static_cast<int>(c)] = s.plastic_strain[6 * p + c];
    measure[p] = equivalent_plastic_deviatoric_strain(strain);
  }
  return measure;
}

}  // namespace

void write_provenance(Hdf5Writer& file, const Scene& scene) {
  file.group("provenance");
  for (const auto& [name, value] : build_info()) file.attribute("provenance", name, value);
  file.text("provenance/scene", scene.resolved);
}

void write_particle_frame(const std::string& path, const Scene& scene, const ParticleReader& particles) {
  Hdf5Writer file(path);
  write_mesh(
      file, {particles.count, particles.count, 1, 1}, particles.time,
      [&](Hdf5Rows<double>& points) {
        particles.for_each_range(field::position, [&](const Snapshot& s) { points.append(s.position); });
      },
      [](size_t n) { return static_cast<std::int64_t>(n); });
  /// What of(snapshot) makes of some fields, `columns` numbers a particle.
  const auto write = [&](const char* name, auto number, size_t columns, unsigned fields, const auto& of) {
    const std::vector<size_t> shape =
        columns == 1 ? std::vector<size_t>{particles.count} : std::vector<size_t>{particles.count, columns};
    auto rows = file.rows<decltype(number)>(std::string("VTKHDF/PointData/") + name, shape);
    particles.for_each_range(fields, [&](const Snapshot& s) { rows.append(of(s)); });
    rows.finish();
  };
  const auto& names = scene.output.fields;
  const auto wanted = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  using Doubles = std::vector<double>;
  const auto write_field = [&](const char* name, size_t columns, unsigned field, Doubles Snapshot::*values) {
    if (wanted(name))
      write(name, double(), columns, field, [&](const Snapshot& s) -> const Doubles& { return s.*values; });
  };
  if (wanted("id"))
    write(
        "id", std::int64_t(), 1, 0, [](const Snapshot& s) -> const auto& { return s.id; });
  if (wanted("displacement"))
    write("displacement", double(), 3, field::position | field::initial_position,
          [](const Snapshot& s) -> const Doubles& { return s.displacement; });
  write_field("velocity", 3, field::velocity, &Snapshot::velocity);
  write_field("cauchy_stress", 6, field::cauchy_stress, &Snapshot::cauchy_stress);
  if (!particles.recovered_stress.empty())
    write_field("recovered_stress", 6, field::recovered_stress, &Snapshot::recovered_stress);
  if (particles.plastic) {
    write_field("plastic_strain", 6, field::plastic_strain, &Snapshot::plastic_strain);
    if (wanted("equivalent_plastic_strain"))
      write("equivalent_plastic_strain", double(), 1, field::plastic_strain, equivalent_plastic_strain);
  }
  write_field("volume", 1, field::volume, &Snapshot::volume);
  write_field("mass", 1, field::mass, &Snapshot::mass);
  if (wanted("in_boundary"))
    write(
        "in_boundary", static_cast<unsigned char>(0), 1, field::in_boundary,
        [](const Snapshot& s) -> const auto& { return s.in_boundary; });
  const auto exact = known_exactly(scene);
  const auto write_exact = [&](const char* name, size_t columns, Doubles ExactFields::*values) {
    write(name, double(), columns, exact.needed,
          [&](const Snapshot& s) { return exact_at(scene, s).*values; });
  };
  if (exact.displacement) write_exact("exact_displacement", 3, &ExactFields::displacement);
  if (exact.cauchy_stress) write_exact("exact_cauchy_stress", 6, &ExactFields::cauchy_stress);
  write_provenance(file, scene);
  file.commit();
}

/// The grid goes out as a mesh of lines, quadrilaterals or hexahedra: VTK 9.1 crashes on plane image data.
void write_grid_frame(const std::string& path, const Scene& scene, const GridSnapshot& grid, double time) {
  Hdf5Writer file(path);
  const auto d = static_cast<size_t>(scene.dimension);
  std::array<size_t, 3> nodes{1, 1, 1}, cells{1, 1, 1};
  for (size_t i = 0; i < d; ++i) {
    cells[i] = static_cast<size_t>(scene.grid.cells[i]);
    nodes[i] = cells[i] + 1;
  }
  constexpr std::array<std::array<size_t, 3>, 8> corners{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  const size_t per_cell = size_t(1) << d;
  const unsigned char cell_type = d == 1 ? 3 : d == 2 ? 9 : 12;  // VTK_LINE, VTK_QUAD, VTK_HEXAHEDRON
  write_mesh(
      file, {nodes[0] * nodes[1] * nodes[2], cells[0] * cells[1] * cells[2], per_cell, cell_type}, time,
      [&](Hdf5Rows<double>& points) {
        for (size_t k = 0; k < nodes[2]; ++k)
          for (size_t j = 0; j < nodes[1]; ++j)
            for (size_t i = 0; i < nodes[0]; ++i) {
              const Point x = node_position(scene.grid, scene.dimension,
                                            {static_cast<int>(i), static_cast<int>(j), static_cast<int>(k)});
              points.append(x.data(), x.size());
            }
      },
      [&](size_t n) {
        const auto& corner = corners[n % per_cell];
        const size_t cell = n / per_cell, i = cell % cells[0], j = cell / cells[0] % cells[1],
                     k = cell / (cells[0] * cells[1]);
        return static_cast<std::int64_t>(i + corner[0] +
                                         nodes[0] * (j + corner[1] + nodes[1] * (k + corner[2])));
      });
  const size_t n = grid.mass.size();
  file.dataset("VTKHDF/PointData/mass", grid.mass, {n});
  file.dataset("VTKHDF/PointData/velocity", grid.velocity, {n, 3});
  file.dataset("VTKHDF/PointData/force", grid.force, {n, 3});
  file.dataset("VTKHDF/PointData/boundary", grid.boundary, {n});
  write_provenance(file, scene);
  file.commit();
}

}  // namespace vsb::app
