#include "runner/plan/preflight.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <sys/stat.h>

#include "core/base/paths.h"
#include "core/file/atomic_file.h"
#include "core/image/image_limits.h"
#include "core/image_io/image_file.h"
#include "graphs/document/forecasts.h"
#include "runner/plan/memory_advice.h"
#include "runner/plan/plan_shapes.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// A node's name without loop labels: "all/files" for "all[sand]/files".
std::string without_iterations(const std::string& node) {
  std::string out;
  int depth = 0;
  for (const char c : node) {
    depth += c == '[';
    if (depth == 0) out += c;
    depth -= c == ']';
  }
  return out;
}

/// Whether two nodes are iterations of the same node in a loop.
bool are_iterations(const std::string& a, const std::string& b) {
  return a != b && without_iterations(a) == without_iterations(b);
}

/// Identifies a file independently of links.
using FileIdentity = std::pair<dev_t, ino_t>;

std::optional<FileIdentity> identity_of(const fs::path& path) {
  struct stat status;
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return FileIdentity(status.st_dev, status.st_ino);
}

class PreflightChecker {
 public:
  PreflightChecker() = default;
  explicit PreflightChecker(const Graph& graph) {
    note_source(graph.file, "it is the graph file");
    for (const fs::path& path : graph.made_from) note_source(path, "the graph is made from it");
  }

  struct PendingNode {
    const GraphNode* node = nullptr;
    bool writes = false;    ///< it will write its files
    bool computes = false;  ///< its results will be computed
  };
  /// Nodes in the order of their wires.
  PreflightProblems look(const std::vector<PendingNode>& nodes) {
    for (const PendingNode& pending : nodes) note_sources(*pending.node);
    for (const PendingNode& pending : nodes) look_at(pending);
    if (memory_problem_) problems_.of_run.push_back(std::move(*memory_problem_));
    return std::move(problems_);
  }
  const Forecasts& forecasts() const { return forecasts_; }

 private:
  void note_sources(const GraphNode& node) {
    if (!node.type->files_read) return;
    for (const fs::path& file : node.type->files_read(node.params))
      note_source(file, fmt::format("the node \"{}\" reads it", node.name));
  }

  void note_source(const fs::path& file, const std::string& why) {
    if (const std::optional<FileIdentity> identity = identity_of(file)) sources_.emplace(*identity, why);
  }

  /// A result must never overwrite its own source.
  std::string read_by_others(const fs::path& path) const {
    const std::optional<FileIdentity> identity = identity_of(path);
    const auto source = identity ? sources_.find(*identity) : sources_.end();
    if (source == sources_.end()) return {};
    return fmt::format("{} would be overwritten, but {}; write to another folder", path.string(), source->second);
  }

  void look_at(const PendingNode& pending) {
    const GraphNode& node = *pending.node;
    try {
      const Forecast* forecast = forecasts_.add(node);
      if (forecast && pending.writes) check_files(node, forecast->files);
      if (pending.computes) check_memory(node);
    } catch (const Errors& all) {
      for (const Error& e : all.all()) complain(node, e);
    } catch (const Error& e) {
      complain(node, e);
    }
  }

  /// The budget also limits nodes that cannot work in parts; this is reported before the run rather than by running out
  /// of memory. Only the node that takes most is reported.
  void check_memory(const GraphNode& node) {
    if (!memory_budget_is_set() || !node.type->memory_ahead) return;
    const InputForecasts inputs = forecasts_.inputs_of(node);
    const uint64_t least = node.type->memory_ahead(node.params, inputs);
    if (least <= memory_budget() || least <= most_memory_) return;
    most_memory_ = least;
    memory_problem_ = problem_of(node, "", memory_advice(*node.type, node.params, inputs, least, memory_budget()));
  }

  void complain(const GraphNode& node, const Error& e) {
    // All readers of a wire may report the same problem; only the first is kept.
    const auto wires = node.inputs.find(e.about());
    if (wires == node.inputs.end() || said_.emplace(wires->second, e.what()).second)
      problems_.of_nodes.push_back(problem_of(node, e.about(), e.what()));
  }

