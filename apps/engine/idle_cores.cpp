// SPDX-License-Identifier: BSD-3-Clause
#include "engine/idle_cores.hpp"

#include <unistd.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>

#ifdef __linux__
#include <sched.h>
#endif

namespace vsb::app {

#ifdef __linux__
namespace {

struct Ticks {
  long long idle = 0, all = 0;
};

/// Since the system started, by core: lines "cpu3 user nice system idle iowait irq softirq steal ...".
std::map<int, Ticks> ticks_of_cores() {
  std::map<int, Ticks> cores;
  std::ifstream file("/proc/stat");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("cpu", 0) != 0 || line.size() < 4 || line[3] == ' ') continue;
    std::istringstream numbers(line.substr(3));
    int core = 0;
    numbers >> core;
    Ticks& ticks = cores[core];
    long long n = 0;
    for (int column = 0; column < 8 && numbers >> n; ++column) {
      ticks.all += n;
      if (column == 3 || column == 4) ticks.idle += n;
    }
  }
  return cores;
}

}  // namespace
#endif

std::optional<double> idle_cores() {
#ifdef __linux__
  cpu_set_t usable;
  if (sched_getaffinity(0, sizeof usable, &usable) != 0) return {};
  const auto before = ticks_of_cores();
  usleep(100'000);
  double idle = 0;
  int counted = 0;
  for (const auto& [core, now] : ticks_of_cores()) {
    const auto then = before.find(core);
    if (core >= CPU_SETSIZE || !CPU_ISSET(core, &usable) || then == before.end()) continue;
    const auto all = now.all - then->second.all;
    if (all > 0)
      idle += static_cast<double>(now.idle - then->second.idle) / static_cast<double>(all);
    else
      idle += 1;  // a core that sleeps may count nothing
    ++counted;
  }
  if (counted > 0) return idle;
#endif
  return {};
}

}  // namespace vsb::app
