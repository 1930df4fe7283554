// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Standard output and error of a program that has work to save when nobody reads them any more.
#pragma once

namespace vsb::app {

/// From here on, what cannot be written (a closed pipe, a terminal that is gone, a full disk) is lost, and
/// asks the run to stop with a checkpoint (run/interrupt.hpp), in place of ending the process. A file above
/// the limit of its size (ulimit -f) is an error of writing too. Lines go out as they are printed.
void survive_lost_output();

/// Whether standard output took all that was printed so far; for the end of the program.
bool output_is_whole();

}  // namespace vsb::app
