// SPDX-License-Identifier: BSD-3-Clause
#include "run/standard_streams.hpp"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>

#include "run/interrupt.hpp"

namespace vsb::app {

namespace {

bool is_whole = true;

/// Tells the user where there is one, once: of a run, or of what nobody closed on purpose (`vsb info |
/// head`).
void output_lost(int descriptor, int error) {
  static bool told = false;
  const bool stops = request_interrupt();
  if (descriptor == STDERR_FILENO) return;
  is_whole = false;
  if (told || (!stops && error == EPIPE)) return;
  told = true;
  const std::string text = std::string("vsb: standard output cannot be written (") + std::strerror(error) +
                           (stops ? "): stopping\n" : ")\n");
  if (::write(STDERR_FILENO, text.data(), text.size()) < 0) errno = 0;
}

#ifdef __GLIBC__
/// Always takes all of it, so that whoever prints finds no error.
ssize_t write_or_lose(void* cookie, const char* text, size_t size) {
  const int descriptor = *static_cast<const int*>(cookie);
  for (size_t done = 0; done < size;) {
    const ssize_t written = ::write(descriptor, text + done, size - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      output_lost(descriptor, errno);
      break;
    }
    done += static_cast<size_t>(written);
  }
  return static_cast<ssize_t>(size);
}

void replace(std::FILE*& stream, int descriptor, int& cookie) {
  cookie = descriptor;
  cookie_io_functions_t functions{};
  functions.write = write_or_lose;
  if (std::FILE* file = fopencookie(&cookie, "w", functions)) stream = file;
}
#endif

}  // namespace

void survive_lost_output() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
#ifdef __GLIBC__
  static int out, error;
  replace(stdout, STDOUT_FILENO, out);
  replace(stderr, STDERR_FILENO, error);
  std::setvbuf(stderr, nullptr, _IONBF, 0);
#endif
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
}

bool output_is_whole() {
  std::fflush(stdout);
  // Help goes to std::cout, which writes to the stream that was there before.
  if (!std::cout.flush()) output_lost(STDOUT_FILENO, errno);
  return is_whole;
}

}  // namespace vsb::app
