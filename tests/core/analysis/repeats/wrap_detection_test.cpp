#include "core/analysis/repeats/wrap_detection.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "core/analysis/repeats/regularity.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("tiling is seen from the borders") {
  // Overlapping discs, cut at the borders or continued on the other side.
  const auto discs = [](bool wraps) {
    return Material::of(make_image({96, 96}, 1, [wraps](int x, int y, int) {
      float value = 0;
      for (int i = 0; i < 60; i++) {
        const uint64_t r = random_bits(9, i);
        int dx = std::abs(int(r % 96) - x), dy = std::abs(int(r / 96 % 96) - y);
        if (wraps) dx = std::min(dx, 96 - dx), dy = std::min(dy, 96 - dy);
        if (dx * dx + dy * dy < 60) value = float(i) / 60;
      }
      return value + (wraps ? 0.f : float(x + y) / 100);
    }));
  };
  CHECK(seems_to_tile(*discs(true), Task()));
  CHECK_FALSE(seems_to_tile(*discs(false), Task()));
  CHECK_FALSE(
      seems_to_tile(*Material::of(make_image({64, 64}, 1, [](int x, int, int) { return float(x) / 64; })), Task()));
}

TEST_CASE("borders of white noise tell nothing, those of blurred noise do") {
  const auto noise = [](int radius, int period) {
    return Material::of(make_image({40, 60}, 1, [=](int x, int y, int) {
      float sum = 0;
      for (int i = 0; i <= radius; i++)
        for (int j = 0; j <= radius; j++)
          sum += float(unit_double(random_bits(5, (x + i) % (period ? 40 : 1000), (y + j) % (period ? 60 : 1000))));
      return sum / float((radius + 1) * (radius + 1));
    }));
  };
  CHECK_FALSE(borders_meet(*noise(0, 1), Task()));
  CHECK(borders_meet(*noise(3, 1), Task()));
  CHECK_FALSE(borders_meet(*noise(3, 0), Task()));
}

TEST_CASE("what a mask leaves out does not count, and if it leaves too little of the borders, nothing is known") {
  const auto gravel = [](int period, bool harmed) {
    return Material::of(make_image({96, 96}, 1, [=](int x, int y, int) {
      if (harmed && x > 80 && y > 20 && y < 60) return 0.f;
      float sum = 0;
      for (int dy = 0; dy < 3; dy++)
        for (int dx = 0; dx < 3; dx++)
          sum += float(unit_double(random_bits(7, (x + dx) % period, (y + dy) % period))) / 9;
      return sum;
    }));
  };
  // Half the size, and white where the gravel is whole.
  const ImagePtr sound = make_image({48, 48}, 1, [](int x, int y, int) { return float(x < 39 || y < 9 || y > 31); });
  CHECK_FALSE(seems_to_tile(*gravel(96, true), Task()));
  CHECK(seems_to_tile(*gravel(96, true), Task(), sound));
  CHECK_FALSE(seems_to_tile(*gravel(1000, true), Task(), sound));
  const ImagePtr left_half = make_image({96, 96}, 1, [](int x, int, int) { return float(x < 48); });
  CHECK_FALSE(seems_to_tile(*gravel(96, false), Task(), left_half));
  const ImagePtr nothing = make_image({96, 96}, 1, [](int, int, int) { return 0.f; });
  CHECK_FALSE(seems_to_tile(*gravel(96, false), Task(), nothing));
}

TEST_CASE("gravel that was cut out anywhere does not tile, though what lies across its borders looks like gravel") {
  const auto gravel = [](int period) {
    return Material::of(make_image({96, 96}, 1, [period](int x, int y, int) {
      float sum = 0;
      for (int dy = 0; dy < 3; dy++)
        for (int dx = 0; dx < 3; dx++)
          sum += float(unit_double(random_bits(7, (x + dx) % period, (y + dy) % period))) / 9;
      return sum;
    }));
  };
  CHECK(seems_to_tile(*gravel(96), Task()));
  CHECK_FALSE(seems_to_tile(*gravel(1000), Task()));
}

