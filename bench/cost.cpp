// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// vsb_cost: what a step on cell lanes costs in time and memory, and what a traction adds to it, beside the
/// paper's Table 3; on a device, where there are no cell lanes, of the particle kernels. See README.md.

#include "context.hpp"
#include "cost_measurements.hpp"
#include "cost_options.hpp"
#include "cost_record.hpp"
#include "machine_rates.hpp"

#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>

namespace vsb::bench {
namespace {

/// One line of the table: a size and a number type.
struct Row {
  CostCase what;
  const char* real;
  Record found;
};

/// The table and what belongs to all of it.
struct Report {
  CostOptions options;
  Record rates[2], flows[2];  ///< double, float
  std::vector<Row> rows;
};

constexpr const char* real_name[2] = {"double", "float"};

void progress(const std::string& text) {
  std::fprintf(stderr, "vsb_cost: %s\n", text.c_str());
}

/// Adds the shares of the machine's rates.
void add_shares(Row& row, const Record& rates) {
  const double ns = row.found["base ns"];
  row.found.set("share of FMA %", 100 * row.found["flops"] / ns / rates["fma GF/s"]);
  row.found.set("share of stream %", 100 * row.found["least bytes"] / ns / rates["stream GB/s"]);
}

/// One thread against several, in turns.
template <class Real>
void add_speed_up(Row& row, const CostOptions& o) {
  std::vector<double> one, several;
  for (int turn = 0; turn < 3; ++turn)
    for (const int threads : {1, o.threads}) {
      const auto found =
          in_child(threads, [&](Record& r) { Measurements<Real>::base(row.what, o.axis, o.repeats, r); });
      (threads == 1 ? one : several).push_back(found["wall 10 % ns"]);
    }
  const auto least = [](const std::vector<double>& x) { return *std::min_element(x.begin(), x.end()); };
  row.found.set("one thread ns", least(one));
  row.found.set("all threads ns", least(several));
  row.found.set("speed-up", least(one) / least(several));
}

template <class Real>
Row measure(const CostCase& what, const CostOptions& o, const Record& rates) {
  const int kind = sizeof(Real) == 8 ? 0 : 1;
  Row row{what, real_name[kind], {}};
  progress(what.name + ", " + row.real);
  if (runs_on_host) {
    row.found =
        in_child(o.threads, [&](Record& r) { Measurements<Real>::engine(what, o.axis, o.repeats, r); });
    add_shares(row, rates);
  }
  if (o.naive || !runs_on_host) {
    progress(what.name + ", " + row.real + ", particle kernels");
    const auto kernels =
        in_child(o.threads, [&](Record& r) { Measurements<Real>::kernels(what, o.axis, o.repeats, r); });
    for (const auto& [name, value] : kernels.all()) row.found.set(name, value);
  }
  if (o.threads > 1) {
    progress(what.name + ", " + row.real + ", threads in turns");
    add_speed_up<Real>(row, o);
  }
  return row;
}

template <class Real>
Record measure_flows(const CostOptions& o) {
  progress(std::string("translating block and sparse grid, ") + real_name[sizeof(Real) == 8 ? 0 : 1]);
  Record all;
  const auto add = [&](const Record& part) {
    for (const auto& [name, value] : part.all()) all.set(name, value);
  };
  for (const auto& [arrangement, steps] :
       {std::pair(Arrangement::lattice, 1000), std::pair(Arrangement::jittered, 200)})
    for (const int direction : {0, 1, 2})
      add(in_child(o.threads, [&, arrangement = arrangement, steps = steps](Record& r) {
        Measurements<Real>::translation(direction, arrangement, steps, r);
      }));
  add(in_child(o.threads, [&](Record& r) { Measurements<Real>::sparse(r); }));
  add(in_child(o.threads, [&](Record& r) { Measurements<Real>::materials(r); }));
  add(in_child(o.threads, [&](Record& r) { Measurements<Real>::means(r); }));
  double bytes[2];
  for (const bool sparse : {false, true})
    bytes[sparse] = in_child(
        o.threads, [&](Record& r) { Measurements<Real>::sparse_memory(sparse, r); })["stepping bytes"];
  all.set("sparse / tight: resident", bytes[1] / bytes[0]);
  return all;
}

void print_extras(const Record& r, const std::string& title, const std::vector<std::string>& names,
                  const std::string& end, const std::string& all) {
  std::printf("  %-30s %22s %22s\n", title.c_str(), "end face", "all faces");
  for (const auto& name : names) {
    std::printf("  %-30s", name.c_str());
    for (const auto& where : {end, all})
      std::printf(" %+10.2f %% %+7.2f ns", r[where + ": " + name + " %"], r[where + ": " + name + " ns"]);
    std::printf("\n");
  }
}

/// The part of a row that is about cell lanes.
void print_engine(const Row& row) {
  const auto& r = row.found;
  std::printf("  base %.2f ns per particle and step (10 %% quantile %.2f)", r["base ns"], r["base 10 % ns"]);
  if (row.what.has_row) std::printf("; the paper: %.0f ns", 1000 * row.what.row.base_us);
  std::printf(
      "\n  %.0f flops: %.0f %% of the FMA rate; at least %.0f bytes: %.0f %% of the stream rate of memory\n",
      r["flops"], r["share of FMA %"], r["least bytes"], r["share of stream %"]);
  std::printf("  bytes per particle: state %.0f, resident while stepping %.0f, peak with set-up %.0f\n",
              r["state bytes"], r["stepping bytes"], r["peak bytes"]);
  std::printf(
      "  a step that re-maps by the mass matrix takes %.3f times one with a second sweep; the program takes "
      "%s\n",
      r["mass matrix / second sweep"], r["by mass matrix"] == 1 ? "the mass matrix" : "a second sweep");
  print_extras(r, "extra by MOD",
               {"null", "pressure", "pressure, marked", "pressure, marked, summed anew", "tensor",
                "tensor, marked", "affine", "affine, marked", "function", "function, marked"},
               "end face", "all faces");
  print_extras(r, "extra by other impositions", {"MP", "BP", "ORIG"}, "end face", "all faces");
}

/// The part about the particle kernels.
void print_kernels(const Row& row) {
  const auto& r = row.found;
  std::printf("  particle kernels: base %.1f ns (10 %% quantile %.1f)", r["kernels base ns"],
              r["kernels base 10 % ns"]);
  if (r.has("base ns"))
    std::printf("; engine %.1f times faster, with pressure on all faces %.1f times",
                r["particle kernels / engine, base"], r["particle kernels / engine, MOD"]);
  std::printf("\n");
  print_extras(r, "extra, particle kernels", {"null", "MP", "BP", "ORIG", "MOD"}, "kernels, end face",
               "kernels, all faces");
}

void print(const Row& row) {
  const auto& r = row.found;
  const auto& p = row.what.row;
  std::printf("\n%s, %s: %d particles, %d per cell\n", row.what.name.c_str(), row.real,
              particle_count<3>(row.what.size), static_cast<int>(std::pow(row.what.size.per_direction, 3)));
  if (r.has("base ns")) print_engine(row);
  if (r.has("kernels base ns")) print_kernels(row);
  if (row.what.has_row)
    std::printf("  the paper, end face: MP %+.2f %%  BP %+.2f %%  ORIG %+.2f %%  MOD %+.2f %%\n", p.MP, p.BP,
                p.ORIG, p.MOD);
  if (r.has("speed-up"))
    std::printf(
        "  threads: %.2f ns with one, %.2f ns with all: %.2f times faster (wall time, 10 %% quantiles)\n",
        r["one thread ns"], r["all threads ns"], r["speed-up"]);
  std::fflush(stdout);
}

void print_flows(const Record& r, const char* real) {
  std::printf(
      "\nrigid translation at 0.1 cells per step, a grid of 30 times the body's volume, plasticity, and "
      "means of the divergence, %s\n",
      real);
  for (const auto& [name, value] : r.all()) std::printf("  %-30s %8.3f\n", name.c_str(), value);
  std::fflush(stdout);
}

/// JSON has no word for what is not a number.
void write_number(std::ostream& out, double x) {
  if (std::isfinite(x))
    out << x;
  else
    out << "null";
}
void write_numbers(std::ostream& out, const Record& r) {
  const char* separator = "";
  out << '{';
  for (const auto& [name, value] : r.all()) {
    out << separator << '"' << name << "\": ";
    write_number(out, value);
    separator = ", ";
  }
  out << '}';
}
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

void write_json(const Report& report, const std::vector<std::pair<std::string, std::string>>& facts) {
  std::ofstream out(report.options.json);
  out.precision(9);
  out << "{\n\"context\": {";
  const char* separator = "";
  for (const auto& [name, value] : facts) {
    out << separator << quoted(name) << ": " << quoted(value);
    separator = ", ";
  }
  out << "},\n\"rows\": [";
  separator = "\n";
  for (const auto& row : report.rows) {
    out << separator << "{\"size\": " << quoted(row.what.name) << ", \"real\": \"" << row.real
        << "\", \"particles\": " << particle_count<3>(row.what.size) << ", \"paper\": ";
    const auto& p = row.what.row;
    if (row.what.has_row)
      out << "{\"base ns\": " << 1000 * p.base_us << ", \"MP %\": " << p.MP << ", \"BP %\": " << p.BP
          << ", \"ORIG %\": " << p.ORIG << ", \"MOD %\": " << p.MOD << '}';
    else
      out << "null";
    out << ",\n \"found\": ";
    write_numbers(out, row.found);
    out << '}';
    separator = ",\n";
  }
  out << "\n],\n\"rates\": {\"double\": ";
  write_numbers(out, report.rates[0]);
  out << ", \"float\": ";
  write_numbers(out, report.rates[1]);
  out << "},\n\"flows\": {\"double\": ";
  write_numbers(out, report.flows[0]);
  out << ", \"float\": ";
  write_numbers(out, report.flows[1]);
  out << "}\n}\n";
  if (!out.flush()) throw std::runtime_error("cannot write " + report.options.json);
}

void run(const CostOptions& options) {
  Report report{options, {}, {}, {}};
  const auto facts = describe_build(Exec::name(), options.threads);
  for (const auto& [name, value] : facts) std::printf("%s: %s\n", name.c_str(), value.c_str());
  std::printf("column along %c; %s; a run's figures are medians of rounds in turns\n", "xyz"[options.axis],
              options.threads > 1 ? "wall time" : "CPU time");
  progress("rates of the machine");
  report.rates[0] = in_child(options.threads, measure_rates<double>);
  report.rates[1] = in_child(options.threads, measure_rates<float>);
  for (const int kind : {0, 1})
    std::printf("rates, %s: stream %.1f GB/s, fused multiply-adds %.1f GF/s\n", real_name[kind],
                report.rates[kind]["stream GB/s"], report.rates[kind]["fma GF/s"]);
  std::fflush(stdout);
  for (const auto& name : options.cases) {
    for (const auto& what : cost_cases(name)) {
      report.rows.push_back(measure<double>(what, options, report.rates[0]));
      print(report.rows.back());
      report.rows.push_back(measure<float>(what, options, report.rates[1]));
      print(report.rows.back());
    }
    if (name == "80k" && runs_on_host) {
      report.flows[0] = measure_flows<double>(options);
      print_flows(report.flows[0], real_name[0]);
      report.flows[1] = measure_flows<float>(options);
      print_flows(report.flows[1], real_name[1]);
    }
  }
  if (!options.json.empty()) write_json(report, facts);
}

}  // namespace
}  // namespace vsb::bench

int main(int argc, char** argv) {
  const auto options = vsb::bench::read_cost_options(argc, argv);
  if (options.help) {
    std::printf("%s", vsb::bench::cost_usage);
    return 0;
  }
  if (!options.error.empty()) {
    std::fprintf(stderr, "vsb_cost: %s\n%s", options.error.c_str(), vsb::bench::cost_usage);
    return 2;
  }
  try {
    vsb::bench::run(options);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "vsb_cost: %s\n", e.what());
    return 1;
  }
  return 0;
}
