#include <doctest/doctest.h>
#include <hwy/nanobenchmark.h>

TEST_CASE("Highway's library measures no timer when it is loaded") {
  CHECK(hwy::platform::TimerResolution() == 1);
}
