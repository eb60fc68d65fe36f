#include "graphs/document/subgraphs.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/file/path_relation.h"
#include "core/file/read_guard.h"
#include "graphs/text/read_document.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

/// Asks the ReadGuard about graphs that are outside of the document's folder.
void check_reading(const fs::path& file, const fs::path& folder) {
  if (!ReadGuard::is_set()) return;
  std::error_code failure;
  const fs::path real = fs::weakly_canonical(file, failure), around = fs::weakly_canonical(folder, failure);
  if (failure || !lies_in(around, real)) ReadGuard::check(file);
}

std::optional<ValueType> value_type(const std::string& name) {
  const auto at = std::ranges::find(value_type_names, name);
  if (at == value_type_names.end()) return std::nullopt;
  return static_cast<ValueType>(at - value_type_names.begin());
}

std::string listed_value_types() {
  return listed(std::vector<std::string>(value_type_names.begin(), value_type_names.end()));
}

/// Reads the port's description in an entry of `inputs` or `outputs`.
class PortReader {
 public:
  PortReader(const JsonMember& member, const std::string& where, std::vector<Problem>& problems)
      : member_(member), diagnostics_(problems, where), out_{.name = member.name} {
    if (!is_parameter_name(member.name))
      diagnostics_.add(member.place, "expected a name of letters, digits and _ that begins with a letter");
  }

  void check_keys(const std::vector<std::string>& keys) {
    for (const JsonMember& m : member_.value.members)
      if (std::ranges::find(keys, m.name) == keys.end())
        diagnostics_.add(m.place, fmt::format("unknown key {}{}", in_quotes(m.name), suggestion(m.name, keys)));
  }

  /// False if there is none, or after a problem.
  bool read_type() {
    const JsonValue* type = member_.value.find("type");
    if (!type) return false;
    const std::optional<ValueType> known = type->is_text() ? value_type(type->text) : std::nullopt;
    if (known)
      out_.type = *known;
    else
      diagnostics_.add(type->place,
                       fmt::format("expected a type of values ({}), found {}", listed_value_types(), found(*type)));
    return known.has_value();
  }

  void read_help() {
    const JsonValue* help = member_.value.find("help");
    if (help && help->is_text())
      out_.help = help->text;
    else if (help)
      diagnostics_.add(help->place, "expected a text for \"help\", found " + found(*help));
  }

  bool read_flag(const char* key) {
    const JsonValue* flag = member_.value.find(key);
    if (flag && flag->kind != JsonValue::Kind::boolean)
      diagnostics_.add(flag->place, fmt::format("expected true or false for \"{}\", found {}", key, found(*flag)));
    return flag && flag->boolean;
  }

  Port& port() { return out_; }
  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  const JsonMember& member_;
  Diagnostics diagnostics_;
  Port out_;
};

}  // namespace

const std::vector<std::string>& document_keys() {
  static const std::vector<std::string> keys = {"terrazzo", "summary", "help",    "parameters", "presets", "seed",
                                                "inputs",   "nodes",   "outputs", "graphs",     "$schema"};
  return keys;
}

const std::vector<std::string>& subgraph_keys() {
  static const std::vector<std::string> keys = {"summary", "help", "parameters", "seed", "inputs", "nodes", "outputs"};
  return keys;
}

Subgraph& Subgraphs::read_main(const JsonValue& document, const fs::path& file) {
  Subgraph& main = graphs_.emplace_back();
  by_key_.emplace(file.lexically_normal().string(), &main);
  main.title = file.filename().string();
  main.folder = file.parent_path();
  main.json = &document;
  main.document = &main;
  read_sections(main);
  return main;
}

const Subgraph* Subgraphs::find(const JsonValue& type, const Subgraph& from) {
  if (!type.is_text()) return nullptr;
  const std::string& name = type.text;
  if (!is_file(name)) {
    if (const auto known = by_key_.find(from.document->file + "#" + name); known != by_key_.end()) return known->second;
    const JsonValue* section = from.document->json->find("graphs");
    const JsonValue* json = section ? section->find(name) : nullptr;
    if (!json || !json->is_object()) return nullptr;
    return read(from.document->file + "#" + name, {.title = name,
                                                   .file = from.document->file,
                                                   .folder = from.document->folder,
                                                   .json = json,
                                                   .document = from.document});
  }
  const auto refuse = [&](const std::string& message) {
    problems_.push_back({type.place, "", fmt::format("the graph {}: {}", in_quotes(name), message), "", from.file});
    return nullptr;
  };
  Subgraph out{.title = name};
  std::string_view text;
  std::string read_text;
  if (is_stock(name)) {
    try {
      text = named_stock_graph(name);
    } catch (const Error& e) {
      return refuse(e.what());
    }
    out.file = fmt::format("stock graph {}.json", name.substr(stock_prefix.size()));
    out.folder = graphs_.front().folder;
  } else {
    const fs::path path = (from.folder / name).lexically_normal();
    out.file = path.string();
    out.folder = path.parent_path();
    if (!by_key_.contains(out.file)) {
      try {
        check_reading(path, graphs_.front().folder);
        read_text = read_document(path);
      } catch (const GraphError& e) {
        by_key_.emplace(out.file, nullptr);
        return refuse(e.problems().front().message);
      } catch (const Error& e) {
        by_key_.emplace(out.file, nullptr);
        return refuse(e.what());
      }
      files_.push_back(path);
    }
    text = read_text;
  }
  if (const auto known = by_key_.find(out.file); known != by_key_.end()) return known->second;
  out.json = document_in(text, out.file);
  if (!out.json) {
    by_key_.emplace(out.file, nullptr);
    return nullptr;
  }
  const std::string key = out.file;
  return read(key, std::move(out));
}

