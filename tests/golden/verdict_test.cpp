#include "tests/golden/verdict.h"

#include <fstream>

#include <doctest/doctest.h>

#include "core/base/error.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

Content content(uint64_t digest, double mean = 0.5) {
  Content c;
  c.digest = {0, digest};
  c.mean = mean;
  c.deviation = 0.2;
  c.samples = {0.1, 0.5};
  return c;
}

GoldenLine line(const std::string& name, uint64_t digest, int version = 3) {
  return {name, "blur", version, "image", content(digest)};
}

GoldenCase golden(const GoldenLine& line, const std::vector<std::string>& sources = {}) {
  GoldenCase c;
  c.file = "image";
  c.lines = {line};
  for (const std::string& s : sources) c.sources.push_back({s, "image"});
  return c;
}

Verdict verdict_on(const std::vector<GoldenLine>& recorded, const std::vector<GoldenCase>& cases,
                   const std::string& libraries = "a 1") {
  Verdict v({{"image", {"a 1", recorded}}}, libraries);
  for (const GoldenCase& c : cases) v.judge(c);
  v.judge_leftovers({"doc"});
  return v;
}

}  // namespace

TEST_SUITE_BEGIN("golden");

TEST_CASE("results that are as recorded are fine") {
  CHECK(verdict_on({line("doc/a", 1)}, {golden(line("doc/a", 1))}).diagnostics().empty());
}

TEST_CASE("other results ask for a higher version, or for a new record where it has been raised") {
  const Verdict same = verdict_on({line("doc/a", 1)}, {golden(line("doc/a", 2))});
  REQUIRE(same.diagnostics().size() == 1);
  CHECK(same.diagnostics()[0].find("doc/a: \"blur\" gives another image than recorded") == 0);
  CHECK(same.diagnostics()[0].find("Its version is still 3: undo the change, or raise its version") !=
        std::string::npos);
  const Verdict raised = verdict_on({line("doc/a", 1)}, {golden(line("doc/a", 2, 4))});
  REQUIRE(raised.diagnostics().size() == 1);
  CHECK(raised.diagnostics()[0].find(
            "went from 3 to 4, as it should; record it anew with tests/golden/regenerate.sh") != std::string::npos);
  CHECK(verdict_on({line("doc/a", 1)}, {golden(line("doc/a", 1, 4))}).diagnostics().size() == 1);
}

TEST_CASE("only the node that changed is blamed, not those that read it or its files") {
  GoldenCase writer = golden(line("doc/a", 2)), reader = golden(line("doc/c", 5));
  writer.files_out = reader.files_in = {"/tmp/file.png"};
  const Verdict v = verdict_on({line("doc/a", 1), line("doc/b", 3), line("doc/c", 4)},
                               {writer, golden(line("doc/b", 9), {"doc/a"}), reader});
  REQUIRE(v.diagnostics().size() == 1);
  CHECK(v.diagnostics()[0].find("doc/a") == 0);
  CHECK(v.followers() == 2);
}

TEST_CASE("cases that were never recorded, and records without a case, are found") {
  const Verdict v = verdict_on({line("doc/old", 1), line("other/old", 1)}, {golden(line("doc/new", 1))});
  REQUIRE(v.diagnostics().size() == 2);
  CHECK(v.diagnostics()[0].find("doc/new: nothing is recorded of image") == 0);
  CHECK(v.diagnostics()[1].find("doc/old: image.txt has results of image, which no case gives any more") == 0);
}

TEST_CASE("with other libraries results only have to be near") {
  GoldenLine near = line("doc/a", 2), off = line("doc/a", 2), elsewhere = line("doc/a", 2);
  near.content.mean += 0.005;
  off.content.mean += 0.05;
  elsewhere.content.samples[1] = 0.4;
  CHECK(verdict_on({line("doc/a", 1)}, {golden(near)}, "a 2").diagnostics().empty());
  CHECK(verdict_on({line("doc/a", 1)}, {golden(near)}).diagnostics().size() == 1);
  CHECK(verdict_on({line("doc/a", 1)}, {golden(off)}, "a 2").diagnostics().size() == 1);
  CHECK(verdict_on({line("doc/a", 1)}, {golden(elsewhere)}, "a 2").diagnostics().size() == 1);
  GoldenCase decided = golden(elsewhere);
  decided.decided = true;  // a decision may fall otherwise, as long as the whole looks alike
  CHECK(verdict_on({line("doc/a", 1)}, {decided}, "a 2").diagnostics().empty());
  decided.lines[0].content.mean = 0.7;
  CHECK(verdict_on({line("doc/a", 1)}, {decided}, "a 2").diagnostics().size() == 1);
}

TEST_CASE("golden files come back as they were written, and damaged ones are refused") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "image.txt";
  CHECK(read_golden(path).lines.empty());
  write_golden(path, {"png 1.6", {line("doc/a", 7), line("doc/b", 8, 12)}});
  const GoldenFile file = read_golden(path);
  CHECK(file.libraries == "png 1.6");
  REQUIRE(file.lines.size() == 2);
  const GoldenLine* b = file.find("doc/b", "image");
  REQUIRE(b);
  CHECK(b->version == 12);
  CHECK(b->content.digest == content(8).digest);
  CHECK(b->content.samples == content(8).samples);
  std::ofstream(path, std::ios::app) << "doc/c blur v1 image 12 0 0\n";
  CHECK_THROWS_WITH_AS(read_golden(path), doctest::Contains("image.txt:9: not a line of a golden file"), Error);
}

TEST_CASE("every pixel of a computed image counts, not its recipe") {
  const ImageInfo info{.size = {4, 3}, .channels = 1};
  const auto image = [&](float last) {
    return Image::computed(info, {1, 2}, [last](const Rect& r, float* out) {
      for (int y = r.y; y < r.bottom(); y++)
        for (int x = r.x; x < r.right(); x++) *out++ = x == 3 && y == 2 ? last : 0.0f;
    });
  };
  CHECK(content_of(image(0)).digest == content_of(image(0)).digest);
  CHECK(content_of(image(0)).digest != content_of(image(1e-6f)).digest);
  CHECK(content_of(image(6)).mean == doctest::Approx(0.5));
}

TEST_SUITE_END();
