// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Packs of numbers, lane by lane against the numbers themselves.
#include <vsb/views/pack.hpp>
#include <vsb/views/static_for.hpp>

#include "support.hpp"

using namespace vsb;
using namespace vsb::test;

namespace {

/// What a b + c must be.
template <class T>
T multiply_add(T a, T b, T c) {
#if defined(VSB_PACK_FMA)
  return std::fma(a, b, c);
#else
  const volatile T product = a * b;  // rounded before it is added to
  return product + c;
#endif
}

template <class T, int W>
struct Draw {
  Random random{91};
  Pack<T, W> operator()(double low = -2, double high = 2) {
    Pack<T, W> p;
    for (int l = 0; l < W; ++l) p.set(l, random.draw<T>(low, high));
    return p;
  }
};

/// Counts the lanes where a pack is not, to the last bit, what `expected` says of lane l.
template <class T, int W, class Expected>
int wrong(Pack<T, W> p, const Expected& expected) {
  int count = 0;
  for (int l = 0; l < W; ++l) count += p[l] != expected(l);
  return count;
}

}  // namespace

TEMPLATE_TEST_CASE_SIG("arithmetic is that of every lane", "", ((typename T, int W), T, W), (double, 4),
                       (float, 8), (double, 2), (float, 4)) {
  using P = Pack<T, W>;
  STATIC_REQUIRE(sizeof(P) == W * sizeof(T));
  Draw<T, W> draw;
  int bad = 0;
  for (int n = 0; n < 200; ++n) {
    const P a = draw(), b = draw(), c = draw();
    const T s = draw()[0];
    bad += wrong(P(s), [&](int) { return s; });
    bad += wrong(a + b, [&](int l) { return a[l] + b[l]; });
    bad += wrong(a - b, [&](int l) { return a[l] - b[l]; });
    bad += wrong(P(a * b), [&](int l) { return a[l] * b[l]; });
    bad += wrong(a / b, [&](int l) { return a[l] / b[l]; });
    bad += wrong(P(a * b) / c, [&](int l) { return a[l] * b[l] / c[l]; });
    bad += wrong(-a, [&](int l) { return -a[l]; });
    bad += wrong(P(-(a * b)), [&](int l) { return -(a[l] * b[l]); });
    bad += wrong(P(a * b * c), [&](int l) { return a[l] * b[l] * c[l]; });
    bad += wrong(P(a * (b * c)), [&](int l) { return a[l] * (b[l] * c[l]); });
    bad += wrong(P((a * b) * (c * a)), [&](int l) { return (a[l] * b[l]) * (c[l] * a[l]); });
    auto d = a;
    d += b;
    d -= c;
    d *= b;
    bad += wrong(d, [&](int l) { return ((a[l] + b[l]) - c[l]) * b[l]; });
    d.set(W - 1, s);
    CHECK(d[W - 1] == s);
  }
  CHECK(bad == 0);
}

TEMPLATE_TEST_CASE_SIG("a product in a sum is rounded once where the machine can", "",
                       ((typename T, int W), T, W), (double, 4), (float, 8), (double, 2), (float, 4)) {
  using P = Pack<T, W>;
  Draw<T, W> draw;
  int bad = 0, twice = 0;
  for (int n = 0; n < 200; ++n) {
    const P a = draw(), b = draw(), c = draw(), d = draw();
    bad += wrong(a * b + c, [&](int l) { return multiply_add(a[l], b[l], c[l]); });
    bad += wrong(c + a * b, [&](int l) { return multiply_add(a[l], b[l], c[l]); });
    bad += wrong(a * b - c, [&](int l) { return multiply_add(a[l], b[l], -c[l]); });
    bad += wrong(c - a * b, [&](int l) { return multiply_add(-a[l], b[l], c[l]); });
    bad += wrong(-(a * b) + c, [&](int l) { return multiply_add(-a[l], b[l], c[l]); });
    // Of two products, the second is rounded by itself, or the first where it is subtracted from.
    bad += wrong(a * b + c * d, [&](int l) { return multiply_add(a[l], b[l], c[l] * d[l]); });
    bad += wrong(a * b - c * d, [&](int l) { return multiply_add(-c[l], d[l], a[l] * b[l]); });
    P sum = c;
    sum += a * b;
    bad += wrong(sum, [&](int l) { return multiply_add(a[l], b[l], c[l]); });
    sum -= d * b;
    bad += wrong(sum, [&](int l) { return multiply_add(-d[l], b[l], multiply_add(a[l], b[l], c[l])); });
    for (int l = 0; l < W; ++l) twice += a[l] * b[l] + c[l] != multiply_add(a[l], b[l], c[l]);
  }
  CHECK(bad == 0);
  // (1 + e)(1 - e) - 1 = -e^2, of which two roundings leave nothing.
  const T e = std::numeric_limits<T>::epsilon();
  const P small = P(1 + e) * P(1 - e) - P(T(1));
#if defined(VSB_PACK_FMA)
  CHECK(twice > 0);
  CHECK(wrong(small, [&](int) { return -e * e; }) == 0);
#else
  CHECK(twice == 0);
  CHECK(wrong(small, [&](int) { return T(0); }) == 0);
#endif
}

