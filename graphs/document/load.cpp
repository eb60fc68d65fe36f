#include "graphs/document/load.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/base/paths.h"
#include "core/base/suggest.h"
#include "graphs/document/file_origins.h"
#include "graphs/document/forecasts.h"
#include "graphs/document/left_out.h"
#include "graphs/document/levels.h"
#include "graphs/document/member_overrides.h"
#include "graphs/document/pack_settings.h"
#include "graphs/document/unused.h"
#include "graphs/document/wires.h"
#include "graphs/text/given_inputs.h"
#include "graphs/text/read_document.h"
#include "graphs/values/convert.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

fs::path working_folder() {
  std::error_code failure;
  const fs::path folder = fs::current_path(failure);
  return failure ? fs::path("/") : folder;
}

/// Loads a document. Collects all problems; `finish` throws them.
class Loader {
 public:
  Loader(std::string_view text, const fs::path& path, const LoadOptions& options)
      : file_(path.string()),
        path_(working_folder() / path),
        folder_(path_.parent_path()),
        types_(options.types),
        subgraphs_(types_, options.migrations, problems_),
        levels_(subgraphs_, types_, problems_) {
    for (const auto& [name, type] : options.inputs) types_.types.emplace(type->name, type);
    ParsedJson parsed = parse_json(text);
    problems_ = std::move(parsed.problems);
    const bool is_read = parsed.value && migrate(*parsed.value, options.migrations, problems_);
    coded("syntax");
    if (!is_read) finish();
    document_ = std::move(*parsed.value);
    for (const JsonMember& m : document_.members)
      if (std::ranges::find(document_keys(), m.name) == document_keys().end())
        problems_.push_back(
            {m.place, "", fmt::format("unknown key {}{}", in_quotes(m.name), suggestion(m.name, document_keys()))});
    given_ = give_inputs(document_, options.inputs);
  }

  void finish() {
    if (!problems_.empty()) throw GraphError(file_, std::move(problems_));
  }

  /// Sets the code of all problems since the last call.
  void coded(const char* code) {
    set_code(problems_, coded_, code);
    coded_ = problems_.size();
  }

  GraphInterface interface() {
    main_ = &subgraphs_.read_main(document_, path_);
    GraphInterface out{main_->summary, main_->help, main_->parameters, {}, main_->inputs, {}};
    for (const GraphOutput& o : main_->outputs) out.outputs.push_back(o.port);
    if (const JsonValue* v = document_.find("presets")) out.presets = read_presets(*v, folder_, "", true, problems_);
    for (Preset& p : presets_beside(file_, problems_)) out.presets.push_back(std::move(p));
    return out;
  }

