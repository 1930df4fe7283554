// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bytes one after the other, out of a simulation and into one, so that its state need not exist twice.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace vsb::app {

class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual void take(const void* from, size_t bytes) = 0;
};

class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// What there was at the beginning.
  virtual size_t size() const = 0;
  /// What has not been taken yet.
  virtual size_t left() const = 0;
  /// The next bytes. There must be as many left.
  virtual void take(void* to, size_t bytes) = 0;
};

/// Counts the bytes.
class ByteCount final : public ByteSink {
 public:
  void take(const void*, size_t bytes) override { count += bytes; }
  size_t count = 0;
};

/// 64-bit FNV-1a, as 16 hexadecimal digits: equal for equal bytes.
class ByteHash final : public ByteSink {
 public:
  void take(const void* from, size_t bytes) override {
    const auto* b = static_cast<const unsigned char*>(from);
    for (size_t n = 0; n < bytes; ++n) hash_ = (hash_ ^ b[n]) * 1099511628211u;
  }
  std::string text() const;

 private:
  std::uint64_t hash_ = 14695981039346656037u;
};

/// Writes numbers, and arrays with their length before them.
class ByteWriter {
 public:
  explicit ByteWriter(ByteSink& to) : to_(to) {}
  template <class T>
  void number(const T& x) {
    to_.take(&x, sizeof x);
  }
  template <class T>
  void array(const T* first, size_t count) {
    number(count);
    values(first, count);
  }
  /// Values of an array whose length is written already.
  template <class T>
  void values(const T* first, size_t count) {
    to_.take(first, count * sizeof(T));
  }

 private:
  ByteSink& to_;
};

/// Reads what a ByteWriter wrote. False where there is not enough, or something else.
class ByteReader {
 public:
  explicit ByteReader(ByteSource& from) : from_(from) {}
  template <class T>
  bool number(T& x) {
    return bytes(&x, sizeof x);
  }
  /// An array of exactly `count` values.
  template <class T>
  bool array(T* first, size_t count) {
    return length(count) && values(first, count);
  }
  /// The length of an array of exactly `count` values, which come next.
  bool length(size_t count) {
    size_t found = 0;
    return number(found) && found == count;
  }
  template <class T>
  bool values(T* first, size_t count) {
    return bytes(first, count * sizeof(T));
  }
  bool at_end() const { return from_.left() == 0; }

 private:
  bool bytes(void* to, size_t n) {
    if (from_.left() < n) return false;
    from_.take(to, n);
    return true;
  }
  ByteSource& from_;
};

}  // namespace vsb::app
