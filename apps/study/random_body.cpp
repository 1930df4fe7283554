// SPDX-License-Identifier: BSD-3-Clause
#include "study/random_body.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <random>

namespace vsb::app {

namespace {

/// The distributions of the standard library differ from one to the next; its engines do not.
class Random {
 public:
  explicit Random(long long seed) : engine_(static_cast<std::uint64_t>(seed)) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  int below(int count) { return static_cast<int>(between(0, count)); }

 private:
  std::mt19937_64 engine_;
};

using Vector = std::vector<double>;  ///< of the scene's dimension

std::string toml(const Vector& v) {
  return fmt::format("[{}]", fmt::join(v, ", "));
}

/// A ball or a box at most this far from `center` in every direction, and at least some of that.
std::string random_part(Random& random, const Vector& center, double smallest, double largest) {
  if (random.below(2) == 0)
    return fmt::format("{{ ball = {{ center = {}, radius = {} }} }}", toml(center),
                       random.between(smallest, largest));
  Vector lower, upper;
  for (const double c : center) {
    const double half = random.between(smallest, largest);
    lower.push_back(c - half);
    upper.push_back(c + half);
  }
  return fmt::format("{{ box = {{ lower = {}, upper = {} }} }}", toml(lower), toml(upper));
}

/// A large part in the middle; the others reach over its edge, lie in it, or miss it.
std::string random_shape(Random& random, const Vector& center, double half_width) {
  std::string shape = random_part(random, center, 0.65 * half_width, 0.85 * half_width);
  for (int more = 1 + random.below(3); more > 0; --more) {
    const char* kind = random.below(2) == 0 ? "union" : "difference";
    Vector at = center;
    for (double& x : at) x += random.between(-0.5, 0.5) * half_width;
    shape = fmt::format("{{ {} = [{}, {}] }}", kind, shape,
                        random_part(random, at, 0.15 * half_width, 0.4 * half_width));
  }
  return shape;
}

}  // namespace

std::string why_no_random_body(const Scene& scene) {
  if (scene.bodies.size() != 1) return "random bodies need a scene with one body, which they replace";
  if (scene.grid.mapped()) return "random bodies need a scene with a uniform grid";
  if (!std::holds_alternative<UniformLattice>(scene.bodies.front().lattice))
    return "random bodies need a scene whose body has a lattice.uniform, which they move";
  return "";
}

std::vector<std::string> random_body(const Scene& scene, long long seed, double half_width) {
  constexpr int empty_cells =
      2;  // on either side, for the shift of half a cell and the cells beyond a boundary
  Random random(seed);
  Vector lower, upper, center, spacing, origin;
  for (size_t i = 0; i < static_cast<size_t>(scene.dimension); ++i) {
    const double h = scene.grid.spacing[i];
    const double cells = std::ceil(2 * half_width / h) + 2 * empty_cells;
    lower.push_back(random.between(-3, 3) * h);
    upper.push_back(lower[i] + cells * h);
    center.push_back(lower[i] + (cells / 2 + random.between(-0.5, 0.5)) * h);
  }
  const double per_cell = random.between(2, 3.2);
  for (size_t i = 0; i < lower.size(); ++i) {
    spacing.push_back(scene.grid.spacing[i] / per_cell);
    origin.push_back(lower[i] + random.between(0, 1) * spacing[i]);
  }
  return {"grid.lower=" + toml(lower), "grid.upper=" + toml(upper),
          "body[0].lattice.uniform.spacing=" + toml(spacing),
          "body[0].lattice.uniform.origin=" + toml(origin),
          "body[0].shape=" + random_shape(random, center, half_width)};
}

}  // namespace vsb::app
