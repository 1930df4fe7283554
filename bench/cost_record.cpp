// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Measurements in processes of their own.

#include "cost_record.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <Kokkos_Core.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#if defined(VSB_BACKEND_OPENMP)
#include <omp.h>
#endif

namespace vsb::bench {
namespace {

/// A line of /proc/self/status, in bytes; 0 where there is none.
double status(const std::string& key) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);)
    if (line.rfind(key + ":", 0) == 0) return 1024 * std::strtod(line.c_str() + key.size() + 1, nullptr);
  return 0;
}

/// What the child does; never returns.
[[noreturn]] void measure_and_exit(int pipe, int threads, const std::function<void(Record&)>& measure) {
  std::ostringstream text;
  text.precision(17);
  try {
#if defined(VSB_BACKEND_OPENMP)
    omp_set_num_threads(threads);
#else
    (void)threads;
#endif
    setenv("OMP_PROC_BIND", "false", 0);  // Kokkos warns where it is not set
    Kokkos::initialize();
    Record record;
    measure(record);
    for (const auto& [name, value] : record.all()) text << name << '\n' << value << '\n';
    Kokkos::finalize();
  } catch (const std::exception& e) {
    text.str("");
    text << "error\n" << e.what() << '\n';
  }
  const std::string all = text.str();
  size_t done = 0;
  while (done < all.size()) {
    const auto n = write(pipe, all.data() + done, all.size() - done);
    if (n <= 0) _exit(1);
    done += static_cast<size_t>(n);
  }
  _exit(0);
}

}  // namespace

void Record::set(const std::string& name, double value) {
  numbers_.emplace_back(name, value);
}

double Record::operator[](const std::string& name) const {
  for (const auto& [key, value] : numbers_)
    if (key == name) return value;
  return std::numeric_limits<double>::quiet_NaN();
}

bool Record::has(const std::string& name) const {
  for (const auto& number : numbers_)
    if (number.first == name) return true;
  return false;
}

Record in_child(int threads, const std::function<void(Record&)>& measure) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe to be had");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process to be had");
  if (child == 0) {
    close(ends[0]);
    measure_and_exit(ends[1], threads, measure);
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<size_t>(n));
  close(ends[0]);
  int state = 0;
  waitpid(child, &state, 0);
  Record record;
  std::istringstream lines(text);
  for (std::string name, value; std::getline(lines, name) && std::getline(lines, value);) {
    if (name == "error") throw std::runtime_error(value);
    record.set(name, std::strtod(value.c_str(), nullptr));
  }
  if (!WIFEXITED(state) || WEXITSTATUS(state) != 0)
    throw std::runtime_error("a measurement broke off; was the memory enough?");
  return record;
}

double resident_bytes() {
  return status("VmRSS");
}
double peak_bytes() {
  return status("VmHWM");
}
void reset_peak() {
  std::ofstream("/proc/self/clear_refs") << 5;
}

}  // namespace vsb::bench
