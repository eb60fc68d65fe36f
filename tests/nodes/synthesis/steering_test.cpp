#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/metrics/wrap_seam.h"
#include "core/procedural/pattern.h"
#include "core/resolve/resolve.h"
#include "nodes/common/registry.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// An exemplar that does not tile, with all its maps.
const MaterialPtr& gravel() {
  static const MaterialPtr made =
      make_pattern({.type = "gravel", .size = {96, 80}, .scale = 9, .tileable = false}, Task());
  return made;
}

IndexPtr index_of(const FeaturesPtr& features) {
  const AppearancePtr appearance = run_node("pca", {}, {{"features", {features}}}).get<Appearance>("appearance");
  return run_node("index", {}, {{"appearance", {appearance}}}).get<Index>("index");
}

IndexPtr gravel_index(const ImagePtr& mask = nullptr) {
  std::map<std::string, std::vector<Value>> inputs = {{"material", {gravel()}}};
  if (mask) inputs["mask"] = {mask};
  return index_of(run_node("weight", {{"tiles", "no"}}, inputs).get<Features>("features"));
}

ImagePtr hole() {
  return make_image({96, 80}, 1, [](int x, int y, int) { return x >= 30 && x < 60 && y >= 20 && y < 50 ? 1.f : 0.f; });
}

/// What is not a hole.
ImagePtr sound() {
  return make_image({96, 80}, 1, [](int x, int y, int) { return x >= 30 && x < 60 && y >= 20 && y < 50 ? 0.f : 1.f; });
}

ExemplarPixel here(int x, int y) {
  return {uint16_t(x), uint16_t(y)};
}

}  // namespace

TEST_CASE("make_tileable keeps the interior, and every map wraps as smoothly as it goes on inside") {
  const IndexPtr index = gravel_index();
  const UvMapPtr uv = run_node("make_tileable", {{"border", 12.0}}, {{"index", {index}}}).get<UvMap>("uv");
  CHECK(uv->size() == Size{96, 80});
  for (int y = 12; y < 68; y++)
    for (int x = 12; x < 84; x++) REQUIRE(uv->at(x, y) == here(x, y));
  const MaterialPtr result = resolved(*gravel(), uv);
  for (const Map& map : result->maps()) {
    CAPTURE(map.name);
    const WrapSeam seam = wrap_seam(*map.image), before = wrap_seam(*gravel()->find(map.name));
    CHECK(seam.x < 1.5);
    CHECK(seam.y < 1.5);
    CHECK(seam.x < before.x);
    CHECK(seam.y < before.y);
  }
}

TEST_CASE("borders that would leave nothing to keep are refused before anything is analysed") {
  const NodeType* type = find_node_type("make_tileable");
  Params params;
  for (const Param& p : type->params)
    if (p.fallback) params.emplace(p.name, *p.fallback);
  const auto refused = [&](double border) {
    params["border"] = border;
    const std::vector<std::string> problems = type->check(params);
    return !problems.empty() && problems.front().find("\"border\": expected less than 0.5") == 0;
  };
  CHECK(refused(0.5));
  CHECK(refused(0.99));
  CHECK_FALSE(refused(0.49));
  CHECK_FALSE(refused(1));
  CHECK_FALSE(refused(40));
}

TEST_CASE("make_tileable in one direction leaves the other alone; the border may be a part of the side") {
  const UvMapPtr uv = run_node("make_tileable", {{"border", 0.125}, {"directions", "x"}}, {{"index", {gravel_index()}}})
                          .get<UvMap>("uv");
  for (int y = 0; y < 80; y++)
    for (int x = 12; x < 84; x++) REQUIRE(uv->at(x, y) == here(x, y));
  CHECK(uv->at(0, 40) != here(0, 40));
  CHECK_THROWS_WITH_AS(run_node("make_tileable", {{"border", 0.6}}, {{"index", {gravel_index()}}}),
                       doctest::Contains("less than half"), Error);
}

TEST_CASE("make_tileable holds a whole number of repeats unless the size must stay") {
  const FeaturesPtr plain = plain_features(wall({61, 53}));
  const IndexPtr index = index_of(plain->with(Lattice{2, {16, 0}, {8, 8}, 1}));
  const std::string anew =
      "the exemplar does not seem to tile, so its border is replaced; if it does tile, set \"tiles\" to \"yes\" where "
      "it is analysed, in the stock graph by --set tiles=yes";
  const NodeRun run = run_node("make_tileable", {}, {{"index", {index}}});
  const UvMapPtr uv = run.get<UvMap>("uv");
  CHECK(uv->size() == Size{64, 48});
  for (int y = 7; y < 41; y++)
    for (int x = 8; x < 53; x++) REQUIRE(uv->at(x, y) == here(x, y));
  CHECK(run.notes == Texts{anew,
                           "the exemplar of 61x53 pixels repeats: the result has 64x48, so that whole repeats wrap "
                           "around; set \"fit\" to \"size\" to keep 61x53 and bend repeats in the border instead"});
  const NodeRun kept = run_node("make_tileable", {{"fit", "size"}}, {{"index", {index}}});
  CHECK(kept.get<UvMap>("uv")->size() == Size{61, 53});
  CHECK(kept.notes ==
        Texts{anew,
              "warning: to wrap around, repeats are bent by 36 % in the border; a wider border bends them less, and "
              "so does \"fit\": \"repeats\", which makes the result 64x48"});
}

