#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// Tuning constants: numbers that trade one goal against another and were determined by measurement. Each is a field of
/// its step's tuning structure, is described where it is defined, and can be overridden in a benchmark run without
/// recompiling:
///
///     struct SeamsTuning {
///       double stay = 32;
///       int reach = 4;
///     };
///     const Tunable<SeamsTuning> seams_tuning("seams", {
///         {&SeamsTuning::stay, "stay", "appearance units per pixel", "higher: straighter seams; lower: seams that find
///         joints", "seams"},
///         {&SeamsTuning::reach, "reach", "pixels", "higher: joints farther away are found; costs time", "seams", 1,
///         96},
///     });
///     ... seams_tuning->reach ...
///
/// The limits of a field (1 and 96) keep runs from crashing or never ending: code that divides by a constant need not
/// check for 0.
///
/// Reading is as cheap as reading a variable; inner loops copy the values they need. Override constants before any work
/// begins; reading is thread-safe.
namespace terrazzo {

/// The description of a constant, for tools.
struct TuningConstant {
  std::string name;      ///< "seams.reach"
  std::string unit;      ///< "pixels"; empty: dimensionless
  std::string trades;    ///< the effects of higher and lower values
  std::string measured;  ///< a heading of tests/bench/experiments.md, or "not measured: " and the reason for the value
  double least = 0;      ///< the range of overrides; values outside might crash the program
  double most = 1e9;
  std::variant<int*, double*> value;

  double number() const;
  /// Whether its range differs from the default.
  bool is_limited() const { return least != TuningConstant().least || most != TuningConstant().most; }
};

/// All constants of the program, by name.
std::vector<const TuningConstant*> tuning_constants();

/// Overrides a constant. Throws Error if the name is unknown (with a suggestion), if the value is out of range, or if
/// an integer would get a fraction.
void override_tuning(std::string_view name, double value);

/// The overridden constants as "name=value", sorted by name; empty in normal runs. Part of every cache key, so that
/// such runs do not share results with others.
std::string overridden_tuning();

namespace detail {
void add_constants(std::string_view group, const std::vector<TuningConstant>& constants);
[[noreturn]] void reject_incomplete(std::string_view group);
}  // namespace detail

/// A tuning structure of ints and doubles, with a description of each field; used as a static object. Doubles must come
/// first, so that missing descriptions are detected. Throws std::logic_error if a field is not described.
template <typename T>
class Tunable {
 public:
  struct Field {
    std::variant<int T::*, double T::*> member;
    const char* name;
    const char* unit;
    const char* trades;
    const char* measured;
    double least = TuningConstant().least;
    double most = TuningConstant().most;
  };

  Tunable(std::string_view group, std::initializer_list<Field> fields) {
    std::vector<TuningConstant> constants;
    size_t described = 0;
    for (const Field& f : fields) {
      TuningConstant c{std::string(group) + "." + f.name, f.unit, f.trades, f.measured, f.least, f.most, {}};
      std::visit(
          [&](auto member) {
            c.value = &(values_.*member);
            described += sizeof(values_.*member);
          },
          f.member);
      constants.push_back(std::move(c));
    }
    if (described + alignof(T) <= sizeof(T)) detail::reject_incomplete(group);
    detail::add_constants(group, constants);
  }
  Tunable(const Tunable&) = delete;
  Tunable& operator=(const Tunable&) = delete;

  const T* operator->() const { return &values_; }
  const T& operator*() const { return values_; }

 private:
  mutable T values_{};  // overridden through add_constants(); the object itself is const
};

}  // namespace terrazzo
