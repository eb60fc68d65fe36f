#include <cstdlib>
#include <fstream>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "core/base/error.h"
#include "core/base/variables_read.h"
#include "core/file/read_guard.h"
#include "core/image_io/color.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// Sets an environment variable for the time it lives.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) { ::setenv(name, value.c_str(), 1); }
  ~Environment() { ::unsetenv(name_); }

 private:
  const char* name_;
};

/// A configuration whose space "Looked" is half, or whatever the look-up files say, of the linear one.
struct Studio {
  explicit Studio(const std::string& transform, const std::string& head = "search_path: luts\n",
                  const std::string& more = "") {
    fs::create_directories(folder.path() / "show/luts/deep");
    fs::create_directories(folder.path() / "shared");
    write(config(), "ocio_profile_version: 2\n" + head +
                        "roles: {default: raw, scene_linear: lin_rec709}\n"
                        "displays: {screen: [!<View> {name: plain, colorspace: lin_rec709}]}\n"
                        "colorspaces:\n"
                        "  - !<ColorSpace> {name: lin_rec709}\n"
                        "  - !<ColorSpace> {name: raw, isdata: true}\n"
                        "  - !<ColorSpace> {name: Unused, to_scene_reference: !<FileTransform> {src: missing.spi1d}}\n"
                        "  - !<ColorSpace> {name: Looked, to_scene_reference: " +
                        transform + "}\n" + more);
  }

  static void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  /// A table that multiplies by `factor`.
  void table(const std::string& file, double factor) const {
    write(folder.path() / file, fmt::format("Version 1\nFrom 0 1\nLength 2\nComponents 1\n{{\n0.0\n{}\n}}\n", factor));
  }
  std::string config() const { return (folder.path() / "show/config.ocio").string(); }
  ImagePtr converted() const {
    const ImagePtr one = make_image(
        {1, 1}, 3, [](int, int, int) { return 0.5f; }, Semantic::base_color, "Looked");
    return convert_color(one, "lin_rec709", config());
  }
  double value() const { return converted()->pixels()[0]; }
  /// Below the folder, in the order of their names.
  std::vector<std::string> files() const {
    std::vector<std::string> out;
    for (const fs::path& f : color_config_files(config())) out.push_back(f.lexically_relative(folder.path()).string());
    return out;
  }

  TemporaryFolder folder;
};

std::string file_transform(const std::string& src) {
  return "!<FileTransform> {src: " + src + "}";
}

}  // namespace

TEST_CASE("a look-up file counts wherever a configuration names it, and is read again when it changes") {
  struct Case {
    std::string transform, file;
    std::string head = "search_path: luts\n";
    std::string more = "";
  };
  const std::string deep = file_transform("deep/a.spi1d");
  const Case cases[] = {
      {file_transform("a.spi1d"), "show/luts/a.spi1d"},
      {deep, "show/luts/deep/a.spi1d"},
      {deep, "show/luts/deep/a.spi1d", "search_path: [none, ' luts/ ']\n"},
      {file_transform("../../shared/a.spi1d"), "shared/a.spi1d"},
      {file_transform("a.spi1d"), "shared/a.spi1d", "search_path: ../shared\n"},
      {file_transform("a.spi1d"), "shared/a.spi1d", "search_path: $TZ_PLACE\n"},
      {file_transform("'${TZ_NAME}.spi1d'"), "show/luts/a.spi1d"},
      {file_transform("$TZ_PLACE/a.spi1d"), "shared/a.spi1d"},
      {file_transform("$TZ_INNER/a.spi1d"), "shared/a.spi1d",
       "environment: {TZ_INNER: $TZ_PLACE, TZ_PLACE: none}\nsearch_path: luts\n"},
      {file_transform("luts/a.spi1d"), "show/luts/a.spi1d", ""},
      {"!<GroupTransform> {children: [!<GroupTransform> {children: [" + deep + "]}]}", "show/luts/deep/a.spi1d"},
      {"!<LookTransform> {src: lin_rec709, dst: lin_rec709, looks: warm}", "show/luts/deep/a.spi1d",
       "search_path: luts\n", "looks:\n  - !<Look> {name: warm, process_space: lin_rec709, transform: " + deep + "}\n"},
      {"!<ColorSpaceTransform> {src: Other, dst: lin_rec709}", "show/luts/deep/a.spi1d", "search_path: luts\n",
       "  - !<ColorSpace> {name: Other, to_scene_reference: " + deep + "}\n"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.transform);
    CAPTURE(c.head);
    Studio studio(c.transform, c.head, c.more);
    const Environment place("TZ_PLACE", (studio.folder.path() / "shared").string()), name("TZ_NAME", "a");
    studio.table(c.file, 0.5);
    CHECK(studio.value() == doctest::Approx(0.25));
    const Digest before = studio.converted()->digest();
    std::vector<std::string> files = {c.file, "show/config.ocio"};
    std::ranges::sort(files);
    CHECK(studio.files() == files);
    studio.table(c.file, 0.25);
    CHECK(studio.value() == doctest::Approx(0.125));
    CHECK(studio.converted()->digest() != before);
  }
}

