// SPDX-License-Identifier: BSD-3-Clause
#include "setup/loads.hpp"

#include <cmath>

#include "setup/loaded_pieces.hpp"

namespace vsb::app {

namespace {

double distance2(const Point& a, const Point& b) {
  double sum = 0;
  for (size_t i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

/// Finds the nearest of some particles by buckets of a given size.
class NearestParticle {
 public:
  NearestParticle(const PlacedParticles& placed, const Region& layer, double bucket_size)
      : placed_(placed), size_(bucket_size) {
    for (size_t p = 0; p < placed.position.size(); ++p)
      if (layer(placed.position[p])) buckets_[bucket(placed.position[p])].push_back(static_cast<int>(p));
  }
  /// -1 where no particle is within a bucket's size.
  int operator()(const Point& x) const {
    const auto centre = bucket(x);
    int nearest = -1;
    double least = size_ * size_;
    for (int k = -1; k <= 1; ++k)
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
          const auto found = buckets_.find({centre[0] + i, centre[1] + j, centre[2] + k});
          if (found == buckets_.end()) continue;
          for (const int p : found->second) {
            const double d = distance2(placed_.position[static_cast<size_t>(p)], x);
            if (d < least || (d == least && p < nearest)) {
              nearest = p;
              least = d;
            }
          }
        }
    return nearest;
  }

 private:
  using Bucket = std::array<long long, 3>;
  Bucket bucket(const Point& x) const {
    Bucket b;
    for (size_t i = 0; i < 3; ++i) b[i] = std::llround(std::floor(x[i] / size_));
    return b;
  }
  const PlacedParticles& placed_;
  double size_;
  std::map<Bucket, std::vector<int>> buckets_;
};

/// Calls work(piece) for the pieces of the bodies' surface on which traction k acts.
template <class Work>
void for_each_piece(const Scene& scene, size_t k, const Work& work) {
  const auto& traction = scene.tractions[k];
  for (const auto& piece :
       surface_pieces(union_of_bodies(scene), surface_box(scene, traction.points_per_cell)))
    if (traction.surface(piece.position)) work(piece);
}

Point force_on(const Stress6& s, const Point& area) {
  return {s[0] * area[0] + s[3] * area[1] + s[5] * area[2], s[3] * area[0] + s[1] * area[1] + s[4] * area[2],
          s[5] * area[0] + s[4] * area[1] + s[2] * area[2]};
}

template <int Dim>
Stress6 stress_at(const Scene& scene, const TractionSpec& traction, const Point& x) {
  Vector<Dim, double> position;
  for (size_t i = 0; i < Dim; ++i) position[static_cast<int>(i)] = x[i];
  const auto s = stress_field<Dim, double>(scene, traction.field).at(position).stress;
  Stress6 stress{};
  for (size_t c = 0; c < SymmetricTensor<Dim, double>::size; ++c) stress[c] = s[static_cast<int>(c)];
  return stress;
}

}  // namespace

TractionMask imposed_by(const Scene& scene, Imposition imposition) {
  TractionMask mask = 0;
  for (size_t k = 0; k < scene.tractions.size(); ++k)
    if (scene.tractions[k].imposition == imposition) mask |= TractionMask(1) << k;
  return mask;
}

TractionMask tractions_at(const Scene& scene, TractionMask among, const Point& x) {
  TractionMask mask = 0;
  for (size_t k = 0; k < scene.tractions.size(); ++k)
    if ((among >> k & 1u) && scene.tractions[k].surface(x)) mask |= TractionMask(1) << k;
  return mask;
}

TractionMask carried_tractions(const Scene& scene) {
  TractionMask mask = 0;
  for (size_t k = 0; k < scene.tractions.size(); ++k)
    if (scene.tractions[k].carried) mask |= TractionMask(1) << k;
  return mask;
}

std::vector<TractionMask> carried_by_particles(const Scene& scene, const PlacedParticles& placed) {
  const TractionMask carried = carried_tractions(scene);
  if (carried == 0) return {};
  std::vector<TractionMask> masks;
  TractionMask found = 0;
  for (const Point& x : placed.position) {
    masks.push_back(tractions_at(scene, carried, x));
    found |= masks.back();
  }
  for (size_t k = 0; k < scene.tractions.size(); ++k)
    if ((carried & ~found) >> k & 1u)
      throw SetupError(fmt::format(
          "traction '{}' has configuration = \"initial\", and no particle lies in its 'surface' at "
          "the start to carry it: let the surface reach a cell or two into the body",
          scene.tractions[k].name));
  return masks;
}

std::vector<LoadedPiece> loaded_pieces(const Scene& scene, size_t k, const PlacedParticles& placed) {
  const auto& traction = scene.tractions[k];
  const double largest = *std::max_element(placed.volume.begin(), placed.volume.end());
  const double search_radius = 4 * std::pow(largest, 1.0 / scene.dimension);
  const NearestParticle nearest(placed, traction.layer, search_radius);
  std::vector<LoadedPiece> pieces;
  for_each_piece(scene, k, [&](const SurfacePiece& piece) {
    const int p = nearest(piece.position);
    if (p < 0)
      throw SetupError(
          traction.where,
          fmt::format("traction '{}' has no material point within {:.6g} m of {} on its surface: check its "
                      "'layer'",
                      traction.name, search_radius, position_text(scene, piece.position)));
    pieces.push_back({piece, p});
  });
  return pieces;
}

std::vector<LoadedPoint> loaded_points(const Scene& scene, const PlacedParticles& placed) {
  std::vector<LoadedPoint> points;
  for (size_t k = 0; k < scene.tractions.size(); ++k) {
    const auto& traction = scene.tractions[k];
    const TractionMask mask = TractionMask(1) << k;
    if (traction.imposition == Imposition::boundary_particles)
      for_each_piece(scene, k, [&](const SurfacePiece& piece) {
        points.push_back({piece.position, piece.area, mask, carried_by_grid});
      });
    if (traction.imposition == Imposition::material_points) {
      std::map<int, Point> area;
      for (const auto& [piece, p] : loaded_pieces(scene, k, placed))
        for (size_t i = 0; i < 3; ++i) area[p][i] += piece.area[i];
      for (const auto& [p, sum] : area)
        points.push_back({placed.position[static_cast<size_t>(p)], sum, mask, p});
    }
  }
  return points;
}

Stress6 full_stress(const Scene& scene, const TractionSpec& traction, const Point& x) {
  return scene.dimension == 1   ? stress_at<1>(scene, traction, x)
         : scene.dimension == 2 ? stress_at<2>(scene, traction, x)
                                : stress_at<3>(scene, traction, x);
}

std::vector<Resultant> exact_resultants(const Scene& scene, const Point& about) {
  std::vector<Resultant> resultants(scene.tractions.size());
  for (size_t k = 0; k < scene.tractions.size(); ++k) {
    auto& r = resultants[k];
    for_each_piece(scene, k, [&](const SurfacePiece& piece) {
      const auto f = force_on(full_stress(scene, scene.tractions[k], piece.position), piece.area);
      Point x = piece.position;
      for (size_t i = 0; i < 3; ++i) x[i] -= about[i];
      for (size_t i = 0; i < 3; ++i) {
        const size_t j = (i + 1) % 3, l = (i + 2) % 3;
        r.force[i] += f[i];
        r.torque[i] += x[j] * f[l] - x[l] * f[j];
      }
      r.load += std::hypot(f[0], f[1], f[2]);
    });
  }
  return resultants;
}

}  // namespace vsb::app