/// Null after problems.
const JsonValue* Subgraphs::document_in(std::string_view text, const std::string& file) {
  const size_t before = problems_.size();
  ParsedJson parsed = parse_json(text);
  problems_.insert(problems_.end(), parsed.problems.begin(), parsed.problems.end());
  const bool is_right = parsed.value && migrate(*parsed.value, migrations_, problems_);
  if (is_right)
    for (const JsonMember& m : parsed.value->members)
      if (std::ranges::find(document_keys(), m.name) == document_keys().end())
        problems_.push_back(
            {m.place, "", fmt::format("unknown key {}{}", in_quotes(m.name), suggestion(m.name, document_keys()))});
  set_file(problems_, before, file);
  return is_right ? &documents_.emplace_back(std::move(*parsed.value)) : nullptr;
}

const Subgraph* Subgraphs::read(const std::string& key, Subgraph graph) {
  const auto [at, is_new] = by_key_.emplace(key, nullptr);
  if (!is_new) return at->second;
  Subgraph& out = graphs_.emplace_back(std::move(graph));
  at->second = &out;
  if (!out.document) out.document = &out;
  const size_t before = problems_.size();
  if (out.document != &out)
    for (const JsonMember& m : out.json->members)
      if (std::ranges::find(subgraph_keys(), m.name) == subgraph_keys().end())
        problems_.push_back({m.place, "graph " + in_quotes(out.title),
                             fmt::format("unknown key {}{}", in_quotes(m.name), suggestion(m.name, subgraph_keys()))});
  read_sections(out);
  set_file(problems_, before, out.file);
  return &out;
}

std::string Subgraphs::text_at(const JsonValue& json, std::string_view key) {
  const JsonValue* v = json.find(key);
  if (!v) return "";
  if (!v->is_text()) problems_.push_back({v->place, fmt::format("\"{}\"", key), "expected a text, found " + found(*v)});
  return v->text;
}

void Subgraphs::read_sections(Subgraph& graph) {
  const JsonValue& json = *graph.json;
  const auto object_at = [&](const char* key, const char* expected) {
    const JsonValue* section = json.find(key);
    if (!section || section->is_object()) return section;
    problems_.push_back(
        {section->place, in_quotes(key), fmt::format("expected {}, found {}", expected, found(*section))});
    return static_cast<const JsonValue*>(nullptr);
  };
  open_.push_back(&graph);
  graph.summary = text_at(json, "summary");
  graph.help = text_at(json, "help");
  if (const JsonValue* section = json.find("parameters"))
    graph.parameters = read_parameters(*section, graph.folder, problems_);
  if (graph.document == &graph)
    if (const JsonValue* section = object_at("graphs", "an object of graphs by name"))
      for (const JsonMember& m : section->members) {
        const std::string where = "graph " + in_quotes(m.name);
        graph.graph_names.push_back(m.name);
        if (!is_node_name(m.name)) problems_.push_back({m.place, where, "expected a name of letters, digits, _ and -"});
        if (types_.find(m.name)) problems_.push_back({m.place, where, "a node type has this name; choose another"});
        if (!m.value.is_object())
          problems_.push_back(
              {m.value.place, where,
               "expected a graph, an object with \"nodes\", \"inputs\" and \"outputs\", found " + found(m.value)});
      }
  if (!json.find("nodes"))
    problems_.push_back({json.place, graph.document == &graph ? "" : "graph " + in_quotes(graph.title),
                         "expected \"nodes\", an object of nodes by name"});
  object_at("nodes", "an object of nodes by name");
  if (const JsonValue* section = object_at("inputs", "an object of inputs by name")) read_inputs(graph, *section);
  read_sources(graph);
  if (const JsonValue* section = object_at("outputs", "an object of wires by name"))
    for (const JsonMember& m : section->members) read_output(graph, m);
  open_.pop_back();
}

