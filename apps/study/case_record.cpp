// SPDX-License-Identifier: BSD-3-Clause
#include "study/case_record.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "engine/build_info.hpp"
#include "files/hdf5_file.hpp"
#include "scene/toml_reader.hpp"

namespace vsb::app {

namespace fs = std::filesystem;

namespace {

const std::array<const char*, 3> state_names = {"running", "finished", "failed"};

std::string path_in(const std::string& directory) {
  return directory + "/case.toml";
}

/// Version and commit: another commit may well give other figures.
std::string program() {
  std::string text = "vsb";
  for (const auto& [name, value] : build_info())
    if (name == "version" || name == "commit") text += " " + value;
  return text;
}

CaseRecord read(const toml::table& file) {
  CaseRecord record;
  const std::string state = file["state"].value_or(std::string());
  for (size_t i = 0; i < state_names.size(); ++i)
    if (state == state_names[i]) record.state = static_cast<CaseRecord::State>(i);
  record.message = file["message"].value_or(std::string());
  record.particles = file["particles"].value_or(0);
  record.seconds = file["seconds"].value_or(0.0);
  record.steps_timed = file["steps_timed"].value_or(0LL);
  record.end_time = file["end_time"].value_or(0.0);
  record.steps = file["steps"].value_or(0LL);
  record.iterations = file["iterations"].value_or(0LL);
  record.state_hash = file["state_hash"].value_or(std::string());
  if (const auto* figures = file["figures"].as_array())
    for (const auto& item : *figures)
      if (const auto* figure = item.as_table())
        record.figures.emplace_back((*figure)["name"].value_or(std::string()),
                                    (*figure)["value"].value_or(0.0));
  return record;
}

}  // namespace

std::optional<double> CaseRecord::figure(const std::string& name) const {
  for (const auto& [known, value] : figures)
    if (known == name) return value;
  return {};
}

double CaseRecord::ns_per_particle_step() const {
  const auto sweeps = static_cast<double>(steps_timed + iterations);
  return sweeps > 0 ? 1e9 * seconds / (static_cast<double>(particles) * sweeps) : 0;
}

std::string record_subject(const Scene& scene, Solution solution) {
  const char* what = solution == Solution::static_state ? "# static solution\n"
                     : solution == Solution::balance    ? "# balance\n"
                                                        : "";
  return what + scene.resolved;
}

std::optional<CaseRecord> read_case_record(const std::string& directory, const std::string& subject) {
  std::error_code error;
  if (!fs::exists(path_in(directory), error)) return {};
  try {
    const toml::table file = toml::parse_file(path_in(directory));
    if (file["program"].value_or(std::string()) != program() ||
        file["scene"].value_or(std::string()) != subject)
      return {};
    CaseRecord record = read(file);
    if (record.state == CaseRecord::State::finished && !fs::exists(directory + "/summary.json", error))
      return {};
    return record;
  } catch (const toml::parse_error&) {
    return {};
  }
}

void write_case_record(const std::string& directory, const std::string& subject, const CaseRecord& r) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) throw FileError(fmt::format("{}: cannot create the directory ({})", directory, error.message()));
  std::string text = fmt::format(
      "# What 'vsb study' knows of this case; without it, the case runs anew.\nprogram = {}\nstate = {}\n"
      "message = {}\nparticles = {}\nseconds = {}\nsteps_timed = {}\nend_time = {}\nsteps = {}\n"
      "iterations = {}\nstate_hash = {}\nscene = {}\n",
      quoted(program()), quoted(state_names[static_cast<size_t>(r.state)]), quoted(r.message), r.particles,
      r.seconds, r.steps_timed, r.end_time, r.steps, r.iterations, quoted(r.state_hash), quoted(subject));
  for (const auto& [name, value] : r.figures)
    text += fmt::format("\n[[figures]]\nname = {}\nvalue = {}\n", quoted(name), value);
  write_text_file(path_in(directory), text);
}

}  // namespace vsb::app