  LoadedGraph graph(const std::vector<Override>& given, const LoadOptions& options) {
    LoadedGraph out;
    GraphInterface head = interface();
    out.graph.file = file_;
    out.graph.summary = std::move(head.summary);
    out.help = std::move(head.help);
    out.presets = std::move(head.presets);
    out.inputs = std::move(head.inputs);

    coded("document");
    std::vector<Override> overrides = all_overrides(out.presets, given, options);
    auto owned = std::make_unique<Level>();
    Level& root = *owned;
    root.graph = main_;
    root.names.parameters = std::move(head.parameters);
    std::vector<GraphParameter>& parameters = root.names.parameters;
    merge_members(overrides, parameters, main_->sources, problems_);
    set_parameters(parameters, overrides, main_->sources, problems_);
    coded("override");
    root.names.scope = std::make_unique<GraphScope>(parameters, main_->sources, "", problems_);
    root.names.scope->evaluate_parameters();
    coded("document");
    root.names.substitution = std::make_unique<Substitution>(*root.names.scope);
    levels_.read(std::move(owned), overrides);
    coded("node");
    if (levels_.is_full()) finish();  // further checks would process everything read so far
    std::vector<Problem> conversions;
    for (const std::unique_ptr<Level>& level : levels_.all()) check_wires(*level, problems_, conversions);
    connect(levels_, problems_);
    coded("wire");
    Drafts& drafts = levels_.nodes();
    for (NodeDraft& d : drafts) resolve_queried_nodes(d);
    for (NodeDraft& d : levels_.others()) resolve_queried_nodes(d);
    const std::vector<size_t> order = execution_order(drafts, problems_);
    coded("cycle");
    read_deferred(order, root);
    const std::set<std::string> wanted = wanted_nodes(drafts, options.only);
    const bool is_part = options.keep_going ? !of_sources_.empty() : report_sources(asked_too(drafts, wanted));
    coded("parameter");
    if (!options.allow_unset) require_set(parameters, out.inputs, wanted);
    coded("unset");
    trace_files(drafts, order);
    if (options.traces || !options.pack.empty()) trace_settables(drafts);
    if (!options.pack.empty() && !options.allow_unset)
      for (Problem& p : writes_elsewhere(drafts, without_trailing_slash(folder_), given_to_pack_))
        problems_.push_back(std::move(p));
    coded("parameter");
    if (!problems_.empty() && options.look_ahead)
      for (Problem& p : options.look_ahead(faultless(order))) problems_.push_back(std::move(p));
    coded("input");
    finish();

    set_code(conversions, 0, "conversion");
    out.conversions = std::move(conversions);
    out.warnings = warnings_about(levels_, subgraphs_, root, order);
    // A pack's settings for its inputs replace parameters that nodes use.
    if (!options.pack.empty())
      std::erase_if(out.warnings, [](const Problem& p) { return p.code == "unused-parameter"; });
    const std::set<std::string> left = options.keep_going ? without_faulty(order, wanted) : wanted;
    const bool complete = std::ranges::all_of(drafts, [](const NodeDraft& d) { return d.unset.empty(); });
    for (const size_t i : order)
      if ((!is_part && (complete || options.allow_unset)) || left.contains(drafts[i].node.name)) {
        drafts[i].node.is_open = !drafts[i].unset.empty();
        if (options.traces) out.set_by.emplace(drafts[i].node.name, std::move(drafts[i].set_by));
        out.graph.nodes.push_back(std::move(drafts[i].node));
      }
    out.graph.made_from = subgraphs_.files();
    // A new file changes its folder's modification time.
    for (const LoopSource& l : levels_.made_from())
      out.graph.made_from.push_back(l.kind == "table" ? l.path : l.path.parent_path());
    out.loops = levels_.made_from();
    out.given = given_;
    out.graph.settings = settings_of(parameters);
    out.parameters = std::move(parameters);
    return out;
  }

