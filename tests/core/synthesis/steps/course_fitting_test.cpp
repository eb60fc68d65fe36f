#include "core/synthesis/steps/course_fitting.h"

#include <algorithm>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

constexpr int brick = 6;  // columns

ColumnDescriptor look(int shade) {
  ColumnDescriptor out{};
  for (AppearanceVector& v : out)
    for (size_t d = 0; d < v.size(); d++) v[d] = int16_t(int(random_bits(3, shade, d) % 400) - 200);
  return out;
}

/// Bricks of six columns each, each of a shade; joints are between them.
CourseColumns course(const std::vector<int>& shades) {
  CourseColumns out;
  for (size_t b = 0; b < shades.size(); b++)
    for (int i = 0; i < brick; i++) {
      out.looks.push_back(look(shades[b]));
      out.cuts.push_back({int(b) * brick + i, i == 0 ? 10 : 100000});
    }
  out.cuts.push_back({int(out.looks.size()), 10});
  out.usable.assign(out.looks.size(), 1);
  return out;
}

std::vector<ColumnDescriptor> looks(const std::vector<int>& shades) {
  std::vector<ColumnDescriptor> out;
  for (const int s : shades) out.push_back(look(s));
  return out;
}

std::vector<int> bricks(const std::vector<int>& shades) {
  std::vector<int> out;
  for (const int s : shades) out.insert(out.end(), brick, s);
  return out;
}

std::string text(const std::vector<CourseRun>& runs) {
  std::string out;
  for (const CourseRun& r : runs) out += fmt::format("{} from {} at {}; ", r.course, r.from, r.begin);
  return out;
}

const CourseFit fit{.step = 1, .least_step_back = 12, .per_difference = 0.01, .most_difference = 1000};

}  // namespace

TEST_CASE("what is a sequence of whole bricks already is found again") {
  const CourseColumns a = course({1, 2, 3, 4}), b = course({5, 6, 7, 8});
  const auto runs = fitting_runs(looks(bricks({2, 3, 7, 8, 1})), {{&a}, {&b}}, {}, fit);
  CHECK(text(runs) == "0 from 6 at 0; 1 from 12 at 12; 0 from 0 at 24; ");
}

TEST_CASE("bricks that are not whole become whole: the more like what there is the better") {
  const CourseColumns a = course({1, 2, 3, 4}), b = course({5, 6, 7, 8});
  // Of the second brick two columns are another's.
  std::vector<int> shown = bricks({2, 3, 7});
  shown[brick + 4] = shown[brick + 5] = 5;
  const auto runs = fitting_runs(looks(shown), {{&a}, {&b}}, {}, fit);
  CHECK(text(runs) == "0 from 6 at 0; 1 from 12 at 12; ");
}

TEST_CASE("columns that are not usable are not shown, dear ones only if they must") {
  CourseColumns a = course({1, 2, 3, 4});
  const CourseColumns b = course({1, 2, 3, 4});
  const std::vector<ColumnDescriptor> shown = looks(bricks({2, 3}));
  a.usable[brick + 1] = 0;
  CHECK(fitting_runs(shown, {{&a}, {&b}}, {}, fit).front().course == 1);
  a.usable[brick + 1] = 1;
  CHECK(fitting_runs(shown, {{&a}, {&b}}, {.columns = {{1, brick + 2, 0, 12, 5}}}, fit).front().course == 0);
  CHECK(fitting_runs(shown, {{&a}, {&b}}, {.columns = {{0, brick + 2, 0, 12, 5}}}, fit).front().course == 1);
  // Elsewhere in the result it costs nothing.
  CHECK(fitting_runs(shown, {{&a}, {&b}}, {.columns = {{0, brick + 2, 3, 12, 5}, {1, brick + 2, 0, 3, 5}}}, fit)
            .front()
            .course == 0);
}