TEST_CASE("rough joints along the border are compared with those inside, over all maps, of any sizes") {
  // `lighter`: the last rows, which are half a joint.
  const auto wall = [](int side, float lighter) {
    return make_image({side, side}, 1, [=](int x, int y, int) {
      const int course = side / 4, joint = side / 48, row = y % course;
      const float rough = float(unit_double(random_bits(8, x, y)));
      if (row < joint || row >= course - joint) return y < side - joint ? rough : rough + lighter;
      return 0.5f + 0.02f * rough;
    });
  };
  const auto material = [&](float lighter) {
    return Material::make("wall", {{"height", wall(192, lighter)}, {"roughness", wall(96, lighter)}});
  };
  CHECK(seems_to_tile(*material(0), Task()));
  CHECK_FALSE(seems_to_tile(*material(1), Task()));
}

TEST_CASE("one tile with its joint along the border tiles, unless the joint is cut off on one side") {
  const auto tile = [](int left) {
    return Material::of(make_image({96, 96}, 1, [left](int x, int y, int) {
      const float grain = 0.1f * float(unit_double(random_bits(4, x, y)));
      return (x < left || x >= 93 || y < 3 || y >= 93 ? 1.f : 0.3f) + grain;
    }));
  };
  CHECK(seems_to_tile(*tile(3), Task()));
  CHECK_FALSE(seems_to_tile(*tile(0), Task()));
}

TEST_CASE("large tiles with a joint along the border and the same one inside tile, whatever the tiles show") {
  // Bevelled: the last pixels of a tile are dark, its first one is light. Nothing in the tiles goes on across a border.
  const auto tiles = [](int left, int width) {
    return Material::of(make_image({width, 192}, 1, [left](int x, int y, int) {
      const auto bevel = [](int at) { return at >= 94 ? -0.6f : at == 93 ? -0.3f : at == 0 ? 0.3f : 0.f; };
      const auto corner = [&](int i, int j) { return unit_double(random_bits(8, (x + left) / 16 + i, y / 16 + j)); };
      const double u = (x + left) % 16 / 16.0, v = y % 16 / 16.0;
      const double above = (1 - u) * corner(0, 0) + u * corner(1, 0), below = (1 - u) * corner(0, 1) + u * corner(1, 1);
      return 0.5f * float((1 - v) * above + v * below) + bevel((x + left) % 96) + bevel(y % 96);
    }));
  };
  CHECK(seems_to_tile(*tiles(0, 192), Task()));
  CHECK_FALSE(seems_to_tile(*tiles(40, 192), Task()));
  CHECK_FALSE(seems_to_tile(*tiles(40, 130), Task()));
}

TEST_CASE("two by two tiles tile though the joint along the border is unlike those inside; a part of tiles does not") {
  // Tiles end in a dark rim and begin with a light joint, which is broader along the border.
  const auto tiles = [](int shift, int side) {
    return Material::of(make_image({side, side}, 1, [shift](int i, int j, int) {
      const auto edge = [&](int at) {
        const int in = (at + shift) % 80;
        return in < (at < 3 ? 3 : 1) ? 0.6f : in > 76 ? -0.3f : 0.f;
      };
      const float grain = 0.1f * float(unit_double(random_bits(4, i, j)));
      return 0.4f + 0.05f * float((i + shift) / 80 + 2 * ((j + shift) / 80)) + edge(i) + edge(j) + grain;
    }));
  };
  CHECK(seems_to_tile(*tiles(0, 160), Task()));
  CHECK_FALSE(seems_to_tile(*tiles(30, 130), Task()));
}

TEST_CASE("panels in a single row tile, though their bevels meet nowhere but along the border") {
  // Heights go on, slopes jump from one bevel to the other.
  const auto panels = [](int above) {
    const auto depth = [above](int x, int y) {
      return std::min({x % 48, 47 - x % 48, wrap(y + above, 96), 95 - wrap(y + above, 96), 4});
    };
    const ImagePtr height = make_image({192, 96 - above}, 1, [=](int x, int y, int) {
      return 0.2f * float(depth(x, y)) + 0.02f * float(unit_double(random_bits(8, x, y)));
    });
    const ImagePtr slope = make_image({192, 96 - above}, 1, [=](int x, int y, int) {
      return 0.5f + 0.2f * float(depth(x, y + 1) - depth(x, y)) + 0.02f * float(unit_double(random_bits(9, x, y)));
    });
    return Material::make("panels", {{"height", height}, {"roughness", slope}});
  };
  CHECK(seems_to_tile(*panels(0), Task()));
  CHECK_FALSE(seems_to_tile(*panels(20), Task()));
}