  /// A path cannot be both a file and a folder of other files.
  std::string folder_and_file(const fs::path& path) const {
    const fs::path place = place_of_file(path);
    for (fs::path above = place.parent_path(); above.has_relative_path(); above = above.parent_path())
      if (const auto writer = writers_.find(above); writer != writers_.end())
        return fmt::format(
            "{} would be both a file, which the node \"{}\" writes, and a folder, for {}; rename one of them",
            above.string(), writer->second.node, path.string());
    const auto below = writers_.upper_bound(place);
    if (below == writers_.end() ||
        std::mismatch(place.begin(), place.end(), below->first.begin(), below->first.end()).first != place.end())
      return {};
    return fmt::format("{} would be both a file and a folder, for {}, which the node \"{}\" writes; rename one of them",
                       path.string(), below->second.path.string(), below->second.node);
  }

  void check_files(const GraphNode& node, const std::vector<FutureFile>& files) {
    std::set<std::string> said;
    for (const FutureFile& f : files) {
      std::string trouble = why_not_writable(f.folder, f.name);
      const fs::path path = (f.folder / f.name).lexically_normal();
      if (trouble.empty() && !f.name.empty()) trouble = read_by_others(path);
      if (trouble.empty()) trouble = folder_and_file(path);
      if (trouble.empty() && !f.name.empty()) {
        const auto [at, is_new] = writers_.emplace(place_of_file(path), Writer{node.name, f.what, path});
        const Writer& writer = at->second;
        if (!is_new)
          trouble = fmt::format("{} would be written twice, {}{}{}", path.string(),
                                writer.node != node.name ? fmt::format("here and by the node \"{}\"", writer.node)
                                                         : fmt::format("for {} and for {}", writer.what, f.what),
                                writer.path != path ? fmt::format(" ({} is the same file)", writer.path.string()) : "",
                                are_iterations(node.name, writer.node)
                                    ? "; let the path tell the iterations of the loop apart, by its variable, as "
                                      "\"$out/$scan_name\" does in a loop \"as\": \"scan\""
                                    : "");
      }
      if (!trouble.empty() && said.insert(trouble).second)
        problems_.of_run.push_back(problem_of(node, f.param, trouble));
    }
  }

  struct Writer {
    std::string node, what;
    fs::path path;  ///< as it names the file
  };

  Forecasts forecasts_;
  std::map<FileIdentity, std::string> sources_;  ///< why each must not be overwritten
  std::map<fs::path, Writer> writers_;           ///< by place_of_file
  std::set<std::pair<std::vector<Wire>, std::string>> said_;
  PreflightProblems problems_;
  uint64_t most_memory_ = 0;
  std::optional<Problem> memory_problem_;
};

}  // namespace

std::vector<Problem> oversize_problems(const Plan& plan) {
  std::vector<Problem> problems;
  std::set<fs::path> said;
  for (const Stage& s : plan.stages) {
    if (!s.needed || !s.type().files_read) continue;
    for (const fs::path& file : s.type().files_read(s.node->params)) try {
        std::error_code missing;
        const uintmax_t bytes = looks_like_image(file) ? fs::file_size(file, missing) : 0;
        if (!missing) require_bytes_fit(file, bytes);
      } catch (const TooManyPixels& e) {
        if (said.insert(file).second) problems.push_back(problem_of(*s.node, "path", e.what()));
      }
  }
  return problems;
}

namespace {

/// Whether each stage will be computed: stages that run, and derived stages that they read.
std::vector<bool> computed_stages(const Plan& plan) {
  std::vector<bool> computes(plan.stages.size());
  for (size_t i = plan.stages.size(); i-- > 0;) {
    const Stage& s = plan.stages[i];
    computes[i] = s.state == StageState::run || s.state == StageState::depends;
    if (s.state == StageState::derived)
      computes[i] = std::ranges::any_of(s.readers, [&](int reader) { return computes[size_t(reader)]; });
  }
  return computes;
}

}  // namespace

