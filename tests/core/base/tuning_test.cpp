#include "core/base/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <doctest/doctest.h>

#include "core/base/error.h"

namespace terrazzo {

namespace {

struct Settings {
  double weight = 0.5;
  int reach = 4;
};
const Tunable<Settings> settings("test_settings",
                                 {
                                     {&Settings::weight, "weight", "", "more: calmer", "tests"},
                                     {&Settings::reach, "reach", "pixels", "more: slower", "tests", 1, 48},
                                 });

}  // namespace

TEST_CASE("a tuning constant can be found and overridden by name") {
  const auto all = tuning_constants();
  const auto at =
      std::find_if(all.begin(), all.end(), [](const TuningConstant* c) { return c->name == "test_settings.reach"; });
  REQUIRE(at != all.end());
  CHECK((*at)->number() == 4);
  CHECK((*at)->unit == "pixels");
  override_tuning("test_settings.reach", 7);
  override_tuning("test_settings.weight", 0.25);
  CHECK(settings->reach == 7);
  CHECK(settings->weight == 0.25);
  CHECK(overridden_tuning() == "test_settings.reach=7 test_settings.weight=0.25");
  // Back, so that the other tests of this process are not disturbed.
  override_tuning("test_settings.reach", 4);
  override_tuning("test_settings.weight", 0.5);
  CHECK(overridden_tuning().empty());
}

TEST_CASE("overriding says what is wrong with a name or a value") {
  CHECK_THROWS_WITH_AS(override_tuning("test_settings.raech", 4),
                       "there is no tuning constant \"test_settings.raech\" (did you mean \"test_settings.reach\"?)",
                       Error);
  CHECK_THROWS_WITH_AS(override_tuning("test_settings.reach", 4.5),
                       "the tuning constant \"test_settings.reach\" is a whole number, found 4.5", Error);
}

TEST_CASE("a tuning constant takes the values that its description allows, and no others") {
  for (const double value : {1.0, 48.0}) {
    override_tuning("test_settings.reach", value);
    CHECK(settings->reach == value);
  }
  override_tuning("test_settings.reach", 4);
  CHECK_THROWS_WITH_AS(override_tuning("test_settings.reach", 0),
                       "the tuning constant \"test_settings.reach\" takes values from 1 to 48, found 0", Error);
  CHECK_THROWS_WITH_AS(override_tuning("test_settings.reach", 49),
                       "the tuning constant \"test_settings.reach\" takes values from 1 to 48, found 49", Error);
  // Where nothing else is said, what is not negative and no larger than an int can be.
  CHECK_THROWS_WITH_AS(override_tuning("test_settings.weight", -0.5),
                       "the tuning constant \"test_settings.weight\" takes values from 0 to 1000000000, found -0.5",
                       Error);
  CHECK_THROWS_AS(override_tuning("test_settings.weight", std::nan("")), Error);
  CHECK_THROWS_AS(override_tuning("test_settings.weight", std::numeric_limits<double>::infinity()), Error);
  CHECK(overridden_tuning().empty());
}

TEST_CASE("tools can tell which tuning constants are limited more than others") {
  for (const TuningConstant* c : tuning_constants()) {
    if (c->name == "test_settings.reach") CHECK(c->is_limited());
    if (c->name == "test_settings.weight") CHECK(!c->is_limited());
  }
}

TEST_CASE("a tuning structure describes all of its fields") {
  CHECK_THROWS_AS(Tunable<Settings>("incomplete", {{&Settings::weight, "weight", "", "", ""}}), std::logic_error);
}

TEST_CASE("a tuning constant's own value is one that it takes") {
  struct Lone {
    int reach = 4;
  };
  CHECK_THROWS_AS(Tunable<Lone>("test_lone", {{&Lone::reach, "reach", "", "", "", 5}}), std::logic_error);
}

TEST_CASE("every tuning constant says what it trades and where that was measured") {
  for (const TuningConstant* c : tuning_constants()) {
    CAPTURE(c->name);
    CHECK(!c->trades.empty());
    CHECK(!c->measured.empty());
  }
}

}  // namespace terrazzo
