#include "graphs/tools/grouping.h"

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/text/format.h"
#include "nodes/common/registry.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// A document and its parsed subgraph.
struct OpenDocument {
  OpenDocument(std::string_view text, const fs::path& path) : file(path.string()), json(current_document(text, file)) {
    main = &graphs.read_main(json, fs::absolute(path));
    throw_problems();
  }

  void throw_problems() {
    if (!problems.empty()) throw GraphError(file, std::move(problems));
  }

  std::string file;
  JsonValue json;
  std::vector<Problem> problems;
  KnownTypes types{node_types()};
  Subgraphs graphs{types, document_migrations(), problems};
  const Subgraph* main = nullptr;
};

}  // namespace

std::string grouped(std::string_view text, const fs::path& file, const std::string& name,
                    const std::vector<std::string>& nodes) {
  const OpenDocument document(text, file);
  JsonValue out = document.json;
  detail::group(out, *document.main, name, nodes);
  return formatted(out);
}

std::string ungrouped(std::string_view text, const fs::path& file, const std::string& node) {
  OpenDocument document(text, file);
  const JsonValue* use = document.json.find("nodes")->find(node);
  if (!use) {
    std::vector<std::string> names;
    for (const auto& [known, type] : document.main->sources) names.push_back(known);
    throw Error(fmt::format("the graph has no node {}{}", in_quotes(node), suggestion(node, names)));
  }
  const JsonValue* type = use->find("type");
  const Subgraph* graph = type ? document.graphs.find(*type, *document.main) : nullptr;
  document.throw_problems();
  if (!graph)
    throw Error(fmt::format("the node {} is of type {}, which is not a graph", in_quotes(node),
                            in_quotes(type ? type->text : "")));
  if (graph->folder != document.main->folder)
    throw Error(fmt::format("{} is in another folder, and its paths are relative to that", in_quotes(type->text)));
  JsonValue out = document.json;
  detail::ungroup(out, *graph, node);
  return formatted(out);
}

GraphInFile moved_to_file(std::string_view text, const std::string& file, const std::string& name,
                          const std::string& type) {
  JsonValue document = current_document(text, file);
  JsonValue& graphs = *document.find("graphs");
  JsonValue graph = JsonValue::empty_object();
  graph.members.push_back(document.members.front());  // the format version
  for (JsonMember& m : graphs.find(name)->members) graph.members.push_back(std::move(m));
  std::erase_if(graphs.members, [&](const JsonMember& m) { return m.name == name; });
  if (graphs.members.empty()) std::erase_if(document.members, [](const JsonMember& m) { return m.name == "graphs"; });
  const auto rename = [&](JsonValue& nodes) {
    for (JsonMember& m : nodes.members)
      if (JsonValue* t = m.value.find("type"); t && t->text == name) t->text = type;
  };
  rename(*document.find("nodes"));
  return {formatted(document), formatted(graph)};
}

}  // namespace terrazzo