TEMPLATE_TEST_CASE_SIG("comparisons, masks and the lanes they pick", "", ((typename T, int W), T, W),
                       (double, 4), (float, 8), (double, 2), (float, 4)) {
  using P = Pack<T, W>;
  using Mask = PackMask<T, W>;
  Draw<T, W> draw;
  for (std::uint64_t bits = 0; bits < std::uint64_t(1) << W; ++bits) {
    const P a = draw(), b = draw();
    const auto set = [&](int l) { return (bits >> l & 1) != 0; };
    const auto mask = Mask::from_bits(bits | std::uint64_t(1) << W);  // a bit beyond the last lane
    const auto first = Mask::from_bits(1);
    int bad = 0;
    for (int l = 0; l < W; ++l) {
      bad += mask[l] != set(l);
      bad += (!mask)[l] == set(l);
      bad += (mask & first)[l] != (set(l) && l == 0);
      bad += (mask | first)[l] != (set(l) || l == 0);
    }
    bad += wrong(math::select(mask, a, b), [&](int l) { return set(l) ? a[l] : b[l]; });
    bad += wrong(keep_lanes(bits, a), [&](int l) { return set(l) ? a[l] : T(0); });
    CAPTURE(bits);
    CHECK(bad == 0);
    CHECK(any(mask) == (bits != 0));
  }
  int bad = 0;
  for (int n = 0; n < 50; ++n) {
    P a = draw(), b = draw();
    b.set(n % W, a[n % W]);  // equal somewhere
    if (n % 7 == 0) a.set(0, std::numeric_limits<T>::quiet_NaN());
    for (int l = 0; l < W; ++l) {
      bad += (a < b)[l] != (a[l] < b[l]);
      bad += (a > b)[l] != (a[l] > b[l]);
      bad += (a <= b)[l] != (a[l] <= b[l]);
      bad += (a >= b)[l] != (a[l] >= b[l]);
      bad += (a == b)[l] != (a[l] == b[l]);
    }
  }
  CHECK(bad == 0);
  CHECK(math::select(true, 1., 2.) == 1.);
  CHECK(math::select(false, 1., 2.) == 2.);
}

TEMPLATE_TEST_CASE_SIG("a lane that is not kept is zero whatever it holds", "", ((typename T, int W), T, W),
                       (double, 4), (float, 8), (double, 2), (float, 4)) {
  const Pack<T, W> nan(std::numeric_limits<T>::quiet_NaN()), one(T(1));
  CHECK(wrong(keep_lanes(0, nan), [](int) { return T(0); }) == 0);
  CHECK(wrong(math::select(PackMask<T, W>::from_bits(0), nan, one), [](int) { return T(1); }) == 0);
}

TEMPLATE_TEST_CASE_SIG("shift_in, rotated, bits_of, abs, exp", "", ((typename T, int W), T, W), (double, 4),
                       (float, 8), (double, 2), (float, 4)) {
  Draw<T, W> draw;
  int bad = 0;
  for (int n = 0; n < 50; ++n) {
    const auto before = draw(), p = draw(-20, 20);
    bad += wrong(shift_in(before, p), [&](int l) { return l == 0 ? before[W - 1] : p[l - 1]; });
    bad += wrong(rotated<1>(p), [&](int l) { return p[(l + W - 1) % W]; });
    bad += wrong(rotated<-1>(p), [&](int l) { return p[(l + 1) % W]; });
    bad += wrong(rotated<0>(p), [&](int l) { return p[l]; });
    std::uint32_t positive = 0;
    for (int l = 0; l < W; ++l)
      if (p[l] > T(0)) positive |= std::uint32_t(1) << l;
    bad += bits_of(p > Pack<T, W>(T(0))) != positive;
    bad += wrong(math::abs(p), [&](int l) { return std::abs(p[l]); });
    bad += wrong(math::exp(p), [&](int l) { return std::exp(p[l]); });
  }
  CHECK(bad == 0);
}

TEMPLATE_TEST_CASE_SIG("packs are loaded from and stored to anywhere", "", ((typename T, int W), T, W),
                       (double, 4), (float, 8), (double, 2), (float, 4)) {
  std::vector<T> numbers(4 * W);
  for (size_t k = 0; k < numbers.size(); ++k) numbers[k] = static_cast<T>(k);
  for (int offset = 0; offset <= 2 * W; ++offset) {
    const auto p = Pack<T, W>::load(numbers.data() + offset);
    CHECK(wrong(p, [&](int l) { return static_cast<T>(offset + l); }) == 0);
    std::vector<T> to(4 * W, T(-1));
    p.store(to.data() + offset);
    int bad = 0;
    for (int k = 0; k < 4 * W; ++k)
      bad += to[static_cast<size_t>(k)] != (k >= offset && k < offset + W ? static_cast<T>(k) : T(-1));
    CHECK(bad == 0);
  }
}

TEST_CASE("cell lanes are 32 bytes of numbers") {
  STATIC_REQUIRE(Lanes<double>::width == 4);
  STATIC_REQUIRE(Lanes<float>::width == 8);
  STATIC_REQUIRE(std::is_same_v<Lanes<float>::Pack, Pack<float, 8>>);
}

TEST_CASE("static_for counts with constants, in order") {
  std::vector<int> seen;
  static_for<4>([&](auto i) {
    constexpr int as_constant = i;  // or this does not compile
    seen.push_back(as_constant);
  });
  CHECK(seen == std::vector<int>{0, 1, 2, 3});
  static_for<0>([&](auto) { seen.push_back(-1); });
  CHECK(seen.size() == 4);
}
