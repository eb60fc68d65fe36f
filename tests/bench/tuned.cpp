// The whole command line with tuning constants that can be changed without recompiling (core/base/tuning.h).

#include <algorithm>
#include <charconv>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/tuning.h"
#include "core/synthesis/state/expansion.h"
#include "core/synthesis/steps.h"
#include "core/synthesis/steps/initialize.h"
#include "runner/cli/cli_commands.h"
#include "tests/energy/energy.h"
#include "tests/energy/window_coherence.h"

using namespace terrazzo;

namespace {

constexpr std::string_view usage =
    "usage: terrazzo_tuned [--tune NAME=VALUE]... [--step-times] [--step-energy] COMMAND...\n"
    "           terrazzo with other constants; its results have cache keys of their own\n"
    "           --step-times: prints the milliseconds of every step on every level, on standard error\n"
    "           --step-energy: prints what the result costs after every step (tests/energy/energy.h), as "
    "columns\n"
    "           of level, step, pass; per pixel the window distance (1: usual), the share of unlike windows, the "
    "mismatch\n"
    "           along seams (appearance units), the share of cut neighbours and the phase\n"
    "       terrazzo_tuned --tunings\n"
    "           lists the constants\n";

/// The word after `option`, or its value after "="; moves on to it. Null if the word is another one.
const char* value_of(std::string_view option, int& i, int argc, const char* const* argv) {
  const std::string_view word = argv[i];
  if (word == option) {
    if (i + 1 == argc) throw Error(fmt::format("{} needs NAME=VALUE", option));
    return argv[++i];
  }
  return word.starts_with(option) && word.substr(option.size()).starts_with("=") ? argv[i] + option.size() + 1
                                                                                 : nullptr;
}

void tune(std::string_view text) {
  const size_t at = text.find('=');
  double value = 0;
  const std::string_view digits = at == std::string_view::npos ? "" : text.substr(at + 1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size())
    throw Error(fmt::format("expected NAME=NUMBER, found \"{}\"", text));
  override_tuning(text.substr(0, at), value);
}

std::string evidence(const TuningConstant& c) {
  return c.measured.starts_with("not measured") ? c.measured : "measured: experiments.md, " + c.measured;
}

std::string range(const TuningConstant& c) {
  if (!c.is_limited()) return "";
  return c.most == TuningConstant().most ? fmt::format(", at least {}", c.least)
                                         : fmt::format(", from {} to {}", c.least, c.most);
}

void list() {
  for (const TuningConstant* c : tuning_constants())
    fmt::print("{} = {}{}{}{}\n    {}\n    {}\n", c->name, c->number(), c->unit.empty() ? "" : " ", c->unit, range(*c),
               c->trades, evidence(*c));
}

/// What the steps of one process have taken.
class StepTimes {
 public:
  void add(const Step& step, const LevelFacts& facts, double seconds) {
    const std::scoped_lock lock(mutex_);
    const auto row = size_t(&step - synthesis_steps().data());
    milliseconds_[{-facts.level, row}] += 1e3 * seconds;
  }
  void print() const {
    for (const auto& [key, milliseconds] : milliseconds_)
      fmt::print(stderr, "level {}, {:<18} {:>8.1f} ms\n", -key.first, synthesis_steps()[key.second].name,
                 milliseconds);
  }

 private:
  std::mutex mutex_;
  std::map<std::pair<int, size_t>, double> milliseconds_;  // the coarsest level first
};

/// What the result costs after a step.
void print_energy(const Step& step, const StepContext& c) {
  if (step.phase == Phase::costs) return;
  CorrectionLevel level = c.level;
  Field field = c.field;
  if (step.phase == Phase::upsampling) {  // its pixels are blocks of 2x2
    level.window = PlaneWindow::all_of(c.shared.plane(c.facts.level));
    level.block = 1;
    field = expanded(c.field.pixels, c.level.window, level.window, level.exemplar);
  }
  const Energy e = energy_of(std::move(field), level, 1 << 16, c.shared.task);
  const auto share = [&](int64_t sum, double unit) {
    return double(sum) / unit / double(std::max<int64_t>(1, e.pixels));
  };
  fmt::print(stderr, "{}\t{}\t{}\t{:.4f}\t{:.4f}\t{:.2f}\t{:.4f}\t{:.4f}\n", c.facts.level, step.name, c.pass,
             share(e.windows, WindowCoherence::usual), share(e.unlike, 1), share(e.seams, mismatch_unit),
             share(e.cut, 1), share(e.phase, 256));
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<const char*> rest = {argv[0]};
  bool lists = false, times = false, energy = false;
  try {
    for (int i = 1; i < argc; i++) {
      if (std::string_view(argv[i]) == "--tunings")
        lists = true;
      else if (std::string_view(argv[i]) == "--step-times")
        times = true;
      else if (std::string_view(argv[i]) == "--step-energy")
        energy = true;
      else if (const char* text = value_of("--tune", i, argc, argv))
        tune(text);
      else
        rest.push_back(argv[i]);
    }
  } catch (const Error& e) {
    fmt::print(stderr, "{}\n{}", e.what(), usage);
    return exit_usage;
  }
  if (lists) {
    list();
    return 0;
  }
  StepTimes taken;
  if (times || energy)
    watch_steps([&](const Step& s, const StepContext& c, double seconds) {
      if (times) taken.add(s, c.facts, seconds);
      if (energy) print_energy(s, c);
    });
  const int status = run_command_line(int(rest.size()), rest.data());
  taken.print();
  return status;
}
