#include "nodes/sink/compare.h"

#include <algorithm>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "tests/core/metrics/textures.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr image(const Planes& planes, const std::string& color_space = "srgb_texture") {
  const ImageInfo info{
      .size = planes.size, .channels = planes.channels, .semantic = Semantic::base_color, .color_space = color_space};
  return Image::from_floats(info, planes.values);
}

std::map<std::string, double> figures(const NodeRun& run) {
  std::map<std::string, double> out;
  for (const Report::Figure& f : run.get<Report>("report")->figures()) {
    CHECK_FALSE(f.help.empty());
    out[f.name] = std::get<double>(f.value);
  }
  return out;
}

/// The figures that a node with these parameters and these inputs gives are those that were foretold, with what is
/// said about them.
void check_foretold(const Params& params, const std::map<std::string, std::vector<Value>>& inputs) {
  using Better = ComparedFigure::Better;
  const NodeRun run = run_node("compare", params, inputs);
  const std::vector<ComparedFigure> known =
      compared_figures({{"tileable", params.contains("tileable") ? params.at("tileable") : ParamValue("auto")}},
                       inputs.contains("uv"), inputs.contains("labels"));
  size_t at = 0;
  for (const Report::Figure& f : run.get<Report>("report")->figures()) {
    while (at < known.size() && known[at].name != f.name) at++;
    REQUIRE_MESSAGE(at < known.size(), f.name);
    const bool higher = f.help.find("higher is better") != f.help.npos, lower = f.help.find("lower is") != f.help.npos;
    CHECK_MESSAGE(known[at].better == (higher ? Better::higher : lower ? Better::lower : Better::neither), f.name);
  }
}

std::string error(const std::vector<Value>& exemplar, const std::vector<Value>& output, const Params& params = {}) {
  try {
    run_node("compare", params, {{"exemplar", exemplar}, {"output", output}});
  } catch (const Error& e) {
    return e.about() + ": " + e.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("compare reports figures and a sheet, and figures of the layout when it has the uv map") {
  const Planes exemplar = bricks({32, 32}, 1), output = tiled(exemplar, {48, 64});
  const std::map<std::string, std::vector<Value>> inputs = {{"exemplar", {image(exemplar)}},
                                                            {"output", {image(output)}}};
  const NodeRun plain = run_node("compare", {}, inputs);
  const auto without = figures(plain);
  for (const char* name :
       {"swd", "cooccurrence", "coherence", "completeness", "broken", "structure", "acf", "verbatim", "repeat"})
    CHECK_MESSAGE(without.count(name), name);
  CHECK(without.size() == 9);
  CHECK(plain.get<Image>("sheet")->size() == Size{32 + 48 + 18, 64 + 12 + 9});
  CHECK(plain.get<Report>("report")->pictures().size() == 1);

  std::vector<ExemplarPixel> pixels;
  for (int y = 0; y < 64; y++)
    for (int x = 0; x < 48; x++) pixels.push_back({uint16_t(x % 32), uint16_t(y % 32)});
  auto with_uv = inputs;
  with_uv["uv"] = {UvMap::make({48, 64}, {32, 32}, pixels)};
  const auto with = figures(run_node("compare", {}, with_uv));
  CHECK(with.size() == 14);
  CHECK(with.at("largest_copy") == 1);
  CHECK(with.at("seam_share") > 0);
  CHECK(figures(run_node("compare", {{"wraps", true}}, with_uv)).at("seam_share") == 0);
  with_uv["uv"] = {UvMap::make({48, 64}, {32, 32}, pixels, {true, false, false})};
  check_foretold({}, with_uv);
  check_foretold({{"tileable", "xy"}}, with_uv);
  check_foretold({}, inputs);
  check_foretold({{"tileable", "y"}}, inputs);
  CHECK(figures(run_node("compare", {}, with_uv)).count("wrap_seam_x") == 1);
  CHECK(figures(run_node("compare", {}, with_uv)).count("wrap_seam_y") == 0);
  CHECK(figures(run_node("compare", {{"tileable", "none"}}, with_uv)).count("wrap_seam_x") == 0);
  CHECK(figures(run_node("compare", {{"tileable", "y"}}, inputs)).count("wrap_seam_y") == 1);
}

TEST_CASE("compare measures the maps it is told to, else those that both have") {
  const ImagePtr color = image(bricks({32, 32}, 1)), other = image(spots({32, 32}, 1));
  const Value exemplar = Material::make("e", {{"base_color", color}, {"height", color}, {"mask", color}});
  const Value output = Material::make("o", {{"height", other}, {"base_color", color}});
  const auto run = [&](const Params& params) {
    return figures(run_node("compare", params, {{"exemplar", {exemplar}}, {"output", {output}}}));
  };
  CHECK(run({{"maps", Texts{"base_color"}}}).at("coherence") == 0);
  CHECK(run({{"maps", Texts{"height"}}}).at("coherence") > run({}).at("coherence"));
  CHECK(run({}).at("coherence") > 0);
  CHECK(error({exemplar}, {output}, {{"maps", Texts{"mask"}}}) ==
        "maps.0: there is no map \"mask\"; the output has height, base_color");
}

TEST_CASE("a grey output can be compared with a colour exemplar") {
  const Planes grey = bricks({32, 32}, 1);
  Planes color = Planes::zeros(grey.size, 3);
  for (size_t i = 0; i < color.values.size(); i++) color.values[i] = grey.values[i / 3];
  const NodeRun run = run_node("compare", {}, {{"exemplar", {image(color)}}, {"output", {image(grey)}}});
  CHECK(figures(run).at("coherence") == 0);
}

TEST_CASE("compare says what does not fit together") {
  const Planes small = bricks({32, 32}, 1);
  CHECK(error({image(small)}, {image(bricks({32, 8}, 1))}).find("output: a material of at least 16x16") == 0);
  CHECK(error({image(small)}, {image(small, "acescg")}).find("srgb_texture in the exemplar and acescg") !=
        std::string::npos);
  const Value height = Material::make("h", {{"height", image(small)}});
  CHECK(error({image(small)}, {height}) ==
        "output: exemplar and output must share a map to be compared; the exemplar has base_color, the output height");
  const UvMapPtr uv = UvMap::make({8, 8}, {32, 32}, std::vector<ExemplarPixel>(64));
  CHECK_THROWS_AS(run_node("compare", {}, {{"exemplar", {image(small)}}, {"output", {image(small)}}, {"uv", {uv}}}),
                  Error);
}
