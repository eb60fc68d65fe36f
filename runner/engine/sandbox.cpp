#include "runner/engine/sandbox.h"

#include <algorithm>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "core/file/path_relation.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// Resolves links in the existing part of a path. Nullopt if a link is dangling, since its target may be anything
/// later.
std::optional<fs::path> resolved(const fs::path& path) {
  std::error_code failure;
  const fs::path whole = fs::absolute(path, failure);
  fs::path prefix;
  for (const fs::path& part : whole) {
    prefix /= part;
    if (fs::is_symlink(fs::symlink_status(prefix, failure)) && !fs::exists(prefix, failure)) return std::nullopt;
  }
  const fs::path out = fs::weakly_canonical(whole, failure);
  return failure ? std::nullopt : std::optional(out);
}

/// The folder above the first part of a name that has one of these characters.
fs::path in_front_of(const fs::path& path, const char* characters) {
  fs::path out;
  for (const fs::path& part : path) {
    if (part.native().find_first_of(characters) != std::string::npos) break;
    out /= part;
  }
  return out;
}

/// The part before placeholders: "out" for "out/{map}.png".
fs::path fixed_part(const fs::path& path) {
  return in_front_of(path, "{");
}

}  // namespace

Sandbox::Sandbox(fs::path folder)
    : Sandbox(
          std::move(folder),
          "give it to a parameter of type path with --set (a text opens nothing), or choose a place in the sandbox") {}

Sandbox::Sandbox(fs::path folder, std::string advice) : given_(std::move(folder)), advice_(std::move(advice)) {
  open(given_);
}

void Sandbox::open(const fs::path& path) {
  std::error_code missing;
  const bool is_pattern = !fs::exists(path, missing) && path.native().find_first_of("*?[") != std::string::npos;
  std::optional<fs::path> root = resolved(is_pattern ? in_front_of(path, "*?[") : fixed_part(path));
  if (!root) return;
  if (!root->has_filename()) *root = root->parent_path();
  roots_.push_back(std::move(*root));
}

void Sandbox::open_to_read(const fs::path& path) {
  if (std::optional<fs::path> root = resolved(path)) readable_.push_back(std::move(*root));
}

std::string Sandbox::trouble_with(std::string_view verb, const fs::path& path) const {
  const std::optional<fs::path> place = resolved(path);
  const auto holds_it = [&](const fs::path& root) { return lies_in(root, *place); };
  if (place && (std::ranges::any_of(roots_, holds_it) || (verb == "read" && std::ranges::any_of(readable_, holds_it))))
    return "";
  const std::string leads = !place           ? " (a link that leads nowhere)"
                            : *place != path ? fmt::format(" (a link to {})", place->string())
                                             : "";
  return fmt::format("may not {} {}{}: it is outside the sandbox {}; {}", verb, path.string(), leads, given_.string(),
                     advice_);
}

void Sandbox::check(const char* verb, const fs::path& path) const {
  if (const std::string trouble = trouble_with(verb, path); !trouble.empty()) throw Error(trouble);
}

std::vector<Problem> sandbox_problems(const std::vector<GraphNode>& nodes, const Sandbox& sandbox) {
  std::vector<Problem> problems;
  for (const GraphNode& node : nodes) {
    std::set<std::string> said;
    const auto look_at = [&](const std::string& about, const char* verb, const fs::path& path) {
      const std::string trouble = sandbox.trouble_with(verb, path);
      if (!trouble.empty() && said.insert(trouble).second) problems.push_back(problem_of(node, about, trouble));
    };
    for (const Param& p : node.type->params) {
      const auto value = node.params.find(p.name);
      if (p.type != ParamType::path || value == node.params.end()) continue;
      const fs::path path = std::get<std::string>(value->second);
      if (!path.empty()) look_at(p.name, node.type->is_sink() ? "write" : "read", fixed_part(path));
    }
    if (!said.empty() || !node.type->files_read) continue;
    for (const fs::path& file : node.type->files_read(node.params)) look_at("", "read", file);
  }
  return problems;
}

}  // namespace terrazzo
