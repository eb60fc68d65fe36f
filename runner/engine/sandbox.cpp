#include "runner/engine/sandbox.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

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

bool is_within(const fs::path& path, const fs::path& root) {
  return std::mismatch(root.begin(), root.end(), path.begin(), path.end()).first == root.end();
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

class SandboxCheck {
 public:
  explicit SandboxCheck(const Sandbox& sandbox) : sandbox_(sandbox) {}

  void look_at(const GraphNode& node) {
    said_.clear();
    const char* verb = node.type->is_sink() ? "write" : "read";
    for (const Param& p : node.type->params) {
      const auto value = node.params.find(p.name);
      if (p.type != ParamType::path || value == node.params.end()) continue;
      const fs::path path = std::get<std::string>(value->second);
      if (!path.empty()) complain(node, p.name, sandbox_.trouble_with(verb, fixed_part(path)));
    }
    if (!said_.empty() || !node.type->files_read) return;
    for (const fs::path& file : node.type->files_read(node.params))
      complain(node, "", sandbox_.trouble_with("read", file));
  }

  std::vector<Problem> take() { return std::move(problems_); }

 private:
  void complain(const GraphNode& node, const std::string& about, const std::string& trouble) {
    if (!trouble.empty() && said_.insert(trouble).second) problems_.push_back(problem_of(node, about, trouble));
  }

  const Sandbox& sandbox_;
  std::set<std::string> said_;  ///< of one node
  std::vector<Problem> problems_;
};

}  // namespace

Sandbox::Sandbox(fs::path folder) : given_(std::move(folder)) {
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

bool Sandbox::allows(const fs::path& path) const {
  const std::optional<fs::path> place = resolved(path);
  return place && std::any_of(roots_.begin(), roots_.end(), [&](const fs::path& r) { return is_within(*place, r); });
}

std::string Sandbox::trouble_with(const char* verb, const fs::path& path) const {
  if (allows(path)) return "";
  const std::optional<fs::path> place = resolved(path);
  const auto holds_it = [&](const fs::path& root) { return is_within(*place, root); };
  if (place && std::string_view(verb) == "read" && std::ranges::any_of(readable_, holds_it)) return "";
  const std::string leads = !place           ? " (a link that leads nowhere)"
                            : *place != path ? fmt::format(" (a link to {})", place->string())
                                             : "";
  return fmt::format(
      "may not {} {}{}: it is outside the sandbox {}; give it to a parameter of type path with --set (a text opens "
      "nothing), or choose a place in the sandbox",
      verb, path.string(), leads, given_.string());
}

void Sandbox::check(const char* verb, const fs::path& path) const {
  if (const std::string trouble = trouble_with(verb, path); !trouble.empty()) throw Error(trouble);
}

std::vector<Problem> sandbox_problems(const std::vector<GraphNode>& nodes, const Sandbox& sandbox) {
  SandboxCheck check(sandbox);
  for (const GraphNode& n : nodes) check.look_at(n);
  return check.take();
}

}  // namespace terrazzo