TEST_CASE("an exemplar that wraps already stays as it is, and a note says so") {
  const FeaturesPtr plain = plain_features(wall({64, 64}), true);
  const NodeRun run = run_node("make_tileable", {}, {{"index", {index_of(plain)}}});
  const UvMapPtr uv = run.get<UvMap>("uv");
  for (int y = 0; y < 64; y++)
    for (int x = 0; x < 64; x++) REQUIRE(uv->at(x, y) == here(x, y));
  CHECK(uv->wraps().x);
  CHECK(uv->wraps().y);
  REQUIRE(run.notes.size() == 1);
  CHECK(run.notes[0].find("already tiles") != std::string::npos);
  for (const float v : run.get<Image>("border")->pixels()) REQUIRE(v == 0);
}

TEST_CASE("inpaint keeps what is there and takes nothing out of a masked hole") {
  const IndexPtr index = gravel_index(sound());
  const UvMapPtr uv = run_node("inpaint", {{"margin", 0.0}}, {{"index", {index}}, {"mask", {hole()}}}).get<UvMap>("uv");
  const auto in_hole = [](int x, int y) { return x >= 30 && x < 60 && y >= 20 && y < 50; };
  for (int y = 0; y < 80; y++)
    for (int x = 0; x < 96; x++) {
      const ExemplarPixel p = uv->at(x, y);
      REQUIRE(!in_hole(p.x, p.y));
      if (!in_hole(x, y)) REQUIRE(p == here(x, y));
    }
}

TEST_CASE("inpaint lets pixels give way up to the margin, and tells which did") {
  const IndexPtr index = gravel_index(sound());
  const NodeRun run = run_node("inpaint", {{"margin", 12.0}}, {{"index", {index}}, {"mask", {hole()}}});
  const UvMapPtr uv = run.get<UvMap>("uv");
  const std::vector<float> filled = run.get<Image>("filled")->pixels();
  int in_margin = 0;
  for (int y = 0; y < 80; y++)
    for (int x = 0; x < 96; x++) {
      const int dx = std::max({30 - x, x - 59, 0}), dy = std::max({20 - y, y - 49, 0});
      const bool same = uv->at(x, y) == here(x, y), hole = dx == 0 && dy == 0;
      CAPTURE(x);
      CAPTURE(y);
      if (dx * dx + dy * dy > 144) REQUIRE(same);
      REQUIRE(filled[size_t(y) * 96 + x] == (hole || !same ? 1.0f : 0.0f));
      in_margin += !hole && !same;
    }
  CHECK(in_margin > 0);
  // A scratch is given no wider a margin than it is wide.
  const ImagePtr scratch = make_image({96, 80}, 1, [](int x, int, int) { return x == 40 || x == 41 ? 1.f : 0.f; });
  const UvMapPtr thin =
      run_node("inpaint", {{"margin", 12.0}}, {{"index", {index}}, {"mask", {scratch}}}).get<UvMap>("uv");
  for (int y = 0; y < 80; y++)
    for (int x = 0; x < 96; x++)
      if (x < 38 || x > 43) REQUIRE(thin->at(x, y) == here(x, y));
  // Holes whose margins meet leave nothing that always stays, and are filled all the same.
  CHECK_NOTHROW(run_node("inpaint", {{"margin", 60.0}}, {{"index", {index}}, {"mask", {hole()}}}));
}

TEST_CASE("holes that cover everything are refused with advice about holes") {
  const ImagePtr white = make_image({96, 80}, 1, [](int, int, int) { return 1.f; });
  CHECK_THROWS_WITH_AS(run_node("inpaint", {}, {{"index", {gravel_index()}}, {"mask", {white}}}),
                       doctest::Contains("the holes cover everything"), Error);
  const ImagePtr black = make_image({96, 80}, 1, [](int, int, int) { return 0.f; });
  CHECK_THROWS_WITH_AS(gravel_index(black), doctest::Contains("if it comes from holes"), Error);
}

TEST_CASE("maps of different shapes are refused, all named with their sizes") {
  const auto flat = [](Size size) {
    return make_image(
        size, 1, [](int x, int y, int) { return float(x * y % 7) / 7; }, Semantic::height);
  };
  const Value material = Material::make("m", {{"base_color", flat({32, 32})}, {"height", flat({32, 16})}});
  for (const char* node : {"weight", "guidance", "progression", "filter_bank"})
    CHECK_THROWS_WITH_AS(run_node(node, {}, {{"material", {material}}}),
                         doctest::Contains("their aspect ratios differ: 32x32 (base_color), 32x16 (height)"), Error);
  const Value smaller = Material::make("m", {{"base_color", flat({32, 32})}, {"height", flat({16, 16})}});
  CHECK_NOTHROW(run_node("weight", {}, {{"material", {smaller}}}));
}

