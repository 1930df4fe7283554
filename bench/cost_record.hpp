// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What one measurement found: numbers by name, in the order in which they came. Every measurement runs in a
/// process of its own, so that memory and threads are its own, and sends its record through a pipe.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace vsb::bench {

class Record {
 public:
  void set(const std::string& name, double value);
  /// NaN where there is none.
  double operator[](const std::string& name) const;
  bool has(const std::string& name) const;
  const std::vector<std::pair<std::string, double>>& all() const { return numbers_; }

 private:
  std::vector<std::pair<std::string, double>> numbers_;
};

/// Runs measure(record) in a child process with Kokkos started on so many threads; throws what the child
/// threw, as std::runtime_error. Never call it with Kokkos started.
Record in_child(int threads, const std::function<void(Record&)>& measure);

/// Bytes of this process: resident now; the most there were since the last reset.
double resident_bytes();
double peak_bytes();
void reset_peak();

}  // namespace vsb::bench
