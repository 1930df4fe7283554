// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The little of HDF5 that frames and checkpoints need. Every function throws FileError with the path and the
/// object's name.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/byte_stream.hpp"

namespace vsb::app {

/// A file that cannot be read or written (exit code 4).
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Renames a file that is complete onto its final path, after flushing it to the disk. Where that fails, it
/// removes the file and throws FileError.
void put_in_place(const std::string& temporary, const std::string& path);

/// An array of a file, written in order, in as many parts as one likes.
template <class T>
class Hdf5Rows {
 public:
  Hdf5Rows(std::int64_t file, std::string what, const std::string& name, const std::vector<size_t>& shape);
  ~Hdf5Rows();
  Hdf5Rows(const Hdf5Rows&) = delete;
  Hdf5Rows& operator=(const Hdf5Rows&) = delete;

  void append(const T* values, size_t count);
  void append(const std::vector<T>& values) { append(values.data(), values.size()); }
  /// After the last value.
  void finish();

 private:
  void write();

  std::string what_;           ///< of an error
  std::vector<size_t> shape_;  ///< slowest index first
  size_t row_ = 1;             ///< values of a row
  size_t chunk_rows_ = 0;      ///< rows that go out together
  size_t written_ = 0;         ///< rows
  std::vector<T> buffer_;
  std::int64_t set_ = -1;
};

/// Writes an HDF5 file under a temporary name; commit() puts it in place, so that a file of that name is
/// always whole.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(std::string path);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  void group(const std::string& name);
  /// An array of the given shape, slowest index first, compressed and with a checksum, to be filled. T is
  /// double, std::int64_t or unsigned char.
  template <class T>
  Hdf5Rows<T> rows(const std::string& name, const std::vector<size_t>& shape) {
    return Hdf5Rows<T>(file_, path_ + ": cannot write " + name, name, shape);
  }
  /// The same, all of it at once.
  template <class T>
  void dataset(const std::string& name, const std::vector<T>& values, const std::vector<size_t>& shape);
  void attribute(const std::string& group, const std::string& name, const std::vector<std::int64_t>& values);
  void attribute(const std::string& group, const std::string& name, const std::vector<double>& values);
  /// A fixed-length ASCII string, the only kind that VTK reads. Less than 64 KiB, as all attributes of an
  /// object together.
  void attribute(const std::string& group, const std::string& name, const std::string& text);
  /// A string of any length, as an array of one fixed-length string, compressed.
  void text(const std::string& name, const std::string& text);

  /// Ends the file; whoever calls has it from then on, under the temporary name that is returned.
  std::string finish();
  /// Ends the file and puts it in place.
  void commit() { put_in_place(finish(), path_); }

 private:
  std::string path_, temporary_;
  std::int64_t file_;
};

class Hdf5Bytes;

class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::string& path);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  std::vector<unsigned char> bytes(const std::string& name) const;
  std::vector<std::int64_t> integers(const std::string& group, const std::string& attribute) const;
  /// What Hdf5Writer::text wrote.
  std::string text(const std::string& name) const;

 private:
  friend class Hdf5Bytes;
  std::string path_;
  std::int64_t file_;
};

/// The bytes of an array in a file, read as they are taken.
class Hdf5Bytes final : public ByteSource {
 public:
  Hdf5Bytes(const std::string& path, const std::string& name);
  ~Hdf5Bytes() override;
  size_t size() const override { return size_; }
  size_t left() const override { return size_ - at_; }
  void take(void* to, size_t bytes) override;

 private:
  void read_ahead();

  Hdf5Reader file_;
  std::string what_;
  std::int64_t set_;
  size_t size_ = 0, at_ = 0;
  size_t ahead_ = 0;  ///< the first byte behind those in buffer_
  std::vector<unsigned char> buffer_;
};

/// Writes a text file through a temporary one.
void write_text_file(const std::string& path, const std::string& text);

}  // namespace vsb::app