void Subgraphs::read_inputs(Subgraph& graph, const JsonValue& section) {
  std::set<std::string_view> node_names;
  if (const JsonValue* nodes = graph.json->find("nodes"))
    for (const JsonMember& n : nodes->members) node_names.insert(n.name);
  for (const JsonMember& m : section.members) {
    PortReader reader(m, "input " + in_quotes(m.name), problems_);
    if (node_names.contains(m.name))
      reader.diagnostics().add(m.place, "a node has this name too; wires could not tell them apart");
    if (!m.value.is_object()) {
      reader.diagnostics().add(
          m.value.place,
          "expected an object such as {\"type\": \"material\", \"help\": \"...\"}, found " + found(m.value));
      continue;
    }
    reader.check_keys({"type", "help", "optional", "list"});
    if (!reader.read_type() && !m.value.find("type"))
      reader.diagnostics().add(m.value.place, fmt::format("expected a \"type\": {}", listed_value_types()));
    reader.read_help();
    reader.port().optional = reader.read_flag("optional");
    reader.port().list = reader.read_flag("list");
    graph.inputs.push_back(reader.port());
  }
}

/// The possible sources of the graph's wires.
void Subgraphs::read_sources(Subgraph& graph) {
  if (const JsonValue* nodes = graph.json->find("nodes"))
    for (const JsonMember& m : nodes->members) {
      const JsonValue* type = m.value.find("type");
      const NodeType* known = type && type->is_text() ? types_.find(type->text) : nullptr;
      if (type && !known) {
        const size_t before = problems_.size();
        const Subgraph* inner = find(*type, graph);
        for (size_t i = before; i < problems_.size(); i++)
          if (problems_[i].where.empty() && problems_[i].place.line == type->place.line)
            problems_[i].where = "node " + in_quotes(m.name);
        // A graph that is still being read contains itself, which is reported where it is used.
        if (inner && !inner->is_wrong && std::ranges::find(open_, inner) == open_.end())
          known = &graph.types.emplace_back(type_of_use(*inner, {}));
      }
      graph.sources.emplace_back(m.name, known);
    }
  for (const Port& input : graph.inputs) {
    NodeType& type = graph.types.emplace_back();
    type.name = "input";
    type.outputs = {input};
    graph.sources.emplace_back(input.name, &type);
  }
  for (size_t i = 0; i < graph.sources.size(); i++) graph.positions.emplace(graph.sources[i].first, i);
}

/// Null if the wire has no source, which is reported where it is used, or if the source is unknown.
const Port* Subgraphs::port_behind(const Subgraph& graph, const JsonValue& wire) const {
  std::vector<Problem> ignored;
  Diagnostics diagnostics(ignored, "");
  const WireEnd end = wire_end(wire, diagnostics);
  const auto* source = graph.find_source(end.node);
  if (!source || !source->second || source->second->outputs.empty()) return nullptr;
  return end.port.empty() ? &source->second->outputs.front() : source->second->find_output(end.port);
}

void Subgraphs::read_output(Subgraph& graph, const JsonMember& member) {
  PortReader reader(member, "output " + in_quotes(member.name), problems_);
  const JsonValue* from = member.value.is_object() ? member.value.find("from") : &member.value;
  if (member.value.is_object()) {
    reader.check_keys({"from", "type", "help"});
    reader.read_help();
  }
  const bool is_expression_ = from && from->is_text() && is_expression(from->text);
  if (!from || !(is_wire(*from) || is_expression_)) {
    reader.diagnostics().add(member.value.place,
                             "expected a wire such as \"@node\" or \"@node.port\", or an object "
                             "such as {\"from\": \"@node\", \"help\": \"...\"}, found " +
                                 found(from ? *from : member.value));
    graph.is_wrong = true;
    return;
  }
  if (!reader.read_type()) {
    const Port* source = is_wire(*from) ? port_behind(graph, *from) : nullptr;
    if (is_expression_)
      reader.diagnostics().add(member.value.place,
                               "if an expression chooses the wire, its type must be given: {\"from\": \"=...\", "
                               "\"type\": \"material\"}");
    if (!source) graph.is_wrong = true;
    if (source) reader.port().type = source->type;
  }
  graph.outputs.push_back({reader.port(), *from});
}

std::vector<fs::path> Subgraphs::files() const {
  return files_;
}

std::vector<std::pair<std::string, Place>> Subgraphs::unused() const {
  std::vector<std::pair<std::string, Place>> out;
  const Subgraph& main = graphs_.front();
  if (const JsonValue* section = main.json->find("graphs"))
    for (const JsonMember& m : section->members)
      if (!by_key_.contains(main.file + "#" + m.name)) out.emplace_back(m.name, m.place);
  return out;
}

NodeType type_of_use(const Subgraph& graph, const std::vector<std::string>& given) {
  NodeType out;
  out.name = graph.title;
  out.category = graph_category;
  out.summary = graph.summary;
  out.help = graph.help;
  out.inputs = graph.inputs;
  for (const GraphOutput& o : graph.outputs) out.outputs.push_back(o.port);
  for (const GraphParameter& p : graph.parameters) {
    if ((p.is_wrong || p.formula) && std::ranges::find(given, p.param.name) == given.end()) continue;
    out.params.push_back(p.param);
    if (p.value) out.params.back().fallback = p.value;  // its path is absolute
  }
  return out;
}

}  // namespace terrazzo
