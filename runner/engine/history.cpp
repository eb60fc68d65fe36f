#include "runner/engine/history.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "core/file/atomic_file.h"
#include "core/file/file_io.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view first_line = "terrazzo history 1";

/// One line each: node, what, digest, shown, separated by tabs.
bool parse(const std::string& line, std::string& node, Ingredient& ingredient) {
  std::istringstream in(line);
  std::string digest;
  return std::getline(in, node, '\t') && std::getline(in, ingredient.what, '\t') && std::getline(in, digest, '\t') &&
         Digest::parse(digest, ingredient.digest) && std::getline(in, ingredient.shown);
}

std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return text;
}

const Ingredient* find(const std::vector<Ingredient>& all, const std::string& what) {
  const auto at = std::find_if(all.begin(), all.end(), [&](const Ingredient& i) { return i.what == what; });
  return at == all.end() ? nullptr : &*at;
}

std::string difference(const Ingredient& before, const Ingredient& now) {
  if (now.what.starts_with("input ")) return fmt::format("its {} ({}) changed", now.what, now.shown);
  if (now.what.starts_with("file ")) return fmt::format("the content of {} changed", now.shown);
  if (now.what == "type") return fmt::format("the node was {}, now it is {}", before.shown, now.shown);
  return fmt::format("{} changed from {} to {}", now.what, before.shown, now.shown);
}

}  // namespace

History::History(const fs::path& folder, const fs::path& graph_file)
    : path_(folder / "history" / (Hasher().add(fs::weakly_canonical(graph_file).string()).digest().hex() + ".txt")) {
  std::ifstream in(path_);
  std::string line;
  if (!std::getline(in, line) || line != first_line) return;
  while (std::getline(in, line)) {
    std::string node;
    Ingredient ingredient;
    if (parse(line, node, ingredient)) nodes_[node].push_back(ingredient);
  }
}

std::string History::first_difference(const std::string& node, const std::vector<Ingredient>& now) const {
  const auto at = nodes_.find(node);
  if (at == nodes_.end()) return "";
  for (const Ingredient& i : now) {
    const Ingredient* before = find(at->second, i.what);
    if (!before) return fmt::format("{} ({}) is new", i.what, i.shown);
    if (before->digest != i.digest) return difference(*before, i);
  }
  for (const Ingredient& before : at->second)
    if (!find(now, before.what)) return fmt::format("{} ({}) is gone", before.what, before.shown);
  return "";
}

void History::remember(const std::string& node, const std::vector<Ingredient>& now) {
  std::vector<Ingredient>& before = nodes_[node];
  const auto same = [](const Ingredient& a, const Ingredient& b) { return a.what == b.what && a.digest == b.digest; };
  if (std::equal(before.begin(), before.end(), now.begin(), now.end(), same)) return;
  before = now;
  changed_ = true;
}

void History::save() const {
  if (!changed_) return;
  std::error_code failure;
  fs::create_directories(path_.parent_path(), failure);
  std::string text = fmt::format("{}\n", first_line);
  for (const auto& [node, ingredients] : nodes_)
    for (const Ingredient& i : ingredients)
      text +=
          fmt::format("{}\t{}\t{}\t{}\n", on_one_line(node), on_one_line(i.what), i.digest.hex(), on_one_line(i.shown));
  try {
    write_whole_file(path_, text);
  } catch (const FileError&) {
    // Without it, plans cannot say what has changed since.
  }
}

}  // namespace terrazzo