PreflightProblems preflight_problems(Plan& plan) {
  const std::vector<bool> computes = computed_stages(plan);
  std::vector<PreflightChecker::PendingNode> nodes;
  for (size_t i = 0; i < plan.stages.size(); i++)
    if (const Stage& s = plan.stages[i]; s.needed)
      nodes.push_back({s.node, s.state != StageState::up_to_date, computes[i]});
  PreflightChecker checker(*plan.graph);
  PreflightProblems problems = checker.look(nodes);
  for (Stage& s : plan.stages) s.shape = shape_of(*s.node, checker.forecasts());
  return problems;
}

namespace {

/// "out/*.png" for the parameter value "out/{map}.png".
std::string pattern_of(const std::string& text) {
  std::string out;
  for (size_t i = 0; i < text.size(); i++) {
    const size_t end = text[i] == '{' ? text.find('}', i) : text.npos;
    out += end == text.npos ? text[i] : '*';
    if (end != text.npos) i = end;
  }
  return out;
}

FileToWrite file_to_write(const GraphNode& node, const FutureFile& file) {
  if (!file.name.empty()) return {file.folder / file.name, false, node.name};
  const auto param = node.params.find(file.param);
  const std::string* text = param == node.params.end() ? nullptr : std::get_if<std::string>(&param->second);
  return {text ? pattern_of(*text) : std::string(), true, node.name};
}

}  // namespace

std::vector<FileToWrite> files_to_write(const Plan& plan) {
  std::vector<FileToWrite> out;
  Forecasts forecasts;
  for (const Stage& s : plan.stages) {
    if (!s.needed) continue;
    if (s.known && s.known->record)
      for (const OutputFile& f : s.known->record->files) out.push_back({f.path, false, s.node->name});
    try {
      if (const Forecast* forecast = forecasts.add(*s.node))
        for (const FutureFile& f : forecast->files) out.push_back(file_to_write(*s.node, f));
    } catch (const Error&) {
      // This is one of its faults; the node writes nothing.
    }
  }
  return out;
}

std::vector<Problem> preflight_of_nodes(const std::vector<GraphNode>& nodes) {
  std::vector<PreflightChecker::PendingNode> all;
  for (const GraphNode& n : nodes) all.push_back({&n, true, false});
  PreflightProblems problems = PreflightChecker().look(all);
  std::ranges::move(problems.of_run, std::back_inserter(problems.of_nodes));
  return std::move(problems.of_nodes);
}

namespace {

/// Whether a node of a type reads this one.
bool is_read_by(const Graph& graph, const GraphNode& node, std::string_view type) {
  return std::ranges::any_of(graph.nodes, [&](const GraphNode& reader) {
    return reader.type->name == type && std::ranges::any_of(reader.inputs, [&](const auto& port) {
             return std::ranges::any_of(port.second, [&](const auto& wire) { return wire.node == node.name; });
           });
  });
}

}  // namespace

std::vector<Problem> lint_of(const Graph& graph, const Task& task) {
  const CurrentTask working(task);
  std::vector<Problem> out;
  Forecasts forecasts;
  for (const GraphNode& node : graph.nodes) {
    if (node.is_open) continue;
    task.check();
    try {
      forecasts.add(node);
    } catch (const Error&) {
      continue;  // has been reported as a problem
    }
    if (!node.type->lint) continue;
    Lints lints;
    try {
      lints = node.type->lint(node.params, forecasts.inputs_of(node));
    } catch (const Error& e) {
      lints = {{e.what()}};
    }
    for (const auto& [message, answered_by] : lints) {
      if (is_read_by(graph, node, answered_by)) continue;
      // The place of the quoted parameter or port at the beginning of the message.
      const size_t end = message.find('"', 1);
      const bool is_about = message.starts_with('"') && end != message.npos;
      out.push_back(problem_of(node, "", message));
      out.back().place = node.place_of(is_about ? message.substr(1, end - 1) : "");
    }
  }
  set_code(out, 0, "doubt");
  return out;
}

}  // namespace terrazzo
