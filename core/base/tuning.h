#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// Tuning constants: numbers that trade one good against another and were found by measuring. Each is a field of its
/// step's tuning structure, described where it is defined, and can be overridden in a benchmark run without
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
/// The least and the most that a field takes (1 and 96) keep a run from crashing or going on and on: code that divides
/// by a constant need not expect 0.
///
/// Reading is as cheap as reading a variable; inner loops copy what they need. Overriding is for a process that has
/// not begun to work yet; reading is thread-safe.
namespace terrazzo {

/// A constant as tools see it.
struct TuningConstant {
  std::string name;      ///< "seams.reach"
  std::string unit;      ///< "pixels"; empty: a plain number
  std::string trades;    ///< what more and less of it bring
  std::string measured;  ///< a heading of tests/bench/experiments.md, or "not measured: " and why it is what it is
  double least = 0;      ///< what an override may give it; beyond, the program might crash
  double most = 1e9;
  std::variant<int*, double*> value;

  double number() const;
  /// Whether it takes fewer values than most constants do.
  bool is_limited() const { return least != TuningConstant().least || most != TuningConstant().most; }
};

/// All constants of the program, by name.
std::vector<const TuningConstant*> tuning_constants();

/// Gives a constant another value. Throws Error, with the nearest name, if there is none of that name, if an integer is
/// to take a fraction, and if the constant does not take the value.
void override_tuning(std::string_view name, double value);

/// What differs from its default, "name=value" each in order of names; empty in a usual run. Part of every cache key,
/// so that results of such runs stay among themselves.
std::string overridden_tuning();

namespace detail {
void add_constants(std::string_view group, const std::vector<TuningConstant>& constants);
[[noreturn]] void reject_incomplete(std::string_view group);
}  // namespace detail

/// A tuning structure of ints and doubles (doubles first: then a field that is not described is noticed), one static
/// object of which describes its fields. Throws std::logic_error if a field is left out.
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
