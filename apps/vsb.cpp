// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The program vsb: run, check, study, keys, info.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>

#include "engine/build_info.hpp"
#include "engine/kokkos_session.hpp"
#include "engine/simulation.hpp"
#include "files/hdf5_file.hpp"
#include "run/check_scene.hpp"
#include "run/run_scene.hpp"
#include "run/standard_streams.hpp"
#include "scene/key_reference.hpp"
#include "scene/open_setting.hpp"
#include "scene/scene_error.hpp"
#include "scene/scene_keys.hpp"
#include "setup/place_particles.hpp"
#include "study/read_study.hpp"
#include "study/run_study.hpp"
#include "study/study_keys.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

using namespace vsb::app;

/// Large arrays go back to the system when they are freed. Left alone, glibc keeps those of up to 32 MB for
/// itself: what a frame needs for a moment, as much again as the particles, would stay for the whole run.
void release_large_arrays() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
#endif
}

void print_info() {
  fmt::print("vsb\n");
  for (const auto& [name, value] : build_info()) fmt::print("  {:<16} {}\n", name, value);
  if (threads_at_hand() > 0) fmt::print("  {:<16} {}\n", "threads", threads_at_hand());
}

/// Places the particles of a scene, keeps them for its run, and tells how many they are.
int count_placed(const Scene& scene, PlacedParticles& placed, PlacedParticles*& kept) {
  placed = place_particles(scene);
  kept = &placed;
  return static_cast<int>(placed.position.size());
}

std::string refuse_empty(const std::string& directory) {
  return directory.empty() ? "is empty: give a directory, or leave it out" : "";
}

