#include "graphs/document/load.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/base/paths.h"
#include "core/base/suggest.h"
#include "graphs/document/file_origins.h"
#include "graphs/document/forecast_pass.h"
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
    std::vector<Problem> conversions;
    Level& root = first_pass(std::move(head.parameters), overrides, conversions);
    std::vector<GraphParameter>& parameters = root.names.parameters;
    Drafts& drafts = levels_.nodes();
    forecasts_.resolve_queries();
    const std::vector<size_t> order = execution_order(drafts, problems_);
    coded("cycle");
    forecasts_.run(order, root);
    const std::set<std::string> wanted = wanted_nodes(drafts, options.only);
    const bool is_part =
        options.keep_going ? !forecasts_.problems_of_sources().empty() : report_sources(asked_too(drafts, wanted));
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

  void collect_values(std::map<std::string, Params>& values) {
    for (Drafts* drafts : {&levels_.nodes(), &levels_.others()})
      for (NodeDraft& d : *drafts) values.emplace(d.node.name, std::move(d.node.params));
  }

 private:
  /// Reads all values but those that query results of nodes, and connects the nodes.
  Level& first_pass(std::vector<GraphParameter> parameters, std::vector<Override>& overrides,
                    std::vector<Problem>& conversions) {
    auto owned = std::make_unique<Level>();
    owned->graph = main_;
    NodeScope& names = owned->names;
    names.parameters = std::move(parameters);
    merge_members(overrides, names.parameters, main_->sources, problems_);
    set_parameters(names.parameters, overrides, main_->sources, problems_);
    coded("override");
    names.scope = std::make_unique<GraphScope>(names.parameters, main_->sources, "", problems_);
    names.scope->evaluate_parameters();
    coded("document");
    names.substitution = std::make_unique<Substitution>(*names.scope);
    Level& root = levels_.read(std::move(owned), overrides);
    coded("node");
    if (levels_.is_full()) finish();  // further checks would process everything read so far
    for (const std::unique_ptr<Level>& level : levels_.all()) check_wires(*level, problems_, conversions);
    connect(levels_, problems_);
    coded("wire");
    return root;
  }

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

  /// Reports problems of these nodes' sources. Returns whether other nodes have errors; they are left out.
  bool report_sources(const std::set<std::string>& nodes) {
    bool is_part = false;
    for (Problem& p : forecasts_.problems_of_sources()) {
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
    for (const Problem& p : forecasts_.problems_of_sources())
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
        Diagnostics(problems_, "parameter " + in_quotes(p.param.name), p.param.name)
            .add(p.place, fmt::format("has no default and must be set: --set {}=VALUE", p.param.name));
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

  std::string file_;
  fs::path path_, folder_;
  JsonValue document_;
  std::vector<Problem> problems_;
  size_t coded_ = 0;  ///< number of problems that have a code
  std::vector<std::string> given_;
  std::vector<Override> given_to_pack_;  ///< overrides that do not come from the pack itself
  KnownTypes types_;
  Subgraphs subgraphs_;
  Levels levels_;
  ForecastPass forecasts_{levels_, problems_};
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

InspectedGraph inspect_graph_text(std::string_view text, const fs::path& path, const LoadOptions& options) {
  InspectedGraph out;
  std::optional<Loader> loader;
  try {
    loader.emplace(text, path, options);
    LoadedGraph loaded = loader->graph({}, options);
    out.conversions = std::move(loaded.conversions);
    out.warnings = std::move(loaded.warnings);
    out.parameters = std::move(loaded.parameters);
    for (GraphNode& n : loaded.graph.nodes) out.values.emplace(n.name, std::move(n.params));
  } catch (const GraphError& e) {
    out.problems = e.problems();
  }
  if (loader) loader->collect_values(out.values);
  return out;
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
