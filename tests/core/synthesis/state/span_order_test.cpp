#include "core/synthesis/state/span_order.h"

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "core/base/geometry.h"

using namespace terrazzo;

namespace {

/// Of an exemplar of 100 pixels; the last goes on around its border.
const std::vector<ExemplarSpan> spans = {{5, 30}, {30, 48}, {48, 90}, {90, 105}};

/// What is shown at each pixel of a result.
std::vector<int> shown(const std::vector<ShownSpan>& order, const SpanLine& line) {
  std::vector<int> out(size_t(line.result), -1);
  for (const ShownSpan& s : order)
    for (int at = int(std::ceil(s.begin)); at < s.end; at++)
      if (line.closed || (at >= 0 && at < line.result)) {
        int& there = out[size_t(wrap(at, line.result))];
        CHECK(there == -1);
        there = wrap(at + s.shift(at), line.exemplar);
      }
  return out;
}

}  // namespace

TEST_CASE("spans cover all of a result, whole and without overlap") {
  for (const bool closed : {false, true})
    for (const int length : {1, 37, 100, 333, 2000}) {
      const SpanLine line{100, length, closed};
      const std::vector<ShownSpan> order = SpanOrder(spans, line, 7).order();
      for (const int u : shown(order, line)) CHECK(u >= 0);
      // Long results are hardly stretched, and ends are where they should be.
      for (const ShownSpan& s : order) {
        if (length >= 333) CHECK(std::abs(s.too_much()) <= 2);
        if (!s.is_cut()) continue;
        CHECK(s.begin + s.shift(s.begin) == doctest::Approx(s.shown.from).epsilon(0.02));
        CHECK(s.end + s.shift(s.end) == doctest::Approx(s.shown.to).epsilon(0.02));
      }
    }
}

TEST_CASE("kept pixels go on as they are, and others fill what is between and around them") {
  const SpanLine line{100, 400, false}, ring{100, 400, true};
  for (const SpanLine& l : {line, ring}) {
    // Span 2 from 80 on, of which 90 to 110 are kept, and span 0 from 300 on, of which all is, but for a crumb.
    SpanOrder order(spans, l, 3);
    for (int at = 90; at < 110; at++) order.keep(at, 48 + at - 80);
    for (int at = 300; at < 325; at++) order.keep(at, at == 310 ? 60 : 5 + at - 300);
    const std::vector<int> out = shown(order.order(), l);
    for (int at = 80; at < 122; at++) CHECK(out[size_t(at)] == 48 + at - 80);
    for (int at = 300; at < 325; at++) CHECK(out[size_t(at)] == 5 + at - 300);
    for (const int u : out) CHECK(u >= 0);
  }
}

TEST_CASE("a kept span that crosses the border of a result that wraps is one") {
  const SpanLine ring{100, 300, true};
  SpanOrder order(spans, ring, 3);
  for (int at = -20; at < 22; at++) order.keep(wrap(at, 300), 48 + at + 20);
  const std::vector<int> out = shown(order.order(), ring);
  for (int at = -20; at < 22; at++) CHECK(out[size_t(wrap(at, 300))] == 48 + at + 20);
}