TEST_CASE("looks, named transforms and view transforms name files too") {
  const std::string deep = file_transform("deep/a.spi1d");
  for (const std::string& more :
       {"looks:\n  - !<Look> {name: warm, process_space: lin_rec709, inverse_transform: " + deep + "}\n",
        "named_transforms:\n  - !<NamedTransform> {name: warm, inverse_transform: " + deep + "}\n",
        "view_transforms:\n  - !<ViewTransform> {name: warm, from_scene_reference: " + deep + "}\n",
        "display_colorspaces:\n  - !<ColorSpace> {name: Screen, from_display_reference: " + deep + "}\n",
        std::string("inactive_colorspaces: [Off]\n")}) {
    CAPTURE(more);
    const bool inactive = more.starts_with("inactive");
    const std::string off = "  - !<ColorSpace> {name: Off, from_scene_reference: " + deep + "}\n";
    Studio studio("!<MatrixTransform> {}", inactive ? "search_path: luts\n" + more : "search_path: luts\n",
                  inactive ? off : more);
    studio.table("show/luts/deep/a.spi1d", 0.5);
    CHECK(studio.files() == std::vector<std::string>{"show/config.ocio", "show/luts/deep/a.spi1d"});
  }
}

TEST_CASE("variables of the environment that a configuration uses are noted, and another value gives another result") {
  Studio studio(file_transform("$TZ_NAME.spi1d"));
  studio.table("show/luts/a.spi1d", 0.5);
  studio.table("show/luts/b.spi1d", 0.25);
  const auto noted = [&] {
    const VariablesRead variables;
    studio.files();
    return variables.all();
  };
  using Values = std::map<std::string, std::string>;
  {
    const Environment name("TZ_NAME", "a");
    CHECK(noted() == Values{{"TZ_NAME", "a"}});
    CHECK(studio.value() == doctest::Approx(0.25));
  }
  {
    const Environment name("TZ_NAME", "b"), unrelated("TZ_OTHER", "c");
    CHECK(noted() == Values{{"TZ_NAME", "b"}});
    CHECK(studio.value() == doctest::Approx(0.125));
  }
  CHECK(noted().empty());
  CHECK_THROWS_AS(studio.value(), Error);
  const Environment flags("OCIO_OPTIMIZATION_FLAGS", "0");
  CHECK(noted() == Values{{"OCIO_OPTIMIZATION_FLAGS", "0"}});
}

TEST_CASE("a file that comes to lie earlier in the search path is the one that counts") {
  Studio studio(file_transform("a.spi1d"), "search_path: [luts/deep, luts]\n");
  studio.table("show/luts/a.spi1d", 0.5);
  CHECK(studio.value() == doctest::Approx(0.25));
  studio.table("show/luts/deep/a.spi1d", 0.25);
  CHECK(studio.value() == doctest::Approx(0.125));
  CHECK(studio.files() == std::vector<std::string>{"show/config.ocio", "show/luts/deep/a.spi1d"});
}

