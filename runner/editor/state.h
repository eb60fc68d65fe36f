#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "graphs/text/problem.h"
#include "runner/editor/document.h"
#include "runner/editor/layout_edits.h"

/// What an editor's page shows of a document, as JSON.
namespace terrazzo {

/// Further problems of the graph, found by planning it: by severity.
struct FoundProblems {
  std::vector<Problem> errors, warnings, notes;
};

/// The whole state: revision, file, text, levels with nodes and positions, problems. Ports and parameters of a node
/// only if its type is not in types_json. `found`: what else is known, such as what preflight finds; problems that are
/// listed already are left out. Reads the graph files and tables that the graph names (set a ReadGuard to confine
/// that). Never throws because of the document. Positions that are not in the layout are chosen here. The text may not
/// be UTF-8: use dump's error handler `replace`. Thread-safe.
nlohmann::ordered_json state_json(const DocumentSnapshot& document, const FoundProblems& found = {});

/// {"values": {...}} of a preset of the document: by target, "seed" or "node.parameter". Throws Error if there is none.
nlohmann::ordered_json preset_json(const DocumentSnapshot& document, const std::string& name);

/// {"lines": [...], "nodes": {name: "added"|"changed"|"removed"}}: how the text differs from the file in git's last
/// commit, in the words of `diff`. Names of nodes in other levels are "level/name". Both empty if there is no git, no
/// repository, or no such file in it. Runs git, but no program that the repository's settings name.
nlohmann::ordered_json changed_since_commit(const DocumentSnapshot& document);

}  // namespace terrazzo
