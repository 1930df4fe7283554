// SPDX-License-Identifier: BSD-3-Clause
#include "files/hdf5_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>

namespace vsb::app {

namespace {

/// `what`, and what the system said of the call of HDF5 that just failed, where it said something.
std::string with_reason(const std::string& what) {
  std::string reason;
  const auto look = [](unsigned, const H5E_error2_t* entry, void* found) -> herr_t {
    const std::string text = entry->desc ? entry->desc : "", before = "error message = '";
    const auto at = text.find(before);
    if (at != std::string::npos)
      *static_cast<std::string*>(found) =
          text.substr(at + before.size(), text.rfind('\'') - at - before.size());
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look, &reason);
  return reason.empty() ? what : fmt::format("{} ({})", what, reason);
}

/// An HDF5 identifier that closes itself.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
    if (id < 0) throw FileError(with_reason(what));
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void check(herr_t status, const std::string& what) {
  if (status < 0) throw FileError(with_reason(what));
}

hid_t memory_type(double) {
  return H5T_NATIVE_DOUBLE;
}
hid_t memory_type(std::int64_t) {
  return H5T_NATIVE_INT64;
}
hid_t memory_type(unsigned char) {
  return H5T_NATIVE_UCHAR;
}

template <class T>
void write_attribute(hid_t file, const std::string& path, const std::string& group, const std::string& name,
                     const std::vector<T>& values) {
  const std::string what = fmt::format("{}: cannot write attribute {} of {}", path, name, group);
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, what);
  const Handle attribute(H5Acreate_by_name(file, group.c_str(), name.c_str(), memory_type(T{}), space,
                                           H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, what);
  check(H5Awrite(attribute, memory_type(T{}), values.data()), what);
}

/// Makes a file's content, or a directory's entries, survive a crash.
void flush_to_disk(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY);
  if (descriptor < 0 || ::fsync(descriptor) != 0) {
    const int error = errno;
    if (descriptor >= 0) ::close(descriptor);
    throw FileError(fmt::format("{}: {}", path, std::strerror(error)));
  }
  ::close(descriptor);
}

/// Before anything else of HDF5. Its handler at exit writes what a file that could not be closed still holds,
/// and crashes where that fails again.
void prepare_hdf5() {
  [[maybe_unused]] static const herr_t once = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace

void put_in_place(const std::string& temporary, const std::string& path) {
  try {
    flush_to_disk(temporary);
    std::error_code error;
    std::filesystem::rename(temporary, path, error);
    if (error) throw FileError(fmt::format("{}: {}", path, error.message()));
  } catch (const FileError&) {
    std::remove(temporary.c_str());
    throw;
  }
  const auto directory = std::filesystem::path(path).parent_path();
  flush_to_disk(directory.empty() ? "." : directory.string());
}

Hdf5Writer::Hdf5Writer(std::string path) : path_(std::move(path)), temporary_(path_ + ".part") {
  prepare_hdf5();
  file_ = H5Fcreate(temporary_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file_ < 0) throw FileError(with_reason(fmt::format("{}: cannot create the file", temporary_)));
}

Hdf5Writer::~Hdf5Writer() {
  if (file_ < 0) return;
  H5Fclose(file_);
  std::remove(temporary_.c_str());
}

void Hdf5Writer::group(const std::string& name) {
  const std::string what = fmt::format("{}: cannot create group {}", path_, name);
  Handle(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, what);
}

template <class T>
Hdf5Rows<T>::Hdf5Rows(std::int64_t file, std::string what, const std::string& name,
                      const std::vector<size_t>& shape)
    : what_(std::move(what)), shape_(shape), chunk_rows_(shape.at(0)) {
  const std::vector<hsize_t> extent(shape.begin(), shape.end());
  const int rank = static_cast<int>(extent.size());
  for (size_t i = 1; i < shape.size(); ++i) row_ *= shape[i];
  const Handle space(H5Screate_simple(rank, extent.data(), nullptr), H5Sclose, what_);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what_);
  check(H5Pset_obj_track_times(properties, false), what_);  // the same data makes the same file
  if (shape[0] * row_ > 64) {  // chunks of at most about 64k values; tiny sets stay contiguous
    std::vector<hsize_t> chunk(extent);
    for (size_t i = 0; i < chunk.size(); ++i) {
      hsize_t rest = 1;
      for (size_t j = i + 1; j < chunk.size(); ++j) rest *= extent[j];
      chunk[i] = std::min(chunk[i], std::max<hsize_t>(1, 65536 / rest));
    }
    chunk_rows_ = chunk[0];
    check(H5Pset_chunk(properties, rank, chunk.data()), what_);
    check(H5Pset_shuffle(properties), what_);
    check(H5Pset_deflate(properties, 4), what_);
    check(H5Pset_fletcher32(properties), what_);
  }
  set_ = H5Dcreate2(file, name.c_str(), memory_type(T{}), space, H5P_DEFAULT, properties, H5P_DEFAULT);
  if (set_ < 0) throw FileError(what_);
}

template <class T>
Hdf5Rows<T>::~Hdf5Rows() {
  if (set_ >= 0) H5Dclose(set_);
}

template <class T>
void Hdf5Rows<T>::append(const T* values, size_t count) {
  while (count > 0) {
    const size_t part = std::min(count, std::max<size_t>(1, chunk_rows_ * row_) - buffer_.size());
    buffer_.insert(buffer_.end(), values, values + part);
    values += part;
    count -= part;
    if (buffer_.size() >= chunk_rows_ * row_) write();
  }
}

/// Whole chunks, so that each is compressed once.
template <class T>
void Hdf5Rows<T>::write() {
  if (buffer_.empty()) return;
  const size_t rows = buffer_.size() / row_;
  if (rows * row_ != buffer_.size() || written_ + rows > shape_[0])
    throw FileError(fmt::format("{}: {} values for a shape of {} x {}", what_,
                                written_ * row_ + buffer_.size(), shape_[0], row_));
  std::vector<hsize_t> first(shape_.size(), 0), extent(shape_.begin(), shape_.end());
  first[0] = written_;
  extent[0] = rows;
  const Handle memory(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose,
                      what_);
  const Handle file(H5Dget_space(set_), H5Sclose, what_);
  check(H5Sselect_hyperslab(file, H5S_SELECT_SET, first.data(), nullptr, extent.data(), nullptr), what_);
  check(H5Dwrite(set_, memory_type(T{}), memory, file, H5P_DEFAULT, buffer_.data()), what_);
  written_ += rows;
  buffer_.clear();
}

template <class T>
void Hdf5Rows<T>::finish() {
  write();
  if (written_ != shape_[0]) throw FileError(fmt::format("{}: {} rows of {}", what_, written_, shape_[0]));
  const herr_t status = H5Dclose(set_);
  set_ = -1;
  check(status, what_);
}
template class Hdf5Rows<double>;
template class Hdf5Rows<std::int64_t>;
template class Hdf5Rows<unsigned char>;

template <class T>
void Hdf5Writer::dataset(const std::string& name, const std::vector<T>& values,
                         const std::vector<size_t>& shape) {
  auto all = rows<T>(name, shape);
  all.append(values);
  all.finish();
}
template void Hdf5Writer::dataset(const std::string&, const std::vector<double>&, const std::vector<size_t>&);
template void Hdf5Writer::dataset(const std::string&, const std::vector<std::int64_t>&,
                                  const std::vector<size_t>&);
template void Hdf5Writer::dataset(const std::string&, const std::vector<unsigned char>&,
                                  const std::vector<size_t>&);

void Hdf5Writer::attribute(const std::string& group, const std::string& name,
                           const std::vector<std::int64_t>& values) {
  write_attribute(file_, path_, group, name, values);
}

void Hdf5Writer::attribute(const std::string& group, const std::string& name,
                           const std::vector<double>& values) {
  write_attribute(file_, path_, group, name, values);
}

void Hdf5Writer::attribute(const std::string& group, const std::string& name, const std::string& text) {
  const std::string what = fmt::format("{}: cannot write attribute {} of {}", path_, name, group);
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, what);
  check(H5Tset_size(type, std::max<size_t>(1, text.size())), what);
  check(H5Tset_strpad(type, H5T_STR_NULLPAD), what);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, what);
  const Handle attribute(H5Acreate_by_name(file_, group.c_str(), name.c_str(), type, space, H5P_DEFAULT,
                                           H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, what);
  check(H5Awrite(attribute, type, text.c_str()), what);
}

