// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The fields of the particles, as a structure of arrays.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vsb/views/tensor.hpp>

namespace vsb {

/// A bundle of Views, one row per particle. The Views are strided, so that they wrap arrays of any layout:
/// assign to them what `wrap` makes of your own arrays, or take them from allocate_particles.
/// Copying the bundle copies no data.
template <int Dim, class Real, class Device>
struct Particles {
  static constexpr int dimension = Dim;                               ///< of space: 1, 2 or 3
  static constexpr int stress_size = symmetric_components(Dim);       ///< stored stress components: 3, 4 or 6
  using real = Real;                                                  ///< type of the numbers
  using device = Device;                                              ///< where the memory is
  using Scalars = Kokkos::View<Real*, Kokkos::LayoutStride, Device>;  ///< one number per particle
  using Fields = Kokkos::View<Real**, Kokkos::LayoutStride, Device>;  ///< one row per particle

  Fields position;        ///< [particle][Dim], m
  Fields velocity;        ///< [particle][Dim], m/s
  Scalars mass;           ///< [particle], kg (kg/m^2 in 1D, kg/m in 2D: per unit of the directions left out)
  Scalars volume;         ///< [particle], m^3 (m in 1D, m^2 in 2D)
  Fields cauchy_stress;   ///< [particle][3, 4 or 6], Pa, tension positive; order xx yy zz xy yz xz
  Fields material_state;  ///< [row][columns]: what a material remembers beside the stress; all zero where it
                          ///< has seen no deformation. No rows unless a body's material needs them, and then
                          ///< for the particles of such bodies alone (Body::state_offset)

  /// Views a caller's array as a field without owning it: entry (p, c) is at
  /// first[p * row_stride + c * column_stride]. Strides count numbers, not bytes.
  static Fields wrap(Real* first, int particles, int columns, int row_stride, int column_stride = 1) {
    check_wrapped(first, particles, columns, row_stride, column_stride);
    return Fields(first,
                  Kokkos::LayoutStride(static_cast<size_t>(particles), static_cast<size_t>(row_stride),
                                       static_cast<size_t>(columns), static_cast<size_t>(column_stride)));
  }
  /// The same for one number per particle: entry p is at first[p * stride].
  static Scalars wrap(Real* first, int particles, int stride = 1) {
    check_wrapped(first, particles, 1, stride, 1);
    return Scalars(first, Kokkos::LayoutStride(static_cast<size_t>(particles), static_cast<size_t>(stride)));
  }

  /// The rows of `position`: marking the boundary needs no other field.
  KOKKOS_FUNCTION int count() const { return static_cast<int>(position.extent(0)); }

  /// The first N columns of a field at particle p.
  template <int N>
  KOKKOS_FUNCTION static Vector<N, Real> row(const Fields& field, int p) {
    Vector<N, Real> v;
    for (int i = 0; i < N; ++i) v[i] = field(p, i);
    return v;
  }
  /// The position of particle p, m.
  KOKKOS_FUNCTION Vector<Dim, Real> position_of(int p) const { return row<Dim>(position, p); }
  /// The velocity of particle p, m/s.
  KOKKOS_FUNCTION Vector<Dim, Real> velocity_of(int p) const { return row<Dim>(velocity, p); }
  /// The Cauchy stress of particle p in Pa, tension positive.
  KOKKOS_FUNCTION SymmetricTensor<Dim, Real> stress_of(int p) const {
    SymmetricTensor<Dim, Real> s;
    for (int c = 0; c < stress_size; ++c) s[c] = cauchy_stress(p, c);
    return s;
  }

  /// Throws std::invalid_argument, naming the field, unless all fields have the shapes given above.
  void check() const {
    const size_t particles = position.extent(0) > 0 ? position.extent(0) : mass.extent(0);
    const auto expect = [&](const char* name, const auto& field, size_t columns, size_t wanted) {
      if (field.extent(0) != particles || columns != wanted)
        throw std::invalid_argument(std::string("vsb::Particles: ") + name + " is " +
                                    std::to_string(field.extent(0)) + " x " + std::to_string(columns) +
                                    ", expected " + std::to_string(particles) + " x " +
                                    std::to_string(wanted) + ": wrap an array of one's own or allocate it");
    };
    expect("position", position, position.extent(1), Dim);
    expect("velocity", velocity, velocity.extent(1), Dim);
    expect("mass", mass, 1, 1);
    expect("volume", volume, 1, 1);
    expect("cauchy_stress", cauchy_stress, cauchy_stress.extent(1), stress_size);
  }

