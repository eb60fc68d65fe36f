#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "graphs/text/json.h"

/// Changes of graph documents, as an editor makes them: from text to text. Order, comments and all bytes that a change
/// does not concern stay as they are.
namespace terrazzo {

struct EditedText {
  std::string text;
  std::vector<std::string> added{};  ///< names of the nodes that were added
  std::vector<size_t> added_by{};    ///< for each of these the position of the change
  std::vector<std::string> taken{};  ///< what else went away, a sentence each: wires to a removed node, presets, ...
  /// Nodes that have other names now: old and new name, with their level.
  struct Renamed {
    std::string level, from, to;
  };
  std::vector<Renamed> renamed{};
  std::string label{};  ///< what was done, for undo: `remove "lattice"`
};

/// Applies changes in order, all or none. Each is an object with the member "op", by default in the document's own
/// nodes; "level" names an entry of the section `graphs`.
///
/// | op         | members                                                                                   |
/// |------------|-------------------------------------------------------------------------------------------|
/// | add        | type, name?, values?, behind?: {node, output?}                                            |
/// | remove     | nodes: [..]                                                                               |
/// | connect    | from: "node" or "node.port", to, port, index? (in a list port: inserted there, else last) |
/// | disconnect | node, port, index?                                                                        |
/// | set, unset | node, key, value; without node: summary, help or seed of the graph                        |
/// | parameter  | name, set: {..} or null, rename?: its declaration; a member that is null goes away        |
/// | value      | name, value: the default of a parameter                                                   |
/// | preset     | name, set: {help?, set?} or null, rename?; a member that is null goes away                |
/// | input      | name, set: {..} or null: an input of the graph                                            |
/// | output     | name, from or null: an output of the graph, "node" or "node.port"                         |
/// | rename     | node, to: wires, expressions, outputs and presets follow                                  |
/// | group      | nodes: [..], name                                                                         |
/// | ungroup    | node                                                                                      |
/// | paste      | text: as copied_nodes returns it                                                          |
/// | insert     | node, wire: {node, port, index?}                                                          |
///
/// `file`: the document's path, absolute; its folder is where graph files used as types are looked for. Throws Error
/// with a message for the user if a change is not possible; about() is then the JSON pointer of the part concerned, or
/// empty. Thread-safe.
EditedText edited(std::string_view text, const std::filesystem::path& file, const JsonValue& edits);

/// These nodes as JSON text for a clipboard: {"nodes": {..}}, and the graphs of the document that they are made of.
/// Throws Error if one does not exist.
std::string copied_nodes(std::string_view text, const std::string& level, const std::vector<std::string>& nodes);

}  // namespace terrazzo
