// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The little of HDF5 that frames and checkpoints need. Every function throws FileError with the path and the
/// object's name.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace vsb::app {

/// A file that cannot be read or written (exit code 4).
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
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
  /// An array of the given shape, slowest index first, compressed and with a checksum. T is double,
  /// std::int64_t or unsigned char.
  template <class T>
  void dataset(const std::string& name, const std::vector<T>& values, const std::vector<size_t>& shape);
  void attribute(const std::string& group, const std::string& name, const std::vector<std::int64_t>& values);
  void attribute(const std::string& group, const std::string& name, const std::vector<double>& values);
  /// A fixed-length ASCII string, the only kind that VTK reads.
  void attribute(const std::string& group, const std::string& name, const std::string& text);

  /// Flushes to the disk and renames onto the final path.
  void commit();

 private:
  std::string path_, temporary_;
  std::int64_t file_;
};

class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::string& path);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  std::vector<unsigned char> bytes(const std::string& name) const;
  std::vector<std::int64_t> integers(const std::string& group, const std::string& attribute) const;
  std::string text(const std::string& group, const std::string& attribute) const;

 private:
  std::string path_;
  std::int64_t file_;
};

/// Writes a text file through a temporary one.
void write_text_file(const std::string& path, const std::string& text);

}  // namespace vsb::app
