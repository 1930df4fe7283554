// SPDX-License-Identifier: BSD-3-Clause
#include "files/sealed_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "files/hdf5_file.hpp"

namespace vsb::app {

namespace {

constexpr char mark[] = "vsb-seal";
constexpr size_t mark_size = sizeof mark - 1, seal_size = mark_size + 32;

/// The first 32 bits of the fractional part of a root of the nth prime: FIPS 180-4, 4.2.2 and 5.3.3.
struct Constants {
  std::array<std::uint32_t, 64> round{};   ///< K, of cube roots
  std::array<std::uint32_t, 8> initial{};  ///< H(0), of square roots
  Constants() {
    size_t n = 0;
    for (int candidate = 2; n < round.size(); ++candidate) {
      bool prime = true;
      for (int d = 2; d * d <= candidate; ++d) prime = prime && candidate % d != 0;
      if (!prime) continue;
      const auto bits = [](long double root) {
        return static_cast<std::uint32_t>((root - std::floor(root)) * 4294967296.0L);
      };
      if (n < initial.size()) initial[n] = bits(std::sqrt(static_cast<long double>(candidate)));
      round[n++] = bits(std::cbrt(static_cast<long double>(candidate)));
    }
  }
};

class Sha256 {
 public:
  void take(const unsigned char* from, size_t bytes) {
    total_ += bytes;
    while (bytes > 0) {
      const size_t part = std::min(bytes, block_.size() - filled_);
      std::memcpy(&block_[filled_], from, part);
      from += part;
      bytes -= part;
      filled_ += part;
      if (filled_ == block_.size()) compress();
    }
  }
  /// After the last byte.
  std::string digest() {
    const std::uint64_t bits = 8 * total_;
    const unsigned char one = 0x80, zero = 0;
    take(&one, 1);
    while (filled_ != block_.size() - 8) take(&zero, 1);
    for (int shift = 56; shift >= 0; shift -= 8) {
      const auto byte = static_cast<unsigned char>(bits >> shift);
      take(&byte, 1);
    }
    std::string text;
    for (const std::uint32_t word : state_)
      for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(word >> shift & 0xff);
    return text;
  }

 private:
  static std::uint32_t rotated(std::uint32_t x, int n) { return x >> n | x << (32 - n); }

  void compress() {
    std::array<std::uint32_t, 64> w;
    for (size_t t = 0; t < 16; ++t)
      w[t] = std::uint32_t(block_[4 * t]) << 24 | std::uint32_t(block_[4 * t + 1]) << 16 |
             std::uint32_t(block_[4 * t + 2]) << 8 | block_[4 * t + 3];
    for (size_t t = 16; t < 64; ++t)
      w[t] = (rotated(w[t - 2], 17) ^ rotated(w[t - 2], 19) ^ w[t - 2] >> 10) + w[t - 7] +
             (rotated(w[t - 15], 7) ^ rotated(w[t - 15], 18) ^ w[t - 15] >> 3) + w[t - 16];
    auto [a, b, c, d, e, f, g, h] = state_;
    for (size_t t = 0; t < 64; ++t) {
      const std::uint32_t t1 = h + (rotated(e, 6) ^ rotated(e, 11) ^ rotated(e, 25)) + ((e & f) ^ (~e & g)) +
                               constants().round[t] + w[t];
      const std::uint32_t t2 =
          (rotated(a, 2) ^ rotated(a, 13) ^ rotated(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
      h = g, g = f, f = e, e = d + t1;
      d = c, c = b, b = a, a = t1 + t2;
    }
    const std::array<std::uint32_t, 8> added{a, b, c, d, e, f, g, h};
    for (size_t i = 0; i < added.size(); ++i) state_[i] += added[i];
    filled_ = 0;
  }
  static const Constants& constants() {
    static const Constants all;
    return all;
  }

  std::array<std::uint32_t, 8> state_ = constants().initial;
  std::array<unsigned char, 64> block_{};
  size_t filled_ = 0;
  std::uint64_t total_ = 0;
};

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File open_file(const std::string& path, const char* mode) {
  File file(std::fopen(path.c_str(), mode), std::fclose);
  if (!file) throw FileError(fmt::format("{}: {}", path, std::strerror(errno)));
  return file;
}

/// Of the bytes up to the end, or up to that of the seal, which goes to `seal`.
std::string hash_of(const std::string& path, std::string* seal) {
  const auto file = open_file(path, "rb");
  Sha256 hash;
  std::vector<unsigned char> bytes(1 << 20);
  size_t kept = 0;  // read, and possibly of the seal
  const size_t keep = seal ? seal_size : 0;
  while (const size_t got = std::fread(&bytes[kept], 1, bytes.size() - kept, file.get())) {
    const size_t there = kept + got;
    kept = std::min(there, keep);
    hash.take(bytes.data(), there - kept);
    std::memmove(bytes.data(), &bytes[there - kept], kept);
  }
  if (std::ferror(file.get()) != 0) throw FileError(fmt::format("{}: cannot be read", path));
  if (seal) seal->assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(kept));
  return hash.digest();
}

}  // namespace

std::string sha256(const std::string& bytes) {
  Sha256 hash;
  hash.take(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  return hash.digest();
}

void seal_file(const std::string& path) {
  const std::string seal = mark + hash_of(path, nullptr);
  auto file = open_file(path, "ab");
  const bool written = std::fwrite(seal.data(), 1, seal.size(), file.get()) == seal.size();
  if (std::fclose(file.release()) != 0 || !written)
    throw FileError(fmt::format("{}: cannot finish the file ({})", path, std::strerror(errno)));
}

std::string checked_seal(const std::string& path) {
  std::string seal;
  const std::string hash = hash_of(path, &seal);
  if (seal.substr(0, mark_size) != mark)
    throw FileError(fmt::format("{}: has no seal at its end: it is damaged, or of another version", path));
  if (seal.substr(mark_size) != hash)
    throw FileError(fmt::format("{}: is damaged: its bytes are not those that were written", path));
  return hash;
}

}  // namespace vsb::app
