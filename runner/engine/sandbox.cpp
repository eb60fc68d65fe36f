#include "runner/engine/sandbox.h"

#include <algorithm>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// Where a path leads, as far as it is there. None if a link in it leads nowhere: that place may come to be anywhere.
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

/// The folder above the first part of a name that is made up only later: "out" of "out/{map}.png".
fs::path fixed_part(const fs::path& path) {
  fs::path out;
  for (const fs::path& part : path) {
    if (part.native().find('{') != std::string::npos) break;
    out /= part;
  }
  return out;
}

std::vector<fs::path> paths_in(const ParamValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return {*text};
  return {};
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
      for (const fs::path& path : paths_in(value->second))
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

Sandbox::Sandbox(fs::path folder, std::vector<fs::path> named) : given_(std::move(folder)) {
  named.push_back(given_);
  for (const fs::path& path : named)
    if (std::optional<fs::path> root = resolved(fixed_part(path))) {
      if (!root->has_filename()) *root = root->parent_path();
      roots_.push_back(std::move(*root));
    }
}

bool Sandbox::allows(const fs::path& path) const {
  const std::optional<fs::path> place = resolved(path);
  return place && std::any_of(roots_.begin(), roots_.end(), [&](const fs::path& r) { return is_within(*place, r); });
}

std::string Sandbox::trouble_with(const char* verb, const fs::path& path) const {
  if (allows(path)) return "";
  const std::optional<fs::path> place = resolved(path);
  const std::string leads = !place           ? " (a link that leads nowhere)"
                            : *place != path ? fmt::format(" (a link to {})", place->string())
                                             : "";
  return fmt::format(
      "may not {} {}{}: it lies outside of the sandbox {}; name it on the command line with --set, or "
      "choose a place in the sandbox",
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

std::vector<fs::path> named_paths(const Graph& graph, const std::vector<std::string>& values) {
  std::vector<fs::path> out;
  for (const std::string& text : values) {
    const size_t sign = text.find('=');
    if (sign == std::string::npos) continue;
    const std::string name = text.substr(0, sign);
    std::error_code failure;
    const fs::path path = fs::absolute(text.substr(sign + 1), failure).lexically_normal();
    // Values of path parameters have been made absolute; other texts are as they were given.
    const auto is_it = [&](const ParamValue& value) {
      const auto* given = std::get_if<std::string>(&value);
      return given && fs::path(*given).is_absolute() && fs::path(*given).lexically_normal() == path;
    };
    bool found = std::any_of(graph.settings.begin(), graph.settings.end(),
                             [&](const GraphSetting& s) { return s.name == name && is_it(s.value); });
    const size_t dot = name.rfind('.');
    for (const GraphNode& n : graph.nodes)
      if (dot != std::string::npos && stands_for(name.substr(0, dot), n.name))
        if (const auto p = n.params.find(name.substr(dot + 1)); p != n.params.end()) found |= is_it(p->second);
    if (found) out.push_back(path);
  }
  return out;
}

}  // namespace terrazzo
