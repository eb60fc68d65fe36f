#include "core/base/tuning.h"

#include <cmath>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/suggest.h"

namespace terrazzo {

namespace {

/// Filled while the program starts, before main.
std::map<std::string, TuningConstant, std::less<>>& all_constants() {
  static std::map<std::string, TuningConstant, std::less<>> constants;
  return constants;
}

std::map<std::string, double>& defaults() {
  static std::map<std::string, double> values;
  return values;
}

}  // namespace

double TuningConstant::number() const {
  return std::visit([](const auto* v) { return double(*v); }, value);
}

std::vector<const TuningConstant*> tuning_constants() {
  std::vector<const TuningConstant*> out;
  for (const auto& [name, constant] : all_constants()) out.push_back(&constant);
  return out;
}

void override_tuning(std::string_view name, double value) {
  const auto at = all_constants().find(name);
  if (at == all_constants().end()) {
    std::vector<std::string> names;
    for (const auto& [known, constant] : all_constants()) names.push_back(known);
    throw Error(fmt::format("there is no tuning constant \"{}\"{}", name, did_you_mean(std::string(name), names)));
  }
  const TuningConstant& constant = at->second;
  int* const* whole = std::get_if<int*>(&constant.value);
  if (whole && std::trunc(value) != value)
    throw Error(fmt::format("the tuning constant \"{}\" is a whole number, found {}", name, value));
  if (!(constant.least <= value && value <= constant.most))
    throw Error(fmt::format("the tuning constant \"{}\" takes values from {} to {}, found {}", name, constant.least,
                            constant.most, value));
  if (whole)
    **whole = int(value);
  else
    *std::get<double*>(constant.value) = value;
}

std::string overridden_tuning() {
  std::string out;
  auto usual = defaults().begin();  // of the same names in the same order; every stage's key asks
  for (const auto& [name, constant] : all_constants())
    if (const double now = constant.number(); now != (usual++)->second)
      out += fmt::format("{}{}={}", out.empty() ? "" : " ", name, now);
  return out;
}

namespace detail {

void add_constants(std::string_view group, const std::vector<TuningConstant>& constants) {
  for (const TuningConstant& c : constants) {
    const std::string name = c.name;
    defaults()[name] = c.number();
    if (!(c.least <= c.number() && c.number() <= c.most))
      throw std::logic_error(fmt::format("the tuning constant \"{}\" does not take its own value", name));
    if (!all_constants().try_emplace(name, c).second)
      throw std::logic_error(fmt::format("two tuning constants are called \"{}\" (group {})", name, group));
  }
}

void reject_incomplete(std::string_view group) {
  throw std::logic_error(fmt::format("the tuning structure \"{}\" has a field that is not described", group));
}

}  // namespace detail

}  // namespace terrazzo