void Hdf5Writer::text(const std::string& name, const std::string& text) {
  const std::string what = fmt::format("{}: cannot write {}", path_, name);
  const hsize_t one = 1;
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, what);
  check(H5Tset_size(type, std::max<size_t>(1, text.size())), what);
  check(H5Tset_strpad(type, H5T_STR_NULLPAD), what);
  check(H5Tset_cset(type, H5T_CSET_UTF8), what);
  const Handle space(H5Screate_simple(1, &one, nullptr), H5Sclose, what);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  check(H5Pset_obj_track_times(properties, false), what);
  check(H5Pset_chunk(properties, 1, &one), what);
  check(H5Pset_deflate(properties, 4), what);
  const Handle set(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                   H5Dclose, what);
  check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()), what);
}

std::string Hdf5Writer::finish() {
  const herr_t status = H5Fclose(file_);
  file_ = -1;
  if (status < 0) {
    const FileError error(with_reason(fmt::format("{}: cannot finish the file", path_)));
    std::remove(temporary_.c_str());
    throw error;
  }
  return temporary_;
}

Hdf5Reader::Hdf5Reader(const std::string& path) : path_(path) {
  prepare_hdf5();
  file_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0) throw FileError(fmt::format("{}: cannot be opened as an HDF5 file", path));
}

