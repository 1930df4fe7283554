// SPDX-License-Identifier: BSD-3-Clause
#include "files/directory_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "files/hdf5_file.hpp"

namespace vsb::app {

namespace {

std::string who() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return fmt::format("process {} on {}", getpid(), host.data());
}

}  // namespace

DirectoryLock::DirectoryLock(const std::string& directory)
    : directory_(directory), path_(directory + "/vsb.lock") {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw FileError(fmt::format("{}: cannot create the directory ({})", directory, error.message()));
  // A run that is being stopped still writes its checkpoint.
  for (int pauses = 40; !take(pauses <= 0); --pauses) usleep(50'000);
}

/// Whether the lock is ours. Throws at the last try.
bool DirectoryLock::take(bool last_try) {
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw FileError(fmt::format("{}: {}", path_, std::strerror(errno)));
  if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    std::array<char, 512> holder{};
    if (::read(file_, holder.data(), holder.size() - 1) < 0) holder[0] = '\0';
    ::close(file_);
    if (last_try)
      throw FileError(
          fmt::format("{}: {} is writing results there; wait for it, or give another directory with --out",
                      directory_, holder[0] != '\0' ? holder.data() : "another process"));
    return false;
  }
  struct stat opened {
  }, named{};
  if (fstat(file_, &opened) != 0 || stat(path_.c_str(), &named) != 0 || opened.st_ino != named.st_ino) {
    ::close(file_);  // the one before removed it in the meantime
    return false;
  }
  const std::string text = who();  // for messages alone
  if (ftruncate(file_, 0) != 0 || pwrite(file_, text.data(), text.size(), 0) < 0) errno = 0;
  return true;
}

DirectoryLock::~DirectoryLock() {
  ::unlink(path_.c_str());
  ::close(file_);
}

}  // namespace vsb::app
