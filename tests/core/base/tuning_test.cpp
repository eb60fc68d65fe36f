#include "core/base/tuning.h"

#include <algorithm>
#include <stdexcept>

#include <doctest/doctest.h>

#include "core/base/error.h"

namespace terrazzo {

namespace {

struct Settings {
  double weight = 0.5;
  int reach = 4;
};
const Tunable<Settings> settings("test_settings", {
                                                      {&Settings::weight, "weight", "", "more: calmer", "tests"},
                                                      {&Settings::reach, "reach", "pixels", "more: slower", "tests"},
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

TEST_CASE("a tuning structure describes all of its fields") {
  CHECK_THROWS_AS(Tunable<Settings>("incomplete", {{&Settings::weight, "weight", "", "", ""}}), std::logic_error);
}

TEST_CASE("every tuning constant says what it trades and where that was measured") {
  for (const TuningConstant* c : tuning_constants()) {
    CAPTURE(c->name);
    CHECK(!c->trades.empty());
    CHECK(!c->measured.empty());
  }
}

}  // namespace terrazzo
