// SPDX-License-Identifier: BSD-3-Clause
#include "study/draw_study.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <vector>

#include "engine/build_info.hpp"

extern char** environ;

namespace vsb::app {

namespace {

/// Runs a program and waits; its exit code, or -1 where it could not run. Silent: its output goes nowhere.
int spawn(std::vector<std::string> arguments, bool silent) {
  std::vector<char*> argv;
  for (auto& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (silent)
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failure = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (failure != 0) return -1;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

std::string draw_study(const std::string& csv_file, bool quiet) {
  const std::string script = apps_directory() + "/plot/plot_study.py";
  if (!std::filesystem::exists(script)) return fmt::format("there is no {}", script);
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    if (spawn({python, "-c", "import matplotlib"}, true) != 0) continue;
    std::fflush(stdout);
    const int code = spawn({python, script, csv_file}, quiet);
    return code == 0 ? "" : fmt::format("{} {} {} ended with exit code {}", python, script, csv_file, code);
  }
  return "no python3 has matplotlib; on Debian: apt-get install python3-matplotlib";
}

}  // namespace vsb::app
