// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Small vectors and tensors of compile-time size, for one point in space. T is a scalar or a pack of
/// scalars.
#pragma once

#include <vsb/views/kokkos_compat.hpp>

namespace vsb {

/// N numbers: a point, a velocity, a force.
template <int N, class T>
struct Vector {
  static constexpr int size = N;  ///< number of components
  T data[N];                      ///< by direction x, y, z

  /// The null vector.
  KOKKOS_FUNCTION static Vector zero() {
    Vector v;
    for (int i = 0; i < N; ++i) v.data[i] = T(0);
    return v;
  }
  ///@{
  /// Component i in [0, N).
  KOKKOS_FUNCTION T& operator[](int i) { return data[i]; }
  KOKKOS_FUNCTION const T& operator[](int i) const { return data[i]; }
  ///@}

  ///@{
  /// Component by component.
  KOKKOS_FUNCTION Vector& operator+=(const Vector& b) {
    for (int i = 0; i < N; ++i) data[i] += b.data[i];
    return *this;
  }
  KOKKOS_FUNCTION Vector& operator-=(const Vector& b) {
    for (int i = 0; i < N; ++i) data[i] -= b.data[i];
    return *this;
  }
  KOKKOS_FUNCTION Vector& operator*=(T s) {
    for (int i = 0; i < N; ++i) data[i] *= s;
    return *this;
  }
  KOKKOS_FUNCTION friend Vector operator+(Vector a, const Vector& b) { return a += b; }
  KOKKOS_FUNCTION friend Vector operator-(Vector a, const Vector& b) { return a -= b; }
  KOKKOS_FUNCTION friend Vector operator*(T s, Vector a) { return a *= s; }
  ///@}
};

/// The scalar product a . b.
template <int N, class T>
KOKKOS_INLINE_FUNCTION T dot(const Vector<N, T>& a, const Vector<N, T>& b) {
  T sum = a[0] * b[0];
  for (int i = 1; i < N; ++i) sum += a[i] * b[i];
  return sum;
}

/// A general second-order tensor, such as the velocity gradient L(i, j) = dv_i / dx_j.
template <int Dim, class T>
struct Matrix {
  T data[Dim][Dim];  ///< [row][column]

  /// The null tensor.
  KOKKOS_FUNCTION static Matrix zero() {
    Matrix m;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) m.data[i][j] = T(0);
    return m;
  }
  /// The unit tensor.
  KOKKOS_FUNCTION static Matrix identity() {
    Matrix m = zero();
    for (int i = 0; i < Dim; ++i) m.data[i][i] = T(1);
    return m;
  }
  ///@{
  /// Component (i, j), each in [0, Dim).
  KOKKOS_FUNCTION T& operator()(int i, int j) { return data[i][j]; }
  KOKKOS_FUNCTION const T& operator()(int i, int j) const { return data[i][j]; }
  ///@}
};

/// The sum of the diagonal.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION T trace(const Matrix<Dim, T>& m) {
  T sum = m(0, 0);
  for (int i = 1; i < Dim; ++i) sum += m(i, i);
  return sum;
}

/// The determinant.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION T determinant(const Matrix<Dim, T>& m) {
  static_assert(Dim >= 1 && Dim <= 3, "determinant: dimension 1, 2 or 3");
  if constexpr (Dim == 1) {
    return m(0, 0);
  } else if constexpr (Dim == 2) {
    return m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0);
  } else {
    return m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) -
           m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0)) +
           m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
  }
}

/// The cofactor det(m) m^-T, also where m has no inverse. It maps area vectors (Nanson).
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Matrix<Dim, T> cofactor(const Matrix<Dim, T>& m) {
  Matrix<Dim, T> c;
  if constexpr (Dim == 1) {
    c(0, 0) = T(1);
  } else if constexpr (Dim == 2) {
    c(0, 0) = m(1, 1);
    c(0, 1) = -m(1, 0);
    c(1, 0) = -m(0, 1);
    c(1, 1) = m(0, 0);
  } else {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        c(i, j) = m(i1, j1) * m(i2, j2) - m(i1, j2) * m(i2, j1);
      }
  }
  return c;
}

