// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A directory of results that one process alone writes to.
#pragma once

#include <string>

namespace vsb::app {

/// Holds the file vsb.lock in the directory while it lives. The lock is the system's (flock), which ends with
/// the process however that ends: a file that was left behind is taken over. A file system without locks lets
/// everyone in.
class DirectoryLock {
 public:
  /// Creates the directory where it is missing. Throws FileError where that fails, or where another process
  /// holds the lock and does not let go of it within two seconds.
  explicit DirectoryLock(const std::string& directory);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  bool take(bool last_try);

  std::string directory_, path_;
  int file_ = -1;
};

}  // namespace vsb::app