TEST_CASE("a panel in a frame tiles, though all sides of the frame differ; a part of it does not") {
  const auto panel = [](int left) {
    return Material::of(make_image({160 - left, 160}, 1, [left](int i, int y, int) {
      const int x = i + left;
      const float grain = 0.1f * float(unit_double(random_bits(4, x, y)));
      if (y < 14) return 0.3f + grain;
      if (y >= 144) return 0.05f + grain;
      if (x < 10) return 0.2f + grain;
      if (x >= 148) return 0.f + grain;
      return (std::abs(y - 80) < 2 ? 0.1f : 0.8f) + grain;
    }));
  };
  CHECK(seems_to_tile(*panel(0), Task()));
  CHECK_FALSE(seems_to_tile(*panel(40), Task()));
}

TEST_CASE("two by two chequered tiles tile, though they touch more softly inside than across the border") {
  const auto floor = [](int left) {
    return Material::of(make_image({96 - left, 96}, 1, [left](int x, int y, int) {
      const auto side = [](int i) { return std::clamp((i % 96 - 47.5) / 1.5, -1.0, 1.0); };
      const double tile = side(x + left) * side(y);
      return float(0.5 + 0.4 * tile + 0.05 * unit_double(random_bits(5, x, y)));
    }));
  };
  CHECK(seems_to_tile(*floor(0), Task()));
  CHECK_FALSE(seems_to_tile(*floor(48), Task()));
}

TEST_CASE("an odd number of chequered tiles does not tile, however smooth its borders; an even one does") {
  const auto chequered = [](double side) {
    return Material::of(make_image({192, 192}, 1, [side](int x, int y, int) {
      const int tile = int(x / side + 0.5) + int(y / side + 0.5);  // borders run through tiles
      return (tile % 2 == 0 ? 0.8f : 0.2f) + 0.1f * float(unit_double(random_bits(5, x, y)));
    }));
  };
  CHECK(seems_to_tile(*chequered(24), Task()));
  CHECK_FALSE(seems_to_tile(*chequered(192.0 / 7), Task()));
}

TEST_CASE("tiles of which a border cuts off a little do not tile") {
  const auto tiles = [](double side) {
    return Material::of(make_image({192, 192}, 1, [side](int x, int y, int) {
      const double u = x - side * std::floor(x / side), v = y - side * std::floor(y / side);
      const float grain = 0.1f * float(unit_double(random_bits(6, x, y)));
      return (std::min({u, v, side - u, side - v}) < 2 ? 0.f : 0.5f) + grain;
    }));
  };
  CHECK(seems_to_tile(*tiles(24), Task()));
  CHECK_FALSE(seems_to_tile(*tiles(23.7), Task()));
}

TEST_CASE("a quick look never rules out a lattice that is there, and rules it out in noise") {
  for (const double side : {9.0, 16.0, 27.4, 48.0}) {
    CAPTURE(side);
    const FeaturesPtr tiles = plain_features(make_image({192, 192}, 1, [side](int x, int y, int) {
      const double u = x - side * std::floor(x / side), v = y - side * std::floor(y / side);
      return (std::min(u, v) < 2 ? 0.f : 0.5f) + 0.1f * float(unit_double(random_bits(6, x, y)));
    }));
    CHECK(may_have_lattice(*tiles, 0.75, Task()));
  }
  const FeaturesPtr noise = plain_features(
      make_image({192, 192}, 1, [](int x, int y, int) { return float(unit_double(random_bits(7, x / 3, y / 3))); }));
  CHECK_FALSE(may_have_lattice(*noise, 0.75, Task()));
}
