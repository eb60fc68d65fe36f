#include "runner/cli/exemplar/starting_graph.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "core/analysis/space/weighting.h"
#include "core/base/text.h"
#include "graphs/text/format.h"
#include "graphs/text/json.h"
#include "graphs/text/stock_graphs.h"
#include "graphs/values/convert.h"

namespace terrazzo {

namespace {

JsonValue& needed_member(JsonValue& object, std::string_view name) {
  if (JsonValue* found = object.find(name)) return *found;
  throw std::logic_error(fmt::format("the stock graph has no \"{}\"", name));
}

/// Names of parameters for folders, and, at the end, for a picture; the first that a graph has is set.
constexpr std::array<std::string_view, 4> folder_parameters = {"material", "first", "base", "image"};

JsonValue* folder_parameter(JsonValue& graph) {
  JsonValue* parameters = graph.find("parameters");
  for (const std::string_view name : folder_parameters)
    if (JsonValue* found = parameters ? parameters->find(name) : nullptr) return found;
  return nullptr;
}

/// Whether a map is constant, so that nothing in it can be compared.
bool is_constant(const Image& image) {
  const int channels = image.channels();
  std::array<float, 4> least, most;
  least.fill(std::numeric_limits<float>::max());
  most.fill(std::numeric_limits<float>::lowest());
  for_each_strip(image, [&](const Rect& r, const float* v) {
    for (int64_t i = 0; i < r.area() * channels; i++) {
      least[i % channels] = std::min(least[i % channels], v[i]);
      most[i % channels] = std::max(most[i % channels], v[i]);
    }
  });
  for (int c = 0; c < channels; c++)
    if (most[c] - least[c] > 1.5f / 255) return false;
  return true;
}

void comment(JsonValue& value, const std::string& text) {
  value.comments_before.push_back("// " + text);
}

void weigh(JsonValue& weighted, const Material& exemplar) {
  comment(weighted, "How much each map counts when neighbourhoods are compared; 0 leaves a map out.");
  JsonValue weights = JsonValue::empty_object();
  for (const Map& m : exemplar.maps()) {
    const bool is_empty = is_constant(*m.image);
    if (is_empty) comment(weighted, m.name + " is the same everywhere and is left out.");
    weights.members.push_back({m.name, {}, json_of(is_empty ? 0.0 : default_weight(m.image->info().semantic))});
  }
  const bool all_are_empty =
      std::ranges::all_of(weights.members, [](const JsonMember& m) { return m.value.number == 0; });
  if (!all_are_empty) weighted.set("weights", std::move(weights));
}

void tell_of_lattice(JsonValue& lattice, const ExemplarFindings& look) {
  for (const std::string& note : look.lattice_notes) comment(lattice, note);
  if (look.repeats) {
    comment(lattice, "Pieces move by whole steps of it. \"off\" lets them move freely: more variety, broken joints.");
    return;
  }
  comment(lattice, "So none is looked for. \"auto\" looks again, \"manual\" takes one that you give.");
  lattice.set("mode", JsonValue::of("off"));
}

void tell_of_layout(JsonValue& layout, const ExemplarFindings& look) {
  comment(layout, "Another seed gives another variation; nothing before this node runs again for it.");
  comment(layout, look.repeats
                      ? "Jitter is left to the lattice: it moves pieces by whole steps, so that joints meet."
                      : "Jitter is chosen by the exemplar's size: without a lattice, more gives more variety.");
  comment(layout, "Where results repeat: raise evenness. Where they look torn: lower coherence, or less jitter.");
}

/// The node that reads the folder; null if the graph has none.
JsonValue* folder_reader(JsonValue& graph) {
  for (JsonMember& node : needed_member(graph, "nodes").members) {
    const JsonValue* path = node.value.find("path");
    const bool reads_it = path && std::ranges::any_of(folder_parameters, [&](std::string_view parameter) {
                            return path->text == fmt::format("${}", parameter);
                          });
    if (reads_it) return &node.value;
  }
  return nullptr;
}

/// Sets the material's name: by a parameter of the graph, or of the node that reads the folder.
void pick_material(JsonValue& graph, const std::string& name) {
  if (name.empty()) return;
  if (JsonValue* parameter = needed_member(graph, "parameters").find("name"))
    return parameter->set("default", JsonValue::of(name));
  if (JsonValue* node = folder_reader(graph)) node->set("name", JsonValue::of(name));
}

void interpret(JsonValue& graph, const std::map<std::string, std::string>& maps) {
  JsonValue* node = maps.empty() ? nullptr : folder_reader(graph);
  if (!node) return;
  if (node->find("type")->text == "load_map") return node->set("interpret", JsonValue::of(maps.begin()->second));
  JsonValue said = JsonValue::empty_object();
  for (const auto& [map, how] : maps) said.set(map, JsonValue::of(how));
  node->set("interpret", std::move(said));
}

/// Lets all readers of `from` read `to`. Expressions about the node's size stay.
void rewire(JsonValue& value, std::string_view from, std::string_view to) {
  if (value.text == from) value.text = to;
  for (JsonValue& item : value.items) rewire(item, from, to);
  for (JsonMember& member : value.members) rewire(member.value, from, to);
}

/// Puts a node behind the exemplar that takes out its light.
void delight(JsonValue& nodes, const ExemplarFindings& look) {
  constexpr const char* name = "even_light";
  const auto exemplar = std::ranges::find(nodes.members, "exemplar", &JsonMember::name);
  for (const char* wire : {"@exemplar", "@exemplar.material", "@exemplar.image"})
    rewire(nodes, wire, std::string("@") + name);
  JsonValue node = JsonValue::empty_object();
  node.set("type", JsonValue::of("delight"));
  node.set("material", JsonValue::of("@exemplar"));
  comment(node, look.light() + ".");
  comment(node, "This takes out what is slow, and the shading of the relief; \"strength\" says how much.");
  nodes.members.insert(exemplar + 1, {name, {}, std::move(node)});
}

}  // namespace

std::string ExemplarFindings::nature() const {
  if (repeats) return streaks ? "it repeats, in streaks" : "it repeats";
  return fmt::format("{}; it {}", streaks ? "streaks" : "no lattice", tiles ? "tiles" : "does not tile");
}

std::string ExemplarFindings::advice() const {
  return method.sentence() + (method.method == Method::noise ? "; --like noise begins with that" : "");
}

std::string ExemplarFindings::light() const {
  if (!faults.is_lit_from_a_side()) return "";
  return fmt::format("It is {:.0f} % brighter at the {} than at the {}: light that was baked in",
                     100 * faults.brightening, faults.bright_side, faults.dark_side);
}

bool takes_an_exemplar(std::string_view graph, bool is_picture) {
  ParsedJson parsed = parse_json(graph);
  if (!parsed.value || parsed.value->find("inputs")) return false;
  const JsonValue* parameter = folder_parameter(*parsed.value);
  return parameter && is_picture == (parameter == parsed.value->find("parameters")->find(folder_parameters.back()));
}

std::string starting_graph(const ExemplarFindings& look, std::string_view stock) {
  ParsedJson parsed = parse_json(stock);
  if (!parsed.value) throw std::logic_error("the stock graph is not JSON");
  JsonValue& graph = *parsed.value;
  // Defaults are literal: "$" and "@" have no special meaning.
  folder_parameter(graph)->set("default", JsonValue::of(look.folder.generic_string()));
  pick_material(graph, look.name);
  interpret(graph, look.interpret);

  JsonValue& nodes = needed_member(graph, "nodes");
  if (nodes.members.empty()) return formatted(graph);
  JsonValue& first = nodes.members.front().value;
  comment(first, "What was found in " + look.folder.generic_string() + ":");
  for (const Map& m : look.exemplar->maps())
    comment(first, fmt::format("  {}: {}x{}, {}", m.name, m.image->width(), m.image->height(),
                               counted(m.image->channels(), "channel")));
  for (const std::string& note : look.notes) comment(first, "  " + note);
  comment(first, "  " + look.advice());
  // Graphs with several exemplars compare common maps.
  const bool is_of_one = nodes.find("exemplar") && !nodes.find("all");
  if (is_of_one && !look.light().empty()) delight(nodes, look);
  if (JsonValue* weighted = nodes.find("weighted"); weighted && is_of_one) weigh(*weighted, *look.exemplar);
  if (JsonValue* guides = nodes.find("guides"))
    comment(*guides, "Edges keep features such as joints and cracks whole. `terrazzo nodes guidance` says more.");
  if (JsonValue* lattice = nodes.find("lattice"); lattice && is_of_one) tell_of_lattice(*lattice, look);
  if (JsonValue* layout = nodes.find("layout"); layout && layout->find("type")->text == "synthesize")
    tell_of_layout(*layout, look);
  return formatted(graph);
}

}  // namespace terrazzo
