// Scores graphs/texture.json for several values of a tuning constant; tests/bench/sweep builds and starts this.

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/suggest.h"
#include "core/base/tuning.h"
#include "tests/bench/quality_runs.h"

namespace fs = std::filesystem;
using namespace terrazzo;
using namespace terrazzo::bench;

namespace {

std::vector<double> numbers_in(const std::string& list) {
  std::vector<double> out;
  const char* at = list.data();
  const char* const end = at + list.size();
  for (;;) {
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || (next != end && *next != ','))
      throw Error(fmt::format("expected numbers with commas between them, found \"{}\"", list));
    out.push_back(value);
    if (next == end) return out;
    at = next + 1;
  }
}

/// Throws Error, with the nearest name, if there is none of that name.
const TuningConstant& find_constant(const std::string& name) {
  std::vector<std::string> names;
  for (const TuningConstant* c : tuning_constants()) {
    if (c->name == name) return *c;
    names.push_back(c->name);
  }
  throw Error(fmt::format("there is no tuning constant \"{}\"{}", name, did_you_mean(name, names)));
}

/// A figure's means over all exemplars, one for each seed.
struct Spread {
  double mean = 0, least = 0, most = 0;
  explicit Spread(const std::vector<double>& of_seeds)
      : least(*std::ranges::min_element(of_seeds)), most(*std::ranges::max_element(of_seeds)) {
    for (const double v : of_seeds) mean += v / double(of_seeds.size());
  }
};

class Sweep {
 public:
  Sweep(const TuningConstant& constant, const Program& program, std::vector<Case> cases, std::vector<int> seeds,
        fs::path out)
      : constant_(constant),
        program_(program),
        cases_(std::move(cases)),
        seeds_(std::move(seeds)),
        out_(std::move(out)),
        runs_(out_ / "runs.csv") {
    for (const Column& c : columns()) names_.push_back(c.name);
    names_.push_back("seconds");
    const bool measured = !constant.measured.starts_with("not measured");
    const std::string evidence = (measured ? "measured: experiments.md, " : "") + constant.measured;
    fmt::print(
        "{} ({}), default {}; {}\n    {}\n{} exemplars, seeds {}; means over exemplars and seeds, ± half "
        "the range of the seeds' means\n\n",
        constant.name, constant.unit, constant.number(), evidence, constant.trades, cases_.size(),
        fmt::join(seeds_, ", "));
    fmt::print("{:<14}", "value");
    for (const std::string& name : names_) fmt::print(" {:>16}", name);
    fmt::print("\n");
    runs_ << "value,seed,exemplar," << fmt::format("{}\n", fmt::join(names_, ","));
  }

  /// Prints a row of the table.
  void score(double value, bool is_default) {
    std::map<std::string, std::vector<double>> of_seeds;
    for (const int seed : seeds_) {
      Row mean;
      for (const Case& c : cases_)
        for (const auto& [name, figure] : score(value, seed, c)) mean[name] += figure / double(cases_.size());
      for (const auto& [name, figure] : mean) of_seeds[name].push_back(figure);
    }
    fmt::print("{:<14}", fmt::format("{}{}", value, is_default ? " default" : ""));
    for (const std::string& name : names_) {
      const Spread s(of_seeds.at(name));
      fmt::print(" {:>16}", fmt::format("{0:.{2}f} ±{1:.{2}f}", s.mean, (s.most - s.least) / 2, decimals(name)));
    }
    fmt::print("\n");
    std::fflush(stdout);
  }

 private:
  Row score(double value, int seed, const Case& c) {
    Program program = program_;
    program.arguments = {"--tune", fmt::format("{}={}", constant_.name, value)};
    const fs::path folder =
        out_ / "results" / fmt::format("{}={}", constant_.name, value) / fmt::format("seed{}", seed);
    const Row row = synthesize(c, program, seed, folder / c.name).row;
    runs_ << fmt::format("{},{},{}", value, seed, c.name);
    for (const std::string& name : names_) runs_ << fmt::format(",{:.5f}", row.at(name));
    runs_ << std::endl;  // a sweep may be stopped
    return row;
  }
  static int decimals(const std::string& name) {
    for (const Column& c : columns())
      if (c.name == name) return c.decimals;
    return 2;
  }

  const TuningConstant& constant_;
  Program program_;
  std::vector<Case> cases_;
  std::vector<int> seeds_;
  fs::path out_;
  std::ofstream runs_;
  std::vector<std::string> names_;
};

int sweep(const std::vector<std::string>& words) {
  const size_t at = words[2].find('=');
  if (at == std::string::npos) throw Error(fmt::format("expected NAME=V1,V2,..., found \"{}\"", words[2]));
  const TuningConstant& constant = find_constant(words[2].substr(0, at));
  std::vector<double> values = numbers_in(words[2].substr(at + 1));
  const double usual = constant.number();
  values.push_back(usual);
  std::ranges::sort(values);
  values.erase(std::ranges::unique(values).begin(), values.end());
  for (const double v : values) override_tuning(constant.name, v);  // the wrong ones before anything runs
  override_tuning(constant.name, usual);
  std::vector<int> seeds;
  for (const double seed : numbers_in(words[5])) seeds.push_back(int(seed));
  const fs::path exemplars = words[3], out = words[4];
  const Program program{words[0], words[1]};
  fs::create_directories(out);
  Sweep table(constant, program, find_cases(program, exemplars, exemplars / "../peers", out), seeds, out);
  for (const double v : values) table.score(v, v == usual);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 7) {
    fmt::print(stderr, "usage: terrazzo_sweep PROGRAM SOURCE NAME=V1,V2,... EXEMPLARS OUT SEEDS\n");
    return 2;
  }
  try {
    std::vector<std::string> words(argv + 1, argv + argc);
    words[0] = fs::absolute(words[0]).string();
    return sweep(words);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