TEST_CASE("a run does not begin where that is dear, unless it has to") {
  const CourseColumns a = course({1, 2, 3, 4}), b = course({5, 6, 7, 8});
  const std::vector<ColumnDescriptor> shown = looks(bricks({2, 3, 3, 7, 8}));
  const auto begins = [&](const CourseCosts& prices, const CourseFit& f) {
    std::vector<int> out;
    for (const CourseRun& r : fitting_runs(shown, {{&a}, {&b}}, prices, f)) out.push_back(r.begin);
    return out;
  };
  const std::vector<int> free = begins({}, fit);
  REQUIRE(free.size() > 1);
  CourseCosts dear{.cuts = std::vector<int32_t>(shown.size(), 0)};
  CHECK(begins(dear, fit) == free);
  dear.cuts[size_t(free[1])] = 50000;
  const std::vector<int> elsewhere = begins(dear, fit);
  CHECK(std::ranges::find(elsewhere, free[1]) == elsewhere.end());
  // The same for all columns changes nothing that has to be cut.
  CourseCosts all{.cuts = std::vector<int32_t>(shown.size(), 1)};
  CHECK(begins(all, fit) == free);
  CourseFit around = fit;
  around.closed = true;
  const std::vector<int> closed = begins({}, around);
  REQUIRE(!closed.empty());
  CourseCosts there{.cuts = std::vector<int32_t>(shown.size(), 0)};
  there.cuts[size_t(closed[0])] = 50000;
  const std::vector<int> moved = begins(there, around);
  CHECK(std::ranges::find(moved, closed[0]) == moved.end());
}

TEST_CASE("a course does not repeat itself at once, but goes back far enough") {
  const CourseColumns a = course({1, 2, 3, 4});
  const auto runs = fitting_runs(looks(bricks({2, 2, 2, 2})), {{&a}}, {}, fit);
  for (size_t i = 1; i < runs.size(); i++) {
    const int ended = runs[i - 1].from + runs[i].begin - runs[i - 1].begin;
    CHECK((runs[i].from >= ended || ended - runs[i].from >= fit.least_step_back));
  }
}

TEST_CASE("runs begin in phase only") {
  const CourseColumns a = course({1, 2, 3, 4}), b = course({5, 6, 7, 8});
  std::vector<CandidateCourse> tried{{&a}, {&b}};
  for (CandidateCourse& t : tried) {
    t.least_shift = -100;
    for (int shift = -100; shift < 4 * brick; shift++) t.in_phase.push_back((shift + 100 * brick) % brick == 0);
  }
  const std::vector<int> shown = {3, 3, 7, 7, 7, 7, 7, 7, 2, 2, 2, 2, 2, 2, 5, 5};
  for (const CourseRun& r : fitting_runs(looks(shown), tried, {}, fit)) CHECK((r.from - r.begin) % brick == 0);
  const auto free = fitting_runs(looks(shown), {{&a}, {&b}}, {}, fit);
  CHECK(free.front().from % brick == brick - 2);
}

TEST_CASE("two parts of a joint make a whole one") {
  // Two bricks; the joint's five columns may be cut anywhere.
  const auto jointed = [](int left, int right) {
    CourseColumns out;
    const std::vector<int> shades = {left, left, left, left, left, 0, 0, 0, 0, 0, right, right, right, right, right};
    out.looks = looks(shades);
    out.usable.assign(shades.size(), 1);
    for (int u = 5; u <= 9; u++) out.cuts.push_back({u, 10, u - 7});
    return out;
  };
  const CourseColumns a = jointed(1, 2), b = jointed(3, 4);
  CourseFit strict = fit;
  strict.per_gap = 10000;
  // The joint that is there is too narrow.
  const auto runs = fitting_runs(looks({1, 1, 1, 1, 1, 0, 0, 4, 4, 4, 4, 4}), {{&a}, {&b}}, {}, strict);
  REQUIRE(runs.size() == 2);
  CHECK(runs[0].course == 0);
  CHECK(runs[1].course == 1);
  const int left = runs[0].from + runs[1].begin - runs[0].begin;  // where the first is left
  CAPTURE(text(runs));
  CHECK(left == runs[1].from);
}

