#include "core/synthesis/state/plane_window.h"

#include <doctest/doctest.h>

using namespace terrazzo;

TEST_CASE("a window ends at the border of a plane that does not tile") {
  const PlaneWindow w = PlaneWindow::around({10, 4, 20, 8}, 16, {{100, 60}});
  CHECK(w.part == Rect{0, 0, 46, 28});
  CHECK(!w.closed_x);
  CHECK(w.held({10, 4, 20, 8}) == Rect{10, 4, 20, 8});
}

TEST_CASE("a window of a plane that tiles goes on around its border") {
  const PlaneWindow w = PlaneWindow::around({90, 30, 20, 8}, 5, {{100, 60}, true, false});
  CHECK(w.part == Rect{85, 25, 30, 18});
  CHECK(w.x(0) == 85);
  CHECK(w.x(20) == 5);
  CHECK(w.index(20, 1) == 26 * 100 + 5);
  CHECK(PlaneWindow::around({0, 0, 5, 5}, 3, {{100, 60}, true, true}).x(0) == 97);
}

TEST_CASE("a window that meets itself, or crosses the border of an odd length, is all of its axis") {
  for (const PlaneWindow& w : {PlaneWindow::around({10, 0, 20, 9}, 40, {{100, 9}, true, false}),
                               PlaneWindow::around({80, 0, 20, 9}, 5, {{99, 9}, true, false})}) {
    CHECK(w.closed_x);
    CHECK(w.part == Rect{0, 0, w.plane.size.width, 9});
    CHECK(w.held({95, 2, 20, 3}) == Rect{0, 2, w.plane.size.width, 3});
    CHECK(w.column(-1) == w.plane.size.width - 1);
  }
}
