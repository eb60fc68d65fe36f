#include "runner/plan/history.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "core/file/atomic_file.h"
#include "core/file/file_io.h"
#include "runner/cache/cache_folder.h"
#include "runner/cache/history_files.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

/// Takes the place of an ingredient's name.
constexpr std::string_view seconds_line = "seconds";

/// Smaller differences in time do not justify rewriting the file.
constexpr double notable_change = 0.25;

/// One line each: node, what, digest, shown, separated by tabs.
bool parse(const std::string& line, std::string& node, Ingredient& ingredient) {
  std::istringstream in(line);
  std::string digest;
  return std::getline(in, node, '\t') && std::getline(in, ingredient.what, '\t') && std::getline(in, digest, '\t') &&
         Digest::parse(digest, ingredient.digest) && std::getline(in, ingredient.shown);
}

std::optional<double> parse_seconds(const std::string& text) {
  double seconds = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (failure != std::errc() || !std::isfinite(seconds) || seconds < 0) return std::nullopt;
  return seconds;
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

/// The saved lines; empty if they cannot be read.
std::string lines_in(const fs::path& file) {
  try {
    const auto bytes = CacheFolder::read(file);
    if (!bytes) return "";
    return unsealed_history({reinterpret_cast<const char*>(bytes->data()), bytes->size()}).value_or("");
  } catch (const Error&) {
    return "";
  }
}

}  // namespace

History::History(const fs::path& folder, const fs::path& graph_file)
    : path_(folder / "history" / (Hasher().add(fs::weakly_canonical(graph_file).string()).digest().hex() + ".txt")) {
  CacheFolder::use(path_);
  std::istringstream in(lines_in(path_));
  std::string line;
  while (std::getline(in, line)) {
    std::string node;
    Ingredient ingredient;
    if (!parse(line, node, ingredient)) continue;
    if (ingredient.what != seconds_line)
      nodes_[node].push_back(ingredient);
    else if (const std::optional<double> seconds = parse_seconds(ingredient.shown))
      seconds_[node] = *seconds;
  }
}

std::optional<double> History::seconds(const std::string& node) const {
  const auto at = seconds_.find(node);
  return at == seconds_.end() ? std::nullopt : std::optional(at->second);
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

void History::remember(const std::string& node, const std::vector<Ingredient>& now, double seconds) {
  const auto [known, is_new] = seconds_.emplace(node, seconds);
  if (is_new || std::abs(seconds - known->second) > notable_change * known->second) {
    known->second = seconds;
    changed_ = true;
  }
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
  std::string text;
  for (const auto& [node, ingredients] : nodes_)
    for (const Ingredient& i : ingredients)
      text +=
          fmt::format("{}\t{}\t{}\t{}\n", on_one_line(node), on_one_line(i.what), i.digest.hex(), on_one_line(i.shown));
  for (const auto& [node, seconds] : seconds_)
    text += fmt::format("{}\t{}\t{}\t{:.3g}\n", on_one_line(node), seconds_line, Digest().hex(), seconds);
  try {
    std::error_code failure;
    fs::create_directories(path_.parent_path(), failure);
    // Never in place: opening a pipe would block.
    write_whole_file(path_, sealed_history(text), temporary_beside(path_));
  } catch (const FileError&) {
    // Without it, plans cannot say what has changed since.
  }
}

}  // namespace terrazzo
