#pragma once

#include <algorithm>
#include <string>

#include <doctest/doctest.h>

#include "core/base/tuning.h"

namespace terrazzo::test {

inline const TuningConstant& tuning_constant(const std::string& name) {
  const auto all = tuning_constants();
  const auto at = std::ranges::find_if(all, [&](const TuningConstant* c) { return c->name == name; });
  REQUIRE(at != all.end());
  return **at;
}

/// Another value of a tuning constant for a while: the other tests of this process must not notice.
class TuningOverride {
 public:
  TuningOverride(const std::string& name, double value) : name_(name), usual_(tuning_constant(name).number()) {
    override_tuning(name, value);
  }
  ~TuningOverride() { override_tuning(name_, usual_); }
  TuningOverride(const TuningOverride&) = delete;
  TuningOverride& operator=(const TuningOverride&) = delete;

 private:
  std::string name_;
  double usual_;
};

}  // namespace terrazzo::test