TEST_CASE("files that CLF and CTF files refer to count as well") {
  Studio studio(file_transform("outer.ctf"));
  const auto refer = [&](const std::string& inside) {
    Studio::write(studio.folder.path() / "show/luts/outer.ctf",
                  "<?xml version=\"1.0\"?>\n<ProcessList version=\"1.2\" id=\"x\">\n" + inside + "\n</ProcessList>\n");
  };
  refer("<Reference inBitDepth=\"32f\" outBitDepth=\"32f\" path=\"deep/inner.ctf\"/>");
  fs::create_directories(studio.folder.path() / "show/luts/deep");
  Studio::write(studio.folder.path() / "show/luts/deep/inner.ctf",
                "<ProcessList version=\"1.2\" id=\"y\"><reference inBitDepth='32f' outBitDepth='32f' "
                "path = 'a.spi1d'></reference></ProcessList>");
  studio.table("show/luts/a.spi1d", 0.5);
  CHECK(studio.files() == std::vector<std::string>{"show/config.ocio", "show/luts/a.spi1d", "show/luts/deep/inner.ctf",
                                                   "show/luts/outer.ctf"});
  CHECK(studio.value() == doctest::Approx(0.25));
  studio.table("show/luts/a.spi1d", 0.25);
  CHECK(studio.value() == doctest::Approx(0.125));
  for (const char* hidden : {"<Reference inBitDepth=\"32f\" outBitDepth=\"32f\" path=\"&#97;.spi1d\"/>",
                             "<Reference inBitDepth=\"32f\" outBitDepth=\"32f\"/>"}) {
    refer(hidden);
    CHECK_THROWS_WITH_AS(studio.value(), doctest::Contains("cannot tell which files"), Error);
  }
  Studio::write(studio.folder.path() / "show/luts/outer.ctf",
                "<!DOCTYPE x [<!ENTITY r \"&#60;Reference path='a.spi1d'/>\">]><ProcessList version=\"1.2\" "
                "id=\"x\">&r;</ProcessList>");
  CHECK_THROWS_WITH_AS(studio.value(), doctest::Contains("cannot tell which files"), Error);
}

TEST_CASE("pipes and devices are refused before OpenColorIO opens them, what lies beside them is no reason to") {
  Studio studio(file_transform("a.spi1d"));
  studio.table("show/luts/b.spi1d", 0.5);
  const fs::path table = studio.folder.path() / "show/luts/a.spi1d";
  fs::create_symlink("/dev/zero", studio.folder.path() / "show/luts/beside.spi1d");
  fs::create_symlink("b.spi1d", table);
  CHECK(studio.value() == doctest::Approx(0.25));
  CHECK(studio.files() == std::vector<std::string>{"show/config.ocio", "show/luts/a.spi1d"});
  fs::remove(table);
  fs::create_symlink("/dev/zero", table);
  CHECK_THROWS_WITH_AS(studio.value(), doctest::Contains("a.spi1d: it is a device; expected a regular file"), Error);
  fs::remove(table);
  REQUIRE(::mkfifo(table.c_str(), 0600) == 0);
  CHECK_THROWS_WITH_AS(color_space_names(studio.config()), doctest::Contains("a.spi1d: it is a pipe"), Error);
  CHECK(studio.files() == std::vector<std::string>{"show/config.ocio", "show/luts/a.spi1d"});
  fs::remove(studio.config());
  REQUIRE(::mkfifo(studio.config().c_str(), 0600) == 0);
  CHECK_THROWS_WITH_AS(color_space_names(studio.config()), doctest::Contains("config.ocio: it is a pipe"), Error);
  const Environment ocio("OCIO", studio.config());
  CHECK_THROWS_WITH_AS(canonical_color_space("srgb"), doctest::Contains("it is a pipe"), Error);
  CHECK(color_config_files().size() == 1);
}

TEST_CASE("where reading is guarded, neither a configuration nor its files are read elsewhere") {
  Studio studio(file_transform("../../shared/a.spi1d"));
  studio.table("shared/a.spi1d", 0.5);
  const fs::path inside = studio.folder.path() / "show";
  const auto guard = [&](const fs::path& path) {
    if (path.lexically_normal().lexically_relative(inside).native().starts_with(".."))
      throw Error("may not read " + path.string());
  };
  CHECK(studio.value() == doctest::Approx(0.25));
  {
    const ReadGuard reading(guard);
    CHECK_THROWS_WITH_AS(studio.value(), doctest::Contains("may not read "), Error);
  }
  CHECK(studio.value() == doctest::Approx(0.25));
}
