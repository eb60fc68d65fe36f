#include "core/file/archive.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numeric>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <locale.h>

#include "core/base/error.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

const std::string long_name = std::string(150, 'n') + "/" + std::string(90, 'm') + ".png";
const std::string decomposed_name = "inputs/1/u\u0308" + std::string(100, 'x');

fs::path archive_in(const fs::path& folder) {
  const fs::path path = folder / "a.tar";
  write_text(folder / "data", std::string(1300, 'd'));
  const std::unique_ptr<ArchiveWriter> writer = write_archive(path);
  writer->add("first.txt", "one");
  writer->add_file("data", folder / "data");
  writer->add(long_name, "deep");
  writer->add(decomposed_name, "");
  writer->finish();
  return path;
}

using Content = std::map<std::string, std::string>;

Content content_of(const fs::path& archive) {
  Content out;
  const std::unique_ptr<ArchiveReader> reader = read_archive(archive);
  const TemporaryFolder folder;
  while (reader->next()) {
    reader->extract(folder.path() / "out");
    out[reader->name()] = read_text(folder.path() / "out");
  }
  return out;
}

std::string trouble_of(const fs::path& archive) {
  try {
    content_of(archive);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

std::string padded(std::string bytes) {
  bytes.resize((bytes.size() + 511) / 512 * 512);
  return bytes;
}

/// An entry in the format of POSIX.1-1988.
std::string entry(const std::string& name, char type, const std::string& bytes, const std::string& link = "",
                  uint64_t size = 0) {
  std::string b(512, '\0');
  b.replace(0, name.size(), name);
  b.replace(100, 7, "0000644");
  b.replace(124, 11, fmt::format("{:011o}", size > 0 ? size : bytes.size()));
  b.replace(136, 11, "00000000000");
  b[156] = type;
  b.replace(157, link.size(), link);
  b.replace(257, 8, std::string("ustar\0000", 8));
  b.replace(148, 8, 8, ' ');
  const auto sum = std::accumulate(b.begin(), b.end(), 0, [](int s, char c) { return s + uint8_t(c); });
  b.replace(148, 8, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
  return b + padded(bytes);
}

/// What stands before an entry of a long name, or of other facts.
std::string pax(const std::map<std::string, std::string>& facts) {
  std::string records;
  for (const auto& [key, value] : facts) {
    const std::string rest = fmt::format(" {}={}\n", key, value);
    size_t length = rest.size() + 1;
    while (std::to_string(length).size() + rest.size() != length) length++;
    records += std::to_string(length) + rest;
  }
  return entry("long-name", 'x', records);
}

const std::string end(1024, '\0');

/// Gives the thread another locale, if the system has it.
struct OtherLocale {
  explicit OtherLocale(const char* name) : other(::newlocale(LC_ALL_MASK, name, nullptr)) {
    if (other) before = ::uselocale(other);
  }
  ~OtherLocale() {
    if (other) ::uselocale(before), ::freelocale(other);
  }
  locale_t other, before{};
};

}  // namespace

TEST_CASE("what goes into an archive comes out of it, names of any length included") {
  const TemporaryFolder folder;
  const fs::path path = archive_in(folder.path());
  CHECK(is_archive(path));
  const Content expected = {
      {"first.txt", "one"}, {"data", std::string(1300, 'd')}, {long_name, "deep"}, {decomposed_name, ""}};
  CHECK(content_of(path) == expected);
  CHECK(listing(folder.path()) == std::vector<std::string>{"a.tar", "data"});
}

TEST_CASE("the usual tool reads an archive") {
  const TemporaryFolder folder;
  const fs::path path = archive_in(folder.path());
  const std::string command =
      "tar xf '" + path.string() + "' -C '" + folder.path().string() + "' first.txt '" + long_name + "'";
  REQUIRE(std::system(command.c_str()) == 0);
  CHECK(read_text(folder.path() / "first.txt") == "one");
  CHECK(read_text(folder.path() / long_name) == "deep");
}

TEST_CASE("the same content gives the same bytes, and an archive that is not finished leaves nothing") {
  const TemporaryFolder one, other;
  const std::string bytes = read_text(archive_in(one.path()));
  {
    const OtherLocale utf8("C.UTF-8");
    CHECK(read_text(archive_in(other.path())) == bytes);
  }
  {
    const std::unique_ptr<ArchiveWriter> writer = write_archive(one.path() / "b.tar");
    writer->add("x", "y");
  }
  CHECK(listing(one.path()) == std::vector<std::string>{"a.tar", "data"});
  CHECK_THROWS_AS(write_archive(one.path() / "data" / "c.tar"), Error);
}

TEST_CASE("the same content gives the same zip file, in any time zone, which Python reads") {
  const TemporaryFolder folder;
  const auto zip = [&](const char* name) {
    const std::unique_ptr<ArchiveWriter> writer = write_archive(folder.path() / name, ArchiveFormat::zip);
    writer->add("addon/a.py", "one = 1\n");
    writer->add("addon/b.py", std::string(5000, '#'));
    writer->finish();
    return read_text(folder.path() / name);
  };
  const std::string bytes = zip("a.zip");
  ::setenv("TZ", "Asia/Tokyo", 1);
  ::tzset();
  CHECK(zip("b.zip") == bytes);
  ::unsetenv("TZ");
  ::tzset();
  CHECK(bytes.size() < 1000);
  const std::string command = "cd '" + folder.path().string() + "' && python3 -m zipfile -e a.zip .";
  REQUIRE(std::system(command.c_str()) == 0);
  CHECK(read_text(folder.path() / "addon/a.py") == "one = 1\n");
  CHECK(read_text(folder.path() / "addon/b.py") == std::string(5000, '#'));
}

TEST_CASE("archives in pax form, as they were written before, are read, in any locale") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.tar";
  write_text(path, entry("graph.json", '0', "{}") + entry("inputs", '5', "") + pax({{"path", decomposed_name}}) +
                       entry("inputs/1/u", '0', "deep") + end);
  const Content expected = {{"graph.json", "{}"}, {decomposed_name, "deep"}};
  CHECK(content_of(path) == expected);
  const OtherLocale utf8("C.UTF-8");
  CHECK(content_of(path) == expected);
}

TEST_CASE("damaged and cut archives are refused") {
  const TemporaryFolder folder;
  const fs::path path = archive_in(folder.path());
  const std::string whole = read_text(path);
  int refused = 0;
  for (size_t length = 0; length < whole.size() - 1024; length += length % 512 == 0 ? 173 : 339) {
    replace_text(path, whole.substr(0, length));
    CHECK(contains(trouble_of(path), "a.tar: the archive is cut off or damaged"));
    refused++;
  }
  CHECK(refused > 10);
  for (const size_t at : {0, 100, 124, 156, 512 * 2 + 130}) {
    std::string damaged = whole;
    damaged[at] ^= 4;
    replace_text(path, damaged);
    CHECK(contains(trouble_of(path), "get the file again"));
  }
  replace_text(path, "{\"terrazzo\": 1}");
  CHECK_FALSE(is_archive(path));
  CHECK_FALSE(is_archive(folder.path()));
}

TEST_CASE("an archive holds regular files and folders, and nothing that is larger than it") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.tar";
  const auto trouble_with = [&](const std::string& entries) {
    replace_text(path, entry("graph.json", '0', "{}") + entries + end);
    return trouble_of(path);
  };
  CHECK(trouble_with("") == "");
  for (const char type : {'1', '2', '3', '4', '6'})
    CHECK(contains(trouble_with(entry("x", type, "", "graph.json")), "holds \"x\", which is not a regular file"));
  CHECK(contains(trouble_with(entry("x/", '0', "xy")), "holds \"x/\", which is not a regular file"));
  const std::string sparse =
      pax({{"GNU.sparse.map", "0,512"}, {"GNU.sparse.numblocks", "1"}, {"GNU.sparse.size", "1000000000000"}});
  CHECK(contains(trouble_with(sparse + entry("x", '0', std::string(512, 'x'))), "not a regular file"));
  CHECK(contains(trouble_with(entry("x", '0', "x", "", 07777777777)), "Truncated"));
  CHECK(trouble_with(pax({{"size", "4611686018427387904"}}) + entry("x", '0', "x")) != "");
  CHECK(trouble_with(pax({{"size", "-5"}}) + entry("x", '0', "x")) != "");
  CHECK(trouble_with(pax({{"path", std::string(2 << 20, 'p')}}) + entry("x", '0', "x")) != "");
}