TEST_CASE("a result that wraps closes with a joint") {
  const CourseColumns a = course({1, 2, 3, 4}), b = course({5, 6, 7, 8});
  CourseFit closed = fit;
  closed.closed = true;
  // Begins in the middle of a brick.
  std::vector<int> shown = bricks({2, 7, 3, 8, 1});
  std::rotate(shown.begin(), shown.begin() + 3, shown.end());
  const auto runs = fitting_runs(looks(shown), {{&a}, {&b}}, {}, closed);
  CHECK(text(runs) == "1 from 12 at 3; 0 from 12 at 9; 1 from 18 at 15; 0 from 0 at 21; ");
}

TEST_CASE("a result that wraps and is shorter than any run is left alone") {
  const CourseColumns a = course({1, 2, 3, 4});
  CourseFit closed = fit;
  closed.closed = true;
  CHECK(fitting_runs(looks({1, 1}), {{&a}}, {}, closed).empty());
}

TEST_CASE("where nothing may be shown there is still an answer, or none") {
  CourseColumns a = course({1, 2});
  a.usable.assign(a.usable.size(), 0);
  for (const bool closed : {false, true}) {
    CourseFit f = fit;
    f.closed = closed;
    for (const CourseRun& r : fitting_runs(looks(bricks({1, 2, 1})), {{&a}}, {}, f)) {
      CHECK(r.from >= 0);
      CHECK(r.from < 2 * brick);
    }
  }
}

TEST_CASE("a course that is closed goes on around the exemplar's border at no cost, also with long steps") {
  for (const int step : {1, 4}) {
    CAPTURE(step);
    CourseColumns a = course({1, 2, 3, 4});
    a.cuts.pop_back();
    a.closed = true;
    CourseFit around = fit;
    around.step = step;
    std::vector<int> shown;
    for (int x = 0; x < 60 / step; x++) shown.push_back((15 + x * step) % 24 / brick + 1);
    const auto runs = fitting_runs(looks(shown), {{&a}}, {}, around);
    REQUIRE(runs.size() == 1);
    for (int x = 0; x < int(shown.size()); x++) CHECK((runs[0].from + x * step) % 24 / brick + 1 == shown[size_t(x)]);
    // Of a result that wraps as well, once it is as long as the exemplar, or what it shows does not go on.
    around.closed = true;
    shown.resize(size_t(24 / step));
    const auto closed = fitting_runs(looks(shown), {{&a}}, {}, around);
    REQUIRE(!closed.empty());
    for (size_t i = 0; i < closed.size(); i++) {
      const int length = (i + 1 < closed.size() ? closed[i + 1].begin : closed[0].begin + 24 / step) - closed[i].begin;
      CHECK((closed[i].from + length * step - closed[(i + 1) % closed.size()].from) % 24 == 0);
    }
  }
}

TEST_CASE("around a closed course no brick comes right beside itself, either way") {
  CourseColumns a = course({1, 2, 3, 4});
  a.cuts.pop_back();
  a.closed = true;
  for (const std::vector<int>& shades : {std::vector<int>{4, 4, 4, 4}, {1, 1, 1, 1, 2}, {3, 3, 1, 1}}) {
    const auto runs = fitting_runs(looks(bricks(shades)), {{&a}}, {}, fit);
    for (size_t i = 1; i < runs.size(); i++) {
      const int ended = (runs[i - 1].from + runs[i].begin - runs[i - 1].begin) % 24;
      CHECK((ended - runs[i].from + 24) % 24 >= fit.least_step_back);
    }
  }
  // Two bricks on is half of the course back.
  const auto skips = fitting_runs(looks(bricks({1, 4, 3, 2})), {{&a}}, {}, fit);
  CHECK(skips.size() > 1);
}