/// The inverse of a regular tensor.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Matrix<Dim, T> inverse(const Matrix<Dim, T>& m) {
  const T factor = T(1) / determinant(m);
  const auto c = cofactor(m);
  Matrix<Dim, T> r;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j) r(i, j) = factor * c(j, i);
  return r;
}

/// m . v.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Vector<Dim, T> operator*(const Matrix<Dim, T>& m, const Vector<Dim, T>& v) {
  Vector<Dim, T> r;
  for (int i = 0; i < Dim; ++i) {
    r[i] = m(i, 0) * v[0];
    for (int j = 1; j < Dim; ++j) r[i] += m(i, j) * v[j];
  }
  return r;
}

/// Number of stored components of a symmetric stress or strain: those that uniaxial strain (xx, yy, zz),
/// plane strain (xx, yy, zz, xy) or a general state (xx, yy, zz, xy, yz, xz) can make non-zero. Each is a
/// prefix of the next.
KOKKOS_INLINE_FUNCTION constexpr int symmetric_components(int dimension) {
  return dimension == 1 ? 3 : dimension == 2 ? 4 : 6;
}

/// Where component (i, j) is stored.
KOKKOS_INLINE_FUNCTION constexpr int symmetric_index(int i, int j) {
  return i == j ? i : i + j == 1 ? 3 : i + j == 3 ? 4 : 5;
}

/// A symmetric tensor in a Dim-dimensional problem; always with the three normal components.
template <int Dim, class T>
struct SymmetricTensor {
  static constexpr int size = symmetric_components(Dim);  ///< stored components: 3, 4 or 6
  T data[size];  ///< xx, yy, zz, xy, yz, xz, as far as they are stored

  /// The null tensor.
  KOKKOS_FUNCTION static SymmetricTensor zero() {
    SymmetricTensor s;
    for (int c = 0; c < size; ++c) s.data[c] = T(0);
    return s;
  }
  /// `value` times the unit tensor of three dimensions, whatever Dim is.
  KOKKOS_FUNCTION static SymmetricTensor isotropic(T value) {
    SymmetricTensor s = zero();
    for (int i = 0; i < 3; ++i) s.data[i] = value;
    return s;
  }
  ///@{
  /// Stored component c in [0, size).
  KOKKOS_FUNCTION T& operator[](int c) { return data[c]; }
  KOKKOS_FUNCTION const T& operator[](int c) const { return data[c]; }
  ///@}
  /// Component (i, j), each in [0, Dim), or (2, 2), the normal component zz, for any Dim.
  KOKKOS_FUNCTION const T& operator()(int i, int j) const { return data[symmetric_index(i, j)]; }

  ///@{
  /// Component by component.
  KOKKOS_FUNCTION SymmetricTensor& operator+=(const SymmetricTensor& b) {
    for (int c = 0; c < size; ++c) data[c] += b.data[c];
    return *this;
  }
  KOKKOS_FUNCTION SymmetricTensor& operator-=(const SymmetricTensor& b) {
    for (int c = 0; c < size; ++c) data[c] -= b.data[c];
    return *this;
  }
  KOKKOS_FUNCTION SymmetricTensor& operator*=(T s) {
    for (int c = 0; c < size; ++c) data[c] *= s;
    return *this;
  }
  KOKKOS_FUNCTION friend SymmetricTensor operator+(SymmetricTensor a, const SymmetricTensor& b) {
    return a += b;
  }
  KOKKOS_FUNCTION friend SymmetricTensor operator-(SymmetricTensor a, const SymmetricTensor& b) {
    return a -= b;
  }
  KOKKOS_FUNCTION friend SymmetricTensor operator*(T s, SymmetricTensor a) { return a *= s; }
  ///@}
};

/// s . v, with the in-plane (Dim x Dim) part of s: the traction on a face of normal v, or, with v = grad N, a
/// nodal force.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Vector<Dim, T> operator*(const SymmetricTensor<Dim, T>& s, const Vector<Dim, T>& v) {
  Vector<Dim, T> r;
  for (int i = 0; i < Dim; ++i) {
    r[i] = s(i, 0) * v[0];
    for (int j = 1; j < Dim; ++j) r[i] += s(i, j) * v[j];
  }
  return r;
}

}  // namespace vsb
