#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "graphs/document/subgraphs.h"
#include "graphs/edit/edit_document.h"
#include "graphs/text/json.h"

/// What the edits share. They change a parsed document; its text follows at the end.
namespace terrazzo::edits {

/// A document in the midst of its changes, and the change that is being applied.
struct EditContext {
  JsonValue document;
  std::filesystem::path file;
  EditedText out{};
  const JsonValue* change = nullptr;
  std::string level{};  ///< of the change

  /// A member of the change. These throw Error if it is missing or of another kind.
  const std::string& text(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key) const;
  const JsonValue& value(std::string_view key) const;
  /// Empty if there is none.
  std::string text_or_empty(std::string_view key) const;
  /// -1 if there is none.
  int64_t position(std::string_view key) const;

  /// The graph of the level: the document, or an entry of its section `graphs`. Throws Error if there is none.
  JsonValue& graph();
  /// The section, created if it is missing.
  JsonValue& section(const std::string& name);
  /// Null if there is none of that name.
  JsonValue* find_node(const std::string& name);
  /// Throws Error if there is none, with the nearest name.
  JsonValue& node(const std::string& name);

  /// The JSON pointer of something in the level: {"nodes", "x"}.
  std::string pointer(std::vector<std::string> path) const;
  /// A name that no node and no input of the level has: the wanted one, or with a number.
  std::string free_name(const std::string& wanted);
  void label(const std::string& what) { out.label = out.label.empty() ? what : out.label; }
};

/// The types of the nodes in a level, as the document has them now.
class LevelTypes {
 public:
  explicit LevelTypes(EditContext& context);

  const Subgraph& graph() const { return *graph_; }
  /// Null if the node or its type is unknown.
  const NodeType* of(const std::string& node) const;
  /// The type that a node would have; null if it is unknown.
  const NodeType* named(const JsonValue& type);
  Subgraphs& graphs() { return graphs_; }
  const Subgraph& main() const { return *main_; }

 private:
  JsonValue document_;
  std::vector<Problem> problems_;
  KnownTypes known_;
  Subgraphs graphs_;
  const Subgraph* main_;
  const Subgraph* graph_;
  std::deque<NodeType> uses_;
};

/// The nodes that a node's wires and expressions name.
std::vector<std::string> named_nodes(const JsonValue& node);

/// Renames nodes in the wires and expressions of an entry; all other texts stay as they are.
void rename_nodes(JsonValue& entry, const std::map<std::string, std::string>& names);

/// Takes the wires to nodes that are gone out of an entry. Returns the ports concerned.
std::vector<std::string> without_wires(JsonValue& entry, const std::function<bool(const std::string& node)>& is_gone);

/// A node's or a parameter's name within a target of a preset, and the level that it belongs to. It may be changed;
/// false takes the target out.
using TargetPart = std::function<bool(const std::string& level, std::string& name)>;

/// Calls `on_node` for every node that a preset's target leads through, and `on_parameter` for the parameter of a graph
/// of the document that it sets; either may be empty. Returns what was taken out, in words.
std::vector<std::string> walk_preset_targets(JsonValue& document, const TargetPart& on_node,
                                             const TargetPart& on_parameter);

/// Puts a wire into a port. Throws Error if it does not fit, naming both ends.
void put_wire(EditContext& context, const std::string& from, const std::string& to, const std::string& port,
              int64_t index);
/// Throws Error, which begins with `refused`, if the source depends on the reader.
void refuse_cycle(EditContext& context, const std::string& source, const std::string& reader,
                  const std::string& refused);
/// The wire of this text ("node", "node.port", with or without @) with its first output left out.
std::string wire_text(const LevelTypes& types, const std::string& from);
/// The node's first input that a wire of this type fits into, and that is free; null if there is none.
const Port* fitting_input(const NodeType& node, ValueType wire);

void add(EditContext& context);
void remove(EditContext& context);
void rename(EditContext& context);
void insert(EditContext& context);
void connect(EditContext& context);
void disconnect(EditContext& context);
void set(EditContext& context);
void unset(EditContext& context);
void set_parameter(EditContext& context);
void set_preset(EditContext& context);
void set_default(EditContext& context);
void set_input(EditContext& context);
void set_output(EditContext& context);
void group(EditContext& context);
void ungroup(EditContext& context);
void paste(EditContext& context);

}  // namespace terrazzo::edits
