// SPDX-License-Identifier: BSD-3-Clause
#include "report/static_advice.hpp"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>

#include "setup/local_origin.hpp"

namespace vsb::app {

namespace {

using Cell = std::array<int, 3>;
using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

/// What linear theory may be off by before it is told.
constexpr double small_error = 0.01;
/// The same of the stretch that a turn makes, relative to the strain.
constexpr double small_stretch = 0.05;
/// What is unlike the motion around it, in strains: bodies that hold together have up to 1, bent ones the
/// most; particles that nothing holds some thousands.
constexpr double loose = 10;

Cell cell_of(const Scene& scene, const Point& q) {
  const auto& grid = scene.grid;
  Cell cell{};
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
    const auto& nodes = grid.coordinates[i];
    cell[i] = static_cast<int>(
        grid.mapped()
            ? static_cast<double>(std::upper_bound(nodes.begin(), nodes.end(), q[i]) - nodes.begin())
            : std::floor((q[i] - grid.lower[i]) / grid.spacing[i]));
  }
  return cell;
}

/// The particles of a cell, positions from one point for all; sums of those in it.
struct Content {
  std::vector<Vector> x, u;
  double count = 0;
  Vector sum_x = Vector::Zero(), sum_u = Vector::Zero();
  Matrix xx = Matrix::Zero(), ux = Matrix::Zero();

  void add(const Vector& position, const Vector& displacement) {
    x.push_back(position);
    u.push_back(displacement);
    count += 1;
    sum_x += position;
    sum_u += displacement;
    xx += position * position.transpose();
    ux += displacement * position.transpose();
  }
  void add_sums(const Content& other) {
    count += other.count;
    sum_x += other.sum_x;
    sum_u += other.sum_u;
    xx += other.xx;
    ux += other.ux;
  }
};
using Cells = std::map<Cell, Content>;

Content around(const Cells& cells, const Cell& cell) {
  Content all;
  for (int k = -1; k <= 1; ++k)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i)
        if (const auto found = cells.find({cell[0] + i, cell[1] + j, cell[2] + k}); found != cells.end())
          all.add_sums(found->second);
  return all;
}

/// Whether faces of the grid hold the bodies at both ends of an axis along it.
bool is_held_at_both_ends(const Scene& scene, const LocalMotion& motion, size_t axis) {
  const auto& faces = scene.faces.fixed[axis];
  const Cell first = cell_of(scene, motion.lower), last = cell_of(scene, motion.upper);
  const int low = scene.grid.mapped() ? 1 : 0;
  return (faces[0] >> axis & 1) != 0 && (faces[1] >> axis & 1) != 0 && first[axis] == low &&
         last[axis] == low + scene.grid.cells[axis] - 1;
}

}  // namespace

LocalMotion local_motion(const Scene& scene, const ParticleReader& particles) {
  LocalMotion motion;
  Cells cells;
  Point origin{};
  bool first = true;
  particles.for_each_range(field::position | field::initial_position, [&](const Snapshot& s) {
    for (size_t p = 0; p < s.count(); ++p) {
      const Point x{s.initial_position[3 * p], s.initial_position[3 * p + 1], s.initial_position[3 * p + 2]};
      const Point q = logical_coordinates(scene.grid, x);
      if (first) {
        origin = x;
        motion.lower = motion.upper = q;
      }
      first = false;
      for (size_t i = 0; i < 3; ++i) {
        motion.lower[i] = std::min(motion.lower[i], q[i]);
        motion.upper[i] = std::max(motion.upper[i], q[i]);
      }
      cells[cell_of(scene, q)].add(
          Vector(x[0] - origin[0], x[1] - origin[1], x[2] - origin[2]),
          Vector(s.displacement[3 * p], s.displacement[3 * p + 1], s.displacement[3 * p + 2]));
    }
  });
  for (const auto& [cell, content] : cells) {
    const Content all = around(cells, cell);
    const Vector x = all.sum_x / all.count, u = all.sum_u / all.count;
    const Matrix C = all.xx - all.count * x * x.transpose();
    const double size = C.trace();
    if (!(size > 0)) continue;
    // What keeps C regular where the particles lie in a row or a plane: nothing is known across it.
    const Matrix regular = C + 1e-9 * size * Matrix::Identity();
    const Matrix G = (all.ux - all.count * u * x.transpose()) * regular.inverse();
    const Vector turn(G(2, 1) - G(1, 2), G(0, 2) - G(2, 0), G(1, 0) - G(0, 1));
    motion.rotation = std::max(motion.rotation, 0.5 * turn.norm());
    const double radius = std::sqrt(size / all.count);
    for (size_t p = 0; p < content.x.size(); ++p) {
      const double unlike = (content.u[p] - u - G * (content.x[p] - x)).norm();
      if (unlike <= motion.unlike) continue;
      motion.unlike = unlike;
      motion.unlike_strain = unlike / radius;
      for (size_t i = 0; i < 3; ++i) motion.at[i] = origin[i] + content.x[p][static_cast<Eigen::Index>(i)];
    }
  }
  return motion;
}

std::vector<std::string> static_advice(const Scene& scene, const ParticleReader& particles,
                                       double largest_strain) {
  if (!(largest_strain > 0)) return {};
  const auto motion = local_motion(scene, particles);
  if (motion.unlike_strain > loose * largest_strain)
    return {fmt::format(
        "a particle at {} is displaced by {:.3g} m against those around it, which no strain explains: too "
        "few particles hold their cells' shape there (2 per cell and direction at least); stresses may be "
        "right, displacements are not",
        position_text(scene, motion.at, 4), motion.unlike)};
  std::vector<std::string> advice;
  const double turned = motion.rotation * motion.rotation;
  if (const double error = std::max(largest_strain, turned); error > small_error)
    advice.push_back(fmt::format(
        "strains up to {:.2g}, rotations up to {:.2g} rad: --static is linear in the displacement, so its "
        "figures are off by about the strain or the square of the rotation, {:.2g} %; an explicit run "
        "follows both",
        largest_strain, motion.rotation, 100 * error));
  for (size_t axis = 0; axis < static_cast<size_t>(scene.dimension); ++axis)
    if (const double stretch = 0.5 * turned;
        stretch > small_stretch * largest_strain && is_held_at_both_ends(scene, motion, axis))
      advice.push_back(fmt::format(
          "the body turns by up to {:.2g} rad and is held at both ends along {}: the stretch that comes with "
          "it, half the square, is {:.2g} times the largest strain, and --static leaves it out: it finds the "
          "body too soft; an explicit run follows it",
          motion.rotation, scene.grid.axis_name(axis), stretch / largest_strain));
  return advice;
}

}  // namespace vsb::app