TEST_CASE("every quality is a result of its own, and normal is the default") {
  const IndexPtr index = gravel_index();
  const auto made = [&](const Params& params) {
    Params all = params;
    all["size"] = Size{64, 64};
    return run_node("synthesize", all, {{"index", {index}}}).get<UvMap>("uv")->digest();
  };
  CHECK(made({}) == made({{"quality", "normal"}}));
  CHECK(made({}) != made({{"quality", "draft"}}));
  CHECK(made({}) != made({{"quality", "best"}}));
}

TEST_CASE("inpaint makes a part of an earlier result anew") {
  const IndexPtr index = gravel_index();
  const UvMapPtr first =
      run_node("synthesize", {{"size", Size{96, 80}}, {"seed", int64_t{3}}}, {{"index", {index}}}).get<UvMap>("uv");
  const UvMapPtr second = run_node("inpaint", {{"seed", int64_t{5}}, {"margin", 0.0}},
                                   {{"index", {index}}, {"mask", {hole()}}, {"uv", {first}}})
                              .get<UvMap>("uv");
  int changed = 0;
  for (int y = 0; y < 80; y++)
    for (int x = 0; x < 96; x++) {
      const bool same = first->at(x, y) == second->at(x, y);
      if (x < 30 || x >= 60 || y < 20 || y >= 50) REQUIRE(same);
      changed += !same;
    }
  CHECK(changed > 450);
}

TEST_CASE("extend keeps every pixel it grows from, wherever it lies") {
  const IndexPtr index = gravel_index();
  const UvMapPtr first = run_node("synthesize", {{"size", Size{40, 30}}}, {{"index", {index}}}).get<UvMap>("uv");
  const UvMapPtr grown =
      run_node("extend", {{"size", Size{90, 70}}, {"at", Numbers{21, 33}}}, {{"index", {index}}, {"uv", {first}}})
          .get<UvMap>("uv");
  for (int y = 0; y < 30; y++)
    for (int x = 0; x < 40; x++) REQUIRE(grown->at(x + 21, y + 33) == first->at(x, y));
  CHECK_THROWS_WITH_AS(
      run_node("extend", {{"size", Size{60, 60}}, {"at", Numbers{21, 0}}}, {{"index", {index}}, {"uv", {first}}}),
      doctest::Contains("at most [20, 30]"), Error);
  CHECK_THROWS_WITH_AS(run_node("extend", {{"size", Size{39, 60}}}, {{"index", {index}}, {"uv", {first}}}),
                       doctest::Contains("at least the size of what is kept"), Error);
}

TEST_CASE("what is kept must be of the index's exemplar") {
  const UvMapPtr other = UvMap::make({4, 4}, {50, 50}, std::vector<ExemplarPixel>(16));
  CHECK_THROWS_WITH_AS(run_node("extend", {}, {{"index", {gravel_index()}}, {"uv", {other}}}),
                       doctest::Contains("an exemplar of 50x50"), Error);
}

TEST_CASE("transfer steers by a target and wants controls in pairs") {
  const IndexPtr index = gravel_index();
  const ImagePtr has = make_image({96, 80}, 1, [](int x, int, int) { return float(x) / 96; });
  const ImagePtr wants = make_image({20, 20}, 1, [](int x, int, int) { return x < 10 ? 0.f : 1.f; });
  const auto transfer = [&](Size size) {
    return run_node("transfer", {{"size", size}},
                    {{"index", {index}}, {"exemplar_control", {has}}, {"target", {wants}}});
  };
  CHECK(transfer({64, 32}).notes ==
        Texts{"the target of 20x20 pixels is stretched to the result's 64x32, which has another aspect ratio"});
  const NodeRun run = transfer({64, 64});
  CHECK(run.notes.empty());
  const UvMapPtr uv = run.get<UvMap>("uv");
  int64_t left = 0, right = 0;
  for (int y = 0; y < 64; y++)
    for (int x = 0; x < 64; x++) (x < 32 ? left : right) += uv->at(x, y).x;
  CHECK(right > 3 * left / 2);
  CHECK_THROWS_WITH_AS(
      run_node("transfer", {}, {{"index", {index}}, {"exemplar_control", {has}}, {"target", {wants, wants}}}),
      doctest::Contains("as many images"), Error);
  CHECK_THROWS_WITH_AS(run_node("transfer", {{"strength", Numbers{1, 2}}},
                                {{"index", {index}}, {"exemplar_control", {has}}, {"target", {wants}}}),
                       doctest::Contains("one number"), Error);
}

TEST_CASE("a jitter distribution wants one amplitude") {
  const NodeType& type = *find_node_type("synthesize");
  Params params;
  for (const Param& p : type.params) params[p.name] = *p.fallback;
  params["jitter_shape"] = "peak";
  REQUIRE(type.check(params).size() == 1);
  CHECK(type.check(params)[0].find("\"jitter\": expected one number") == 0);
  params["jitter"] = Numbers{2};
  CHECK(type.check(params).empty());
}
