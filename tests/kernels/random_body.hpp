// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Closed bodies of random shape, on a random lattice, anywhere on a grid of unit cells.
#pragma once

#include <vsb/kernels/readout/balance.hpp>

#include "support.hpp"

namespace vsb::test {

/// Balls and boxes, added or taken away one after the other.
template <int Dim>
struct RandomShape {
  struct Part {
    bool is_ball, is_added;
    Vector<Dim, double> center, half;  ///< a ball has the radius half[0]
  };
  std::vector<Part> parts;

  /// Within a box of half width `half_width` about the origin.
  RandomShape(Random& random, double half_width) {
    const int count = 2 + random.index(3);
    for (int n = 0; n < count; ++n) {
      Part part{random.index(2) == 0, n == 0 || random.index(2) == 0, {}, {}};
      for (int i = 0; i < Dim; ++i) {
        part.half[i] = (n == 0 ? random(0.65, 0.85) : random(0.15, 0.4)) * half_width;
        part.center[i] = n == 0 ? 0 : random(-0.5, 0.5) * half_width;
      }
      parts.push_back(part);
    }
  }
  bool operator()(const Vector<Dim, double>& x) const {
    bool inside = false;
    for (const auto& part : parts) {
      const auto d = x - part.center;
      bool hit = dot(d, d) < part.half[0] * part.half[0];
      if (!part.is_ball) {
        hit = true;
        for (int i = 0; i < Dim; ++i) hit = hit && std::abs(d[i]) < part.half[i];
      }
      if (hit) inside = part.is_added;
    }
    return inside;
  }
};

/// The particles of a random shape: 2 to 3 per cell and direction, the lattice anywhere with respect to the
/// grid.
template <int Dim>
struct RandomBody {
  int half_width;  ///< of the box around the shape, cells
  LinearBasis<Dim, double> basis;
  ParticleBlock<Dim, double, Device> block;
  Vector<Dim, double> center;  ///< of the shape
  double spacing, area;        ///< of the lattice; of the faces between a lattice cell in and one out, m

  explicit RandomBody(unsigned seed, int half_width_in_cells = 7) : half_width(half_width_in_cells) {
    Random random(seed);
    const RandomShape<Dim> shape(random, half_width);
    Vector<Dim, double> lower;
    Vector<Dim, int> cells;
    for (int i = 0; i < Dim; ++i) {
      lower[i] = random(-3, 3);
      cells[i] = 2 * half_width + 4;
      center[i] = lower[i] + half_width + 2 + random(-0.5, 0.5);
    }
    basis.grid = UniformGrid<Dim, double>(lower, unit(), cells);
    spacing = 1 / random(2, 3.2);
    Vector<Dim, double> shift;
    for (int i = 0; i < Dim; ++i) shift[i] = random(0, 1) * spacing;
    const int n = 2 * static_cast<int>(half_width / spacing) + 2;
    std::vector<Vector<Dim, double>> positions;
    int faces = 0;
    const CellNumbering<Dim> lattice{count(n)};
    for_each_cell(lattice, [&](const Vector<Dim, int>& ijk) {
      Vector<Dim, double> x;
      for (int i = 0; i < Dim; ++i) x[i] = (ijk[i] - n / 2) * spacing + shift[i];
      if (!shape(x)) return;
      positions.push_back(center + x);
      for (int i = 0; i < Dim; ++i)
        for (const double step : {-spacing, spacing}) {
          auto neighbour = x;
          neighbour[i] += step;
          if (!shape(neighbour)) ++faces;
        }
    });
    area = faces * std::pow(spacing, Dim - 1);
    block = allocate_particles<Dim, double, Device>(static_cast<int>(positions.size()));
    edit(block, [&](const auto& p) {
      for (int k = 0; k < p.count(); ++k) {
        for (int i = 0; i < Dim; ++i) p.position(k, i) = positions[static_cast<size_t>(k)][i];
        p.volume(k) = std::pow(spacing, Dim);
        p.mass(k) = p.volume(k);
      }
    });
  }
  double volume() const {
    const auto p = read(block);
    double sum = 0;
    for (int k = 0; k < p.count(); ++k) sum += p.volume(k);
    return sum;
  }

  /// The resultant of a field at the boundary nodes or at all active ones; the torque about the origin.
  template <class Field>
  Balance<Dim> resultant(const Field& field, bool at_all_active_nodes) {
    auto state = make_state(block.particles, basis);
    Kokkos::deep_copy(state.occupancy.tractions, 1u);
    state.occupancy.at_all_active_nodes = at_all_active_nodes ? 1 : 0;
    REQUIRE(update_occupancy(Exec(), block.particles, state.occupancy, basis) == -1);
    return balance(Exec(), state, std::vector<Body<double>>{}, basis, field, StepOptions<Dim, double>{});
  }

 private:
  static Vector<Dim, double> unit() {
    Vector<Dim, double> v;
    for (int i = 0; i < Dim; ++i) v[i] = 1;
    return v;
  }
  static Vector<Dim, int> count(int n) {
    Vector<Dim, int> v;
    for (int i = 0; i < Dim; ++i) v[i] = n;
    return v;
  }
};

template <int N>
double length(const Vector<N, double>& v) {
  return std::sqrt(dot(v, v));
}

}  // namespace vsb::test