 private:
  /// Throws std::invalid_argument for strides by which two entries (p, c) share an address.
  static void check_wrapped(const Real* first, int particles, int columns, int row_stride,
                            int column_stride) {
    const auto refuse = [&](const std::string& why) {
      throw std::invalid_argument("vsb::Particles::wrap: " + why + " (" + std::to_string(particles) +
                                  " particles, " + std::to_string(columns) + " columns, strides " +
                                  std::to_string(row_stride) + " and " + std::to_string(column_stride) + ")");
    };
    if (particles < 0 || columns < 1 || row_stride < 1 || column_stride < 1)
      refuse("counts and strides must be positive; strides count numbers");
    if (first == nullptr && particles > 0) refuse("the array is a null pointer");
    const auto in_a_row = static_cast<long long>(columns - 1) * column_stride,
               in_a_column = static_cast<long long>(particles - 1) * row_stride;
    if (particles > 1 && in_a_row >= row_stride && in_a_column >= column_stride)
      refuse(
          "rows overlap: the strides are the distances from one particle, and from one component, to the "
          "next");
  }
};

/// Rows to allocate for n particles: an odd number of cache lines, so that no two of the first 64 columns
/// start at the same offset in a 4096-byte page. Columns with the same offset evict each other from the
/// first-level cache.
template <class Real>
int padded_rows(int n) {
  constexpr int line = 64 / static_cast<int>(sizeof(Real));
  const int lines = (n + line - 1) / line;
  return (lines | 1) * line;
}

/// Particles that own their memory: one block, a column per component. The block makes copies to and from a
/// device (or a file) a single transfer.
template <int Dim, class Real, class Device>
struct ParticleBlock {
  using Block = Kokkos::View<Real**, Kokkos::LayoutLeft, Device>;  ///< one column per component
  Block block;                                                     ///< [padded particle][columns]
  Block state_block;                       ///< [padded row][columns] of material_state; empty without it
  Particles<Dim, Real, Device> particles;  ///< Views of the two blocks

  ParticleBlock() = default;
  /// Wraps a block that has the columns position, velocity, mass, volume, stress, for n particles.
  ParticleBlock(Block b, int n) : block(std::move(b)) {
    const auto rows = std::make_pair(0, n);
    int column = 0;
    const auto fields = [&](int width) {
      column += width;
      return Kokkos::subview(block, rows, std::make_pair(column - width, column));
    };
    particles.position = fields(Dim);
    particles.velocity = fields(Dim);
    particles.mass = Kokkos::subview(block, rows, column++);
    particles.volume = Kokkos::subview(block, rows, column++);
    particles.cauchy_stress = fields(Particles<Dim, Real, Device>::stress_size);
  }
  /// Adds a block of material states with the given number of rows in use.
  void set_state(Block b, int rows) {
    state_block = std::move(b);
    particles.material_state = Kokkos::subview(state_block, std::make_pair(0, rows), Kokkos::ALL());
  }
  /// Columns of `block`.
  static constexpr int columns() { return 2 * Dim + 2 + Particles<Dim, Real, Device>::stress_size; }
};

/// Allocates zero-filled particles.
template <int Dim, class Real, class Device>
ParticleBlock<Dim, Real, Device> allocate_particles(int n) {
  using Result = ParticleBlock<Dim, Real, Device>;
  return Result(
      typename Result::Block("vsb::particles", static_cast<size_t>(padded_rows<Real>(n)), Result::columns()),
      n);
}

/// Gives the particles `rows` rows of material state, all zero.
template <int Dim, class Real, class Device>
void allocate_material_state(ParticleBlock<Dim, Real, Device>& block, int rows, int columns) {
  using Block = typename ParticleBlock<Dim, Real, Device>::Block;
  block.set_state(Block("vsb::material_state", static_cast<size_t>(padded_rows<Real>(rows)),
                        static_cast<size_t>(columns)),
                  rows);
}

/// A copy in host memory (the same memory where the device is the host).
template <int Dim, class Real, class Device>
ParticleBlock<Dim, Real, Kokkos::HostSpace> host_copy(const ParticleBlock<Dim, Real, Device>& source) {
  const Kokkos::HostSpace host;
  ParticleBlock<Dim, Real, Kokkos::HostSpace> copy(
      Kokkos::create_mirror_view_and_copy(host, source.block, "vsb::particles on host"),
      source.particles.count());
  if (source.state_block.size() > 0)
    copy.set_state(
        Kokkos::create_mirror_view_and_copy(host, source.state_block, "vsb::material_state on host"),
        static_cast<int>(source.particles.material_state.extent(0)));
  return copy;
}

/// Copies the particles of host_copy back to the device.
template <int Dim, class Real, class Device>
void copy_to_device(const ParticleBlock<Dim, Real, Kokkos::HostSpace>& from,
                    const ParticleBlock<Dim, Real, Device>& to) {
  Kokkos::deep_copy(to.block, from.block);
  if (to.state_block.size() > 0) Kokkos::deep_copy(to.state_block, from.state_block);
}

}  // namespace vsb
