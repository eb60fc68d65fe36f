#include "core/synthesis/synthesize.h"

#include <doctest/doctest.h>

#include "core/analysis/elements/find_elements.h"
#include "core/analysis/space/appearance_space.h"
#include "core/analysis/space/weighting.h"
#include "core/base/error.h"
#include "core/procedural/pattern.h"
#include "nodes/common/registry.h"
#include "tests/drawn_stones.h"
#include "tests/drawn_wall.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

UvMapPtr uv_of(const NodeRun& run) {
  return run.get<UvMap>("uv");
}

std::vector<std::string> problems(Params params) {
  const NodeType& type = *find_node_type("synthesize");
  for (const Param& p : type.params)
    if (p.fallback) params.emplace(p.name, *p.fallback);
  return type.check(params);
}

}  // namespace

TEST_CASE("a part of a surface is that part of the whole, with coarse levels made once or anew") {
  const IndexPtr index = wall_index({72, 64});
  const Params shared = {{"seed", int64_t{4}}, {"tileable", std::string("x")}};
  Params whole = shared, coarse = shared, part = shared;
  whole["size"] = coarse["size"] = part["surface"] = Size{300, 60};
  part["size"] = Size{50, 30};
  part["origin"] = Numbers{270, 20};
  const UvMapPtr all = uv_of(run_node("synthesize", whole, {{"index", {index}}}));
  const UvMapPtr levels = uv_of(run_node("synthesize_coarse", coarse, {{"index", {index}}}));
  const UvMapPtr anew = uv_of(run_node("synthesize", part, {{"index", {index}}}));
  const UvMapPtr given = uv_of(run_node("synthesize", part, {{"index", {index}}, {"coarse", {levels}}}));
  CHECK(anew->digest() == given->digest());
  CHECK(!given->wraps().x);
  for (int y = 0; y < 30; y++)
    for (int x = 0; x < 50; x++) REQUIRE(given->at(x, y) == all->at((270 + x) % 300, 20 + y));
}

TEST_CASE("whole bricks are a choice, of no weight to drafts, and laid alike in parts") {
  const IndexPtr index = make_index(DrawnWall({240, 220}).appearance(), 3, Task());
  const auto made = [&](const Params& params) { return uv_of(run_node("synthesize", params, {{"index", {index}}})); };
  const Params laid = {{"size", Size{300, 260}}}, loose = {{"size", Size{300, 260}}, {"whole_bricks", false}};
  const UvMapPtr whole = made(laid);
  CHECK(whole->digest() != made(loose)->digest());
  Params draft = laid, loose_draft = loose;
  draft["quality"] = loose_draft["quality"] = std::string("draft");
  CHECK(made(draft)->digest() == made(loose_draft)->digest());

  const UvMapPtr part = made({{"surface", Size{300, 260}}, {"size", Size{80, 70}}, {"origin", Numbers{200, 30}}});
  for (int y = 0; y < 70; y++)
    for (int x = 0; x < 80; x++) REQUIRE(part->at(x, y) == whole->at(200 + x, 30 + y));
}

TEST_CASE("the whole surface from its coarse levels is what synthesize makes by itself") {
  const IndexPtr index = wall_index({72, 64});
  const Params size = {{"size", Size{120, 90}}};
  const UvMapPtr levels = uv_of(run_node("synthesize_coarse", size, {{"index", {index}}}));
  const UvMapPtr refined = uv_of(run_node("synthesize", size, {{"index", {index}}, {"coarse", {levels}}}));
  CHECK(refined->digest() == uv_of(run_node("synthesize", size, {{"index", {index}}}))->digest());
}

TEST_CASE("coarse levels of another surface are refused, saying what they are of") {
  const IndexPtr index = wall_index({72, 64});
  const UvMapPtr levels = uv_of(run_node("synthesize_coarse", {{"size", Size{300, 60}}}, {{"index", {index}}}));
  CHECK_THROWS_WITH_AS(run_node("synthesize", {{"size", Size{50, 50}}}, {{"index", {index}}, {"coarse", {levels}}}),
                       doctest::Contains("these have 150x30"), Error);
}

TEST_CASE("the size of coarse levels is known ahead, and so is that they are of another surface") {
  const IndexPtr index = wall_index({72, 64});
  const Params size{{"size", Size{75, 50}}};
  const OutputForecasts foreseen = find_node_type("synthesize_coarse")->infer(size, {{"index", {forecast_of(index)}}});
  CHECK(foreseen.at("uv").size == Size{38, 25});
  CHECK(contradiction(foreseen.at("uv"), uv_of(run_node("synthesize_coarse", size, {{"index", {index}}}))) == "");
  const Params part{{"size", Size{20, 20}}, {"surface", Size{90, 50}}, {"origin", Numbers{0, 0}}};
  CHECK_THROWS_WITH_AS(
      find_node_type("synthesize")->infer(part, {{"index", {forecast_of(index)}}, {"coarse", {foreseen.at("uv")}}}),
      doctest::Contains("a surface of 90x50 has coarse levels of 45x25, these have 38x25"), Error);
}

