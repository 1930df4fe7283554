// SPDX-License-Identifier: BSD-3-Clause
#include "study/run_case.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "files/hdf5_file.hpp"
#include "run/interrupt.hpp"

#ifdef __linux__
#include <sys/prctl.h>
#endif

namespace vsb::app {

namespace {

void take_figures(CaseRecord& record, const Scene& scene, const RunResult& result) {
  const auto& figures = result.figures;
  record.seconds += figures.seconds;
  record.steps_timed += figures.steps_timed;
  record.steps = figures.steps;
  record.iterations = figures.iterations;
  if (result.code != exit_done && result.code != exit_not_static) return;
  record.state = CaseRecord::State::finished;
  record.end_time = static_cast<double>(figures.steps) * scene.time.dt;
  record.state_hash = figures.state_hash;
  record.figures = named_figures(scene, figures);
  if (result.code == exit_not_static)
    record.message = fmt::format("not static after max_steps = {}", scene.time.steps);
}

/// The work of the case's process; its exit code.
ExitCode make(const Scene& scene, const RunOptions& options, CaseRecord record, const SceneRunner& run) {
  try {
    ExitCode code = exit_done;
    try {
      const auto result = run(scene, options);
      code = result.code == exit_interrupted ? exit_interrupted : exit_done;
      take_figures(record, scene, result);
    } catch (const SetupError& error) {
      record.state = CaseRecord::State::failed;
      record.message = error.what();
    } catch (const Diverged& error) {
      record.state = CaseRecord::State::failed;
      record.message = std::string("diverged ") + error.what();
    } catch (const LeftGrid& error) {
      record.state = CaseRecord::State::failed;
      record.message = error.what();
    } catch (const NotStatic& error) {
      record.state = CaseRecord::State::failed;
      record.message = error.what();
    }
    write_case_record(options.directory, record_subject(scene, options.solution), record);
    return code;
  } catch (const FileError& error) {
    fmt::print(stderr, "vsb: {}\n", error.what());
    return exit_files;
  } catch (const std::exception& error) {
    fmt::print(stderr, "vsb: {}\n", error.what());
    return exit_internal;
  }
}

/// Waits for the case's process, passing a request to stop on to it (a terminal does so itself, but kill does
/// not).
int wait_for(pid_t child) {
  int status = 0;
  bool told = false;
  for (unsigned pause = 1000; waitpid(child, &status, WNOHANG) != child;
       pause = std::min(2 * pause, 50'000u)) {
    usleep(pause);
    if (!interrupt_requested() || told) continue;
    kill(child, SIGTERM);
    told = true;
  }
  return status;
}

}  // namespace

CaseResult run_case(const Scene& scene, const RunOptions& options, const CaseRecord& before,
                    const SceneRunner& run) {
  const std::string subject = record_subject(scene, options.solution);
  write_case_record(options.directory, subject, before);
  std::fflush(nullptr);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) throw FileError(fmt::format("cannot start a process: {}", std::strerror(errno)));
  if (child == 0) {
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // without the study nobody waits for the case: checkpoint and end
    if (getppid() != parent) _exit(exit_interrupted);
#endif
    const ExitCode code = make(scene, options, before, run);
    std::fflush(nullptr);
    _exit(code);
  }
  const int status = wait_for(child);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code == exit_done)
    if (const auto record = read_case_record(options.directory, subject)) return {exit_done, *record};
  if (code == exit_interrupted || code == exit_files) return {static_cast<ExitCode>(code), before};
  // A crash, or no memory. That may be another time's luck, so the record on the disk stays as it is.
  CaseRecord record = before;
  record.state = CaseRecord::State::failed;
  record.message = WIFSIGNALED(status)
                       ? fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))
                       : fmt::format("ended with exit code {}", code);
  return {exit_done, record};
}

}  // namespace vsb::app
