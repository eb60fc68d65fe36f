#include <filesystem>
#include <limits>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/exemplar/appearance.h"
#include "core/exemplar/features.h"
#include "core/exemplar/repeats.h"
#include "core/exemplar/uv_map.h"
#include "core/material/material.h"
#include "core/node/serialize.h"
#include "nodes/common/registry.h"
#include "tests/run_node.h"
#include "tests/sample_values.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

IndexPtr small_index() {
  return std::get<IndexPtr>(sample_values()[size_t(ValueType::index)]);
}

IndexPtr load(const fs::path& path) {
  return run_node("load_analysis", {{"path", path.string()}}).get<Index>("index");
}

/// What load_analysis says about a file; empty if it takes it.
std::string complaint(const fs::path& path) {
  try {
    load(path);
    return "";
  } catch (const Error& e) {
    CHECK(e.about() == "path");
    return e.what();
  }
}

UvMapPtr layout_from(const IndexPtr& index) {
  return run_node("synthesize", {{"size", Size{40, 24}}, {"seed", int64_t{3}}}, {{"index", {index}}}).get<UvMap>("uv");
}

/// What load_analysis says about a file with right checksums, but with content that `spoil` has changed.
template <typename Spoil>
std::string complaint_about(const fs::path& path, const Spoil& spoil) {
  const IndexPtr good = small_index();
  const Appearance& of = *good->appearance();
  std::vector<AppearanceLevel> levels = of.levels();
  std::vector<SimilarSets> sets = good->levels();
  Repeats repeats;
  spoil(levels, sets, repeats);
  save_value(Index::make(Appearance::make(std::move(levels), of.channels(), of.wraps(), repeats), std::move(sets)),
             path, Task());
  return complaint(path);
}

}  // namespace

TEST_CASE("synthesis from a loaded analysis gives the uv map of the original, and its exemplar can come in later") {
  const TemporaryFolder folder;
  const ImagePtr image = make_image(
      {48, 32}, 3, [](int x, int y, int c) { return float((x / 6 + y / 4 + c) % 2) * 0.6f + float(x * y % 7) / 20; },
      Semantic::base_color, "srgb_texture");
  const Value features = run_node("weight", {}, {{"material", {image}}}).outputs.at("features");
  const Value space = run_node("pca", {}, {{"features", {features}}}).outputs.at("appearance");
  const IndexPtr index = run_node("index", {}, {{"appearance", {space}}}).get<Index>("index");

  const fs::path path = folder.path() / "new folder" / "wall.analysis";
  run_node("save_analysis", {{"path", path.string()}}, {{"index", {index}}});
  const IndexPtr back = load(path);
  CHECK(back->digest() == index->digest());
  const UvMapPtr a = layout_from(index), b = layout_from(back);
  CHECK(a->pixels() == b->pixels());
  CHECK(a->digest() == b->digest());
  const auto shown = [&](const UvMapPtr& uv) {
    return run_node("resolve_uv", {}, {{"uv", {uv}}, {"material", {image}}}).get<Material>("material");
  };
  CHECK(shown(a)->maps().front().image->pixels() == shown(b)->maps().front().image->pixels());
}

TEST_CASE("the same index gives the same analysis file") {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"})
    run_node("save_analysis", {{"path", (folder.path() / name).string()}}, {{"index", {small_index()}}});
  CHECK(read_text(folder.path() / "a") == read_text(folder.path() / "b"));
}

TEST_CASE("an analysis file that is damaged anywhere, or cut short anywhere, is refused") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "analysis";
  save_value(small_index(), path, Task());
  std::string bytes = read_text(path);
  REQUIRE(complaint(path).empty());
  for (size_t at = 0; at < bytes.size(); at++) {
    const char flip = char(1 << at % 8);
    bytes[at] ^= flip;
    replace_text(path, bytes);
    REQUIRE(!complaint(path).empty());
    bytes[at] ^= flip;
    replace_text(path, bytes.substr(0, at));
    REQUIRE(!complaint(path).empty());
  }
  bytes[bytes.size() / 2] ^= 1;
  replace_text(path, bytes);
  CHECK(complaint(path).find("checksum") != std::string::npos);
}

