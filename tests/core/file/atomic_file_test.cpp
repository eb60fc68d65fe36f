#include "core/file/atomic_file.h"

#include <chrono>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/file/file_io.h"
#include "core/node/node.h"
#include "tests/run_node.h"
#include "tests/runner/fakes.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// The number of a process that has been and is no more.
pid_t dead_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.rfind(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("what stands in the way of writing a file is told without touching anything") {
  const TemporaryFolder folder;
  const fs::path& at = folder.path();
  write_text(at / "file", "");
  fs::create_directories(at / "folder.png");
  CHECK(why_not_writable(at, "x.png") == "");
  CHECK(why_not_writable(at, "file") == "");
  CHECK(why_not_writable(at, "") == "");
  CHECK(why_not_writable(at / "not/yet/there", "x.png") == "");
  CHECK(why_not_writable("", "x.png") == "");
  CHECK(why_not_writable("not/yet/there", "x.png") == "");
  const std::string in_the_way = "expected a folder to write to, found the file " + (at / "file").string();
  CHECK(why_not_writable(at / "file", "x.png") == in_the_way);
  CHECK(why_not_writable(at / "file/deeper/still", "") == in_the_way);
  CHECK(why_not_writable(at, "folder.png") ==
        "expected the name of a file to write, found the folder " + (at / "folder.png").string());
  CHECK(listing(at) == std::vector<std::string>{"file", "folder.png"});
}

TEST_CASE("a folder that may not be written is named") {
  const TemporaryFolder folder;
  const fs::path locked = folder.path() / "locked";
  fs::create_directories(locked);
  fs::permissions(locked, fs::perms(0555));
  // Root may write everywhere; nobody may not.
  const bool is_root = ::geteuid() == 0;
  if (is_root) REQUIRE(::seteuid(65534) == 0);
  const std::string below = why_not_writable(locked / "below", "x.png");
  if (is_root) REQUIRE(::seteuid(0) == 0);
  fs::permissions(locked, fs::perms(0755));
  CHECK(below == "cannot write into the folder " + locked.string() + ": Permission denied; write to another folder");
}

TEST_CASE("a folder in which nothing can be made is named, also to root, who is forbidden nothing") {
  const std::string reason = ::geteuid() == 0 ? "no file can be created there" : "Permission denied";
  const std::string expected = "cannot write into the folder /proc: " + reason + "; write to another folder";
  CHECK(why_not_writable("/proc", "x.png") == expected);
  CHECK(why_not_writable("/proc/x/y", "x.png") == expected);
}

TEST_CASE("a link to a folder that is not there is named") {
  const TemporaryFolder folder;
  const fs::path link = folder.path() / "link";
  fs::create_directory_symlink("gone", link);
  CHECK(why_not_writable(link / "below", "x.png") ==
        "the folder " + link.string() + " is a link to gone, which is not there");
}

TEST_CASE("temporaries of long names have names that are not too long") {
  const TemporaryFolder folder;
  const fs::path temporary = temporary_beside(folder.path() / (std::string(251, 'x') + ".png"));
  CHECK(temporary.filename().string().size() < 200);
  CHECK(temporary.extension() == ".png");
}

TEST_CASE("temporaries of dead processes are removed, and nothing else") {
  const TemporaryFolder folder;
  const auto make = [&](const std::string& name, bool is_old) {
    write_text(folder.path() / name, "half of");
    if (is_old) fs::last_write_time(folder.path() / name, fs::file_time_type::clock::now() - std::chrono::hours(25));
    return name;
  };
  const std::string mine = temporary_beside(folder.path() / "base_color.tar.png").filename().string();
  const std::string dead = replaced(mine, fmt::format("-{}-", ::getpid()), fmt::format("-{}-", dead_process()));
  const size_t host = mine.find("terrazzo-") + 9;
  const std::string elsewhere = std::string(dead).replace(host, 8, "00000000");
  REQUIRE(mine.starts_with(".base_color.tar."));
  REQUIRE(mine.ends_with(".png"));

  const std::vector<std::string> gone = {make(dead, false), make(replaced(elsewhere, ".png", ".exr"), true)};
  std::vector<std::string> kept = {make(mine, true),
                                   make(elsewhere, false),
                                   make("base_color.png", true),
                                   make(".hidden", true),
                                   make(".base_color." + std::to_string(dead_process()) + "-0.png", true),
                                   make(dead.substr(1), true),
                                   make(replaced(dead, "-", "-x"), true),
                                   make(replaced(dead, "terrazzo", "travertine"), true)};
  const std::string folder_like_one = replaced(dead, ".png", ".tif");
  fs::create_directories(folder.path() / folder_like_one);
  kept.push_back(folder_like_one);
  std::sort(kept.begin(), kept.end());
  remove_abandoned(folder.path());
  CHECK(listing(folder.path()) == kept);
  remove_abandoned(folder.path() / "not there");
}

TEST_CASE("staging a file clears its folder of what killed runs left") {
  const TemporaryFolder folder;
  const fs::path target = folder.path() / "out/x.png";
  const std::string mine = temporary_beside(target).string();
  const std::string dead = replaced(mine, fmt::format("-{}-", ::getpid()), fmt::format("-{}-", dead_process()));
  fs::create_directories(target.parent_path());
  write_text(dead, "half of");
  const NodeType type;
  NodeContext node(type, {}, {}, {}, Task());
  const fs::path temporary = node.stage(target);
  CHECK_FALSE(fs::exists(dead));
  CHECK(temporary.parent_path() == target.parent_path());
  write_text(temporary, "half of");
  CHECK(node.stage(folder.path() / "out/y.png") != temporary);
  CHECK(fs::exists(temporary));
  CHECK_THROWS_WITH_AS(node.stage(temporary / "z.png"), doctest::Contains("expected a folder to write to"), Error);
}

TEST_CASE("a file that is written anew keeps its mode and owner, and links stay links") {
  const TemporaryFolder folder;
  const fs::path& at = folder.path();
  const auto status = [](const fs::path& path) {
    struct stat s {};
    REQUIRE(::stat(path.c_str(), &s) == 0);
    return s;
  };
  fs::create_directories(at / "elsewhere");
  for (const mode_t mode : {0600, 0640, 0755, 0444}) {
    write_text(at / "elsewhere/a.txt", "one");
    REQUIRE(::chmod((at / "elsewhere/a.txt").c_str(), mode) == 0);
    write_whole_file(at / "elsewhere/a.txt", "two");
    CHECK(read_text(at / "elsewhere/a.txt") == "two");
    CHECK((status(at / "elsewhere/a.txt").st_mode & 07777) == mode);
    fs::remove(at / "elsewhere/a.txt");
  }
  if (::geteuid() == 0) {
    write_text(at / "elsewhere/a.txt", "one");
    REQUIRE(::chown((at / "elsewhere/a.txt").c_str(), 65534, 65534) == 0);
    write_whole_file(at / "elsewhere/a.txt", "two");
    CHECK(status(at / "elsewhere/a.txt").st_uid == 65534);
  }
  // Relative to the link's folder, and over a second link.
  fs::create_symlink("elsewhere/second", at / "first");
  fs::create_symlink("a.txt", at / "elsewhere/second");
  write_whole_file(at / "first", "three");
  CHECK(fs::is_symlink(at / "first"));
  CHECK(fs::is_symlink(at / "elsewhere/second"));
  CHECK(read_text(at / "elsewhere/a.txt") == "three");
  // To what is not there yet.
  fs::create_symlink("elsewhere/b.txt", at / "dangling");
  write_whole_file(at / "dangling", "four");
  CHECK(fs::is_symlink(at / "dangling"));
  CHECK(read_text(at / "elsewhere/b.txt") == "four");
  fs::create_symlink("loop", at / "loop");
  CHECK_THROWS_AS(write_whole_file(at / "loop", "five"), FileError);
  CHECK(listing(at / "elsewhere") == std::vector<std::string>{"a.txt", "b.txt", "second"});
}

TEST_CASE("a whole file replaces what was there, or nothing is touched") {
  const TemporaryFolder folder;
  const fs::path at = folder.path() / "a.txt";
  write_whole_file(at, "one");
  write_whole_file(at, "two");
  CHECK(read_text(at) == "two");
  CHECK(listing(folder.path()) == std::vector<std::string>{"a.txt"});

  write_whole_file(folder.path() / "new/folder/a.txt", "three");
  CHECK(read_text(folder.path() / "new/folder/a.txt") == "three");
  fs::remove_all(folder.path() / "new");
  const std::string nowhere = (at / "a.txt").string();
  CHECK_THROWS_WITH_AS(write_whole_file(nowhere, "three"), ("cannot write " + nowhere + ": Not a directory").c_str(),
                       FileError);
  fs::create_directories(folder.path() / "full/folder");
  write_text(folder.path() / "finished", "four");
  CHECK_THROWS_AS(publish_file(folder.path() / "finished", folder.path() / "full"), FileError);
  CHECK_THROWS_AS(write_whole_file(folder.path() / "full", "five"), FileError);
  CHECK(listing(folder.path()) == std::vector<std::string>{"a.txt", "full"});
}

TEST_CASE("a pipe is written in place") {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  const File reader = File::open(pipe, O_RDWR | O_NONBLOCK);
  write_whole_file(pipe, "text");
  std::string got(8, ' ');
  CHECK(::read(reader.descriptor(), got.data(), got.size()) == 4);
  CHECK(got == "text    ");
  CHECK(listing(folder.path()) == std::vector<std::string>{"pipe"});
}