TEST_CASE("a place off the surface is a problem of the document") {
  CHECK(problems({{"size", Size{50, 50}}}).empty());
  CHECK(problems({{"size", Size{50, 50}}, {"surface", Size{0, 100}}, {"origin", Numbers{0, 50}}}).empty());
  const auto first = [](const Params& params) { return problems(params).at(0); };
  CHECK(first({{"size", Size{50, 50}}, {"origin", Numbers{50, 0}}}).starts_with("\"origin\""));
  CHECK(first({{"size", Size{50, 50}}, {"origin", Numbers{0.5, 0}}}).find("whole numbers") != std::string::npos);
  CHECK(first({{"size", Size{50, 50}}, {"surface", Size{40, 90}}}).starts_with("\"surface\""));
}

TEST_CASE("a result that wraps and holds no whole number of repeats names a size that does better") {
  const ImagePtr image = wall({64, 64});
  const Lattice lattice{2, {16, 0}, {0, 16}, 0.5};
  const FeaturesPtr features = Features::make(image->size(), {{image, {1, 1, 1}}}, true, lattice);
  const IndexPtr index = make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
  const auto notes = [&](Size size, const std::string& tileable) {
    return run_node("synthesize", {{"size", size}, {"tileable", tileable}}, {{"index", {index}}}).notes;
  };
  CHECK(notes({112, 96}, "xy").empty());
  CHECK(notes({120, 100}, "none").empty());
  CHECK(notes({114, 96}, "xy").empty());  // what is not seen is not told
  const std::vector<std::string> stretched = notes({120, 100}, "xy");
  REQUIRE(stretched.size() == 1);
  CHECK(stretched[0] ==
        "warning: 120x100 does not hold a whole number of the exemplar's repeats, so that they are stretched to wrap "
        "around and "
        "joints may jog; 128x96 would");
  const FeaturesPtr high = features->with(Lattice{2, {16, 0}, {0, 300}, 0.5});
  const IndexPtr none = make_index(make_appearance(*high, {}, {}, Task()), 3, Task());
  CHECK(run_node("synthesize", {{"size", Size{112, 100}}, {"tileable", "xy"}}, {{"index", {none}}}).notes ==
        std::vector<std::string>{
            "warning: 112x100 does not hold a whole number of the exemplar's repeats, so that they are "
            "stretched to wrap around and joints may jog; no size near it would"});
}

TEST_CASE("of several exemplars it is told how much of each is shown, and which is not shown at all") {
  constexpr Size all{96, 48};
  const ImagePtr image = wall(all);
  const Repeats halves(std::vector<LatticePart>{{{0, 0, 48, 48}, {}, {}, {}}, {{48, 0, 48, 48}, {}, {}, {}}});
  const auto notes = [&](int allowed, Size size) {
    const ImagePtr mask = make_image(all, 1, [=](int x, int, int) { return x < allowed ? 1.f : 0.f; });
    const FeaturesPtr features = Features::make(all, {{image, {1, 1, 1}}}, false, halves, mask);
    const IndexPtr index = make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
    return run_node("synthesize", {{"size", size}}, {{"index", {index}}}).notes;
  };
  const std::vector<std::string> both = notes(96, {100, 80});
  REQUIRE(both.size() == 1);
  const auto percent = [&](const std::string& of) { return std::stoi(both[0].substr(both[0].find(of) + of.size())); };
  CHECK(both[0].starts_with("the result shows exemplar 1 in "));
  const int sum = percent("exemplar 1 in ") + percent("exemplar 2 in ");
  CHECK(sum >= 99);
  CHECK(sum <= 101);
  CHECK(percent("exemplar 2 in ") > 10);
  const std::vector<std::string> one = notes(48, {100, 80});
  REQUIRE(one.size() == 2);
  CHECK(one[0] == "the result shows exemplar 1 in 100 %, exemplar 2 in 0 %");
  CHECK(one[1].starts_with("warning: the result shows nothing of exemplar 2,"));
  CHECK(notes(48, {60, 40}).size() == 1);
}

