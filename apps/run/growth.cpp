// SPDX-License-Identifier: BSD-3-Clause
#include "run/growth.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "run/interrupt.hpp"

namespace vsb::app {

namespace {

/// In cells per step: far above round-off, and far below what takes particles to other cells.
constexpr double disturbance = 1e-10;
/// Of the root mean square difference.
constexpr double largest_growth = 1e6;
/// Into which the time is divided, and differences that are looked at in each: vibrations come and go in
/// between.
constexpr long long windows = 48, most_looks = 16;
/// Over as many the growth can be told from them.
constexpr size_t fewest_windows = 6;

class Bytes final : public ByteSink, public ByteSource {
 public:
  void take(const void* from, size_t bytes) override {
    const auto* first = static_cast<const char*>(from);
    bytes_.insert(bytes_.end(), first, first + bytes);
  }
  size_t size() const override { return bytes_.size(); }
  size_t left() const override { return bytes_.size() - taken_; }
  void take(void* to, size_t bytes) override {
    std::memcpy(to, bytes_.data() + taken_, bytes);
    taken_ += bytes;
  }
  void rewind() { taken_ = 0; }

 private:
  std::vector<char> bytes_;
  size_t taken_ = 0;
};

std::vector<double> velocities(Simulation& simulation) {
  return simulation.read_particles()->all(field::velocity).velocity;
}

/// Slope of the points (0, y[0]), (1, y[1]), ... from the middle one on, by least squares.
double slope_of_second_half(const std::vector<double>& y) {
  const size_t first = y.size() / 2, count = y.size() - first;
  const double middle = 0.5 * static_cast<double>(count - 1);
  double above = 0, below = 0;
  for (size_t k = 0; k < count; ++k) {
    const double x = static_cast<double>(k) - middle;
    above += x * y[first + k];
    below += x * x;
  }
  return above / below;
}

}  // namespace

double growth_rate(const Scene& scene, Simulation& at) {
  Scene after = scene;
  after.method.damping = scene.growth->damping;
  Bytes state;
  at.save_particles(state);
  const auto copy = [&](double speed) {
    auto simulation = make_simulation(after);
    state.rewind();
    simulation->restore(at.saved_state(), state);
    simulation->disturb(speed);
    return simulation;
  };
  const auto calm = copy(0);
  const auto disturbed = copy(disturbance * scene.grid.spacing[0] / scene.time.dt);

  const auto difference = [&] {
    const auto a = velocities(*calm), b = velocities(*disturbed);
    double sum = 0;
    for (size_t k = 0; k < a.size(); ++k) sum += (b[k] - a[k]) * (b[k] - a[k]);
    return sum;
  };
  const double at_start = difference(), largest = largest_growth * largest_growth * at_start;
  const long long steps = std::llround(scene.growth->time / scene.time.dt),
                  stride = std::max(1LL, steps / (windows * most_looks)), looks = steps / (windows * stride);
  std::vector<double> log_size;  // of the difference, window by window
  while (static_cast<long long>(log_size.size()) < windows) {
    double sum = 0;
    try {
      for (long long n = 0; n < looks; ++n) {
        if (interrupt_requested()) return std::numeric_limits<double>::quiet_NaN();
        calm->advance(stride);
        disturbed->advance(stride);
        const double now = difference();
        if (!(now <= largest) && log_size.size() < fewest_windows)  // too fast for windows
          return 0.5 * std::log(now / at_start) / (calm->time() - at.time());
        sum += now / static_cast<double>(looks);
      }
    } catch (const LeftGrid&) {
      break;
    } catch (const Diverged&) {
      break;
    }
    log_size.push_back(0.5 * std::log(sum));
    if (sum > largest) break;
  }
  if (log_size.size() < fewest_windows) return std::numeric_limits<double>::quiet_NaN();
  return slope_of_second_half(log_size) / (static_cast<double>(looks * stride) * scene.time.dt);
}

}  // namespace vsb::app