/// Does what the command line says.
int run_command(int argc, char** argv) {
  CLI::App app{
      "vsb: material point method with tractions by the virtual stress boundary method.\n\n"
      "A scene is a TOML file; the ones to start from lie in apps/scenes. A typical session:\n"
      "  vsb check apps/scenes/column.toml                        what would run, and what it would cost\n"
      "  vsb run apps/scenes/column.toml --set time.steps=30000   run it, with another number of steps\n"
      "  /usr/bin/python3 apps/plot/plot.py results/column             draw its pictures\n"
      "  vsb keys traction                                        every key of a table, or of a name\n\n"
      "Exit codes: 0 done, 2 bad usage or input, 3 diverged, 4 results cannot be read or written,\n"
      "5 interrupted, checkpoint written, 6 a study ran but missed an expectation, 7 not static after "
      "max_steps\n"
      "(of until_static) or max_iterations (of static), or at rest without one of its loads, 8 a healthy "
      "body "
      "left\nthe grid: its last state is a frame."};
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::help);

  std::string scene_path;
  std::vector<std::string> overrides;
  RunOptions options;
  bool static_solution = false;
  int threads = 0;
  const auto add_threads = [&](CLI::App* command) {
    command
        ->add_option("--threads", threads,
                     "Number of threads (default: OMP_NUM_THREADS, else as many as pay)")
        ->check(CLI::Range(1, 1'000'000));
  };
  const auto add_scene_options = [&](CLI::App* command) {
    command->add_option("scene", scene_path, "Scene file (TOML)")->required();
    command
        ->add_option(
            "--set", overrides,
            "Replace a value of the scene, e.g. time.kappa=0.1 or body[0].density=2000; KEY= removes the key")
        ->type_name("KEY=VALUE")
        ->take_all();
    add_threads(command);
  };

  auto* run = app.add_subcommand("run", "Run a scene");
  add_scene_options(run);
  run->add_option("--out", options.directory, "Directory of the results (default: results/NAME)")
      ->check(refuse_empty);
  run->add_flag("--quiet", options.quiet, "Print warnings and errors only");
  run->add_flag("--resume", options.resume,
                "Continue from the checkpoint in the results' directory, if there is one");
  run->add_flag("--static", static_solution,
                "Solve for the static state under the final loads (linear elastic, small strain) in place of "
                "time steps");

  auto* check =
      app.add_subcommand("check", "Print the resolved scene with all defaults, and what it would cost");
  add_scene_options(check);

  std::string study_name;
  StudyOptions study_options;
  bool fine = false;
  auto* study = app.add_subcommand(
      "study",
      "Run the cases of a study and compare their figures with the expected ones; called again after an\n"
      "interrupt, it goes on where it stopped");
  study->add_option("study", study_name, "Study of apps/studies (column), or a file (path/to/mine.toml)")
      ->required();
  study
      ->add_option("--out", study_options.directory, "Directory of the results (default: results/NAME-study)")
      ->check(refuse_empty);
  study->add_flag("--fine", fine, "Run the cases marked fine too (long)");
  add_threads(study);
  study->add_flag("--quiet", study_options.quiet, "Print failing lines only");

  std::string key;
  bool of_studies = false;
  auto* keys =
      app.add_subcommand("keys", "Print the reference of the keys of scenes (Markdown), or a part of it");
  keys->add_option("key", key, "A key or a table, e.g. friction_angle or body.material (default: all)");
  keys->add_flag("--study", of_studies, "The keys of studies");

  auto* info = app.add_subcommand("info", "Print version, commit, Kokkos, backend and instruction set");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_done : exit_input;
  }

  try {
    if (*info) {
      print_info();
      return exit_done;
    }
    if (*keys) {
      const auto part = [&] { return key_reference_of(of_studies ? study_keys : scene_keys(), key); };
      const auto all = [&] { return of_studies ? study_key_reference() : scene_key_reference(); };
      fmt::print("{}", key.empty() ? all() : part());
      return exit_done;
    }
    if (*study) {
      const Study cases = read_study(find_study(study_name), fine);
      if (study_options.directory.empty()) study_options.directory = "results/" + cases.name + "-study";
      check_threads(threads);
      study_options.run = [threads](const Scene& scene, const RunOptions& run_options) {
        auto with_particles = run_options;
        PlacedParticles placed;
        const KokkosSession kokkos(choose_threads(threads, [&] {
                                     return count_placed(scene, placed, with_particles.placed);
                                   }).threads);
        return run_scene(scene, with_particles);
      };
      return run_study(cases, study_options);
    }
    if (static_solution) options.solution = Solution::static_state;
    if (static_solution && options.resume)
      throw SceneError("--static takes no steps, so there is none to --resume from; give one of the two");
    const Scene scene = read_scene(scene_path, overrides);
    if (options.directory.empty()) options.directory = "results/" + scene.name;
    PlacedParticles placed;
    const auto choice = choose_threads(threads, [&] { return count_placed(scene, placed, options.placed); });
    options.threads = choice.why;
    const KokkosSession kokkos(choice.threads);
    if (*check || !options.quiet)
      if (const auto advice = open_setting_advice(scene, scene_path, overrides); !advice.empty())
        fmt::print("{}{}\n", *check ? "# " : "", advice);
    if (*run) return run_scene(scene, options).code;
    if (*check) check_scene(scene, options.placed);
    return exit_done;
  } catch (const SceneError& error) {
    fmt::print(stderr, "vsb: {}\n", error.what());
    return exit_input;
  } catch (const SetupError& error) {
    fmt::print(stderr, "vsb: {}: {}\n", error.where.empty() ? scene_path : error.where, error.what());
    return exit_input;
  } catch (const Diverged& error) {
    fmt::print(stderr, "vsb: diverged {}\n", error.what());
    return exit_diverged;
  } catch (const LeftGrid& error) {
    fmt::print(stderr, "vsb: {}\n", error.what());
    return exit_left_grid;
  } catch (const NotStatic& error) {
    fmt::print(stderr, "vsb: {}\n", error.what());
    return exit_not_static;
  } catch (const FileError& error) {
    fmt::print(stderr, "vsb: {}\n", error.what());
    return exit_files;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "vsb: out of memory; 'vsb check' says what a scene needs\n");
    return exit_input;
  } catch (const std::exception& error) {
    fmt::print(stderr, "vsb: internal error: {}\n", error.what());
    return exit_internal;
  }
}

}  // namespace

int main(int argc, char** argv) {
  wait_gently(argv);
  release_large_arrays();
  survive_lost_output();
  const int code = run_command(argc, argv);
  return output_is_whole() || code != exit_done ? code : exit_files;
}