TEST_CASE("courses that wrap after any length are not said to be torn, though their boards are shortened") {
  const MaterialPtr boards = make_pattern({.type = "planks", .size = {256, 256}}, Task());
  const FeaturesPtr features = weighted_features(*boards, {}, true)->with(Lattice{1, {0, 256 / 6.0}, {}, 0.9});
  const FeaturesPtr known = features->with(find_elements(*features, Task()));
  const IndexPtr index = make_index(make_appearance(*known, {}, {}, Task()), 3, Task());
  const NodeRun run =
      run_node("synthesize", {{"size", Size{450, 256}}, {"tileable", std::string("xy")}}, {{"index", {index}}});
  CHECK(run.says("others are a little shorter or longer"));
  CHECK(!run.says("torn"));
}

TEST_CASE("how many elements are whole is told, and doubtful results are warned of") {
  const DrawnStones stones({240, 240});
  const auto made = [&](const Elements& elements, bool wraps, Size size) {
    const FeaturesPtr features =
        plain_features(stones.image(), wraps)->with(std::make_shared<const Elements>(elements));
    const IndexPtr index = make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
    return run_node("synthesize", {{"size", size}}, {{"index", {index}}});
  };
  const NodeRun good = made(stones.elements(), true, {400, 400});
  CHECK(good.says(" elements are whole; they show "));
  CHECK_FALSE(good.says("look at the result"));
  CHECK_FALSE(good.says("does not appear"));
  Elements two{{240, 240}, {}, 2, 1};
  for (int i = 0; i < 240 * 240; i++) two.at.push_back(i % 240 < 120 ? 0 : 1);
  const NodeRun few = made(two, false, {400, 400});
  CHECK(few.says("the exemplar's border cuts all but 0 of its 2 elements, too few to be laid as wholes"));
  // A result smaller than the exemplar cannot show all of it.
  CHECK(made(two, false, {100, 100}).notes.size() <= 1);
  CHECK_FALSE(made(two, false, {100, 100}).says("too few to be laid"));
}

TEST_CASE("stones of a heap lie partly under others, which is no fault") {
  const DrawnStones stones({240, 240});
  Elements unsure = stones.elements();
  unsure.certainty = 0.3;
  const FeaturesPtr features = plain_features(stones.image(), true)->with(std::make_shared<const Elements>(unsure));
  const IndexPtr index = make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
  const NodeRun run = run_node("synthesize", {{"size", Size{400, 400}}}, {{"index", {index}}});
  CHECK(run.says("others lie partly under them; they show "));
  CHECK_FALSE(run.says("torn"));
}

TEST_CASE("elements cut in phase with cells that bring their joints together are not doubted") {
  // Blurred noise, which says nothing of the squares that it is parted into.
  const ImagePtr noise = make_image({96, 96}, 1, [](int x, int y, int) {
    float sum = 0;
    for (int k = 0; k < 16; k++) sum += float(unit_double(random_bits(3, (x + k % 4) % 96, (y + k / 4) % 96)));
    return sum / 16;
  });
  Elements squares{{96, 96}, {}, 9, 1};
  for (int i = 0; i < 96 * 96; i++) squares.at.push_back(uint16_t(i / 96 / 32 * 3 + i % 96 / 32));
  const auto made = [&](int cell) {
    const FeaturesPtr features = plain_features(noise, true)
                                     ->with(Repeats(Lattice{2, {double(cell), 0}, {0, double(cell)}, 1}))
                                     ->with(std::make_shared<const Elements>(squares));
    const IndexPtr index = make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
    return run_node("synthesize", {{"size", Size{240, 240}}, {"whole_bricks", false}}, {{"index", {index}}});
  };
  CHECK(made(12).says("the others are torn or melted together"));
  CHECK_FALSE(made(32).says("the others are torn or melted together"));
}

TEST_CASE("joints that end in a result are told of, unless a lattice keeps them whole") {
  // Unequal panels: joints that run through a part of the exemplar only, and two all along it.
  const ImagePtr panels = make_image({128, 128}, 1, [](int x, int y, int) {
    const bool middle = (x > 20 && x < 100) != (y > 30 && y < 90);
    const bool joint = y < 2 || x < 2 || (middle ? (y + 7) % 50 < 2 : (x + 30) % 70 < 2);
    return joint ? 0.F : float(0.4 + 0.6 * unit_double(random_bits(3, x, y)));
  });
  const auto says_so = [&](const Lattice& lattice) {
    const FeaturesPtr features = plain_features(panels, false)->with(Repeats(lattice));
    const IndexPtr index = make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
    const NodeRun made = run_node("synthesize", {{"size", Size{256, 256}}, {"seed", 2}}, {{"index", {index}}});
    return made.says("straight joints or edges are broken");
  };
  CHECK(says_so({}));
  CHECK_FALSE(says_so({2, {128, 0}, {0, 128}, 1}));
}
