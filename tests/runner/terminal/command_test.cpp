#include "runner/terminal/command.h"

#include <algorithm>
#include <memory>

#include <doctest/doctest.h>

using namespace terrazzo;
using Words = std::vector<std::string>;

namespace {

struct CommandTargets {
  std::string out, wraps;
  Words set;
  int threads = 0;
  bool force = false;
};

/// A program with one command that has options of every kind.
Command program_for(CommandTargets& to) {
  Command program("tool", "does things");
  Command& make = program.add_command("make", "makes one");
  make.add_option("SOURCE", &to.set, "what of").required().takes("FILE");
  make.add_option("-o,--out", &to.out, "where").takes("DIR");
  make.add_option("--threads", &to.threads, "how many").from_to(1, 8).not_with("--out");
  make.add_flag("--wraps", &to.wraps, "which way").implies("xy");
  make.add_flag("--force", &to.force, "replaces").only_with("--out");
  make.run = [] { return 7; };
  return program;
}

ParsedWords parsed(Command& program, const Words& words) {
  std::vector<const char*> argv = {"tool"};
  for (const std::string& w : words) argv.push_back(w.c_str());
  return parse_words(program, "1.0", int(argv.size()), argv.data());
}

}  // namespace

TEST_CASE("words go where a command's options say, and are kept as given") {
  CommandTargets to;
  Command program = program_for(to);
  const ParsedWords out = parsed(program, {"make", "a", "b", "-o", "there", "--wraps", "--force"});
  REQUIRE(out.request == ParsedWords::Request::run);
  CHECK(out.command->path == "tool make");
  CHECK(out.command->run() == 7);
  CHECK(to.set == Words{"a", "b"});
  CHECK(to.out == "there");
  CHECK(to.wraps == "xy");
  CHECK(to.force);
  CHECK(out.command->find_option("-o")->given == Words{"there"});
  CHECK(out.command->find_option("SOURCE")->given == Words{"a", "b"});
  CHECK(out.command->find_option("--size") == nullptr);
}

TEST_CASE("what is wrong with words is said, and of which command") {
  using Request = ParsedWords::Request;
  CommandTargets to;
  const auto wrong = [&](const Words& words) {
    Command program = program_for(to);
    const ParsedWords out = parsed(program, words);
    CHECK(out.request == Request::nothing_known);
    return out.text;
  };
  CHECK(wrong({}) == "A command is required");
  CHECK(wrong({"make"}) == "SOURCE is required");
  CHECK(wrong({"make", "a", "--threads", "9"}) == "--threads: Value 9 not in range 1 to 8");
  CHECK(wrong({"make", "a", "--force"}) == "--force requires --out");
  CHECK(wrong({"make", "a", "--threads", "2", "-o", "b"}) == "--out excludes --threads");

  Command program = program_for(to);
  const ParsedWords unknown = parsed(program, {"make", "a", "--sise", "3"});
  CHECK(unknown.request == Request::nothing_known);
  CHECK(unknown.unknown.front() == "--sise");
  CHECK(unknown.command->option_names() == Words{"-h", "--help", "-o", "--out", "--threads", "--wraps", "--force"});
}

TEST_CASE("help is that of the command named, whatever else is missing") {
  CommandTargets to;
  Command program = program_for(to);
  const ParsedWords out = parsed(program, {"make", "--help"});
  CHECK(out.request == ParsedWords::Request::help);
  CHECK(out.command->name() == "make");
  CHECK(out.text.find("-o,--out DIR") != std::string::npos);
}

TEST_CASE("help and messages name options in their order, wherever in memory these lie") {
  // Free blocks of every size, which malloc gives out again from the highest address to the lowest.
  constexpr size_t sizes = 128, of_each = 7;
  std::vector<std::unique_ptr<char[]>> blocks;
  for (size_t i = 0; i < of_each; ++i)
    for (size_t size = 1; size <= sizes; ++size) blocks.push_back(std::make_unique<char[]>(size * 16));
  std::ranges::sort(blocks, {}, [](const auto& block) { return uintptr_t(block.get()); });
  for (auto& b : blocks) b.reset();

  bool a = false, b = false, c = false, all = false;
  Command program("tool", "A tool");
  Command& make = program.add_command("make", "Makes");
  make.add_flag("--a", &a, "A");
  make.add_flag("--b", &b, "B");
  make.add_flag("--c", &c, "C");
  make.add_flag("--all", &all, "All").not_with("--c").not_with("--a").not_with("--b");
  make.run = [] { return 0; };
  CHECK(parsed(program, {"make", "--help"}).text.find("--all Excludes: --a --b --c") != std::string::npos);
  CHECK(parsed(program, {"make", "--help"}).text.find("--b Excludes: --all") != std::string::npos);
  CHECK(parsed(program, {"make", "--all", "--c", "--b"}).text == "--b excludes --all");
}
