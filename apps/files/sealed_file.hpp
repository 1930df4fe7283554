// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A seal is the last 40 bytes of a file: "vsb-seal" and the SHA-256 of all bytes before. It is written last
/// and checked first, so that no reader meets a byte that is not as it was written.
#pragma once

#include <string>

namespace vsb::app {

/// SHA-256 (FIPS 180-4) of some bytes, 32 bytes.
std::string sha256(const std::string& bytes);

/// Appends the seal. Throws FileError.
void seal_file(const std::string& path);

/// The seal of a file. Throws FileError where there is none, or where it is not that of the bytes before.
std::string checked_seal(const std::string& path);

}  // namespace vsb::app