Hdf5Reader::~Hdf5Reader() {
  H5Fclose(file_);
}

std::vector<unsigned char> Hdf5Reader::bytes(const std::string& name) const {
  const std::string what = fmt::format("{}: cannot read {}", path_, name);
  const Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose, what);
  const Handle space(H5Dget_space(set), H5Sclose, what);
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  if (size < 0) throw FileError(what);
  std::vector<unsigned char> values(static_cast<size_t>(size));
  check(H5Dread(set, H5T_NATIVE_UCHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), what);
  return values;
}

std::vector<std::int64_t> Hdf5Reader::integers(const std::string& group, const std::string& attribute) const {
  const std::string what = fmt::format("{}: cannot read attribute {} of {}", path_, attribute, group);
  const Handle a(H5Aopen_by_name(file_, group.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                 what);
  const Handle space(H5Aget_space(a), H5Sclose, what);
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  if (size < 0 || size > 1024) throw FileError(what);
  std::vector<std::int64_t> values(static_cast<size_t>(size));
  check(H5Aread(a, H5T_NATIVE_INT64, values.data()), what);
  return values;
}

std::string Hdf5Reader::text(const std::string& name) const {
  const std::string what = fmt::format("{}: cannot read {}", path_, name);
  const Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose, what);
  const Handle space(H5Dget_space(set), H5Sclose, what);
  const Handle type(H5Dget_type(set), H5Tclose, what);
  if (H5Sget_simple_extent_npoints(space) != 1 || H5Tget_class(type) != H5T_STRING ||
      H5Tis_variable_str(type) != 0)
    throw FileError(what);
  std::string value(H5Tget_size(type), '\0');
  check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data()), what);
  return value.substr(0, value.find('\0'));
}

Hdf5Bytes::Hdf5Bytes(const std::string& path, const std::string& name)
    : file_(path), what_(fmt::format("{}: cannot read {}", path, name)) {
  set_ = H5Dopen2(file_.file_, name.c_str(), H5P_DEFAULT);
  if (set_ < 0) throw FileError(what_);
  const hid_t space = H5Dget_space(set_);
  const hssize_t size = space < 0 ? -1 : H5Sget_simple_extent_npoints(space);
  const int rank = space < 0 ? 0 : H5Sget_simple_extent_ndims(space);
  if (space >= 0) H5Sclose(space);
  if (size < 0 || rank != 1) {
    H5Dclose(set_);
    throw FileError(what_);
  }
  size_ = static_cast<size_t>(size);
}

Hdf5Bytes::~Hdf5Bytes() {
  H5Dclose(set_);
}

void Hdf5Bytes::take(void* to, size_t bytes) {
  auto* next = static_cast<unsigned char*>(to);
  while (bytes > 0) {
    if (at_ == ahead_) read_ahead();
    const size_t part = std::min(bytes, ahead_ - at_);
    std::memcpy(next, &buffer_[buffer_.size() - (ahead_ - at_)], part);
    next += part;
    at_ += part;
    bytes -= part;
  }
}

void Hdf5Bytes::read_ahead() {
  constexpr size_t most = 1 << 20;
  const hsize_t first = ahead_, count = std::min(most, size_ - ahead_);
  if (count == 0) throw FileError(what_);
  buffer_.resize(count);
  const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose, what_);
  const Handle file(H5Dget_space(set_), H5Sclose, what_);
  check(H5Sselect_hyperslab(file, H5S_SELECT_SET, &first, nullptr, &count, nullptr), what_);
  check(H5Dread(set_, H5T_NATIVE_UCHAR, memory, file, H5P_DEFAULT, buffer_.data()), what_);
  ahead_ += count;
}

void write_text_file(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".part";
  {
    std::ofstream out(temporary, std::ios::binary);
    errno = 0;
    out << text;
    out.close();
    if (!out) {
      const FileError error(fmt::format("{}: cannot be written ({})", path, std::strerror(errno)));
      std::remove(temporary.c_str());
      throw error;
    }
  }
  put_in_place(temporary, path);
}

}  // namespace vsb::app