 private:
  /// In order of precedence: command line, settings files, presets.
  std::vector<Override> all_overrides(const std::vector<Preset>& presets, const std::vector<Override>& given,
                                      const LoadOptions& options) {
    std::vector<Override> out = chosen_presets(presets, options.presets, problems_);
    const auto of_presets = ptrdiff_t(out.size());
    const auto add = [&](std::vector<Override> more) {
      out.insert(out.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    };
    for (const fs::path& file : options.settings) add(read_settings(file, problems_));
    for (size_t i = 0; i < given.size(); i++) {
      Override o = given[i];
      o.position = i;
      if (o.base.empty()) o.base = working_folder();
      if (!o.name.empty())
        out.push_back(std::move(o));
      else
        o.diagnostics(problems_).add({}, "expected name=value for a graph's parameter, or node.parameter=value");
    }
    if (!options.pack.empty()) {
      given_to_pack_.assign(out.begin() + of_presets, out.end());
      std::vector<Override> packed = pack_settings(options.pack, out, problems_);
      std::swap(out, packed);
      add(std::move(packed));
    }
    std::vector<const Preset*> others;
    for (const Preset& p : presets)
      if (std::ranges::find(options.presets, p.name) == options.presets.end()) others.push_back(&p);
    check_targets(others, main_->parameters, main_->sources, problems_);
    return out;
  }

  /// The source of results that an expression queries, resolved through inputs and subgraphs.
  WireSources sources_behind(const std::string& asked) const {
    const size_t name = asked.rfind('/') + 1;  // 0 if there is none
    const Level* level = levels_.find(asked.substr(0, name));
    std::vector<Problem> ignored;
    Diagnostics diagnostics(ignored, "");
    return level ? sources_of(*level, {asked.substr(name), "", {}, ""}, diagnostics) : WireSources{};
  }

  /// The node whose results an expression queries. Throws Error if there is not exactly one.
  std::string node_behind(const std::string& asked) const {
    const WireSources found = sources_behind(asked);
    if (found.wires.size() > 1)
      throw Error(fmt::format("\"{}\" is a loop, of {} iterations", asked, found.wires.size()));
    if (found.wires.empty()) throw Error(fmt::format("nothing comes into \"{}\"", asked));
    return found.wires.front().node;
  }

  /// Replaces the names in a node's queries by those of the resolved nodes.
  void resolve_queried_nodes(NodeDraft& draft) const {
    std::set<std::string> nodes;
    for (const std::string& name : draft.asked) {
      WireSources found = sources_behind(name);
      if (found.is_faulty || !found.open.empty()) nodes.emplace(never_known);
      if (found.wires.size() == 1) nodes.insert(found.wires.front().node);
      draft.unset.merge(found.open);
    }
    draft.asked = std::move(nodes);
  }

  /// Evaluates values that query forecasts, node by node, so that each can query earlier ones.
  void read_deferred(const std::vector<size_t>& order, Level& root) {
    Drafts& drafts = levels_.nodes();
    std::vector<std::string> asked;
    for (const NodeDraft& d : drafts) asked.insert(asked.end(), d.asked.begin(), d.asked.end());
    for (const NodeDraft& d : levels_.others()) asked.insert(asked.end(), d.asked.begin(), d.asked.end());
    if (asked.empty() && !has_waiting()) return;
    std::map<std::string, const NodeDraft*> by_name;
    for (const NodeDraft& d : drafts) by_name[d.node.name] = &d;
    const std::set<std::string> needed = needed_nodes(drafts, asked);
    std::set<std::string> incomplete = {never_known};  // problems and unset values are reported elsewhere
    std::set<std::string> known;
    Forecasts forecasts;
    levels_.set_forecasts([&](const std::string& name) -> const Forecast& {
      const std::string node = node_behind(name);
      if (const Forecast* found = forecasts.find(node)) return *found;
      throw Error(fmt::format("the results of \"{}\" are not known before it runs", node));
    });
    for (const size_t i : order) {
      NodeDraft& d = drafts[i];
      bool complete = true;
      for (const std::string& source : d.asked) {
        complete &= !incomplete.contains(source);
        if (const auto at = by_name.find(source); at != by_name.end())
          d.unset.insert(at->second->unset.begin(), at->second->unset.end());
      }
      const size_t before = problems_.size();
      if (complete) levels_.read_deferred(*d.level, known);
      if (complete && !d.waiting.empty()) read_waiting(d, problems_);
      set_file(problems_, before, d.node.file);
      if (needed.contains(d.node.name) && !(complete && look_ahead(d, forecasts, incomplete)))
        incomplete.insert(d.node.name);
      if (!incomplete.contains(d.node.name)) known.insert(d.node.name);
    }
    evaluate_rest(root, incomplete);
    levels_.set_forecasts({});
  }

  /// The document's own parameters that no node uses, as far as their queries are known.
  void evaluate_rest(Level& root, const std::set<std::string>& incomplete) {
    GraphScope& scope = *root.names.scope;
    for (const GraphParameter& p : root.names.parameters) {
      if (!p.formula) continue;
      const auto is_known = [&](const std::pair<const std::string, size_t>& asked) {
        const WireSources found = sources_behind(asked.first);
        return !found.is_faulty && found.open.empty() && found.wires.size() == 1 &&
               !incomplete.contains(found.wires.front().node);
      };
      if (std::ranges::all_of(p.formula->expression->nodes(), is_known)) scope.find(p.param.name);
    }
  }

  bool has_waiting() {
    const auto waits = [](const NodeDraft& d) { return !d.waiting.empty(); };
    return std::ranges::any_of(levels_.nodes(), waits) || std::ranges::any_of(levels_.others(), waits);
  }

  /// Whether the forecast succeeded; errors of the node's hooks become problems.
  bool look_ahead(const NodeDraft& draft, Forecasts& forecasts, const std::set<std::string>& incomplete) {
    const GraphNode& node = draft.node;
    if (!is_complete(draft)) return false;
    for (const auto& [port, wires] : node.inputs)
      for (const Wire& w : wires)
        if (incomplete.contains(w.node)) return false;
    const size_t before = of_sources_.size();
    try {
      forecasts.add(node);
      return true;
    } catch (const Errors& all) {
      for (const Error& e : all.all()) of_sources_.push_back(problem_of(node, e.about(), e.what()));
    } catch (const Error& e) {
      of_sources_.push_back(problem_of(node, e.about(), e.what()));
    }
    set_file(of_sources_, before, node.file);
    return false;
  }

  /// Reports problems of these nodes' sources. Returns whether other nodes have errors; they are left out.
  bool report_sources(const std::set<std::string>& nodes) {
    bool is_part = false;
    for (Problem& p : of_sources_) {
      if (nodes.contains(p.node))
        problems_.push_back(std::move(p));
      else
        is_part = true;
    }
    return is_part;
  }

  /// The nodes that can run without the faulty queried ones; the faulty ones stay, so that the run reports them.
  std::set<std::string> without_faulty(const std::vector<size_t>& order, const std::set<std::string>& wanted) {
    const std::set<std::string> asked = asked_too(levels_.nodes(), wanted);
    std::set<std::string> faulty;
    for (const Problem& p : of_sources_)
      if (asked.contains(p.node)) faulty.insert(p.node);
    for (NodeDraft& d : levels_.nodes()) d.node.fails = faulty.contains(d.node.name);
    return nodes_left(levels_.nodes(), order, wanted, faulty);
  }

  /// If all nodes run, includes unused parameters: they are there to be set.
  void require_set(const std::vector<GraphParameter>& parameters, const std::vector<Port>& inputs,
                   const std::set<std::string>& wanted) {
    const Drafts& drafts = levels_.nodes();
    std::set<std::string> unset = levels_.unset_for_loops();
    for (const NodeDraft& d : drafts)
      if (wanted.contains(d.node.name)) unset.insert(d.unset.begin(), d.unset.end());
    for (const GraphParameter& p : parameters)
      if (!p.value && !p.is_wrong && !p.formula && (wanted.size() == drafts.size() || unset.contains(p.param.name)))
        problems_.push_back({p.place, "parameter " + in_quotes(p.param.name),
                             fmt::format("has no default and must be set: --set {}=VALUE", p.param.name)});
    for (const Port& input : inputs)
      if (unset.contains(input.name))
        problems_.push_back({document_.find("inputs")->place, "input " + in_quotes(input.name),
                             "it is not connected: a graph with inputs runs as a node of another graph"});
  }

  /// The nodes without problems whose values are complete except for queried results.
  std::vector<GraphNode> faultless(const std::vector<size_t>& order) {
    const Drafts& drafts = levels_.nodes();
    std::set<std::string> faulty;
    for (const Problem& p : problems_) faulty.insert(p.node);
    std::vector<GraphNode> out;
    for (const size_t i : order) {
      const GraphNode& node = drafts[i].node;
      if (!faulty.contains(node.name) && is_complete(drafts[i])) out.push_back(node);
    }
    return out;
  }

  /// Represents a queried node whose results cannot be known, for reasons that have been reported.
  static constexpr const char* never_known = "?";

  std::string file_;
  fs::path path_, folder_;
  JsonValue document_;
  std::vector<Problem> problems_;
  std::vector<Problem> of_sources_;  ///< problems found by looking ahead, some of which may be about unneeded nodes
  size_t coded_ = 0;                 ///< number of problems that have a code
  std::vector<std::string> given_;
  std::vector<Override> given_to_pack_;  ///< overrides that do not come from the pack itself
  KnownTypes types_;
  Subgraphs subgraphs_;
  Levels levels_;
  Subgraph* main_ = nullptr;
};

}  // namespace

LoadedGraph load_graph_text(std::string_view text, const fs::path& path, const std::vector<Override>& overrides,
                            const LoadOptions& options) {
  return Loader(text, path, options).graph(overrides, options);
}

LoadedGraph load_graph(const fs::path& path, const std::vector<Override>& overrides, const LoadOptions& options) {
  return load_graph_text(read_document(path), path, overrides, options);
}

GraphInterface read_interface(const fs::path& path) {
  return read_interface_text(read_document(path), path);
}

GraphInterface read_interface_text(std::string_view text, const fs::path& path) {
  Loader loader(text, path, {});
  GraphInterface out = loader.interface();
  loader.finish();
  return out;
}

}  // namespace terrazzo
