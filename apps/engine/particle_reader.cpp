// SPDX-License-Identifier: BSD-3-Clause
#include "engine/particle_reader.hpp"

#include <algorithm>

#include "setup/local_origin.hpp"

namespace vsb::app {

namespace {

constexpr size_t range_size = 8192;

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

void append(Snapshot& to, const Snapshot& more) {
  append(to.id, more.id);
  for (const auto of : {&Snapshot::initial_position, &Snapshot::displacement, &Snapshot::position,
                        &Snapshot::velocity, &Snapshot::cauchy_stress, &Snapshot::volume, &Snapshot::mass,
                        &Snapshot::recovered_stress, &Snapshot::plastic_strain})
    append(to.*of, more.*of);
  append(to.in_boundary, more.in_boundary);
}

void ParticleReader::for_each_range(unsigned fields, const Work& work) const {
  visit(fields, [&](Snapshot& s) {
    if ((fields & field::recovered_stress) != 0 && !recovered_stress.empty()) {
      const auto begin = recovered_stress.begin() + static_cast<std::ptrdiff_t>(6 * s.first);
      s.recovered_stress.assign(begin, begin + static_cast<std::ptrdiff_t>(6 * s.count()));
    }
    work(s);
  });
}

Snapshot ParticleReader::all(unsigned fields) const {
  Snapshot whole;
  for_each_range(fields, [&](const Snapshot& s) {
    if (s.first == 0) {
      whole.step = s.step;
      whole.time = s.time;
      whole.bodies = s.bodies;
      whole.id.reserve(count);
      for (const auto of : {&Snapshot::initial_position, &Snapshot::displacement, &Snapshot::position,
                            &Snapshot::velocity, &Snapshot::cauchy_stress, &Snapshot::volume, &Snapshot::mass,
                            &Snapshot::recovered_stress, &Snapshot::plastic_strain})
        (whole.*of).reserve((s.*of).size() / s.count() * count);
    }
    append(whole, s);
  });
  return whole;
}

SceneReader::SceneReader(const Scene& scene, const std::vector<CutStarts>& starts,
                         const std::vector<int>& ids, std::vector<PlacedBody> bodies,
                         std::unique_ptr<FieldSource> source)
    : scene_(scene),
      origin_(local_origin(scene)),
      starts_(starts),
      ids_(ids),
      bodies_(std::move(bodies)),
      source_(std::move(source)) {}

void SceneReader::to_scene_positions(std::vector<double>& positions) const {
  for (size_t i = 0; i < positions.size(); ++i) positions[i] += origin_[i % 3];
}

Snapshot SceneReader::range(unsigned fields, size_t first, size_t size) const {
  Snapshot s;
  s.step = step;
  s.time = time;
  s.first = first;
  s.bodies = bodies_;
  s.id.resize(size);
  for (size_t n = 0; n < size; ++n) s.id[n] = id_of(first + n);
  const auto read = [&](unsigned field, std::vector<double>& to, size_t columns) {
    if ((fields & field) == 0) return;
    to.assign(columns * size, 0.0);
    source_->read(field, first, to);
  };
  read(field::position, s.position, 3);
  if (!s.position.empty())
    for (const auto& [p, x] : outside)
      if (const auto n = static_cast<size_t>(p); n >= first && n < first + size)
        std::copy(x.begin(), x.end(), s.position.begin() + static_cast<std::ptrdiff_t>(3 * (n - first)));
  read(field::velocity, s.velocity, 3);
  read(field::cauchy_stress, s.cauchy_stress, 6);
  read(field::volume, s.volume, 1);
  read(field::mass, s.mass, 1);
  if (plastic) read(field::plastic_strain, s.plastic_strain, 6);
  if ((fields & field::in_boundary) != 0) {
    s.in_boundary.assign(size, 0);
    source_->read_flags(first, s.in_boundary);
  }
  return s;
}

void SceneReader::visit(unsigned fields, const std::function<void(Snapshot&)>& work) const {
  if ((fields & field::initial_position) == 0) {
    for (size_t first = 0; first < count; first += range_size) {
      auto s = range(fields, first, std::min(range_size, count - first));
      to_scene_positions(s.position);
      work(s);
    }
    return;
  }
  std::vector<double> start;
  size_t first = 0;
  std::int64_t number = 0;
  const auto pass_on = [&] {
    if (start.empty()) return;
    const size_t size = start.size() / 3;
    auto s = range(fields, first, size);
    s.displacement = s.position;  // the difference of small numbers, before the origin is added
    for (size_t i = 0; i < s.displacement.size(); ++i) s.displacement[i] -= start[i];
    s.initial_position = std::move(start);
    to_scene_positions(s.initial_position);
    to_scene_positions(s.position);
    work(s);
    start.clear();
    first += size;
  };
  for_each_start(scene_, starts_, [&](const Point& x) {
    const size_t next = first + start.size() / 3;
    if (next >= count || number++ != id_of(next)) return;
    for (size_t i = 0; i < 3; ++i) {  // in the precision in which the particle began
      const double along = x[i] - origin_[i];
      start.push_back(scene_.single_precision ? static_cast<double>(static_cast<float>(along)) : along);
    }
    if (start.size() == 3 * range_size) pass_on();
  });
  pass_on();
}

}  // namespace vsb::app
