// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The fields of particles as the particle kernels have them.
#pragma once

#include <algorithm>
#include <functional>
#include <vsb/kernels/particles/update_stress.hpp>
#include "engine/particle_reader.hpp"
#include "engine/read_rows.hpp"

namespace vsb::app {

/// Row r: entry first + r + offset of a field, for particles begin, ..., end - 1.
template <class Field>
struct ReadField {
  Field from;
  int columns, first, offset, begin, end;
  Rows rows;
  KOKKOS_FUNCTION void operator()(int r) const {
    const int p = first + r;
    if (p < begin || p >= end) return;
    for (int c = 0; c < columns; ++c) rows(r, c) = from(p + offset, c);
  }
};

template <int Dim, class Real>
class BlockFields final : public FieldSource {
 public:
  using Device = ExecutionSpace::device_type;
  using P = Particles<Dim, Real, Device>;

  /// `flags` gives those of all particles; it is called at most once, when they are wanted.
  BlockFields(const ExecutionSpace& exec, const P& particles, const std::vector<Body<Real>>& bodies,
              std::function<Flags()> flags)
      : exec_(exec), particles_(particles), bodies_(bodies), find_flags_(std::move(flags)) {}

  void read(unsigned field, size_t first, std::vector<double>& to) override {
    const int begin = static_cast<int>(first);
    const auto read = [&](const auto& from, int columns, size_t into, int offset, int from_particle,
                          int to_particle) {
      read_rows(
          exec_, "vsb::read_field", into,
          [&](const Rows& rows) {
            return ReadField<std::decay_t<decltype(from)>>{from,          columns,     begin, offset,
                                                           from_particle, to_particle, rows};
          },
          to);
    };
    const auto read_all = [&](const auto& from, int columns, size_t into) {
      read(from, columns, into, 0, 0, particles_.count());
    };
    switch (field) {
      case field::position:
        return read_all(particles_.position, Dim, 3);
      case field::velocity:
        return read_all(particles_.velocity, Dim, 3);
      case field::cauchy_stress:
        return read_all(particles_.cauchy_stress, P::stress_size, 6);
      case field::volume:
        return read_all(as_column(particles_.volume), 1, 1);
      case field::mass:
        return read_all(as_column(particles_.mass), 1, 1);
      default:
        for (const auto& body : bodies_)
          if (is_plastic(body.material))
            read(particles_.material_state, P::stress_size, 6, body.state_offset, body.first, body.last);
    }
  }

  void read_flags(size_t first, std::vector<unsigned char>& to) override {
    if (flags_.size() == 0) flags_ = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), find_flags_());
    std::copy_n(&flags_(first), to.size(), to.begin());
  }

 private:
  static typename P::Fields as_column(const typename P::Scalars& field) {
    return typename P::Fields(field.data(), Kokkos::LayoutStride(field.extent(0), field.stride(0), 1, 1));
  }

  ExecutionSpace exec_;
  P particles_;
  const std::vector<Body<Real>>& bodies_;
  std::function<Flags()> find_flags_;
  typename Flags::HostMirror flags_;
};

}  // namespace vsb::app
