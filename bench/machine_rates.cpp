// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Triad, and a loop of fused multiply-adds.

#include "machine_rates.hpp"

#include "rounds.hpp"

#include <unistd.h>

#include <vsb/views/pack.hpp>
#include <vsb/views/static_for.hpp>

namespace vsb::bench {
namespace {

/// Numbers per array: as much as the last cache, or what a quarter of the machine's memory gives.
template <class Real>
size_t array_size() {
  const long cache = sysconf(_SC_LEVEL3_CACHE_SIZE),
             memory = sysconf(_SC_AVPHYS_PAGES) / 12 * sysconf(_SC_PAGESIZE);
  const long bytes = std::min(std::max(2 * cache, 256L << 20), memory);
  return static_cast<size_t>(bytes) / sizeof(Real);
}

template <class Real>
double stream_rate() {
  const size_t n = array_size<Real>();
  using Array = Kokkos::View<Real*, Device>;
  const Array a("vsb::a", n), b("vsb::b", n), c("vsb::c", n);
  Kokkos::deep_copy(b, Real(1));
  Kokkos::deep_copy(c, Real(2));
  std::vector<double> seconds;
  for (int k = 0; k < 7; ++k) {
    const Real s = static_cast<Real>(k);
    seconds.push_back(seconds_of([&] {
      Kokkos::parallel_for(
          "vsb::triad", Kokkos::RangePolicy<Exec, Kokkos::IndexType<size_t>>(Exec(), 0, n),
          KOKKOS_LAMBDA(size_t i) { a(i) = b(i) + s * c(i); });
    }));
  }
  return 3 * sizeof(Real) * static_cast<double>(n) / *std::min_element(seconds.begin(), seconds.end());
}

template <class Real>
double fma_rate() {
  using P = typename Lanes<Real>::Pack;
  constexpr int chains = 12, repeats = 1 << 20;
  const int threads = Exec().concurrency();
  const Kokkos::View<Real*, Device> out("vsb::out", static_cast<size_t>(threads) * P::width);
  std::vector<double> seconds;
  for (int k = 0; k < 7; ++k)
    seconds.push_back(seconds_of([&] {
      Kokkos::parallel_for(
          "vsb::fma", Kokkos::RangePolicy<Exec>(Exec(), 0, threads), KOKKOS_LAMBDA(int t) {
            const P factor = P(Real(0.999)), term = P(out(0) + Real(1e-3));
            P x[chains];
            static_for<chains>([&](auto c) VSB_UNROLLED { x[c] = P(Real(0.1 * c)); });
            for (int n = 0; n < repeats; ++n)
              static_for<chains>([&](auto c) VSB_UNROLLED { x[c] = factor * x[c] + term; });
            P sum = P(Real(0));
            static_for<chains>([&](auto c) VSB_UNROLLED { sum = sum + x[c]; });
            sum.store(&out(static_cast<size_t>(t) * P::width));
          });
    }));
  return 2.0 * P::width * chains * repeats * threads / *std::min_element(seconds.begin(), seconds.end());
}

}  // namespace

template <class Real>
void measure_rates(Record& record) {
  record.set("stream GB/s", 1e-9 * stream_rate<Real>());
  record.set("fma GF/s", 1e-9 * fma_rate<Real>());
}

template void measure_rates<double>(Record&);
template void measure_rates<float>(Record&);

}  // namespace vsb::bench