TEST_CASE("an analysis file from a newer version, of another kind or missing is refused in those words") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "analysis";
  save_value(small_index(), path, Task());
  std::string bytes = read_text(path);
  bytes[8] = 77;
  replace_text(path, bytes);
  CHECK(complaint(path).find("a newer terrazzo wrote it") != std::string::npos);
  bytes[8] = 0;
  replace_text(path, bytes);
  CHECK(complaint(path).find("an older terrazzo wrote it") != std::string::npos);
  replace_text(path, "\x89PNG\r\n\x1a\n and so on");
  CHECK(complaint(path).find("not a terrazzo value file") != std::string::npos);
  save_value(sample_values()[size_t(ValueType::uv_map)], path, Task());
  CHECK(complaint(path).find("a value of type uv_map") != std::string::npos);
  CHECK(complaint(folder.path() / "none").find("No such file") != std::string::npos);
}

TEST_CASE("an analysis whose checksums are right but whose content cannot be is refused") {
  using Levels = std::vector<AppearanceLevel>;
  using Sets = std::vector<SimilarSets>;
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "analysis";
  const auto about = [&](auto spoil) { return complaint_about(path, spoil); };
  CHECK(about([](Levels&, Sets&, Repeats&) {}).empty());
  const auto has = [](const std::string& text, const char* part) {
    INFO(text);
    return text.find(part) != std::string::npos;
  };
  CHECK(has(about([](Levels& l, Sets&, Repeats&) { l[1].vectors[3][2] = appearance_limit + 1; }), "out of range"));
  CHECK(has(about([](Levels& l, Sets&, Repeats&) { l[0].mean.pop_back(); }), "wrong length"));
  CHECK(has(about([](Levels& l, Sets&, Repeats&) {
              l[0].mean.resize(24);
              l[0].basis.resize(24 * size_t(l[0].dimensions));
            }),
            "does not belong to its channels"));
  CHECK(has(about([](Levels& l, Sets&, Repeats&) {
              l[0].mean.resize(75);
              l[0].basis.resize(75 * size_t(l[0].dimensions));
            }),
            "does not belong to its channels"));
  CHECK(has(about([](Levels& l, Sets&, Repeats&) { l[0].basis[7] = std::numeric_limits<float>::infinity(); }),
            "not a number"));
  CHECK(has(about([](Levels& l, Sets&, Repeats&) { l[1].scale = 0; }), "not positive"));
  CHECK(has(about([](Levels& l, Sets&, Repeats&) { l[1].dimensions = 9; }), "dimensions"));
  CHECK(has(about([](Levels& l, Sets&, Repeats&) { l[1].size = {6, 8}; }), "half the size"));
  CHECK(has(about([](Levels& l, Sets&, Repeats&) { l[0].size = {4, 48}; }), "too small or too large"));
  CHECK(has(about([](Levels&, Sets& s, Repeats&) { s[0].positions[5] = 16 * 12; }), "outside the exemplar"));
  CHECK(has(about([](Levels& l, Sets& s, Repeats&) {
              s[1].per_pixel = most_similar + 1;
              s[1].positions.assign(size_t(l[1].size.area()) * (most_similar + 1), 0);
            }),
            "number of similar pixels"));
  CHECK(has(about([](Levels&, Sets& s, Repeats&) { s[1].positions.pop_back(); }), "wrong length"));
  CHECK(has(about([](Levels&, Sets&, Repeats& r) { r = Lattice{1, {1e9, 0}, {}, 1}; }), "larger than any"));
  const auto about_part = [&](auto spoil) {
    return about([&](Levels&, Sets&, Repeats& r) {
      const Lattice courses{1, {0, 4}, {}, 1};
      LatticePart part{{0, 0, 8, 8}, courses, courses, {}};
      spoil(part);
      r.parts = {part};
    });
  };
  CHECK(about_part([](LatticePart&) {}).empty());
  CHECK(has(about_part([](LatticePart& p) { p.place.width = 1 << 30; }), "lies outside the exemplar"));
  CHECK(has(about_part([](LatticePart& p) { p.place.x = -1; }), "lies outside the exemplar"));
  CHECK(has(about_part([](LatticePart& p) { p.shown = {}; }), "another way than it is shown"));
  CHECK(has(about_part([](LatticePart& p) { p.shown.first.y() = 1e6; }), "larger than any"));
  CHECK(has(about_part([](LatticePart& p) { p.start.x() = 1e12; }), "starts too far away"));
  CHECK(
      has(about_part([](LatticePart& p) { p.start.y() = std::numeric_limits<double>::quiet_NaN(); }), "not a number"));
}

TEST_CASE("the exemplar's size is known before the file is read, from its contents") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.analysis";
  save_value(small_index(), path, Task());
  const NodeType& type = *find_node_type("load_analysis");
  CHECK(type.preflight({{"path", path.string()}}, {}).size == small_index()->appearance()->size());
  save_value(layout_from(small_index()), path, Task());
  CHECK_THROWS_AS(exemplar_of_index_file(path), DamagedFile);
}
