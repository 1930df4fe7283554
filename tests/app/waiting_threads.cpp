// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// When a run says that its threads wait.
#include "engine/waiting_threads.hpp"

#include "support.hpp"

using vsb::app::processor_seconds;
using vsb::app::waiting_threads;
using vsb::test::containing;

TEST_CASE("threads that wait are told of, with how many would do") {
  CHECK(waiting_threads(2, 3.9, 2.1).empty());
  CHECK(waiting_threads(4, 5.1, 2.1).empty());
  CHECK(waiting_threads(2, 1.0, 1.9).empty());  // too early to tell
  CHECK(waiting_threads(1, 0.1, 9.0).empty());
  CHECK_THAT(waiting_threads(2, 2.0, 2.0),
             containing("2 threads had 1.0 cores") && containing("--threads 1 may"));
  CHECK_THAT(waiting_threads(16, 9.0, 3.0), containing("--threads 3 may"));
  CHECK_THAT(waiting_threads(2, 0.1, 3.0), containing("--threads 1 may"));
}

TEST_CASE("the time of the processor goes on with work") {
  const double before = processor_seconds();
  double now = before;
  for (int n = 0; n < 1'000'000'000 && now == before; ++n) now = processor_seconds();
  CHECK(now > before);
}
