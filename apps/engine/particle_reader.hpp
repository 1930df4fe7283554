// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The particles of one moment on the host, in double precision: some thousands at a time, and the fields
/// that are asked for, since all of them would be more than the particles themselves.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "setup/place_particles.hpp"

namespace vsb::app {

/// Fields of particles, to be combined by |.
namespace field {
constexpr unsigned initial_position = 1, position = 2, velocity = 4, cauchy_stress = 8, volume = 16,
                   mass = 32, in_boundary = 64, plastic_strain = 128, recovered_stress = 256;
}

/// Particles at one moment, those of consecutive numbers, with some fields; the others are empty. Vectors
/// have 3 components per particle, stresses 6 (xx yy zz xy yz xz).
struct Snapshot {
  long long step = 0;
  double time = 0;   ///< s
  size_t first = 0;  ///< number of the first particle
  std::vector<std::int64_t> id;
  std::vector<double> initial_position;    ///< m
  std::vector<double> displacement;        ///< m, where both positions are asked for
  std::vector<double> position, velocity;  ///< m, m/s
  std::vector<double> cauchy_stress;       ///< Pa, tension positive
  std::vector<double> volume, mass;        ///< m^3, kg
  std::vector<unsigned char> in_boundary;  ///< 1 where a particle contributes to a node with a traction
  std::vector<PlacedBody> bodies;          ///< which particles are whose, of all there are
  std::vector<double> recovered_stress;    ///< as cauchy_stress; see report/recovered_stress.hpp
  std::vector<double> plastic_strain;      ///< as cauchy_stress; empty unless a body is plastic

  size_t count() const { return id.size(); }
};

/// Appends to the fields that `more` has.
void append(Snapshot& to, const Snapshot& more);

/// Particles to be read; only while their simulation stays as it is.
class ParticleReader {
 public:
  using Work = std::function<void(const Snapshot&)>;
  virtual ~ParticleReader() = default;

  long long step = 0;
  double time = 0;  ///< s
  size_t count = 0;
  bool plastic = false;                  ///< whether there is a plastic strain
  std::vector<double> recovered_stress;  ///< [6 per particle]: whoever recovers it puts it here
  std::map<int, Point> outside;          ///< where particles are whose source has other positions, as there

  /// Calls work(snapshot) for all particles in the order of their numbers, as many at a time as suits.
  void for_each_range(unsigned fields, const Work& work) const;
  /// All of them at once.
  Snapshot all(unsigned fields) const;

 private:
  /// The same but for the recovered stress.
  virtual void visit(unsigned fields, const std::function<void(Snapshot&)>& work) const = 0;
};

/// Where the fields of particles come from.
class FieldSource {
 public:
  virtual ~FieldSource() = default;
  /// One field but the initial position and the flags, of particles first, first + 1, ...; `to` has the
  /// right size, and zeros. Positions are counted from the local origin.
  virtual void read(unsigned field, size_t first, std::vector<double>& to) = 0;
  virtual void read_flags(size_t first, std::vector<unsigned char>& to) = 0;
};

/// Reads the particles of a scene. Where they were at the start is found anew from the scene, but for cut
/// lattices.
class SceneReader final : public ParticleReader {
 public:
  /// `ids`: of those that are left; empty where all are.
  SceneReader(const Scene& scene, const std::vector<CutStarts>& starts, const std::vector<int>& ids,
              std::vector<PlacedBody> bodies, std::unique_ptr<FieldSource> source);

 private:
  void visit(unsigned fields, const std::function<void(Snapshot&)>& work) const override;
  /// With positions as the source has them, counted from origin_.
  Snapshot range(unsigned fields, size_t first, size_t size) const;
  void to_scene_positions(std::vector<double>& positions) const;
  std::int64_t id_of(size_t p) const { return ids_.empty() ? static_cast<std::int64_t>(p) : ids_[p]; }

  const Scene& scene_;
  Point origin_;  ///< setup/local_origin.hpp
  const std::vector<CutStarts>& starts_;
  const std::vector<int>& ids_;
  std::vector<PlacedBody> bodies_;
  std::unique_ptr<FieldSource> source_;
};

}  // namespace vsb::app
